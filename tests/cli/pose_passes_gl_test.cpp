// pose of an object that was laid on another side in between, from the command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "child_process.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "io/load_scene.h"
#include "sphere_scene.h"
#include "support/places.h"
#include "support/scratch_folder.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

const std::string kBoard = test::in_checkout("datasets/boards/board_a4.json");

/// Photographs of an arch on the sheet, rendered once for all tests: upright, and lying on its
/// side.
class PosePasses : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_.emplace();
    photograph("upright", json::object());
    photograph("lying", {{"sheet", {{"turn", {90, 0, 0}}}}, {"degradations", {{"seed", 3}}}});
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::string path(const std::string& name) { return (*folder_ / name).string(); }
  static json read(const std::string& name) { return json::parse(read_bytes(*folder_ / name)); }

  /// An arch on the sheet, photographed into a folder; `spec` in the place of some fields.
  static void photograph(const std::string& name, const json& spec) {
    json all = json::parse(R"({"geometry": {"shape": "arch"},
      "material": {"base": [0.6, 0.33, 0.16], "contrast": 0.7, "size": 0.16},
      "background": {"colour": [0.1, 0.12, 0.14]}, "sheet": {"fill": 0.7},
      "image": {"width": 640, "height": 480, "samples": 2, "maps": false, "masks": false},
      "cameras": {"layout": "arc", "count": 6, "arc": 120, "azimuth": 90, "elevation": 32,
        "distance": 3.2, "fill": 0.6},
      "degradations": {"photon_noise": 0.01, "blur": 0.4}, "truth_samples": 500})");
    all.merge_patch(spec);
    all["sheet"]["board"] = kBoard;
    write_atomically(*folder_ / (name + ".json"), all.dump());
    const Finished made = run_photohull({"synthesize", path(name + ".json"), "--out", path(name)});
    ASSERT_EQ(made.code, 0) << made.err;
  }
  static Finished pose(const std::string& first, const std::string& second) {
    return run_photohull(
        {"pose", "--pass", path(first), path(second), "--board", kBoard, "--out", path("scene")});
  }
  /// So many of a folder's photographs, in another folder.
  static void copy(const std::string& from, const std::string& to, int count) {
    fs::create_directories(path(to));
    for (int i = 0; i < count; ++i)
      fs::copy(path(concat(from, "/images/000", i, ".png")), path(to));
  }
  glm::dvec3 vector(const json& j) const { return {j[0], j[1], j[2]}; }

  void TearDown() override { fs::remove_all(path("scene")); }

  static std::optional<ScratchFolder> folder_;
};

std::optional<ScratchFolder> PosePasses::folder_;

TEST_F(PosePasses, AreJoinedByTheObjectsTexture) {
  const Finished posed = pose("upright/images", "lying/images");
  ASSERT_EQ(posed.code, 0) << posed.err;
  EXPECT_THAT(posed.out, HasSubstr("the object      lay turned by "));
  EXPECT_THAT(posed.out, HasSubstr("seam "));
  const json report = read("scene/pose.json");
  ASSERT_EQ(report["passes"].size(), 2u);
  EXPECT_FALSE(report["passes"][0].contains("motion"));
  const json motion = report["passes"][1]["motion"];
  EXPECT_LT(motion["seam"], 0.5);
  EXPECT_LT(motion["seam_sigma"], 0.1);
  EXPECT_LT(motion["outside"], 0.02);
  // The exact motion: back by 90 degrees about x.
  EXPECT_NEAR(motion["angle"], 90, 0.1);
  EXPECT_LT(glm::distance(vector(motion["axis"]), glm::dvec3(-1, 0, 0)), 2e-3);
  const json first = read("upright/spec.json")["result"]["sheet"],
             second = read("lying/spec.json")["result"]["sheet"];
  const glm::dvec3 middle = vector(second["turned_about"]);
  const double unit = first["unit"];
  EXPECT_NEAR(unit, second["unit"], 1e-12 * unit);
  // The middle, which stays where it is in the world, from one sheet to the other.
  const glm::dvec3 before = (middle - vector(first["origin"])) / unit,
                   after = (middle - vector(second["origin"])) / unit;
  const glm::dvec3 turned(after.x, after.z, -after.y);
  EXPECT_LT(glm::distance(turned + vector(motion["translation"]), before), 0.1);
  // One scene of all, with masks of both.
  const Scene scene = io::load_scene(path("scene"), {});
  ASSERT_EQ(scene.views.size(), 12u);
  std::set<std::string> names;
  for (const SourceView& view : scene.views) {
    names.insert(view.name);
    EXPECT_TRUE(fs::exists(view.mask)) << view.name;
  }
  EXPECT_EQ(names.size(), 12u);
  ASSERT_TRUE(scene.box);
  EXPECT_LT(scene.box->min.z, 0);
  const glm::dvec3 eye = scene.views[6].camera.center();
  const io::LoadSceneOptions plain;
  const Scene exact = io::load_scene(path("lying"), plain);
  const glm::dvec3 there = (exact.views[0].camera.center() - middle) / unit;
  EXPECT_LT(glm::distance(eye, before + glm::dvec3(there.x, there.z, -there.y)), 1.5);
}

TEST_F(PosePasses, WithAPhotographInCommonAreRefused) {
  copy("lying", "copied", 1);
  const Finished posed = pose("lying/images", "copied");
  EXPECT_EQ(posed.code, 1);
  EXPECT_THAT(posed.err, HasSubstr("0000.png are the same photograph: --pass takes a folder for "
                                   "each side that the object lay on"));
}

}  // namespace
}  // namespace photohull::test
