// Photographs that are read again, larger, to match the surface in.
#include "pipeline/larger_photographs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/error.h"
#include "pipeline/image_scale.h"
#include "pipeline/inspect.h"
#include "pipeline/photometric.h"
#include "pipeline/place_lattice.h"
#include "pipeline/reconstruct.h"
#include "pipeline/recording_progress.h"
#include "projtex/gpu_views.h"
#include "projtex/photographs.h"
#include "support/gl_context.h"
#include "support/ray_cast.h"
#include "support/scratch_folder.h"
#include "synth/synthesize.h"
#include "views/prepare_views.h"

namespace photohull::pipeline {
namespace {

constexpr int kWidth = 203, kHeight = 150, kViews = 10;

/// Photographs by a lens that distorts, of a box that fills their middle.
class LargerPhotographs : public testing::Test {
 protected:
  LargerPhotographs() {
    options_.noise = 1;
    test::Rng rng(5);
    std::vector<MemoryPhotograph> all;
    for (int i = 0; i < kViews; ++i) {
      MemoryPhotograph p;
      p.name = std::to_string(i);
      const double angle = 2 * M_PI * i / kViews;
      p.camera = test::look_at(glm::dvec3(6 * std::cos(angle), 6 * std::sin(angle), 1.5),
                               glm::dvec3(0), 300, kWidth, kHeight);
      p.image = test::random_image(rng, kWidth, kHeight);
      if (i % 2 == 0)
        p.distortion = {DistortionModel::kBrown, {-0.15, 0.05, 0.002, -0.001, 0, 0, 0, 0}};
      all.push_back(std::move(p));
    }
    photographs_ = photographs_in_memory(std::move(all), box_);
    photographs_.reader.image = [this, read = photographs_.reader.image](
                                    const std::filesystem::path& path, double scale) {
      if (unreadable_) throw Error("it is not there");
      return read(path, scale);
    };
    for (int i = 0; i < kViews; ++i) {
      gains_.views.push_back(
          {glm::dvec3(1 + 0.02 * i, 1, 1 - 0.01 * i), glm::dvec3(0.01), 9, true});
    }
    gains_.vignetting = {0.2};
  }

  /// As prepare_scene and the stages after it leave them.
  std::vector<PreparedView> views_at(double scale) {
    Scene scene = photographs_.scene;
    const std::vector<double> scales(kViews, scale);
    scale_scene(scales, scene);
    Progress silent;
    PrepareOptions options;
    options.masks = MaskPolicy::kNone;
    PreparedViews prepared = prepare_views(
        scene, reduced_loader(photographs_.reader, photographs_.scene, scales), options, silent);
    for (PreparedView& view : prepared.views) view.scale = scale, view.matched_scale = 1;
    return divide_by_gains(crop_views(std::move(prepared.views), box_), gains_);
  }

  std::unique_ptr<projtex::OutOfCorePhotographs> larger() {
    test::gl_context();
    subject_.box = box_;
    subject_.views = views_at(0.5);
    subject_.held_bytes = 1;
    return larger_photographs(photographs_.reader, subject_, gains_, options_, silent_);
  }

