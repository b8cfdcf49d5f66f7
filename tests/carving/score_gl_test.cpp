// The photo-consistency kernel against its reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "carving/sweep_kernels.h"
#include "support/cameras.h"
#include "support/gl_context.h"

namespace photohull::carving {
namespace {

using glm::ivec3;
using reference::Consistency;
using reference::Patch;
using test_kernels::SweepKernels;

constexpr double kNoiseVariance = 1e-4;
/// Measured on llvmpipe: 4e-5.
constexpr double kScoreBound = 1e-4;
/// Nearly flat patches far from mid-grey lose digits in the sums of their squares; measured: 1e-3.
constexpr double kFlatScoreBound = 3e-3;

class ScoreTest : public ::testing::Test {
 protected:
  /// One brick, all 64 columns of its first layer bare.
  ScoreTest() {
    const GridSpec grid = solid().grid;
    for (int i = 0; i < shaders::kMaxLayerViews; ++i)
      cameras_.push_back(projtex::to_grid(test::random_camera(rng_, grid.bounds(), 64, 64), grid));
  }
  void TearDown() override { context_.check_errors("score test"); }

  static BitVolume solid() {
    BitVolume bits;
    bits.grid = {{0, 0, 0}, 1, {1, 1, 1}};
    bits.table = {0};
    bits.bricks = {{0, 0, 0}};
    bits.words.assign(BitVolume::kWords, ~0u);
    return bits;
  }

  SweepKernels kernels(int views) {
    const std::vector<projtex::GridCamera> cameras(cameras_.begin(), cameras_.begin() + views);
    SweepKernels out(context_, solid(), {2, 1, {8, 8, 8}}, cameras);
    out.parameters.noise = {kNoiseVariance, 0, 0, 0};
    out.select(0);
    return out;
  }

  /// The patches that a column's kernel thread reads.
  static std::vector<Patch> patches_of(const SweepKernels& kernels, std::size_t judged, int views,
                                       const std::vector<glm::vec4>& samples) {
    std::vector<Patch> patches;
    for (int view = 0; view < views; ++view) {
      Patch patch;
      bool whole = true;
      for (int tap = 0; tap < reference::kPatchTaps; ++tap) {
        const glm::vec4 s =
            samples[kernels.patch_base(judged, view) + tap / 5 * shaders::kApronEdge + tap % 5];
        patch[tap] = glm::dvec3(s);
        whole = whole && s.a >= 0;
      }
      if (whole) patches.push_back(patch);
    }
    return patches;
  }

  using Colour = std::function<glm::vec4(int view, int apron)>;
  static std::vector<glm::vec4> samples_of(const SweepKernels& kernels, const Colour& colour) {
    std::vector<glm::vec4> samples(kernels.sample_count());
    for (std::size_t i = 0; i < samples.size(); ++i)
      samples[i] = colour(int(i / shaders::kApronArea), int(i % shaders::kApronArea));
    return samples;
  }

  glm::vec4 random_colour(double low = 0, double high = 1) {
    const double r = test::uniform(rng_, low, high), g = test::uniform(rng_, low, high);
    return {r, g, test::uniform(rng_, low, high), 1};
  }

  /// Scores of all 64 columns, each compared to the reference.
  std::vector<glm::vec4> compare(int views, const std::vector<glm::vec4>& samples,
                                 double bound = kScoreBound) {
    SweepKernels kernels = this->kernels(views);
    const std::vector<glm::vec4> found = kernels.score(samples);
    EXPECT_EQ(found.size(), 64u);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto patches = patches_of(kernels, i, views, samples);
      const Consistency expected = reference::photo_consistency(patches, kNoiseVariance);
      EXPECT_EQ(found[i].w, expected.seen);
      EXPECT_NEAR(found[i].z, expected.texture, 1e-6);
      if (expected.outlier_margin < 10 * bound) continue;  // rounding may drop another view
      EXPECT_EQ(found[i].y, expected.used);
      EXPECT_NEAR(found[i].x, expected.score, bound);
      ++compared_;
    }
    return found;
  }

