#include "projtex/image_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/packing.hpp>

#include "projtex/project_layer_reference.h"
#include "support/filtering.h"
#include "support/gl_context.h"
#include "support/ray_cast.h"

namespace photohull::projtex {
namespace {

PreparedView view_of(ColourImage image) {
  PreparedView view;
  view.camera.intrinsics.width = image.width;
  view.camera.intrinsics.height = image.height;
  view.image = std::move(image);
  return view;
}

/// All layers of a level in linear light.
std::vector<glm::dvec4> download(const gpu::TextureArray& texture, int level, bool half) {
  const int width = std::max(texture.width() >> level, 1);
  const int height = std::max(texture.height() >> level, 1);
  ColourImage image;
  image.width = width;
  image.height = height * texture.layers();
  image.encoding = half ? ColourImage::Encoding::kLinearHalf : ColourImage::Encoding::kSrgb8;
  image.bytes.resize(std::size_t(width) * image.height * image.bytes_per_pixel());
  texture.read(level, image.bytes.size(), image.bytes.data());
  std::vector<glm::dvec4> pixels;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) pixels.emplace_back(image.linear(x, y));
  return pixels;
}

/// Greatest difference of square roots between the texture and the references' chains.
double worst_difference(const ImageSet& set, const std::vector<PreparedView>& views, int level,
                        bool half) {
  const gpu::TextureArray& texture = set.texture();
  const std::vector<glm::dvec4> pixels = download(texture, level, half);
  double worst = 0;
  std::size_t at = 0;
  for (const PreparedView& view : views) {
    const auto chain = reference::mip_chain(view.image, {texture.width(), texture.height()});
    for (const glm::dvec4& expected : chain[level].pixels) {
      for (int c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(std::sqrt(expected[c]) - std::sqrt(pixels[at][c])));
      worst = std::max(worst, std::abs(expected.a - pixels[at].a));
      ++at;
    }
  }
  return worst;
}

class ImageSetTest : public ::testing::Test {
 protected:
  void TearDown() override { context_.check_errors("image set test"); }
  gpu::Context& context_ = test::gl_context();
  test::Rng rng_{5};
};

TEST_F(ImageSetTest, SmallerImagesRepeatTheirBorder) {
  const std::vector<PreparedView> views{view_of(test::random_image(rng_, 16, 8)),
                                        view_of(test::random_image(rng_, 5, 7)),
                                        view_of(test::random_image(rng_, 1, 1))};
  const ImageSet set(views);
  EXPECT_EQ(set.layers(), 3);
  EXPECT_LT(worst_difference(set, views, 0, false), 1e-6);
}

TEST_F(ImageSetTest, MipLevelsOf8BitAreWithinRoundingOfLinearBoxMeans) {
  const std::vector<PreparedView> views{view_of(test::random_image(rng_, 64, 32)),
                                        view_of(test::random_image(rng_, 50, 17))};
  const ImageSet set(views);
  ASSERT_EQ(set.texture().levels(), 7);
  // Every level is rounded to 8 bits of sRGB: half a step of up to 1 / 255 in each. Hardware, whose
  // filters have rounded weights, averages linear light in 8 bits as well: half a step of it, of
  // which the root is compared.
  const double linear_step = test::filtering_error() < 1e-4 ? 0 : std::sqrt(0.5 / 255);
  for (int level = 1; level < 7; ++level)
    EXPECT_LT(worst_difference(set, views, level, false), level * 1.0 / 255 + linear_step) << level;
}

TEST_F(ImageSetTest, MipLevelsAreTheSameWhereverPhotographsAreCut) {
  constexpr int kCut = 8, kLevel = 3;
  const ColourImage image = test::random_image(rng_, 43, 29);
  ColourImage cut = image;
  cut.width -= kCut;
  cut.bytes.clear();
  for (int y = 0; y < image.height; ++y) {
    const auto row = image.bytes.begin() + 4 * y * image.width;
    cut.bytes.insert(cut.bytes.end(), row + 4 * kCut, row + 4 * image.width);
  }
  const std::vector<PreparedView> whole{view_of(image)}, part{view_of(cut)};
  const ImageSet of_whole(whole, kCut), of_part(part, kCut);
  EXPECT_EQ(of_whole.texture().width(), 48);
  EXPECT_EQ(of_whole.texture().height(), 32);
  EXPECT_EQ(of_part.texture().width(), 40);
  const auto a = download(of_whole.texture(), kLevel, false),
             b = download(of_part.texture(), kLevel, false);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x)
      EXPECT_LT(glm::distance(b[std::size_t(5 * y + x)], a[std::size_t(6 * y + x + 1)]), 1e-6);
}

TEST_F(ImageSetTest, OneHalfFloatImageMakesTheSetHalfFloat) {
  const std::vector<PreparedView> views{view_of(test::random_image(rng_, 32, 32)),
                                        view_of(test::to_half(test::random_image(rng_, 20, 32)))};
  const ImageSet set(views);
  for (int level = 0; level < 6; ++level)
    EXPECT_LT(worst_difference(set, views, level, true), (level + 1) * 0x1p-11) << level;
}

TEST_F(ImageSetTest, HalfFloatsAboveOneSurvive) {
  ColourImage image;
  image.width = image.height = 1;
  image.encoding = ColourImage::Encoding::kLinearHalf;
  image.bytes.resize(8);
  const glm::uint64 packed = glm::packHalf4x16({3.5f, 0.25f, 100.0f, 1.0f});
  std::memcpy(image.bytes.data(), &packed, 8);
  const std::vector<PreparedView> views{view_of(image)};
  EXPECT_EQ(download(ImageSet(views).texture(), 0, true)[0], glm::dvec4(3.5, 0.25, 100, 1));
}

/// Which views have pixels while the set has them, and whether all are the same in the end.
std::vector<bool> lent(std::vector<PreparedView> views) {
  const std::vector<PreparedView> before = views;
  const ImageSet set(views);
  set.lend(views);
  std::vector<bool> has;
  for (const PreparedView& view : views) has.push_back(!view.image.bytes.empty());
  set.give_back(views);
  for (std::size_t i = 0; i < views.size(); ++i)
    EXPECT_EQ(views[i].image.bytes, before[i].image.bytes) << i;
  return has;
}

TEST_F(ImageSetTest, PixelsThatWereLentComeBack) {
  std::vector<PreparedView> views{view_of(test::random_image(rng_, 16, 8)),
                                  view_of(test::random_image(rng_, 5, 7)),
                                  view_of(test::random_image(rng_, 7, 3))};
  for (PreparedView& view : views) view.image.has_alpha = false;
  views[2].image.has_alpha = true;
  EXPECT_EQ(lent(views), (std::vector{false, false, true}));
  views[1].image = test::to_half(views[1].image);
  EXPECT_EQ(lent(views), (std::vector{true, false, true}));
}

TEST_F(ImageSetTest, ImagesMustMatchTheirCameras) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  std::vector<PreparedView> views{view_of(test::random_image(rng_, 4, 4))};
  views[0].camera.intrinsics.width = 5;
  EXPECT_DEATH(ImageSet{views}, "check failed");
}

}  // namespace
}  // namespace photohull::projtex
