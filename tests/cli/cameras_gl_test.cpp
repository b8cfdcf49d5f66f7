// convert, refine-cameras and calibrate, from the command line.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/load_scene.h"
#include "sphere_scene.h"

namespace photohull::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class CamerasCommand : public SphereScene {
 protected:
  /// Cameras and box of a scene as the program writes it.
  static Scene load(const std::string& folder) { return io::load_scene(folder, {}); }

  /// Greatest distance in pixels between where two scenes' cameras see points about the sphere.
  static double apart(const Scene& a, const Scene& b) {
    double worst = 0;
    for (std::size_t v = 0; v < a.views.size(); ++v)
      for (int i = 0; i < 8; ++i) {
        const glm::dvec3 p =
            kCentre + 0.7 * kRadius * glm::dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        const glm::dvec3 s = a.views[v].camera.projection() * glm::dvec4(p, 1);
        const glm::dvec3 t = b.views[v].camera.projection() * glm::dvec4(p, 1);
        worst = std::max(worst, glm::distance(glm::dvec2(s) / s.z, glm::dvec2(t) / t.z));
      }
    return worst;
  }

  /// The scene file's, each in another direction.
  void put_cameras_off() {
    for (std::size_t v = 0; v < scene_.views.size(); ++v)
      scene_.views[v].camera.cam_from_world.translation +=
          0.02 * glm::dvec3(std::sin(3.0 * double(v)), std::cos(5.0 * double(v)), 0);
    write_scene_file();
  }

  json report() const { return json::parse(read_bytes(out() + "/report.json")); }
};

TEST_F(CamerasCommand, ConvertedScenesAreUnderstood) {
  for (const char* format : {"colmap-text", "colmap-binary", "transforms", "openmvg", "bundler"}) {
    const std::string folder = path(format);
    const Finished run =
        succeed({"convert", scene(), "--to", format, "--out", folder, "--undistort"});
    EXPECT_THAT(run.out, HasSubstr(std::string("16 views from middlebury to ") + format));
    EXPECT_THAT(succeed({"info", folder}).out,
                HasSubstr(std::string("16 (") + format + " format)"));
    EXPECT_EQ(load(folder).views.size(), std::size_t(kViews));
  }
}

TEST_F(CamerasCommand, ConvertKeepsWhatCamerasSee) {
  succeed({"convert", scene(), "--to", "transforms", "--out", path("nerf")});
  EXPECT_LT(apart(scene_, load(path("nerf"))), 1e-6);
}

TEST_F(CamerasCommand, ConvertRefuses) {
  fail(2, {"convert", scene(), "--to", "polaroid", "--out", out()},
       {"--to polaroid", "transforms"});
  fail(2, {"convert", scene(), "--to", "nvm", "--out", ""}, {"--out is empty"});
  fail(1, {"convert", path("nowhere"), "--to", "nvm", "--out", out()}, {"nowhere"});
}

TEST_F(CamerasCommand, CamerasThatAreRightStayWhereTheyAre) {
  const Finished run =
      succeed({"refine-cameras", scene(), "--masks", path("cutouts"), "--out", out(), "--json"});
  const json report = json::parse(run.out);
  EXPECT_EQ(report["views"].size(), std::size_t(kViews));
  EXPECT_LT(apart(scene_, load(out())), 0.3);
}

TEST_F(CamerasCommand, CamerasThatAreWrongComeNearer) {
  const Scene right = scene_;
  put_cameras_off();
  const double before = apart(right, scene_);
  succeed({"refine-cameras", scene(), "--masks", path("cutouts"), "--out", out()});
  ASSERT_GT(before, 0.5);
  EXPECT_LT(apart(right, load(out())), 0.7 * before);
}

TEST_F(CamerasCommand, ReconstructRefinesThemWhereOutlinesDisagree) {
  succeed(reconstruct({}));
  EXPECT_LT(report()["masks"]["disagreement"], 0.3);
  EXPECT_FALSE(report().contains("camera_refinement"));
  put_cameras_off();
  const Finished run = succeed(reconstruct({}));
  EXPECT_THAT(run.err, HasSubstr("the cameras were refined"));
  EXPECT_GT(report()["masks"]["disagreement"], 0.3);
  const json found = report()["camera_refinement"];
  EXPECT_EQ(found["used"], true);
  EXPECT_LT(found["tangents_after"], 0.8 * double(found["tangents_before"]));
  for (const Arguments& option :
       {Arguments{"--refine-cameras", "off"}, {"--quality", "draft"}, {"--masks", "none"}}) {
    Arguments all = option;
    all.insert(all.end(), {"--method", "hull"});
    const int code = option[1] == "none" ? 3 : 0;  // a hull of no silhouettes is none
    EXPECT_EQ(run_photohull(reconstruct(all)).code, code) << option[0];
    EXPECT_FALSE(report().contains("camera_refinement")) << option[0];
  }
}

