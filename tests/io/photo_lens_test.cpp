#include "io/photo_lens.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "scene_fixture.h"

namespace photohull::io {
namespace {

using PhotoLensTest = TemporaryFolder;

std::filesystem::path photograph(const std::filesystem::path& file, float seconds, float stop,
                                 int speed) {
  OIIO::ImageSpec spec(36, 24, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("Make", "Maker");
  spec.attribute("ExposureTime", seconds);
  spec.attribute("FNumber", stop);
  if (speed > 0) spec.attribute("Exif:PhotographicSensitivity", speed);
  const std::vector<unsigned char> grey(std::size_t(36) * 24 * 3, 90);
  const auto out = OIIO::ImageOutput::create(file.string());
  EXPECT_TRUE(out && out->open(file.string(), spec) &&
              out->write_image(OIIO::TypeDesc::UINT8, grey.data()) && out->close());
  return file;
}

TEST_F(PhotoLensTest, TellsTheExposureThatTheCameraChose) {
  const double once = read_photo_lens(photograph(folder_ / "a.jpg", 0.01f, 4, 200)).exposure;
  EXPECT_NEAR(once, 0.01 / 16 * 2, 1e-6);
  // A stop more light by another aperture.
  EXPECT_NEAR(read_photo_lens(photograph(folder_ / "b.jpg", 0.01f, 2.8284f, 200)).exposure,
              2 * once, 1e-5);
  EXPECT_EQ(read_photo_lens(photograph(folder_ / "c.jpg", 0.01f, 4, 0)).exposure, 0);
  EXPECT_EQ(read_photo_lens(put_image("d.png")).exposure, 0);
}

}  // namespace
}  // namespace photohull::io
