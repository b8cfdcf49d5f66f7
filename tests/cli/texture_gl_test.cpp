// Exported files with textures.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/mesh/read_mesh.h"
#include "reconstruct_fixture.h"
#include "support/analytic_volumes.h"

namespace photohull::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class Texture : public Reconstruct {
 protected:
  std::vector<std::string> stages() const {
    std::vector<std::string> names;
    const json all = report();
    for (const json& stage : all["stages"]) names.push_back(stage["name"]);
    return names;
  }
};

TEST_F(Texture, FilesThatHoldOneHaveOne) {
  succeed(reconstruct({"--method", "hull"}));
  const std::string plain = read_bytes(path("out/mesh.ply"));
  EXPECT_FALSE(report().contains("texture"));
  succeed(
      reconstruct({"--method", "hull", "--export", "glb", "--export", "obj", "--export", "usdz"}));
  EXPECT_THAT(listing(out()),
              ElementsAre("mesh.glb", "mesh.mtl", "mesh.obj", "mesh.ply", "mesh.usdz", "mesh_0.png",
                          "preview.png", "report.html", "report.json", "volume.vdb"));
  EXPECT_EQ(read_bytes(path("out/mesh.ply")), plain);
  EXPECT_THAT(stages(), testing::Contains("texture"));
  const json found = report()["texture"];
  for (const char* field : {"triangles", "pages", "charts", "views", "texels"})
    EXPECT_GT(found[field], 0) << field;
  EXPECT_EQ(found["pages"], 1);
  EXPECT_EQ(found["scale"], 1);
  EXPECT_EQ(found["size"].size(), 2u);
  EXPECT_LT(found["unseen_share"], 0.1);
  EXPECT_LT(found["filled_share"], 0.5);
  EXPECT_EQ(report()["files"].size(), 10u);
  const TriMesh glb = read_mesh(path("out/mesh.glb"));
  EXPECT_EQ(glb.triangles.size(), found["triangles"]);
  EXPECT_LT(glb.triangles.size(), mesh().triangles.size());
  EXPECT_EQ(open_edges(glb), 0u);
  EXPECT_NEAR(signed_volume(glb), signed_volume(mesh()), 0.02 * signed_volume(mesh()));
  EXPECT_EQ(read_mesh(path("out/mesh.obj")).triangles.size(), found["triangles"]);
}

TEST_F(Texture, OffLeavesTheVerticesColours) {
  succeed(reconstruct({"--method", "hull", "--export", "glb", "--texture", "off"}));
  EXPECT_FALSE(report().contains("texture"));
  EXPECT_EQ(report()["options"]["texture"], "off");
  EXPECT_THAT(read_bytes(path("out/mesh.glb")), HasSubstr("COLOR_0"));
  EXPECT_EQ(read_mesh(path("out/mesh.glb")).triangles.size(), mesh().triangles.size());
}

TEST_F(Texture, AnEdgeBoundsIt) {
  succeed(reconstruct({"--method", "hull", "--export", "glb", "--texture", "128"}));
  const json found = report()["texture"];
  EXPECT_EQ(found["pages"], 1);
  EXPECT_LE(std::max(found["size"][0], found["size"][1]), 128);
  EXPECT_THAT(read_bytes(path("out/mesh.glb")), Not(HasSubstr("COLOR_0")));
}

TEST_F(Texture, MeshErrorIsTheTexturedMeshs) {
  succeed(reconstruct({"--method", "hull", "--export", "glb", "--mesh-error", "0.5"}));
  EXPECT_EQ(report()["texture"]["triangles"], mesh().triangles.size());
}

}  // namespace
}  // namespace photohull::test
