// calibrate, and convert with what it found, from the command line on rendered boards.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "../calib/rendered_boards.h"
#include "child_process.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "sphere_scene.h"
#include "support/scratch_folder.h"

namespace photohull::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class CalibrateCommand : public testing::Test {
 protected:
  CalibrateCommand() {
    lens_.k = {320, 240, 306, 306, 0, 161, 118};
    lens_.lens = {};
  }

  void save(const ColourImage& image, const std::string& name) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    io::write_png(folder_ / name, image.width, image.height, 4, image.bytes);
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  json read(const std::string& name) const { return json::parse(read_bytes(folder_ / name)); }

  ScratchFolder folder_;
  Truth lens_;
  const Arguments board_ = {"--columns", "7", "--rows", "4", "--lens", "pinhole"};

  Finished run(Arguments arguments, bool with_board = true) const {
    if (with_board) arguments.insert(arguments.end(), board_.begin(), board_.end());
    return run_photohull(arguments);
  }
};

TEST_F(CalibrateCommand, RigsBecomeScenes) {
  const Pose right{glm::mat3_cast(glm::angleAxis(-0.2, glm::dvec3(0, 1, 0))), {2.5, 0, 0.3}};
  for (int m = 0; m < 5; ++m) {
    const Pose board = pose_of(m, {3, 1.5}, 11);
    save(photograph(lens_, board, chess(7, 4)), concat("boards/left/", m, ".png"));
    save(photograph(lens_,
                    {right.rotation * board.rotation,
                     right.rotation * board.translation + right.translation},
                    chess(7, 4)),
         concat("boards/right/", m, ".png"));
  }
  const Finished found =
      run({"calibrate", path("boards"), "--rig", "{camera}/{moment}", "--out", path("rig.json")});
  ASSERT_EQ(found.code, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("camera right"));
  EXPECT_THAT(found.out, HasSubstr("left/3.png"));
  const json rig = read("rig.json");
  ASSERT_EQ(rig["cameras"].size(), 2u);
  EXPECT_GT(rig["cameras"][1]["translation_sigma"], 0.0);
  EXPECT_EQ(rig["cameras"][1]["views"][2]["moment"], "2");
  // Photographs of an object by the same cameras.
  for (const char* name : {"object/left.png", "object/right.png"})
    save(paint_srgb(320, 240, [](double, double) { return glm::vec3(0.5f); }), name);
  const Finished converted = run({"convert", path("rig.json"), "--images", path("object"), "--to",
                                  "transforms", "--out", path("scene")},
                                 false);
  ASSERT_EQ(converted.code, 0) << converted.err;
  const Scene scene = io::load_scene(folder_ / "scene");
  ASSERT_EQ(scene.views.size(), 2u);
  const Pose& pose = scene.views[1].camera.cam_from_world;
  EXPECT_LT(glm::distance(pose.translation, right.translation), 0.05);
  EXPECT_NEAR(glm::determinant(pose.rotation), 1, 1e-9);
  EXPECT_NEAR(glm::dot(pose.rotation[0], right.rotation[0]), 1, 1e-4);
}

TEST_F(CalibrateCommand, TurntablesBecomeScenes) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.02, -0.9, -0.3)), point(0.2, 1, 11);
  const Pose first = pose_of(1, {3, 1.5}, 11);
  for (int i = 0; i < 6; ++i) {
    const glm::dmat3 turn = glm::mat3_cast(glm::angleAxis((9.0 * i - 25) * kRadian, axis));
    save(photograph(lens_, {turn * first.rotation, turn * (first.translation - point) + point},
                    chess(7, 4)),
         concat("table/", i + 5, ".png"));  // 10 follows 9
  }
  const Finished found =
      run({"calibrate", path("table"), "--turntable", "--step", "9", "--out", path("table.json")});
  ASSERT_EQ(found.code, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("angles           as given"));
  const json table = read("table.json")["turntable"];
  EXPECT_EQ(table["angles_given"], true);
  const glm::dvec3 direction(table["axis"][0], table["axis"][1], table["axis"][2]);
  EXPECT_LT(std::acos(std::min(1.0, glm::dot(direction, axis))) / kRadian, 0.1);
  EXPECT_GT(table["axis_sigma_degrees"], 0.0);
  const Finished converted = run({"convert", path("table.json"), "--images", path("table"),
                                  "--step", "20", "--to", "transforms", "--out", path("scene")},
                                 false);
  ASSERT_EQ(converted.code, 0) << converted.err;
  const Scene scene = io::load_scene(folder_ / "scene");
  ASSERT_EQ(scene.views.size(), 6u);
  // All cameras are as high and as far from the z axis as the first.
  for (const SourceView& view : scene.views) {
    const glm::dvec3 c = view.camera.center(), c0 = scene.views[0].camera.center();
    EXPECT_NEAR(c.z, c0.z, 1e-6);
    EXPECT_NEAR(std::hypot(c.x, c.y), std::hypot(c0.x, c0.y), 1e-6);
  }
  const glm::dvec3 a = scene.views[0].camera.center(), b = scene.views[1].camera.center();
  EXPECT_NEAR(std::acos((a.x * b.x + a.y * b.y) / (a.x * a.x + a.y * a.y)) / kRadian, 20, 1e-4);
}

