#include "gpu/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/error.h"
#include "core/image.h"
#include "support/gl_context.h"

namespace photohull::gpu {
namespace {

class TextureTest : public ::testing::Test {
 protected:
  void TearDown() override { context_.check_errors("texture test"); }
  Context& context_ = test::gl_context();
};

TEST_F(TextureTest, LayersKeepTheirPixels) {
  TextureArray texture(TextureFormat::kR32f, 5, 3, 2);
  EXPECT_EQ(texture.levels(), 1);
  std::vector<float> first(15), second(15);
  for (int i = 0; i < 15; ++i) first[i] = float(i), second[i] = -float(i);
  texture.upload(0, 5, 3, first.data());
  texture.upload(1, 5, 3, second.data());
  std::vector<float> all(30);
  texture.read(0, all.size() * 4, all.data());
  EXPECT_TRUE(std::equal(first.begin(), first.end(), all.begin()));
  EXPECT_TRUE(std::equal(second.begin(), second.end(), all.begin() + 15));
}

TEST_F(TextureTest, SmallerUploadsLieAtTheOrigin) {
  TextureArray texture(TextureFormat::kR8, 4, 4, 1);
  const std::vector<std::uint8_t> whole(16, 9), corner{1, 2, 3, 4, 5, 6};
  texture.upload(0, 4, 4, whole.data());
  texture.upload(0, 3, 2, corner.data());  // rows of 3 bytes: no padding may be assumed
  std::vector<std::uint8_t> out(16);
  texture.read(0, out.size(), out.data());
  EXPECT_EQ(out, std::vector<std::uint8_t>({1, 2, 3, 9, 4, 5, 6, 9, 9, 9, 9, 9, 9, 9, 9, 9}));
}

TEST_F(TextureTest, MoreThanTheDeviceHasIsRefusedByName) {
  Limits low = context_.limits();
  low.texture_size = 64, low.texture_layers = 3;
  set_current_limits(&low);
  EXPECT_NO_THROW(TextureArray(TextureFormat::kR8, 64, 64, 3));
  const auto message = [](int width, int height, int layers) -> std::string {
    try {
      TextureArray(TextureFormat::kR8, width, height, layers);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  for (const std::string& text : {message(65, 4, 1), message(4, 65, 1)})
    EXPECT_NE(text.find("(image_scale)"), std::string::npos) << text;
  EXPECT_NE(message(4, 4, 4).find("(views)"), std::string::npos) << message(4, 4, 4);
  set_current_limits(&context_.limits());
}

TEST_F(TextureTest, LevelsReachDownToOnePixel) {
  EXPECT_EQ(TextureArray(TextureFormat::kR8, 64, 32, 1, 0).levels(), 7);
  EXPECT_EQ(TextureArray(TextureFormat::kR8, 65, 1, 1, 0).levels(), 7);
  EXPECT_EQ(TextureArray(TextureFormat::kR8, 1, 1, 1, 0).levels(), 1);
  EXPECT_EQ(TextureArray(TextureFormat::kR8, 64, 64, 1, 3).levels(), 3);
}

TEST_F(TextureTest, MipmapsOfSrgbAverageLinearLight) {
  TextureArray texture(TextureFormat::kSrgb8Alpha8, 4, 2, 1, 0);
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < 8; ++i) {
    const std::uint8_t value = i % 2 ? 255 : 0;  // columns of black and white
    pixels.insert(pixels.end(), {value, value, value, 255});
  }
  texture.upload(0, 4, 2, pixels.data());
  texture.generate_mipmaps();
  std::vector<std::uint8_t> level(2 * 4);
  texture.read(1, level.size(), level.data());
  // Half the light is the sRGB value 188; an average of the encoded values would be 128.
  EXPECT_NEAR(level[0], 255 * srgb_from_linear(0.5), 1);
  EXPECT_NEAR(level[4], 255 * srgb_from_linear(0.5), 1);
  EXPECT_EQ(level[3], 255);
}

TEST_F(TextureTest, MipmapsOfFloatsAreBoxMeans) {
  TextureArray texture(TextureFormat::kR32f, 8, 8, 1, 0);
  std::vector<float> pixels(64);
  for (int i = 0; i < 64; ++i) pixels[i] = std::sin(float(i * i));
  texture.upload(0, 8, 8, pixels.data());
  texture.generate_mipmaps();
  std::vector<float> level(16);
  texture.read(1, level.size() * 4, level.data());
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      const float* p = &pixels[16 * y + 2 * x];
      EXPECT_NEAR(level[4 * y + x], (p[0] + p[1] + p[8] + p[9]) / 4, 1e-6);
    }
}

TEST_F(TextureTest, AnImpossibleSizeIsAUserError) {
  EXPECT_THROW(TextureArray(TextureFormat::kRgba16f, 1 << 24, 1, 1), Error);
}

}  // namespace
}  // namespace photohull::gpu