  Box box_{glm::dvec3(-0.7), glm::dvec3(0.7)};
  Photographs photographs_;
  PhotometricCalibration gains_;
  Subject subject_;
  ReconstructOptions options_;
  Progress silent_;
  bool unreadable_ = false;
};

TEST_F(LargerPhotographs, AreWhatReadingThemLargeAtOnceGives) {
  const ScratchFolder folder;
  options_.checkpoint = folder.path();
  const auto some = larger();
  const std::vector<PreparedView> all = views_at(1);
  const std::vector<int> numbers = {7, 2, 3};
  // They are kept on the disk: read again, they need no files.
  some->hold(numbers);
  some->hold(std::vector<int>{0, 1, 4, 5, 6, 8, 9});
  unreadable_ = true;
  some->hold(std::vector<int>{0, 1, 4, 5, 6, 8, 9, 2});
  some->hold(std::vector<int>{0, 1, 4, 5, 6, 8, 9, 7});
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 0);
  const projtex::HeldPhotographs& held = some->hold(numbers);
  for (const int n : numbers) {
    const int layer = held.layers[std::size_t(n)];
    ASSERT_GE(layer, 0);
    const PreparedView& view = all[std::size_t(n)];
    const Intrinsics &found = held.cameras[std::size_t(layer)].intrinsics,
                     &right = view.camera.intrinsics;
    ASSERT_EQ(found.width, right.width);
    ASSERT_EQ(found.height, right.height);
    EXPECT_LT(found.width, kWidth) << "cropped to the box";
    EXPECT_NEAR(found.fx, right.fx, 1e-9);
    EXPECT_NEAR(found.cx, right.cx, 1e-9);
    EXPECT_NEAR(found.cy, right.cy, 1e-9);
    std::vector<std::uint8_t> pixels(view.image.bytes.size());
    held.images.texture().read_layer(layer, right.width, right.height, pixels.size(),
                                     pixels.data());
    EXPECT_EQ(pixels, view.image.bytes) << view.name;
  }
  EXPECT_EQ(some->noise_sigma(), 1.0 / 255);
  EXPECT_EQ(some->most(), fewest_held(kViews)) << "however little room there is";
}

TEST_F(LargerPhotographs, OfPartsAreCutWhereTexelsOfMipLevelsBegin) {
  options_.part = {1, 2};
  box_ = {glm::dvec3(-0.3), glm::dvec3(0.3)};
  const auto some = larger();
  const projtex::HeldPhotographs& held = some->hold(std::vector<int>{1, 3});
  for (const std::size_t n : {1, 3}) {  // those by a lens that does not distort
    const double left = photographs_.scene.views[n].camera.intrinsics.cx -
                        held.cameras[std::size_t(held.layers[n])].intrinsics.cx;
    EXPECT_GT(left, 0);
    EXPECT_NEAR(std::remainder(left, projtex::kCutPixels), 0, 1e-9);
  }
  EXPECT_EQ(held.images.texture().width() % projtex::kCutPixels, 0);
  EXPECT_EQ(held.images.texture().height() % projtex::kCutPixels, 0);
}

TEST_F(LargerPhotographs, WhatWasNotAskedForTheLongestGoesFirst) {
  std::vector<std::string> read;
  const auto image = photographs_.reader.image;
  photographs_.reader.image = [&](const std::filesystem::path& path, double scale) {
    static std::mutex mutex;
    const std::scoped_lock lock(mutex);
    read.push_back(path.string());
    return image(path, scale);
  };
  const auto some = larger();
  ASSERT_EQ(some->most(), 8);
  const auto hold = [&](const std::vector<int>& numbers) {
    read.clear();
    const std::vector<int>& layers = some->hold(numbers).layers;
    std::ranges::sort(read);
    for (const int n : numbers) EXPECT_GE(layers[std::size_t(n)], 0);
    return read;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(hold({0, 1, 2, 3, 4, 5}), (Names{"0", "1", "2", "3", "4", "5"}));
  EXPECT_EQ(hold({0, 6, 7}), (Names{"6", "7"}));
  EXPECT_EQ(hold({1, 2}), Names());
  EXPECT_EQ(hold({8, 9, 0}), (Names{"8", "9"})) << "in place of two of 3, 4 and 5";
  EXPECT_EQ(hold({1, 2, 6, 7}), Names());
  EXPECT_EQ(hold({3, 4, 5}).size(), 2u);
}

TEST_F(LargerPhotographs, TheirNoiseIsMeasured) {
  options_.noise.reset();
  EXPECT_GT(larger()->noise_sigma(), 1.0 / 255) << "pixels are random";
}

TEST_F(LargerPhotographs, NoneAreReadWhereTheViewsAreAsLarge) {
  subject_.views = views_at(1);
  EXPECT_EQ(larger_photographs(photographs_.reader, subject_, {}, options_, silent_), nullptr);
}

TEST_F(LargerPhotographs, OneThatChangedMeanwhileIsNamed) {
  const auto some = larger();
  const auto read = photographs_.reader.image;
  photographs_.reader.image = [&](const std::filesystem::path& path, double) {
    return read(path, 0.25);
  };
  const auto again = larger_photographs(photographs_.reader, subject_, gains_, options_, silent_);
  EXPECT_THAT([&] { again->hold(std::vector<int>{4}); },
              testing::ThrowsMessage<Error>(testing::HasSubstr("4: the photograph had 203 x 150")));
}

TEST_F(LargerPhotographs, WhatNoTextureHoldsIsAWarning) {
  RecordingProgress heard(silent_);
  subject_.box = box_;
  subject_.views = views_at(0.5);
  for (PreparedView& view : subject_.views) view.camera.intrinsics.width = 400000;
  subject_.held_bytes = 1;
  EXPECT_EQ(larger_photographs(photographs_.reader, subject_, {}, options_, heard), nullptr);
  EXPECT_THAT(heard.warnings(),
              testing::ElementsAre(testing::HasSubstr("8 larger ones do not fit into one")));
}

/// A job that may take so much less than the photographs would that it holds them smaller.
TEST(LargerPhotographsJob, MatchTheSurfaceWhereMemoryIsShort) {
  const ScratchFolder folder;
  Progress silent;
  synth::Spec spec = synth::parse_spec(R"({"geometry": {"shape": "block"}, "truth_samples": 100,
      "material": {"faces": true, "contrast": 0.6, "size": 0.02},
      "cameras": {"rings": [{"count": 8, "elevation": 15}, {"count": 4, "elevation": 50}]}})",
                                       "test", "");
  spec.image = {1296, 1000, 1};
  synth::synthesize(spec, folder.path() / "scene", silent);
  const Photographs photographs = load_photographs(folder.path() / "scene");
  ReconstructOptions options;
  options.resolution = 160;
  const auto info = [&] { return inspect(photographs.scene, options); };
  EXPECT_EQ(info().matched, info().scales);
  options.max_memory = info().memory_bytes - 1;
  EXPECT_EQ(info().scales[0], 0.5);
  EXPECT_EQ(info().matched[0], 1);
  const Reconstruction some = Reconstructor(options).run(photographs, silent);
  EXPECT_EQ(some.report.photographs.smallest_scale, 0.5);
  EXPECT_EQ(some.report.photographs.matched_scale, 1);
  EXPECT_THAT(some.report.warnings, testing::Contains(testing::HasSubstr("held at 1/2 of their")));
}

}  // namespace
}  // namespace photohull::pipeline