  gpu::Context& context_ = test::gl_context();
  test::Rng rng_{43};
  std::vector<projtex::GridCamera> cameras_;
  int compared_ = 0;
};

TEST_F(ScoreTest, RandomPatchesOfRandomContrast) {
  for (int views = 2; views <= shaders::kMaxLayerViews; ++views)
    for (const double noise : {0.0, 0.02, 0.3, 1.0})
      for (const bool flat : {false, true}) {
        // A pattern that all views share, seen with each view's own contrast and noise.
        std::vector<glm::vec4> pattern(shaders::kApronArea);
        for (glm::vec4& p : pattern) p = random_colour();
        std::vector<float> contrast(shaders::kMaxLayerViews);
        for (float& c : contrast)
          c = float(std::pow(10, flat ? test::uniform(rng_, -3, -1) : test::uniform(rng_, -1, 0)));
        const auto samples = samples_of(kernels(views), [&](int view, int apron) {
          const glm::vec4 mixed = glm::mix(pattern[apron], random_colour(), float(noise));
          return glm::vec4(glm::vec3(mixed) * contrast[view], 1);
        });
        compare(views, samples, flat ? kFlatScoreBound : kScoreBound);
      }
  EXPECT_GT(compared_, 2500);
}

TEST_F(ScoreTest, IdenticalPatchesScoreNearlyOne) {
  std::vector<glm::vec4> pattern(shaders::kApronArea);
  for (glm::vec4& p : pattern) p = random_colour();
  const auto found =
      compare(5, samples_of(kernels(5), [&](int, int apron) { return pattern[apron]; }));
  for (const glm::vec4& score : found) {
    EXPECT_GT(score.x, 0.99);
    EXPECT_EQ(score.y, 5);
  }
}

TEST_F(ScoreTest, GainAndOffsetOfAViewDoNotMatter) {
  std::vector<glm::vec4> pattern(shaders::kApronArea);
  for (glm::vec4& p : pattern) p = random_colour();
  const auto found = compare(4, samples_of(kernels(4), [&](int view, int apron) {
                               const glm::vec3 p(pattern[apron]);
                               return glm::vec4(p * (0.4f + 0.1f * float(view)) + 0.05f, 1);
                             }));
  for (const glm::vec4& score : found) EXPECT_GT(score.x, 0.98);
}

TEST_F(ScoreTest, IndependentNoiseScoresNearlyZero) {
  // Dropping the views that agree least favours chance agreement: measured 0.21 on average.
  double sum = 0;
  for (const glm::vec4& score :
       compare(8, samples_of(kernels(8), [&](int, int) { return random_colour(); }))) {
    EXPECT_LT(score.x, 0.45);
    sum += score.x / 64;
  }
  EXPECT_LT(std::abs(sum), 0.25);
}

TEST_F(ScoreTest, NoiseBelowTheFloorNeverAgrees) {
  const auto found =
      compare(4, samples_of(kernels(4), [&](int, int) { return random_colour(0.5, 0.5 + 1e-3); }));
  for (const glm::vec4& score : found) EXPECT_LT(score.x, 1e-3);
}

TEST_F(ScoreTest, ConstantPatchesNeverAgree) {
  for (const float value : {0.0f, 0.37f, 1.0f}) {
    SweepKernels constant = kernels(6);
    for (const glm::vec4& score :
         constant.score(samples_of(constant, [&](int, int) { return glm::vec4(value); }))) {
      EXPECT_LT(score.x, 1e-3);
      EXPECT_NEAR(score.z, 0, 1e-6);
      EXPECT_EQ(score.w, 6);
    }
  }
}

TEST_F(ScoreTest, OneOutlierIsDropped) {
  std::vector<glm::vec4> pattern(shaders::kApronArea);
  for (glm::vec4& p : pattern) p = random_colour();
  const auto found = compare(5, samples_of(kernels(5), [&](int view, int apron) {
                               return view == 3 ? random_colour() : pattern[apron];
                             }));
  for (const glm::vec4& score : found) {
    EXPECT_EQ(score.y, 4);
    EXPECT_EQ(score.w, 5);
    EXPECT_GT(score.x, 0.99);
  }
}

TEST_F(ScoreTest, PatchesThatLeaveTheImageDoNotCount) {
  const int views = 6;
  const auto found = compare(views, samples_of(kernels(views), [&](int view, int apron) {
                               glm::vec4 colour = random_colour();
                               // View 0 shows nothing, view 1 all but one sample.
                               if (view == 0 || (view == 1 && apron == 53)) colour.a = -1;
                               return colour;
                             }));
  int five = 0;
  for (const glm::vec4& score : found) five += score.w == 5;
  EXPECT_EQ(five, 64 - 25);  // the one sample is part of 25 patches
}

TEST_F(ScoreTest, FewerThanTwoViewsGiveNoScore) {
  for (const int views : {0, 1}) {
    SweepKernels few = kernels(std::max(views, 1));
    for (const glm::vec4& score : few.score(samples_of(few, [&](int, int) {
           glm::vec4 colour = random_colour();
           colour.a = views ? 1.0f : -1.0f;
           return colour;
         }))) {
      EXPECT_EQ(score.x, -1);
      EXPECT_EQ(score.w, views);
    }
  }
}

TEST_F(ScoreTest, OnlyViewsThatSeeTheVoxelCount) {
  const int views = 6;
  SweepKernels kernels = this->kernels(views);
  const double bias = 1.5;
  kernels.parameters.thresholds.w = float(bias);
  // Random voxels around the layer hide it from some of the cameras.
  std::vector<glm::ivec4> list{{0, 0, 0, 0}};
  for (int i = 0; i < 60; ++i)
    list.emplace_back(ivec3(test::uniform_in(rng_, {glm::dvec3(-12), glm::dvec3(20)})), 0);
  list[0].x = int(list.size()) - 1;
  const gpu::Buffer voxels = gpu::Buffer::of(list);
  kernels.views().bind_storage(shaders::kViewsBinding);
  kernels.depth_maps().splat(context_, voxels, list.size() - 1);
  const auto found = kernels.score(samples_of(kernels, [&](int, int) { return random_colour(); }));

  std::vector<std::vector<double>> maps;
  for (int i = 0; i < views; ++i) {
    const std::vector<float> map = kernels.depth_maps().download(std::size_t(i));
    maps.emplace_back(map.begin(), map.end());
  }
  int hidden = 0, compared = 0;
  for (int i = 0; i < 64; ++i) {
    const glm::dvec3 voxel(i % 8, i / 8, 0);
    int seen = 0;
    bool certain = true;
    for (int view = 0; view < views; ++view) {
      const auto& info = kernels.depth_maps().infos()[view];
      const auto sees = [&](const glm::dvec3& shift, double b) {
        return visibility::reference::visible(cameras_[view], info, voxel + shift, b, maps[view]);
      };
      const bool expected = sees({0, 0, 0}, bias);
      // At the edge of a texel or of the bias single precision may see it otherwise.
      for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1e-3, 1e-3}) {
          glm::dvec3 shift(0);
          shift[axis] = side;
          certain = certain && sees(shift, bias - 5e-3) == expected &&
                    sees(shift, bias + 5e-3) == expected;
        }
      seen += expected;
    }
    if (!certain) continue;
    ++compared;
    hidden += views - seen;
    EXPECT_EQ(found[i].w, seen) << "column " << i;
  }
  EXPECT_GT(compared, 50);
  EXPECT_GT(hidden, 20);
  EXPECT_LT(hidden, compared * views - 20);
}

}  // namespace
}  // namespace photohull::carving
