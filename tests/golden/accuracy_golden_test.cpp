// How close reconstructions of synthetic scenes come to the exact surface, on Mesa's software
// rasterizer. Bounds lie about a point below what was measured: after a change for the better,
// write the new figures and raise the bounds; after one for the worse, find out why.
#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

#include "golden/synthetic_scene.h"

namespace photohull::golden {
namespace {

using pipeline::Method;

/// F-scores of the seen surface in percent: what was measured, and the least that passes.
struct Expected {
  Method method;
  double measured_05, least_05;  ///< at 0.5 % of the diagonal
  double measured_1, least_1;    ///< at 1 %
  std::optional<projtex::Sampler> sampler = {};
};

void expect_scores(const SyntheticScene& scene, int resolution, const std::vector<Expected>& all) {
  for (const Expected& expected : all) {
    const eval::Evaluation e = scene.reconstruct(expected.method, resolution, expected.sampler);
    std::printf("%-14s %s\n", to_string(expected.method), summary(e).c_str());
    SCOPED_TRACE(testing::Message() << to_string(expected.method) << ": measured before "
                                    << expected.measured_05 << " and " << expected.measured_1);
    EXPECT_GE(f_score(e, 0.5), expected.least_05);
    EXPECT_GE(f_score(e, 1), expected.least_1);
  }
}

TEST(Accuracy, Sphere) {
  expect_scores(SyntheticScene("sphere", 12, 320, 240), 64,
                {{Method::kHull, 95.68, 94.7, 99.72, 99.2},
                 {Method::kSpaceCarving, 96.57, 95.6, 99.88, 99.4, projtex::Sampler::kMipmap},
                 {Method::kSpaceCarving, 95.77, 94.8, 99.18, 98.5},
                 {Method::kRefine, 98.33, 97.3, 99.86, 99.2}});
}

TEST(Accuracy, Block) {
  expect_scores(SyntheticScene("block", 24, 320, 240), 96,
                {{Method::kHull, 30.27, 29.3, 49.85, 48.8},
                 {Method::kSpaceCarving, 46.89, 45.9, 85.25, 84.2},
                 // 89.74 on one processor, 88.12 on another: one program, other vector code.
                 {Method::kRefine, 88.12, 87.1, 93.48, 92.4}});
}

TEST(Accuracy, RodsBeforeTexture) {
  expect_scores(SyntheticScene("rods_before_texture", 24, 320, 240), 96,
                // An outer bound: half a pixel of room around rods of a pixel is much at this size.
                {{Method::kHull, 18.97, 18.4, 25.1, 24.5},
                 {Method::kSpaceCarving, 20.77, 19.8, 28.31, 27.3},
                 {Method::kRefine, 92.73, 91.7, 96.17, 95.1}});
}

TEST(Accuracy, Pawn) {
  expect_scores(SyntheticScene("pawn", 16, 320, 240), 96,
                {{Method::kHull, 87.28, 86.3, 94.35, 93.3},
                 {Method::kSpaceCarving, 86.12, 85.1, 95.58, 94.6, projtex::Sampler::kMipmap},
                 {Method::kSpaceCarving, 86.29, 85.3, 95.10, 94.1},
                 {Method::kRefine, 99.47, 98.5, 99.98, 99.4}});
}

}  // namespace
}  // namespace photohull::golden
