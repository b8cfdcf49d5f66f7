// What must leave a reconstruction the same, byte for byte or within bounds.
#include <nlohmann/json.hpp>
#include <sstream>

#include "reconstruct_fixture.h"

namespace photohull::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class ReconstructSame : public Reconstruct {
 protected:
  /// The scene file lists its views from the last to the first.
  void reverse_views() const {
    std::istringstream in(read_bytes(path("scene_par.txt")));
    std::string count, line, views;
    std::getline(in, count);
    while (std::getline(in, line)) views = line + "\n" + views;
    write_bytes(path("scene_par.txt"), count + "\n" + views);
  }
};

TEST_F(ReconstructSame, ViewsInAnotherOrderGiveTheSameBytes) {
  succeed(reconstruct({}));
  const std::string expected = read_bytes(path("out/mesh.ply"));
  reverse_views();
  succeed(reconstruct({}));
  EXPECT_EQ(read_bytes(path("out/mesh.ply")), expected);
}

TEST_F(ReconstructSame, SameBytesInEveryRunWhateverTheThreads) {
  for (const std::string method : {"hull", "voxel-coloring", "space-carving", "refine"}) {
    std::string mesh, volume;
    for (const std::string threads : {"1", "2", "3", "2"}) {
      succeed(reconstruct({"--method", method, "--threads", threads}));
      if (mesh.empty()) {
        mesh = read_bytes(path("out/mesh.ply"));
        volume = read_bytes(path("out/volume.vdb"));
      }
      EXPECT_TRUE(mesh == read_bytes(path("out/mesh.ply"))) << method << ", " << threads;
      EXPECT_TRUE(volume == read_bytes(path("out/volume.vdb"))) << method << ", " << threads;
    }
  }
}

// llvmpipe with vectors half as wide stands for another device: threads run in other groups.
TEST_F(ReconstructSame, AnotherWidthOfVectorsLeavesTheHullsBytesAndTheSurface) {
  RunOptions narrow;
  narrow.environment = {"LP_NATIVE_VECTOR_WIDTH=128"};
  for (const std::string method : {"hull", "voxel-coloring", "refine"}) {
    const auto run = [&](const std::string& name, const RunOptions& options) {
      succeed({"reconstruct", scene(), "--out", path(name), "--masks", path("cutouts"),
               "--resolution", "32", "--device", "software", "--method", method},
              options);
      return path(name + "/mesh.ply");
    };
    const std::string wide = run("wide", {}), other = run("narrow", narrow);
    const json report = json::parse(read_bytes(path("narrow/report.json")));
    EXPECT_THAT(report["device"], HasSubstr("128 bits"));
    if (method == "hull") {
      EXPECT_TRUE(read_bytes(wide) == read_bytes(other));
    }
    const json apart =
        json::parse(succeed({"evaluate", other, "--truth", wide, "--json"}).out)["recon_to_gt"];
    const double voxel = report["grid"]["voxel_size"];
    EXPECT_LT(apart["mean"], 0.01 * voxel) << method;
    EXPECT_LT(apart["q95"], 0.05 * voxel) << method;
  }
}

}  // namespace
}  // namespace photohull::test
