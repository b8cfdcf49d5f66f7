#include "projtex/photograph_file.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <random>

#include "core/error.h"
#include "projtex/gpu_views.h"
#include "projtex/photograph_cache.h"
#include "support/gl_context.h"
#include "support/scratch_folder.h"

namespace photohull::projtex {
namespace {

namespace fs = std::filesystem;

/// Photographs of noise, of different sizes.
class PhotographFileTest : public ::testing::Test {
 protected:
  PhotographFileTest() {
    test::gl_context();
    std::mt19937 random(7);
    for (const glm::ivec2& size : {glm::ivec2(9, 5), glm::ivec2(4, 8), glm::ivec2(7, 7)}) {
      PreparedView view;
      view.camera.intrinsics.width = size.x, view.camera.intrinsics.height = size.y;
      view.camera.cam_from_world.translation.x = size.x;
      view.sharpness = 0.05 * size.y;
      view.image = {size.x, size.y, ColourImage::Encoding::kSrgb8, false, {}};
      for (int i = 0; i < 4 * size.x * size.y; ++i)
        view.image.bytes.push_back(std::uint8_t(random()));
      views_.push_back(std::move(view));
    }
  }

  fs::path written() const {
    const ImageSet images(views_);
    const std::vector<Camera> cameras = cameras_of(views_);
    write_photographs(folder_ / "photographs", {images, cameras, 0.0123});
    return folder_ / "photographs";
  }
  /// Does the layer hold the photograph, in all levels of its pixels?
  void expect_held(const HeldPhotographs& held, int number) const {
    const int layer = held.layers[std::size_t(number)];
    ASSERT_GE(layer, 0);
    const PreparedView& view = views_[std::size_t(number)];
    EXPECT_EQ(held.images.read(layer, {view.image.width, view.image.height}).bytes,
              view.image.bytes);
    EXPECT_EQ(held.cameras[std::size_t(layer)].cam_from_world.translation,
              view.camera.cam_from_world.translation);
    EXPECT_EQ(held.images.sharpness()[std::size_t(layer)],
              ImageSet(views_).sharpness()[std::size_t(number)]);
  }

  ScratchFolder folder_;
  std::vector<PreparedView> views_;
};

TEST_F(PhotographFileTest, ComesBackAsItWas) {
  const auto photographs = open_photographs(written());
  EXPECT_EQ(photographs->cameras().size(), 3u);
  EXPECT_EQ(photographs->noise_sigma(), 0.0123);
  EXPECT_EQ(photographs->most(), 3);
  const HeldPhotographs& held = photographs->hold({});
  for (int n = 0; n < 3; ++n) {
    EXPECT_EQ(held.layers[std::size_t(n)], n) << "in their order";
    expect_held(held, n);
  }
  EXPECT_EQ(held.images.texture().width(), 9);
  EXPECT_EQ(held.images.texture().height(), 8);
}

TEST_F(PhotographFileTest, AFewAtATime) {
  class Two : public OutOfCorePhotographs {
   public:
    explicit Two(const std::vector<PreparedView>& views)
        : views_(views),
          cameras_(cameras_of(views)),
          cache_(cameras_, 2, views[0].image.encoding) {}
    std::span<const Camera> cameras() const override { return cameras_; }
    double noise_sigma() const override { return 0.5; }
    int most() const override { return 2; }
    const HeldPhotographs& hold(std::span<const int> numbers) override {
      for (const int n : cache_.missing(numbers)) cache_.put(n, views_[std::size_t(n)]);
      return cache_.held();
    }

   private:
    const std::vector<PreparedView>& views_;
    std::vector<Camera> cameras_;
    PhotographCache cache_;
  } two(views_);
  write_photographs(folder_ / "some", two);
  const auto photographs = open_photographs(folder_ / "some");
  EXPECT_EQ(photographs->most(), 2);
  for (const auto& numbers : {std::array{0, 2}, {1, 2}, {0, 1}}) {
    const HeldPhotographs& held = photographs->hold(numbers);
    for (const int n : numbers) expect_held(held, n);
  }
}

TEST_F(PhotographFileTest, DamagedFilesAreNamed) {
  const fs::path file = written();
  const auto expect_error = [&](const std::string& part) {
    try {
      open_photographs(file);
      ADD_FAILURE() << part;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find(file.string()), std::string::npos) << e.what();
    }
  };
  const std::string bytes = read_text(file);
  write_text(file, bytes.substr(0, bytes.size() - 1));
  expect_error("end too early");
  write_text(file, bytes.substr(0, 60));
  expect_error("it ends too early");
  write_text(file, std::string(400, 'x'));
  expect_error("it ends too early");
  write_text(file, "");
  expect_error("it ends too early");
  fs::remove(file);
  expect_error("cannot be read");
}

}  // namespace
}  // namespace photohull::projtex
