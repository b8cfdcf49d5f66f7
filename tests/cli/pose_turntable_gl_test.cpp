// pose of photographs that a camera which stands still took of a sheet that turns, from the command
// line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "child_process.h"
#include "core/atomic_file.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "sphere_scene.h"
#include "support/places.h"
#include "support/scratch_folder.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

const std::string kBoard = test::in_checkout("datasets/boards/board_a4.json");

class PoseTurntable : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  json report() const { return json::parse(read_bytes(folder_ / "posed/pose.json")); }

  /// The rendered scene that the documentation has, with `spec` in place of some of its fields.
  void photograph(const json& spec = json::object()) const {
    json all = json::parse(read_bytes(test::in_checkout("datasets/synthetic/on_turntable.json")),
                           nullptr, true, true);
    all.merge_patch(spec);
    all["sheet"]["board"] = kBoard;
    write_atomically(folder_ / "spec.json", all.dump());
    const Finished made = run_photohull({"synthesize", path("spec.json"), "--out", path("table")});
    ASSERT_EQ(made.code, 0) << made.err;
  }
  Finished pose(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"pose",  path("table/images"), "--board", kBoard,
                                   "--out", path("posed")};
    words.insert(words.end(), more.begin(), more.end());
    return run_photohull(words);
  }

  ScratchFolder folder_;
};

double overlap(const fs::path& mask, const fs::path& exact) {
  const Mask a = io::read_mask(mask), b = io::read_mask(exact);
  double both = 0, either = 0;
  for (std::size_t i = 0; i < a.coverage.size(); ++i) {
    const bool x = a.coverage[i] >= 128, y = b.coverage[i] >= 128;
    both += x && y, either += x || y;
  }
  return both / either;
}

/// Share of the exact mask that the other one lacks.
double missed(const fs::path& mask, const fs::path& exact) {
  const Mask a = io::read_mask(mask), b = io::read_mask(exact);
  double lacking = 0, all = 0;
  for (std::size_t i = 0; i < b.coverage.size(); ++i)
    if (b.coverage[i] >= 128) ++all, lacking += a.coverage[i] < 128;
  return lacking / all;
}

TEST_F(PoseTurntable, HasAxisAnglesAndTighterMasks) {
  photograph();
  const Finished posed = pose();
  ASSERT_EQ(posed.code, 0) << posed.err;
  EXPECT_THAT(posed.out, HasSubstr("18 of 18 photographs have a pose"));
  EXPECT_THAT(posed.out, HasSubstr("turntable        18 photographs around one axis"));
  const json found = report(), table = found["turntable"];
  EXPECT_TRUE(table["found"]);
  EXPECT_TRUE(table["background_still"]);
  EXPECT_EQ(table["stations"][0]["background"], "still");
  EXPECT_GT(double(table["axis"]["direction"][2]), std::cos(0.02 * 3.14159265 / 180));
  EXPECT_LT(std::abs(double(table["axis"]["point"][0])), 0.02);
  EXPECT_LT(std::abs(double(table["axis"]["point"][1])), 0.02);
  EXPECT_LT(double(table["rms_degrees"]), 0.01);
  for (std::size_t i = 0; i < 18; ++i) {
    // The cameras go around counter-clockwise, so that the table turns clockwise.
    const double angle = found["photographs"][i]["turntable"]["angle"];
    EXPECT_LT(std::abs(std::remainder(angle + 20 * double(i), 360)), 0.02) << i;
  }
  // What the sheet alone would have (0.14 to 0.17): too few photographs for a background.
  fs::create_directories(folder_ / "few");
  for (const char* name : {"0000.png", "0003.png", "0006.png"})
    fs::copy(folder_ / "table/images" / name, folder_ / "few" / name);
  const Finished few =
      run_photohull({"pose", path("few"), "--board", kBoard, "--out", path("alone")});
  ASSERT_EQ(few.code, 0) << few.err;
  EXPECT_THAT(few.out, Not(HasSubstr("turntable")));
  for (const char* name : {"0000.png", "0003.png", "0006.png"}) {
    const fs::path exact = folder_ / "table/masks" / name;
    EXPECT_GT(overlap(folder_ / "posed/masks" / name, exact),
              0.5 + overlap(folder_ / "alone/masks" / name, exact))
        << name;
  }
  double sum = 0;
  for (const auto& mask : fs::directory_iterator(folder_ / "posed/masks")) {
    const fs::path exact = folder_ / "table/masks" / mask.path().filename();
    sum += overlap(mask.path(), exact);
    EXPECT_GT(overlap(mask.path(), exact), 0.87) << mask.path();  // 0.894 at least
    EXPECT_LT(missed(mask.path(), exact), 0.01) << mask.path();   // 0.0051 at most
  }
  EXPECT_GT(sum / 18, 0.92);  // 0.936
}

TEST_F(PoseTurntable, AWalkWithTheSameCamerasIsNone) {
  photograph({{"cameras", {{"turntable", false}}}});
  const Finished posed = pose({"--no-masks"});
  ASSERT_EQ(posed.code, 0) << posed.err;
  EXPECT_THAT(posed.out, HasSubstr("no turntable"));
  const json table = report()["turntable"];
  EXPECT_FALSE(table["found"]);
  EXPECT_FALSE(table["background_still"]);
  EXPECT_EQ(table["stations"][0]["background"], "changes");
  EXPECT_THAT(std::string(table["reason"]), HasSubstr("the camera went around"));
  for (const json& photo : report()["photographs"]) EXPECT_FALSE(photo.contains("turntable"));
}

TEST_F(PoseTurntable, NothingIsToldBeforeAPlainWall) {
  photograph({{"background", {{"type", "colour"}, {"colour", {0.2, 0.2, 0.2}}}}});
  const Finished posed = pose({"--no-masks"});
  ASSERT_EQ(posed.code, 0) << posed.err;
  const json table = report()["turntable"];
  EXPECT_FALSE(table["found"]);
  EXPECT_EQ(table["stations"][0]["background"], "plain");
}

TEST_F(PoseTurntable, SpecsWhoseCameraMovesAreRefused) {
  const auto refused = [&](const json& cameras) {
    const json spec = {{"cameras", cameras}};
    write_atomically(folder_ / "spec.json", spec.dump());
    const Finished made = run_photohull({"synthesize", path("spec.json"), "--out", path("table")});
    EXPECT_EQ(made.code, 1);
    return made.err;
  };
  EXPECT_THAT(refused({{"turntable", true}, {"roll", 5}}), HasSubstr("set cameras.roll to 0"));
  EXPECT_THAT(refused({{"turntable", true}, {"layout", "hemisphere"}}),
              HasSubstr("choose the layout rings or arc"));
}

}  // namespace
}  // namespace photohull::test
