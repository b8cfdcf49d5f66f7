// Finer voxels, smaller errors, as long as the photographs can tell.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

#include "golden/synthetic_scene.h"

namespace photohull::golden {
namespace {

using pipeline::Method;
using testing::Each;
using testing::Gt;

/// A textured sphere without noise, seen from all around.
SyntheticScene whole_sphere(int views) {
  synth::Spec spec = synth::parse_spec("{}", "sphere", "");
  spec.cameras.layout = "hemisphere";
  spec.cameras.lowest = -80;
  spec.cameras.highest = 80;
  spec.cameras.count = views;
  spec.image.width = 480;
  spec.image.height = 360;
  spec.truth_samples = 20000;
  return SyntheticScene(spec);
}

/// Mean errors as shares of the diagonal.
std::vector<double> errors(const SyntheticScene& scene, Method method,
                           const std::vector<int>& resolutions) {
  std::vector<double> means;
  for (const int resolution : resolutions) {
    const eval::Evaluation e = scene.reconstruct(method, resolution);
    std::printf("%-14s %4d %s\n", to_string(method), resolution, summary(e).c_str());
    means.push_back(e.seen.to_truth.mean / e.truth_diagonal);
  }
  return means;
}

/// Between one resolution and the next, twice as fine.
std::vector<double> ratios(const std::vector<double>& means) {
  std::vector<double> all;
  for (std::size_t i = 1; i < means.size(); ++i) all.push_back(means[i - 1] / means[i]);
  return all;
}

// A surface within a cell is interpolated from the distances at its corners, which errs by the
// cell's size squared times the curvature: half the voxel, a quarter of the error.
TEST(Convergence, ErrorOfASphereFallsWithTheSquareOfTheVoxel) {
  const SyntheticScene scene = whole_sphere(36);
  // Measured: 0.00662, 0.00153, 0.00031; then the gaps between 36 silhouettes show.
  const std::vector<double> hull = errors(scene, Method::kHull, {8, 16, 32});
  EXPECT_THAT(ratios(hull), Each(Gt(3.0)));
  EXPECT_LT(hull.back(), 0.0004);
  // Measured: 0.00153, 0.00031, 0.00010, 0.000064. A pixel is 0.0020 of the diagonal: below a
  // twentieth of it, what the pixels tell of outlines is the limit, and not the voxel.
  const std::vector<double> refined = errors(scene, Method::kRefine, {16, 32, 64, 128});
  const std::vector<double> ratio = ratios(refined);
  EXPECT_GT(ratio[0], 3.0);
  EXPECT_GT(ratio[1], 2.8);
  EXPECT_GT(ratio[2], 1.2);
  EXPECT_LT(refined[0], 0.002);
  EXPECT_LT(refined[1], 0.0004);
  EXPECT_LT(refined[2], 0.00013);
  EXPECT_LT(refined[3], 0.00009);
}

}  // namespace
}  // namespace photohull::golden
