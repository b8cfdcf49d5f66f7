// --photometric of reconstruct and evaluate, from the command line.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/image_file.h"
#include "io/mesh/read_mesh.h"
#include "sphere_scene.h"

namespace photohull::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class PhotometricCommand : public SphereScene {
 protected:
  /// Views of odd number record 0.6 of the red light and 0.8 of the rest.
  void dim_every_other_view() const {
    for (int i = 1; i < kViews; i += 2) {
      const ColourImage taken = io::read_image(image(i));
      std::vector<std::uint8_t> pixels = taken.bytes;
      for (std::size_t k = 0; k < pixels.size(); ++k)
        if (k % 4 != 3)
          pixels[k] = std::uint8_t(
              std::lround(255 * srgb_from_linear((k % 4 == 0 ? 0.6 : 0.8) *
                                                 linear_from_srgb(pixels[k] / 255.0))));
      io::write_png(image(i), kWidth, kHeight, 4, pixels);
    }
  }
  json report() const { return json::parse(read_bytes(path("out/report.json"))); }
  /// Root mean square of the difference between the mesh's colours and those of another mesh that
  /// has the same vertices.
  static double difference(const TriMesh& a, const TriMesh& b) {
    EXPECT_EQ(a.positions, b.positions);
    double sum = 0;
    for (std::size_t i = 0; i < a.colours.size(); ++i) {
      const glm::vec3 d = glm::sqrt(a.colours[i]) - glm::sqrt(b.colours[i]);
      sum += glm::dot(d, d) / 3;
    }
    return std::sqrt(sum / double(a.colours.size()));
  }
};

TEST_F(PhotometricCommand, MakesTheColoursOfDimmedViewsAgree) {
  const auto hull = [&](const char* photometric) {
    return reconstruct({"--method", "hull", "--photometric", photometric});
  };
  succeed(hull("off"));
  const TriMesh clean = read_mesh(path("out/mesh.ply"));
  EXPECT_FALSE(report().contains("photometric"));
  dim_every_other_view();
  succeed(hull("off"));
  const TriMesh dimmed = read_mesh(path("out/mesh.ply"));
  const Finished run = succeed(hull("auto"));
  EXPECT_THAT(run.out, HasSubstr("photometric: gains "));
  EXPECT_THAT(run.out, HasSubstr(": corrected"));
  TriMesh corrected = read_mesh(path("out/mesh.ply"));
  const json r = report()["photometric"];
  EXPECT_TRUE(r["used"]);
  EXPECT_TRUE(r["significant"]);
  EXPECT_LT(r["disagreement_after"], 0.8 * double(r["disagreement_before"]));
  ASSERT_EQ(r["views"].size(), std::size_t(kViews));
  for (int i = 0; i < kViews; ++i) {
    const json& view = r["views"][std::size_t(i)];
    EXPECT_EQ(view["name"], scene_.views[i].name);
    EXPECT_TRUE(view["solved"]);
    // Geometric means: sqrt(0.6) and sqrt(0.8).
    EXPECT_NEAR(view["gain"][0], i % 2 ? std::sqrt(0.6) : 1 / std::sqrt(0.6), 0.03) << i;
    EXPECT_NEAR(view["gain"][1], i % 2 ? std::sqrt(0.8) : 1 / std::sqrt(0.8), 0.03) << i;
  }
  // The corrected photographs are by these factors darker than those of the clean scene.
  for (glm::vec3& c : corrected.colours)
    c /= glm::vec3(std::sqrt(0.6f), std::sqrt(0.8f), std::sqrt(0.8f));
  EXPECT_LT(difference(corrected, clean), 0.4 * difference(dimmed, clean));
}

TEST_F(PhotometricCommand, LeavesPhotographsAloneThatAgree) {
  const Finished left = succeed(reconstruct({"--method", "hull"}));  // auto is the default
  EXPECT_THAT(left.out, HasSubstr("left as they are"));
  const json r = report();
  EXPECT_FALSE(r["photometric"]["used"]);
  EXPECT_EQ(r["options"]["photometric"], "auto");
  const json checked = r["photometric"]["checked"];
  EXPECT_LT(checked["rms_gain"], 0.02);
  EXPECT_GE(checked["views"], 2);
  succeed(reconstruct({"--method", "hull", "--photometric", "on"}));
  EXPECT_TRUE(report()["photometric"]["used"]);
}

TEST_F(PhotometricCommand, WithoutMasksGainsAreMeasuredOnTheResult) {
  dim_every_other_view();
  succeed(reconstruct({"--masks", "none", "--photometric", "on"}));
  std::vector<std::string> stages;
  const json r = report();
  for (const json& stage : r["stages"]) stages.push_back(stage["name"]);
  const auto at = [&](const char* name) {
    return std::find(stages.begin(), stages.end(), name) - stages.begin();
  };
  EXPECT_GT(at("photometric"), at("refine"));
  EXPECT_LT(at("photometric"), at("colour"));
  const auto red = [&](std::size_t i) { return double(r["photometric"]["views"][i]["gain"][0]); };
  EXPECT_NEAR(red(1) / red(2), 0.6, 0.05);  // the surface is a guess in part
}

TEST_F(PhotometricCommand, EvaluateComparesHeldOutPhotographsInTheCommonExposure) {
  dim_every_other_view();
  succeed(reconstruct({"--method", "hull"}));
  const auto psnr = [&](const char* photometric) {
    const Finished run =
        succeed({"evaluate", path("out/mesh.ply"), "--photos", scene(), "--views", "3,8", "--masks",
                 path("cutouts"), "--photometric", photometric, "--json"});
    return double(json::parse(run.out)["photos"]["all"]["psnr"]);
  };
  EXPECT_GT(psnr("on"), psnr("off") + 3);
}

TEST_F(PhotometricCommand, RefusesAndWarns) {
  fail(2, reconstruct({"--photometric", "maybe"}), {"--photometric maybe", "off, auto, on"});
  // Two views from opposite sides share nothing; the result fails its own checks, too.
  const Finished run =
      run_photohull(reconstruct({"--method", "hull", "--views", "0,8", "--photometric", "on"}));
  EXPECT_EQ(run.code, 3) << run.err;
  EXPECT_THAT(run.err, HasSubstr("too few surface points are seen by several views"));
  EXPECT_FALSE(report()["photometric"]["solved"]);
}

}  // namespace
}  // namespace photohull::test
