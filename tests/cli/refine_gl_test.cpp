// Reconstructions with --method refine, and parameters changed by --tune.
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/mesh/write_mesh.h"
#include "sphere_scene.h"
#include "support/analytic_volumes.h"

namespace photohull::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class Refine : public SphereScene {
 protected:
  json report() const { return json::parse(read_bytes(path("out/report.json"))); }

  /// Root mean square distance of the result's vertices from the sphere, in voxels.
  double error() const {
    const TriMesh mesh = read_ply(path("out/mesh.ply"));
    EXPECT_EQ(open_edges(mesh), 0u);
    double sum = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      sum += std::pow(glm::distance(mesh.world(i), kCentre) - kRadius, 2);
    return std::sqrt(sum / double(mesh.positions.size())) /
           report()["grid"]["voxel_size"].get<double>();
  }
};

TEST_F(Refine, StagesAndResult) {
  succeed(reconstruct({"--method", "refine"}));
  // The hull of a sphere is the sphere: nothing is to be gained, and little may be lost.
  EXPECT_LT(error(), 0.25);
  const json r = report();
  EXPECT_EQ(r["options"]["method"], "refine");
  EXPECT_GT(r["hull"]["nodes_tested"], 0);
  std::vector<std::string> stages;
  for (const json& stage : r["stages"]) {
    stages.push_back(stage["name"]);
    const bool looks = stage["name"] == "hull" || stage["name"] == "refine";
    EXPECT_EQ(stage["samples"] > 0, looks) << stage["name"];
  }
  EXPECT_THAT(stages, ElementsAre("scene", "device", "views", "cameras", "silhouettes", "hull",
                                  "photometric", "images", "refine", "clean", "mesh", "colour",
                                  "volume", "verdict", "page", "preview", "files"));
}

TEST_F(Refine, SameBytesInEveryRunWhateverTheThreads) {
  succeed(reconstruct({"--method", "refine", "--threads", "1"}));
  const std::string mesh = read_bytes(path("out/mesh.ply"));
  succeed(reconstruct({"--method", "refine", "--threads", "2"}));
  EXPECT_TRUE(mesh == read_bytes(path("out/mesh.ply")));
}

TEST_F(Refine, WithoutMasksBetterThanTheHull) {
  EXPECT_EQ(run_photohull(reconstruct({"--method", "hull", "--masks", "none"})).code, 3);
  const double hull = error();
  succeed(reconstruct({"--method", "refine", "--masks", "none", "--unseen", "closed"}));
  EXPECT_EQ(report()["masks"]["source"], "none");
  EXPECT_LT(error(), 0.6 * hull);
}

TEST_F(Refine, MasksThatBoundNothingLeaveUnknownSpaceOpen) {
  const std::string told = "the masks do not bound the object";
  EXPECT_THAT(succeed(reconstruct({"--method", "refine"})).err, Not(HasSubstr(told)));
  write_masks("white", 255, 255);
  EXPECT_THAT(succeed(reconstruct({"--method", "refine", "--masks", path("white")})).err,
              HasSubstr(told));
  const auto triangles = [&] { return double(report()["mesh"]["triangles"]); };
  const double white = triangles();
  succeed(reconstruct({"--method", "refine", "--masks", "none"}));
  EXPECT_NEAR(white, triangles(), 0.05 * triangles());
  EXPECT_GT(open_edges(read_ply(path("out/mesh.ply"))), 0u);
}

TEST_F(Refine, ParametersCanBeTuned) {
  succeed(
      reconstruct({"--method", "refine", "--tune", "levels=1", "--tune", "peak.least_score=0.4"}));
  EXPECT_EQ(report()["options"]["tune"], "levels=1 peak.least_score=0.4");
  succeed(reconstruct({"--method", "space-carving", "--tune", "max_rounds=1"}));
}

TEST_F(Refine, WrongTuningIsRefused) {
  const auto refuse = [&](const char* method, const char* tune, const char* part) {
    fail(2, reconstruct({"--method", method, "--tune", tune}), {part});
  };
  refuse("refine", "keep_score=0.5", "this method has no 'keep_score'; it has ");
  refuse("space-carving", "levels=2", "this method has no 'levels'; it has ");
  refuse("refine", "levels", "--tune levels: expected NAME=NUMBER");
  refuse("refine", "levels=9", "levels must be 0 (automatic) to 8");
  refuse("refine", "match.best_pairs=0", "match.best_pairs");
  refuse("hull", "levels=2",
         "--tune levels=2: this method has no 'levels'; it has missing.full_miss");
}

}  // namespace
}  // namespace photohull::test
