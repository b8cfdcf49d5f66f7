// Scenes of calibrations and photographs that the same cameras took.
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "io/board_images.h"
#include "io/load_scene.h"
#include "io/read_lens.h"
#include "io/write_scene.h"
#include "scene_fixture.h"

namespace photohull::io {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

json lens_entry() {
  return {{"image_width", 8},
          {"image_height", 6},
          {"camera_matrix", {{10, 0, 3.6}, {0, 11, 2.4}, {0, 0, 1}}},
          {"model", "brown"},
          {"distortion_coefficients", {-0.1, 0.02, 0.001, 0.002, 0, 0, 0, 0}}};
}

class ReadCalibration : public TemporaryFolder {
 protected:
  Scene load(const json& calibration, const CalibratedImages& images) {
    LoadSceneOptions options;
    options.calibrated = images;
    if (options.calibrated->folder.empty()) options.calibrated->folder = folder_ / "images";
    return load_scene(put("calib.json", calibration.dump()), options);
  }

  static json rig() {
    json j = {{"photohull_calibration", "rig"}, {"cameras", json::array()}};
    for (int c = 0; c < 2; ++c) {
      json camera = lens_entry();
      camera["name"] = c == 0 ? "left" : "right";
      camera["R"] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      if (c == 1) camera["R"] = {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};
      camera["t"] = {0.5 * c, 0, 2.0 * c};
      j["cameras"].push_back(camera);
    }
    return j;
  }

