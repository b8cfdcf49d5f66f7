// The box and the lattice that reconstructions work in.
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "reconstruct_fixture.h"
#include "support/analytic_volumes.h"
#include "volume/write_vdb.h"

namespace photohull::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class ReconstructBox : public Reconstruct {};

TEST_F(ReconstructBox, ABoxMuchTooLargeIsMadeSmaller) {
  const Finished run = succeed(reconstruct({"--box", "-60 -60 -60 60 60 60"}));  // cameras inside
  EXPECT_THAT(run.err, HasSubstr("times larger than what the silhouettes leave"));
  const auto box = report()["box"];
  EXPECT_LT(double(box["max"][0]) - double(box["min"][0]), 10);
  EXPECT_EQ(report()["verdict"]["level"], "good");
}

TEST_F(ReconstructBox, ViewsAndBoxSelect) {
  succeed(reconstruct(
      {"--method", "hull", "--views", "0-4,view6*", "--box", "0.1 -1.2 -0.7 1.1 0.8 1.3"}));
  EXPECT_EQ(report()["scene"]["views"], 6);
  EXPECT_EQ(report()["options"]["views"], "0-4,view6*");
  EXPECT_EQ(report()["box"]["source"], "--box");
  // The plane x = 0.1 halves the sphere; half a voxel of slack on the cut.
  EXPECT_NEAR(signed_volume(mesh()), 0.5 * kSphereVolume, 0.12 * kSphereVolume);
  EXPECT_EQ(open_edges(mesh()), 0u);
}

TEST_F(ReconstructBox, VoxelSizeIsTaken) {
  succeed(reconstruct({"--method", "hull", "--voxel-size", "0.08"}));
  EXPECT_DOUBLE_EQ(report()["grid"]["voxel_size"], 0.08);
}

TEST_F(ReconstructBox, ABoxTakenExactlyCutsTheSurface) {
  const Arguments half = {"--method", "hull", "--box", "0.1 -1.2 -0.7 1.1 0.8 1.3"};
  const auto lowest = [&](Arguments more) {
    more.insert(more.begin(), half.begin(), half.end());
    succeed(reconstruct(more));
    double least = 1e9;
    const TriMesh cut = mesh();
    for (std::size_t i = 0; i < cut.positions.size(); ++i) least = std::min(least, cut.world(i).x);
    return least;
  };
  EXPECT_LT(lowest({}), 0.1 - 0.01);  // half a voxel of slack
  EXPECT_NEAR(lowest({"--box-exact"}), 0.1, 1e-6);
  EXPECT_EQ(report()["options"]["box_exact"], "true");
  EXPECT_EQ(open_edges(mesh()), 0u);
}

TEST_F(ReconstructBox, ABoxTakenExactlyIsNotMadeSmaller) {
  const Arguments large = {"--method",     "hull", "--box", "-2.3 -2.3 -2.3 2.3 2.3 2.3",
                           "--resolution", "200"};
  succeed(reconstruct(large));
  EXPECT_THAT(report()["box"]["source"], HasSubstr("made smaller by the silhouettes"));
  for (const std::vector<std::string>& stands :
       {std::vector<std::string>{"--box-exact"}, {"--lattice", "fixed"}}) {
    Arguments more = large;
    more.insert(more.end(), stands.begin(), stands.end());
    // What few views see of so large a box may fail the result's own checks; the files are there.
    EXPECT_THAT(run_photohull(reconstruct(more)).code, testing::AnyOf(0, 3));
    EXPECT_EQ(report()["box"]["source"], "--box");
    EXPECT_DOUBLE_EQ(report()["grid"]["voxel_size"], 4.6 / 200);
  }
}

// Two boxes whose corners are whole voxels apart, and other views: the same voxels.
TEST_F(ReconstructBox, AFixedLatticeFollowsBoxAndSizeAlone) {
  const Arguments fixed = {"--method", "hull", "--lattice", "fixed", "--voxel-size", "0.0625"};
  const auto grid_of = [&](Arguments more) {
    more.insert(more.begin(), fixed.begin(), fixed.end());
    succeed(reconstruct(more));
    return report()["grid"];
  };
  const json all = grid_of({"--box", "-1 -1.25 -0.75 1 1 1.5"});
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_DOUBLE_EQ(all["origin"][axis].get<double>(),
                     (std::array{-1.0, -1.25, -0.75})[std::size_t(axis)] - 2.5 * 0.0625);
  EXPECT_EQ(read_vdb_surface(path("out/volume.vdb")).grid.voxel_size, 0.0625);
  const json fewer = grid_of({"--box", "-1 -1.25 -0.75 1 1 1.5", "--views", "0-9"});
  EXPECT_EQ(fewer["origin"], all["origin"]);
  EXPECT_EQ(fewer["voxels"], all["voxels"]);
  const json part = grid_of({"--box", "-0.5 -1.25 -0.75 1 1 1.5"});
  EXPECT_DOUBLE_EQ(part["origin"][0].get<double>() - all["origin"][0].get<double>(), 0.5);
  EXPECT_EQ(part["origin"][1], all["origin"][1]);
}

}  // namespace
}  // namespace photohull::test
