#include "pipeline/estimate.h"

#include <gtest/gtest.h>

#include <cmath>

namespace photohull::pipeline {
namespace {

constexpr double kFair = 1.5;  // the factor that estimates are to be within

/// A run of bench/results/estimates.json.
struct RecordedRun {
  const char* name;
  Silhouettes masks;
  Method method;
  int views, width, height;  ///< as read
  glm::ivec3 voxels;
  double mebibytes, cpu_seconds;
};

void PrintTo(const RecordedRun& run, std::ostream* out) { *out << run.name; }

CostQuestion question_of(const RecordedRun& run) {
  CostQuestion q;
  q.grid = GridSpec{glm::dvec3(0), 1, run.voxels / kBrickEdge};
  Camera camera;
  camera.intrinsics.width = run.width, camera.intrinsics.height = run.height;
  q.cameras.assign(std::size_t(run.views), camera);
  for (const Camera& c : q.cameras) q.files.push_back(c.intrinsics);
  q.method = run.method;
  q.masks = run.masks;
  return q;
}

class Estimate : public testing::TestWithParam<RecordedRun> {};

TEST_P(Estimate, IsFair) {
  const RecordedRun& run = GetParam();
  const Cost cost = estimate_cost(question_of(run));
  const double mebibytes = std::ldexp(double(cost.bytes), -20);
  EXPECT_LT(run.mebibytes, kFair * mebibytes);
  EXPECT_GT(run.mebibytes, mebibytes / kFair);
  EXPECT_LT(run.cpu_seconds, kFair * cost.cpu_seconds);
  EXPECT_GT(run.cpu_seconds, cost.cpu_seconds / kFair);
}

const RecordedRun kRuns[] = {RecordedRun{"fountain default refine without masks",
                                         Silhouettes::kNone,
                                         Method::kRefine,
                                         11,
                                         1536,
                                         1024,
                                         {1160, 640, 784},
                                         1661,
                                         255.6},
                             RecordedRun{"fountain 256 refine without masks",
                                         Silhouettes::kNone,
                                         Method::kRefine,
                                         11,
                                         768,
                                         512,
                                         {264, 152, 184},
                                         402,
                                         17.2},
                             RecordedRun{"glazed 256 refine without masks",
                                         Silhouettes::kNone,
                                         Method::kRefine,
                                         36,
                                         640,
                                         480,
                                         {264, 264, 136},
                                         430,
                                         33.6},
                             RecordedRun{"plaster 256 refine without masks",
                                         Silhouettes::kNone,
                                         Method::kRefine,
                                         36,
                                         640,
                                         480,
                                         {152, 200, 264},
                                         402,
                                         19.2},
                             RecordedRun{"bunny 256 refine",
                                         Silhouettes::kGiven,
                                         Method::kRefine,
                                         36,
                                         640,
                                         480,
                                         {168, 264, 248},
                                         479,
                                         12.2},
                             RecordedRun{"armadillo 256 refine",
                                         Silhouettes::kGiven,
                                         Method::kRefine,
                                         48,
                                         640,
                                         480,
                                         {192, 256, 264},
                                         514,
                                         11.8},
                             RecordedRun{"templeSparseRing default refine masks made",
                                         Silhouettes::kMade,
                                         Method::kRefine,
                                         16,
                                         640,
                                         480,
                                         {192, 296, 144},
                                         438,
                                         14.3},
                             RecordedRun{"templeRing 256 refine masks made",
                                         Silhouettes::kMade,
                                         Method::kRefine,
                                         47,
                                         640,
                                         480,
                                         {176, 264, 128},
                                         509,
                                         23.3},
                             RecordedRun{"bunny 256 hull",
                                         Silhouettes::kGiven,
                                         Method::kHull,
                                         36,
                                         640,
                                         480,
                                         {168, 264, 248},
                                         458,
                                         3.3},
                             RecordedRun{"bunny 256 space-carving",
                                         Silhouettes::kGiven,
                                         Method::kSpaceCarving,
                                         36,
                                         640,
                                         480,
                                         {168, 264, 248},
                                         579,
                                         23.3},
                             RecordedRun{"fandisk 128 space-carving without masks",
                                         Silhouettes::kNone,
                                         Method::kSpaceCarving,
                                         24,
                                         640,
                                         480,
                                         {112, 136, 96},
                                         409,
                                         35.6},
                             RecordedRun{"templeSparseRing 128 space-carving without masks",
                                         Silhouettes::kNone,
                                         Method::kSpaceCarving,
                                         16,
                                         640,
                                         480,
                                         {88, 136, 72},
                                         335,
                                         25.0}};

INSTANTIATE_TEST_SUITE_P(Recorded, Estimate, testing::ValuesIn(kRuns));

TEST(EstimateCost, PhotographsAloneWithoutAGrid) {
  CostQuestion q;
  const Cost none = estimate_cost(q);
  EXPECT_GT(none.bytes, 0);
  q.cameras.resize(40);
  for (Camera& camera : q.cameras) camera.intrinsics.width = camera.intrinsics.height = 1000;
  EXPECT_GT(estimate_cost(q).bytes, none.bytes);
}

}  // namespace
}  // namespace photohull::pipeline