  static json table() {
    json j = lens_entry();
    j["photohull_calibration"] = "turntable";
    // The axis leans towards the camera, upside down, and passes the optical axis at (0, 0, 5).
    j["turntable"] = {{"axis", {0, 0.8, 0.6}}, {"point", {0, 1.6, 6.2}}};
    j["views"] = {{{"name", "a.png"}, {"angle_degrees", 0}},
                  {{"name", "b.png"}, {"angle_degrees", 30}},
                  {{"name", "c.png"}, {"left_out", true}}};
    return j;
  }
};

TEST_F(ReadCalibration, RigsHaveAPhotographOfEachCamera) {
  put_image("images/left.png");
  put_image("images/right/0003.png");
  const Scene scene = load(rig(), {});
  ASSERT_EQ(scene.views.size(), 2u);
  EXPECT_EQ(scene.views[0].name, "left.png");
  EXPECT_EQ(scene.views[1].image, folder_ / "images/right/0003.png");
  const Camera& right = scene.views[1].camera;
  EXPECT_EQ(right.intrinsics.fy, 11);
  EXPECT_EQ(right.intrinsics.cx, 3.6);  // pixel centres are ours
  EXPECT_EQ(scene.views[1].distortion.model, DistortionModel::kBrown);
  EXPECT_EQ(scene.views[1].distortion.coefficients[2], 0.001);
  EXPECT_LT(glm::distance(right.to_camera({1, 2, 3}), {3.5, 2, 1}), 1e-12);
}

TEST_F(ReadCalibration, RigsMomentsAreChosenByName) {
  for (const char* camera : {"left", "right"})
    for (const char* moment : {"1", "2"})
      put_image(std::string("images/") + camera + "/" + moment + ".png");
  EXPECT_THAT(error_of([&] { load(rig(), {}); }),
              AllOf(HasSubstr("left holds 2 pictures"), HasSubstr("say with moment")));
  EXPECT_EQ(load(rig(), {{}, {}, {}, "2"}).views[1].image, folder_ / "images/right/2.png");
  EXPECT_THAT(error_of([&] {
                load(rig(), {{}, {}, {}, "7"});
              }),
              AllOf(HasSubstr("camera left has no picture"), HasSubstr("7.*")));
}

TEST_F(ReadCalibration, TurntablesTurnTheWorldAboutZ) {
  for (const char* name : {"p1.png", "p2.png", "p10.png"}) put_image(std::string("images/") + name);
  const Scene scene = load(table(), {{}, 90.0, {}, ""});
  ASSERT_EQ(scene.views.size(), 3u);
  EXPECT_EQ(scene.views[2].name, "p10.png");
  // z is up in the picture and the origin on the optical axis, whatever the angle.
  for (const SourceView& view : scene.views) {
    EXPECT_LT(glm::distance(view.camera.to_camera({0, 0, 0}), {0, 0, 5}), 1e-9);
    EXPECT_LT(glm::distance(view.camera.to_camera({0, 0, 1}), {0, -0.8, 4.4}), 1e-9);
  }
  // x points to the camera at angle 0, and turns by the right hand about the axis as it is stated.
  const glm::dvec3 towards = glm::normalize(glm::dvec3(0, 0.6, -0.8));
  for (int i = 0; i < 3; ++i) {
    const glm::dquat turn = glm::angleAxis(i * glm::half_pi<double>(), glm::dvec3(0, 0.8, 0.6));
    EXPECT_LT(glm::distance(scene.views[i].camera.to_camera({1, 0, 0}),
                            glm::dvec3(0, 0, 5) + turn * towards),
              1e-9)
        << i;
  }
  EXPECT_EQ(load(table(), {{}, {}, {5, 6, 7}, ""}).views.size(), 3u);
  EXPECT_THAT(error_of([&] {
                load(table(), {{}, {}, {5, 6}, ""});
              }),
              HasSubstr("2 angles are stated for the 3 pictures"));
}

TEST_F(ReadCalibration, TurntablesOwnAnglesAreThoseOfTheSameNames) {
  for (const char* name : {"a.png", "b.png", "c.png"}) put_image(std::string("images/") + name);
  const Scene scene = load(table(), {});
  ASSERT_EQ(scene.views.size(), 2u);  // the board was not found in c
  const Scene stepped = load(table(), {{}, 30.0, {}, ""});
  EXPECT_LT(glm::distance(scene.views[1].camera.center(), stepped.views[1].camera.center()), 1e-12);
  EXPECT_GT(glm::distance(scene.views[1].camera.center(), scene.views[0].camera.center()), 1);
}

TEST_F(ReadCalibration, CamerasSeeTheBoardBesideTheObject) {
  json j = lens_entry();
  j["photohull_calibration"] = "camera";
  j["views"] = json::array();
  for (const char* name : {"a.jpg", "b.jpg", "c.jpg"})
    j["views"].push_back(
        {{"name", name}, {"R", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {"t", {0, 0, name[0] - 'a'}}});
  j["views"][2].erase("R");
  for (const char* name : {"a.png", "b.png", "c.png"}) put_image(std::string("images/") + name);
  const Scene scene = load(j, {});
  ASSERT_EQ(scene.views.size(), 2u);
  EXPECT_EQ(scene.views[1].camera.cam_from_world.translation.z, 1);
  EXPECT_EQ(scene.warnings.size(), 1u);
  EXPECT_THAT(error_of([&] { load(j, {{}, 10.0, {}, ""}); }), HasSubstr("are for turntables"));
  EXPECT_THAT(error_of([&] { load(j, {{}, {}, {}, "x"}); }), HasSubstr("moment is for rigs"));
}

TEST_F(ReadCalibration, DamagedAndForeignFilesAreRefused) {
  put_image("images/left.png");
  put_image("images/right.png");
  EXPECT_THAT(error_of([&] { load_scene(put("calib.json", rig().dump())); }),
              AllOf(HasSubstr("is a calibration"), HasSubstr("images=")));
  EXPECT_THAT(error_of([&] { load({{"frames", 1}}, {}); }), HasSubstr("no file of photohull"));
  EXPECT_THAT(error_of([&] {
                load(rig(), {folder_ / "nowhere", {}, {}, ""});
              }),
              HasSubstr("nowhere"));
  const auto broken = [&](const std::function<void(json&)>& damage) {
    json j = rig();
    damage(j);
    return error_of([&] { load(j, {}); });
  };
  EXPECT_THAT(broken([](json& j) { j["cameras"][1].erase("R"); }),
              AllOf(HasSubstr("cameras[1]"), HasSubstr("R is missing")));
  EXPECT_THAT(broken([](json& j) { j["cameras"][0]["R"][0][0] = 3; }), HasSubstr("cameras[0]"));
  EXPECT_THAT(broken([](json& j) { j["cameras"][0]["model"] = "mirror"; }), HasSubstr("mirror"));
  EXPECT_THAT(broken([](json& j) { j["cameras"][0]["image_width"] = -8; }),
              HasSubstr("image_width"));
  EXPECT_THAT(broken([](json& j) { j["photohull_calibration"] = "oven"; }), HasSubstr("oven"));
  const std::string whole = rig().dump();
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    LoadSceneOptions options;
    options.calibrated = CalibratedImages{folder_ / "images", {}, {}, ""};
    EXPECT_NE(error_of([&] { load_scene(put("calib.json", whole.substr(0, length)), options); }),
              "");
  }
}

TEST_F(ReadCalibration, LensesAreReadFromCalibrations) {
  json camera = lens_entry();
  camera["photohull_calibration"] = "camera";
  const fs::path file = put("camera.json", camera.dump());
  const CameraLens lens = read_lens(file, 8, 6);
  EXPECT_EQ(lens.intrinsics.fy, 11);
  EXPECT_EQ(lens.distortion.coefficients[0], -0.1);
  // Of pictures twice as large: pixel centres scale about the corner.
  const CameraLens twice = read_lens(file, 16, 12);
  EXPECT_EQ(twice.intrinsics.fx, 20);
  EXPECT_NEAR(twice.intrinsics.cx, 2 * (3.6 + 0.5) - 0.5, 1e-12);
  EXPECT_THAT(error_of([&] { read_lens(file, 6, 8); }),
              AllOf(HasSubstr("for pictures of 8 x 6"), HasSubstr("6 x 8")));
  const fs::path rigs = put("rig.json", rig().dump());
  EXPECT_EQ(read_lens(rigs, 8, 6, "right").intrinsics.fx, 10);
  EXPECT_THAT(error_of([&] { read_lens(rigs, 8, 6, "top"); }),
              AllOf(HasSubstr("left, right"), HasSubstr("none is called top")));
  EXPECT_THAT(error_of([&] { read_lens(rigs, 8, 6); }), HasSubstr("give rig"));
  EXPECT_THAT(error_of([&] { read_lens(folder_ / "nowhere.json", 8, 6); }), HasSubstr("nowhere"));
}

TEST_F(ReadCalibration, LensesAreReadFromScenesWithoutTheirPhotographs) {
  put_image("images/a.png"), put_image("images/b.png"), put_image("images/c.png");
  Scene scene = example_scene(folder_ / "images");
  write_scene(scene, SceneFormat::kTransforms, folder_ / "several");
  EXPECT_THAT(error_of([&] { read_lens(folder_ / "several", 8, 6); }), HasSubstr("several lenses"));
  for (SourceView& view : scene.views)
    view.camera.intrinsics = scene.views[0].camera.intrinsics,
    view.distortion = scene.views[0].distortion;
  write_scene(scene, SceneFormat::kTransforms, folder_ / "one");
  fs::remove_all(folder_ / "images");
  const CameraLens lens = read_lens(folder_ / "one", 8, 6);
  EXPECT_NEAR(lens.intrinsics.fx, scene.views[0].camera.intrinsics.fx, 1e-9);
  EXPECT_NEAR(lens.intrinsics.cx, scene.views[0].camera.intrinsics.cx, 1e-9);
}

TEST_F(ReadCalibration, ACalibrationAndItsPhotographsAreAScene) {
  put_image("images/left.png");
  put_image("images/right.png");
  LoadSceneOptions options;
  options.images = folder_ / "images";
  EXPECT_EQ(load_scene(put("calib.json", rig().dump()), options).views.size(), 2u);
}

class BoardImages : public TemporaryFolder {};

TEST_F(BoardImages, RigsAreFoundByFoldersAndByPatterns) {
  for (const char* name : {"left/2.png", "left/10.png", "right/10.png", "note/x/y/z/1.png"})
    put_image(name);
  const RigImages rig = list_rig_images(folder_, "{camera}/{moment}");
  EXPECT_THAT(rig.cameras, ElementsAre("left", "right"));  // what lies too deep is not listed
  EXPECT_THAT(rig.moments, ElementsAre("2", "10"));
  EXPECT_EQ(rig.images[1][0], fs::path());
  EXPECT_EQ(rig.images[1][1], folder_ / "right/10.png");
}

TEST_F(BoardImages, PatternsOfNames) {
  for (const char* name : {"shot7_camA.png", "shot7_camB.png", "shot8_camA.png", "other.png"})
    put_image(name);
  const RigImages rig = list_rig_images(folder_, "shot{moment}_{camera}");
  EXPECT_THAT(rig.cameras, ElementsAre("camA", "camB"));
  EXPECT_THAT(rig.moments, ElementsAre("7", "8"));
  put_image("shot7_camA.jpg.png");
  for (const char* bad : {"{camera}", "{camera}{moment}", "{camera}/{moment}/{camera}", ""})
    EXPECT_THAT(error_of([&] { list_rig_images(folder_, bad); }), HasSubstr(concat("rig=", bad)))
        << bad;
  EXPECT_THAT(error_of([&] { list_rig_images(folder_, "x{camera}/{moment}"); }),
              HasSubstr("none of 5 pictures"));
  fs::copy(folder_ / "shot8_camA.png", folder_ / "shot8_camA.PNG");
  EXPECT_THAT(error_of([&] { list_rig_images(folder_, "shot{moment}_{camera}"); }),
              HasSubstr("has another picture of 8"));
}

}  // namespace
}  // namespace photohull::io