TEST_F(CalibrateCommand, ABoardWithColumnsAndRowsSwappedIsRefusedAndTheRightOneNamed) {
  for (int i = 0; i < 6; ++i)
    save(photograph(lens_, pose_of(i, {4, 3}, 10), charuco(8, 6)), concat("boards/", i, ".png"));
  const auto calibrate = [&](const char* columns, const char* rows) {
    return run({"calibrate", path("boards"), "--board", "charuco", "--columns", columns, "--rows",
                rows, "--lens", "pinhole", "--out", path("c.json")},
               false);
  };
  const Finished swapped = calibrate("6", "8");
  EXPECT_EQ(swapped.code, 1);
  EXPECT_THAT(swapped.err, HasSubstr("with --columns 8 --rows 6 the boards fit to 0."));
  EXPECT_FALSE(std::filesystem::exists(path("c.json")));
  const Finished corners = calibrate("7", "5");  // counted as on a chessboard
  EXPECT_EQ(corners.code, 1);
  EXPECT_THAT(corners.err, HasSubstr("with --columns 8 --rows 6"));
  const Finished right = calibrate("8", "6");
  EXPECT_EQ(right.code, 0) << right.err;
  EXPECT_THAT(right.err, testing::Not(HasSubstr("warning")));
  EXPECT_LT(read("c.json")["object_error"], 0.3);
  EXPECT_EQ(read("c.json")["warnings"], json::array());
}

TEST_F(CalibrateCommand, ChessboardsCountedInSquaresAreNamed) {
  for (int i = 0; i < 5; ++i)
    save(photograph(lens_, pose_of(i, {3, 1.5}, 11), chess(7, 4)), concat("boards/", i, ".png"));
  const Finished found = run({"calibrate", path("boards"), "--columns", "8", "--rows", "5",
                              "--lens", "pinhole", "--out", path("c.json")},
                             false);
  EXPECT_EQ(found.code, 1);
  EXPECT_THAT(found.err, HasSubstr("with --columns 7 --rows 4"));
}

TEST_F(CalibrateCommand, AFlatBoardOnATurntableNeedsAKnownLens) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.02, -0.8, -0.6)), point(0, 0, 11);
  const glm::dvec3 x = glm::normalize(glm::cross(axis, glm::dvec3(0, 0, 1)));
  const glm::dmat3 flat(x, -glm::cross(axis, x), -axis);
  for (int i = 0; i < 9; ++i) {
    const glm::dmat3 r = glm::mat3_cast(glm::angleAxis(20 * i * kRadian, axis)) * flat;
    save(photograph(lens_, {r, point - r * glm::dvec3(3, 1.5, 0)}, chess(7, 4)),
         concat("table/", i, ".png"));
  }
  const Arguments table = {"calibrate",       path("table"), "--turntable", "--step", "20",
                           "--columns",       "7",           "--rows",      "4",      "--out",
                           path("table.json")};
  const Finished refused = run(table, false);
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.err, HasSubstr("lean the board on the table"));
  EXPECT_THAT(refused.out, HasSubstr("at the object"));  // the numbers are shown all the same
  EXPECT_FALSE(std::filesystem::exists(path("table.json")));
  // The lens from boards that are tilted.
  for (int i = 0; i < 8; ++i)
    save(photograph(lens_, pose_of(i, {3, 1.5}, 11), chess(7, 4)), concat("lens/", i, ".png"));
  ASSERT_EQ(run({"calibrate", path("lens"), "--out", path("lens.json")}).code, 0);
  Arguments known = table;
  known.insert(known.end(), {"--lens-from", path("lens.json")});
  const Finished found = run(known, false);
  ASSERT_EQ(found.code, 0) << found.err;
  const json result = read("table.json");
  EXPECT_EQ(result["lens_known"], true);
  EXPECT_EQ(result["camera_matrix"], read("lens.json")["camera_matrix"]);
  const glm::dvec3 direction(result["turntable"]["axis"][0], result["turntable"]["axis"][1],
                             result["turntable"]["axis"][2]);
  EXPECT_LT(std::acos(std::min(1.0, std::abs(glm::dot(direction, axis)))) / kRadian, 0.3);
  EXPECT_LT(result["object_error"], 0.5);
}

TEST_F(CalibrateCommand, OptionsThatDoNotFitAreRefused) {
  save(paint_srgb(32, 24, [](double, double) { return glm::vec3(0.5f); }), "plain/1.png");
  const std::string out = path("c.json");
  const auto refused = [&](int code, const Arguments& arguments, const char* part) {
    const Finished r = run_photohull(arguments);
    EXPECT_EQ(r.code, code) << r.err;
    EXPECT_THAT(r.err, HasSubstr(part));
  };
  const std::string plain = path("plain");
  refused(2, {"calibrate", plain, "--out", out, "--step", "5"}, "are for --turntable");
  refused(2, {"calibrate", plain, "--out", out, "--turntable", "--angles", "1 x"},
          "--angles 1 x: expected degrees");
  refused(2, {"calibrate", plain, "--out", out, "--turntable", "--angles", "1 2"},
          "2 angles are stated for 1");
  refused(2, {"calibrate", plain, "--out", out, "--rig", "{camera}"}, "expected a pattern");
  refused(1, {"calibrate", plain, "--out", out, "--rig", "{camera}/{moment}"}, "none of 1");
  refused(2, {"convert", plain, "--step", "5", "--to", "nvm", "--out", path("s")}, "--images");
  refused(2, {"calibrate", plain, "--out", out, "--turntable", "--columns", "8", "--rows", "6"},
          "half a turn");
  refused(2, {"calibrate", plain, "--out", out, "--rig", "{camera}/{moment}", "--board", "circles"},
          "half a turn");
  refused(1, {"convert", plain, "--images", plain, "--to", "nvm", "--out", path("s")},
          "no scene found here");
  refused(1,
          {"convert", plain, "--images", plain, "--step", "5", "--to", "nvm", "--out", path("s")},
          "no file of photohull calibrate");
  refused(2, {"calibrate", plain, "--out", out, "--lens", "brown", "--lens-from", plain}, "--lens");
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace photohull::test
