// Every statistic's kernel against its reference, with and without taps that show background.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "carving/statistic_reference.h"
#include "carving/sweep_kernels.h"
#include "support/cameras.h"
#include "support/gl_context.h"

namespace photohull::carving {
namespace {

using reference::CommonPatches;
using reference::Evidence;
using test_kernels::SweepKernels;

constexpr double kNoiseVariance = 1e-4, kLeastTexture = 2.25e-4;
constexpr double kBound = 1e-3;  // scores lie in [-1, 1]
constexpr int kTaps = reference::kPatchTaps;

class StatisticsTest : public ::testing::TestWithParam<Statistic> {
 protected:
  StatisticsTest() {
    bits_.grid = {{0, 0, 0}, 1, {1, 1, 1}};
    bits_.table = {0};
    bits_.bricks = {{0, 0, 0}};
    bits_.words.assign(BitVolume::kWords, ~0u);
    for (int i = 0; i < shaders::kMaxLayerViews; ++i)
      cameras_.push_back(
          projtex::to_grid(test::random_camera(rng_, bits_.grid.bounds(), 64, 64), bits_.grid));
  }
  void TearDown() override { context_.check_errors("statistics test"); }

  /// What the patch of a judged column comes to once views and taps that do not count are gone.
  static CommonPatches patches_of(const SweepKernels& kernels, std::size_t judged, int views,
                                  const std::vector<glm::vec4>& samples) {
    std::vector<std::vector<glm::vec4>> patches;
    for (int view = 0; view < views; ++view) {
      std::vector<glm::vec4> patch;
      for (int tap = 0; tap < kTaps; ++tap)
        patch.push_back(
            samples[kernels.patch_base(judged, view) + tap / 5 * shaders::kApronEdge + tap % 5]);
      const auto shown = std::count_if(patch.begin(), patch.end(), [](auto& s) { return s.a > 0; });
      const bool on_image =
          std::all_of(patch.begin(), patch.end(), [](auto& s) { return s.a >= 0; });
      if (on_image && shown >= 13 && patch[kTaps / 2].a > 0) patches.push_back(patch);
    }
    CommonPatches out;
    out.views.resize(patches.size());
    for (int tap = 0; tap < kTaps; ++tap) {
      if (tap == kTaps / 2 && !patches.empty()) out.middle = out.views[0].size();
      if (std::any_of(patches.begin(), patches.end(), [&](auto& p) { return p[tap].a <= 0; }))
        continue;
      for (std::size_t v = 0; v < patches.size(); ++v) out.views[v].emplace_back(patches[v][tap]);
    }
    return out;
  }

  using Colour = std::function<glm::vec4(int view, int apron)>;

  void compare(int views, const Colour& colour) {
    const std::vector<projtex::GridCamera> cameras(cameras_.begin(), cameras_.begin() + views);
    SweepKernels kernels(context_, bits_, {2, 1, {8, 8, 8}}, cameras,
                         statistic_defines(GetParam(), true));
    kernels.parameters.noise = {kNoiseVariance, 1e-6, kLeastTexture, 0};
    kernels.select(0);
    std::vector<glm::vec4> samples(kernels.sample_count());
    for (std::size_t i = 0; i < samples.size(); ++i)
      samples[i] = colour(int(i / shaders::kApronArea), int(i % shaders::kApronArea));
    const std::vector<glm::vec4> found = kernels.score(samples);
    ASSERT_EQ(found.size(), 64u);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const CommonPatches patches = patches_of(kernels, i, views, samples);
      EXPECT_EQ(found[i].w, patches.views.size());
      const Evidence expected = measured(patches);
      if (expected.margin < 1e-5) continue;  // rounding may decide otherwise
      EXPECT_NEAR(found[i].x, expected.score, kBound);
      EXPECT_NEAR(found[i].z, expected.confidence, kBound);
      EXPECT_EQ(found[i].y, expected.used);
      ++compared_;
      without_evidence_ += expected.confidence == 0;
    }
  }

  /// Of normalised cross-correlation, confidence is the texture.
  static Evidence measured(const CommonPatches& patches) {
    if (const auto reference = entry_of(GetParam()).reference)
      return reference(patches, {kNoiseVariance, kLeastTexture});
    const std::vector<reference::PatchColours> views(patches.views.begin(), patches.views.end());
    const bool few = views.empty() || views[0].size() < 13;
    const reference::Consistency c = reference::photo_consistency(views, kNoiseVariance);
    return {c.score, few ? 0 : c.texture, c.used, views.size() > 1 ? c.outlier_margin - 1e-3 : 1};
  }

  glm::vec4 random_colour() {
    const double r = test::uniform(rng_, 0, 1), g = test::uniform(rng_, 0, 1);
    return {r, g, test::uniform(rng_, 0, 1), 1};
  }

  /// A pattern that all views share, each with its own gain, mixed with noise of its own.
  Colour shared_pattern(double noise, double contrast) {
    auto pattern = std::make_shared<std::vector<glm::vec4>>(shaders::kApronArea);
    for (glm::vec4& p : *pattern) p = glm::mix(glm::vec4(0.4f), random_colour(), float(contrast));
    auto gain = std::make_shared<std::vector<float>>(shaders::kMaxLayerViews);
    for (float& g : *gain) g = float(test::uniform(rng_, 0.7, 1));
    return [this, pattern, gain, noise](int view, int apron) {
      return glm::vec4(
          glm::vec3(glm::mix((*pattern)[apron], random_colour(), float(noise))) * (*gain)[view], 1);
    };
  }

  gpu::Context& context_ = test::gl_context();
  test::Rng rng_{47};
  BitVolume bits_;
  std::vector<projtex::GridCamera> cameras_;
  int compared_ = 0, without_evidence_ = 0;
};

TEST_P(StatisticsTest, PatternsOfAllContrastsAndNoises) {
  for (const int views : {2, 3, 6, shaders::kMaxLayerViews})
    for (const double noise : {0.0, 0.1, 1.0})
      compare(views, shared_pattern(noise, noise > 0.5 || views % 2 ? 1.0 : 0.1));
  EXPECT_GT(compared_, 600);
}

TEST_P(StatisticsTest, BackgroundTapsAndViewsThatLeaveTheImageDoNotCount) {
  for (const int views : {2, 4, 6}) {
    const Colour pattern = shared_pattern(0.1, 1);
    compare(views, [&](int view, int apron) {
      glm::vec4 colour = pattern(view, apron);
      const double chance = test::uniform(rng_, 0, 1);
      if (chance < 0.05) colour = glm::vec4(0);
      if (chance > 0.998) colour.a = -1;
      return colour;
    });
  }
  EXPECT_GT(compared_, 130);
  EXPECT_GT(without_evidence_ + (GetParam() == Statistic::kZncc), 0);
}

TEST_P(StatisticsTest, PlainAndBlackPatches) {
  for (const float value : {0.0f, 0.4f, 1.0f})
    compare(5, [&](int, int) { return glm::vec4(glm::vec3(value), 1); });
  EXPECT_GT(compared_, 0);
}

TEST_P(StatisticsTest, FewerThanTwoViewsAreNoEvidence) {
  compare(1, shared_pattern(0, 1));
  EXPECT_EQ(without_evidence_, GetParam() == Statistic::kZncc ? 0 : 64);
}

std::string name_of(const ::testing::TestParamInfo<Statistic>& info) {
  std::string name = to_string(info.param);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, StatisticsTest, ::testing::ValuesIn(all_statistics()), name_of);

}  // namespace
}  // namespace photohull::carving
