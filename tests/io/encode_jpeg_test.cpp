// Pictures as JPEG files in memory.
#include "io/encode_jpeg.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/error.h"
#include "io/image_file.h"
#include "scene_fixture.h"

namespace photohull::io {
namespace {

using EncodeJpeg = TemporaryFolder;

std::vector<std::uint8_t> slope(int width, int height) {
  std::vector<std::uint8_t> rgb;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int value : {std::min(255, 2 * x), std::min(255, y), 128})
        rgb.push_back(std::uint8_t(value));
  return rgb;
}

TEST_F(EncodeJpeg, IsReadBackAsItWas) {
  for (const auto& [width, height] : {std::pair{61, 37}, {1, 1}, {8, 300}}) {
    const std::vector<std::uint8_t> rgb = slope(width, height);
    const std::vector<std::uint8_t> jpeg = encode_jpeg(width, height, rgb, 90);
    const auto path = folder_ / "picture.jpg";
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(jpeg.data()), std::streamsize(jpeg.size()));
    const ColourImage image = read_image(path);
    ASSERT_EQ(image.width, width);
    ASSERT_EQ(image.height, height);
    int farthest = 0;
    for (std::size_t i = 0; i < rgb.size() / 3; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        farthest = std::max(farthest, std::abs(int(image.bytes[4 * i + c]) - int(rgb[3 * i + c])));
    EXPECT_LE(farthest, 10) << width << " x " << height;
  }
}

TEST_F(EncodeJpeg, LowerQualityTakesLess) {
  std::vector<std::uint8_t> rgb = slope(200, 200);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] ^= std::uint8_t(i * 2654435761u >> 27);
  EXPECT_LT(encode_jpeg(200, 200, rgb, 50).size(), encode_jpeg(200, 200, rgb, 90).size());
  EXPECT_EQ(encode_jpeg(200, 200, rgb, 50), encode_jpeg(200, 200, rgb, 50));
}

TEST_F(EncodeJpeg, RefusesPicturesThatNoJpegHolds) {
  const std::vector<std::uint8_t> rgb(70000 * 3);
  EXPECT_THROW(encode_jpeg(70000, 1, rgb, 80), Error);
}

}  // namespace
}  // namespace photohull::io