TEST_F(CamerasCommand, RefinedCamerasAreKeptForTheNextRun) {
  put_cameras_off();
  const auto cameras = [&] { return report()["cameras"]; };
  const std::string taken = "the run before made agree";
  EXPECT_THAT(succeed(reconstruct({})).err, Not(HasSubstr(taken)));
  const json first = report()["camera_refinement"], refined = cameras();
  // Whatever becomes of them afterwards.
  const Finished hull = succeed(reconstruct({"--method", "hull", "--resolution", "40"}));
  EXPECT_THAT(hull.err, HasSubstr(taken));
  EXPECT_THAT(hull.err, HasSubstr("the cameras were refined"));
  EXPECT_EQ(report()["camera_refinement"], first);
  EXPECT_EQ(cameras(), refined);
  // Not where they are asked for anew, for something else, or with other masks or cameras.
  EXPECT_THAT(succeed(reconstruct({"--fresh"})).err, Not(HasSubstr(taken)));
  EXPECT_THAT(succeed(reconstruct({"--refine-cameras", "poses"})).err, Not(HasSubstr(taken)));
  succeed(reconstruct({}));
  scene_.views[2].camera.cam_from_world.translation.x += 1e-9;
  write_scene_file();
  EXPECT_THAT(succeed(reconstruct({})).err, Not(HasSubstr(taken)));
}

TEST_F(CamerasCommand, WhatIsLeftOfKeptCamerasIsNotTaken) {
  put_cameras_off();
  succeed(reconstruct({}));
  const std::string mesh = read_bytes(out() + "/mesh.ply"), file = out() + "/.photohull-cameras";
  const std::string whole = read_bytes(file);
  ASSERT_GT(whole.size(), 1000u);
  for (const std::string& left :
       {whole.substr(0, whole.size() / 2), std::string("{}"), std::string()}) {
    write_bytes(file, left);
    EXPECT_THAT(succeed(reconstruct({})).err, HasSubstr(".photohull-cameras: damaged"))
        << left.size();
    EXPECT_EQ(read_bytes(out() + "/mesh.ply"), mesh);
  }
  EXPECT_EQ(read_bytes(file), whole);
}

TEST_F(CamerasCommand, ReconstructRefinesThem) {
  succeed(reconstruct({"--refine-cameras", "poses"}));
  EXPECT_TRUE(report().contains("camera_refinement"));
  EXPECT_EQ(report()["options"]["refine_cameras"], "poses");
  fail(2, reconstruct({"--refine-cameras", "perhaps"}),
       {"--refine-cameras perhaps", "poses+intrinsics"});
}

TEST_F(CamerasCommand, InfoFindsNoFaultInCamerasThatAreRight) {
  const Arguments command = {"info", scene(), "--masks", path("cutouts"), "--cameras"};
  EXPECT_THAT(succeed(command).out, HasSubstr("cameras        no fault found"));
  Arguments as_json = command;
  as_json.emplace_back("--json");
  const json cameras = json::parse(succeed(as_json).out)["cameras"];
  EXPECT_TRUE(cameras["faults"].empty());
  EXPECT_TRUE(cameras.contains("pixel_centre"));
}

TEST_F(CamerasCommand, InfoNamesAViewThatDisagrees) {
  scene_.views[5].camera.cam_from_world.translation += glm::dvec3(0.25, 0.1, 0);
  write_scene_file();
  const Finished run = succeed({"info", scene(), "--masks", path("cutouts"), "--cameras"});
  EXPECT_THAT(run.out, HasSubstr(scene_.views[5].name));
  EXPECT_THAT(run.out, testing::Not(HasSubstr("no fault found")));
}

TEST_F(CamerasCommand, CalibrateSaysThatThereIsNoBoard) {
  const std::string file = path("calib.json");
  fail(1, {"calibrate", path("images"), "--out", file}, {"0 of 16 pictures", "--columns"});
  EXPECT_FALSE(std::filesystem::exists(file));
  fail(1, {"calibrate", path("nowhere"), "--out", file}, {"nowhere"});
  fail(2, {"calibrate", path("images"), "--board", "hex", "--out", file},
       {"--board hex", "charuco"});
}

}  // namespace
}  // namespace photohull::test
