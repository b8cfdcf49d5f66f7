#include <cmath>
#include <nlohmann/json.hpp>

#include "io/load_scene.h"
#include "scene_fixture.h"

namespace photohull::io {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class ReadTransforms : public TemporaryFolder {
 protected:
  ReadTransforms() {
    put_image("images/a.png");
    put_image("images/b.png");
    // Camera at (0, 0, 5) looking along world -z with world y up, as OpenGL's default.
    const json pose = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 5}, {0, 0, 0, 1}};
    root_ = {{"fl_x", 100},
             {"fl_y", 110},
             {"cx", 4.5},
             {"cy", 2.5},
             {"w", 8},
             {"h", 6.0},
             {"frames",
              {{{"file_path", "images/a.png"}, {"transform_matrix", pose}},
               {{"file_path", "./images/b"}, {"transform_matrix", pose}}}}};
  }
  Scene load(const LoadSceneOptions& options = {}) const {
    return load_scene(put("transforms.json", root_.dump()), options);
  }
  std::string error() const {
    return error_of([&] { load(); });
  }
  json& frame(int i) { return root_["frames"][i]; }

  json root_;
};

// The point (1, 2, 0) lies 5 before the camera, right of and above its axis.
TEST_F(ReadTransforms, OpenGlAxesAndHalfPixelsAreConverted) {
  const Scene scene = load();
  ASSERT_EQ(scene.views.size(), 2u);
  EXPECT_EQ(scene.format, SceneFormat::kTransforms);
  EXPECT_EQ(scene.views[1].name, "b.png");
  const Camera& camera = scene.views[0].camera;
  EXPECT_EQ(camera.center(), glm::dvec3(0, 0, 5));
  EXPECT_EQ(camera.forward(), glm::dvec3(0, 0, -1));
  const glm::dvec2 pixel = camera.project({1, 2, 0}).value();
  EXPECT_DOUBLE_EQ(pixel.x, 4.0 + 100 * 1 / 5.0);
  EXPECT_DOUBLE_EQ(pixel.y, 2.0 - 110 * 2 / 5.0);
}

TEST_F(ReadTransforms, FieldOfViewGivesTheFocalLength) {
  root_.erase("fl_x");
  root_.erase("fl_y");
  root_.erase("cx");
  root_.erase("cy");
  root_.erase("w");
  root_.erase("h");
  root_["camera_angle_x"] = 2 * std::atan(0.5);
  const Intrinsics k = load().views[0].camera.intrinsics;
  EXPECT_NEAR(k.fx, 8, 1e-12);
  EXPECT_EQ(k.fy, k.fx);
  EXPECT_DOUBLE_EQ(k.cx, 3.5);
  EXPECT_DOUBLE_EQ(k.cy, 2.5);
  root_["camera_angle_y"] = 2 * std::atan(0.25);
  EXPECT_NEAR(load().views[0].camera.intrinsics.fy, 12, 1e-12);
  // The image's centre is its centre under any convention.
  LoadSceneOptions options;
  options.pixel_center = 0.0;
  EXPECT_DOUBLE_EQ(load(options).views[0].camera.intrinsics.cx, 3.5);
}

TEST_F(ReadTransforms, FramesOverrideTheWholeFile) {
  frame(1)["fl_x"] = 50;
  frame(1)["cx"] = 3.5;
  frame(0)["camera_angle_x"] = 2 * std::atan(0.5);
  frame(0)["camera_angle_y"] = nullptr;
  const Scene scene = load();
  EXPECT_EQ(scene.views[1].camera.intrinsics.fx, 50);
  EXPECT_EQ(scene.views[1].camera.intrinsics.fy, 110);
  EXPECT_EQ(scene.views[1].camera.intrinsics.cx, 3);
  EXPECT_NEAR(scene.views[0].camera.intrinsics.fx, 8, 1e-12);
}

TEST_F(ReadTransforms, DistortionIsKept) {
  frame(0).update({{"k1", 0.1}, {"k2", 0.2}, {"p1", 0.3}, {"p2", 0.4}, {"k3", 0.5}});
  frame(1).update({{"camera_model", "OPENCV_FISHEYE"}, {"k1", 0.1}, {"k4", 0.7}});
  const Scene scene = load();
  EXPECT_EQ(scene.views[0].distortion.model, DistortionModel::kBrown);
  EXPECT_THAT(scene.views[0].distortion.coefficients,
              testing::ElementsAre(0.1, 0.2, 0.3, 0.4, 0.5, 0, 0, 0));
  EXPECT_EQ(scene.views[1].distortion.model, DistortionModel::kFisheye);
  EXPECT_THAT(scene.views[1].distortion.coefficients,
              testing::ElementsAre(0.1, 0, 0, 0.7, 0, 0, 0, 0));
}

TEST_F(ReadTransforms, UnclearDistortionIsNamed) {
  frame(1)["k4"] = 0.1;
  EXPECT_EQ(load().views[1].distortion.model, DistortionModel::kPolynomial);
  frame(1)["k5"] = 0.2;
  EXPECT_EQ(load().views[1].distortion.model, DistortionModel::kBrown);
  frame(1).erase("k5");
  frame(1)["k4"] = 0;
  root_["camera_model"] = "EQUIRECTANGULAR";
  EXPECT_THAT(error(), HasSubstr("EQUIRECTANGULAR"));
}

TEST_F(ReadTransforms, AabbIsTheBoxUnlessThereIsAFile) {
  root_["aabb"] = {{-1, -2, -3}, {1, 2, 3}};
  Scene scene = load();
  EXPECT_EQ(scene.box->min, glm::dvec3(-1, -2, -3));
  EXPECT_THAT(scene.box_source, HasSubstr("aabb"));
  put("bbox.txt", "0 0 0\n1 1 1\n");
  scene = load();
  EXPECT_EQ(scene.box->max, glm::dvec3(1));
  EXPECT_EQ(scene.box_source, "bbox.txt");
}

TEST_F(ReadTransforms, BadAabbIsNamed) {
  root_["aabb"] = {{-1, -2, -3}, {1, -2, 3}};
  EXPECT_THAT(error(), AllOf(HasSubstr("aabb"), HasSubstr("along y")));
  for (const json& bad : {json(16), json::array({1, 2}), json{{0, 0, 0}, {1, 1, "x"}}}) {
    root_["aabb"] = bad;
    EXPECT_THAT(error(), HasSubstr("aabb must be"));
  }
}

TEST_F(ReadTransforms, BadPosesAreNamed) {
  const json good = frame(1)["transform_matrix"];
  const auto error_with = [&](int row, int column, const json& value) {
    frame(1)["transform_matrix"] = good;
    frame(1)["transform_matrix"][row][column] = value;
    return error();
  };
  EXPECT_THAT(error_with(0, 1, 0.1),
              AllOf(HasSubstr("frame 1: transform_matrix is not a rotation")));
  EXPECT_THAT(error_with(2, 2, -1), HasSubstr("determinant -1"));
  EXPECT_THAT(error_with(3, 0, 1), HasSubstr("last row"));
  EXPECT_THAT(error_with(0, 3, nullptr), HasSubstr("4 rows of 4"));
  EXPECT_THAT(error_with(0, 3, "1"), HasSubstr("4 rows of 4"));
  frame(1)["transform_matrix"] = {{3, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 3, 5}, {0, 0, 0, 1}};
  EXPECT_THAT(error(), AllOf(HasSubstr("frame 1"), HasSubstr("uniform scale of 3")));
  for (const json& bad : {json(1), json::array(), json{{1, 0}, {0, 1}, {0, 0}}}) {
    frame(1)["transform_matrix"] = bad;
    EXPECT_THAT(error(), HasSubstr("4 rows of 4"));
  }
  frame(1).erase("transform_matrix");
  EXPECT_THAT(error(), HasSubstr("transform_matrix is missing"));
}

TEST_F(ReadTransforms, BadFieldsAreNamed) {
  const json good = root_;
  const auto error_with = [&](const char* key, const json& value) {
    root_ = good;
    root_[key] = value;
    return error();
  };
  EXPECT_THAT(error_with("fl_x", -1), AllOf(HasSubstr("frame 0"), HasSubstr("fl_x")));
  EXPECT_THAT(error_with("fl_x", "100"), HasSubstr("fl_x must be a finite number"));
  EXPECT_THAT(error_with("w", 8.5), HasSubstr("w is 8.5"));
  EXPECT_THAT(error_with("w", -8), HasSubstr("w is -8"));
  EXPECT_THAT(error_with("w", 16), AllOf(HasSubstr("16 x 6"), HasSubstr("is 8 x 6")));
  EXPECT_THAT(error_with("camera_angle_x", 4.0), HasSubstr("camera_angle_x is 4"));
  EXPECT_THAT(error_with("camera_model", 4), HasSubstr("camera_model must be a string"));
  EXPECT_THAT(error_with("is_fisheye", 4), HasSubstr("is_fisheye must be"));
  EXPECT_THAT(error_with("frames", 4), HasSubstr("frames"));
  EXPECT_THAT(error_with("frames", json::array()), HasSubstr("at least 2"));
  EXPECT_THAT(error_with("frames", {1, 2}), HasSubstr("frame 0: must be an object"));
  root_ = good;
  root_.erase("fl_x");
  root_.erase("fl_y");
  EXPECT_THAT(error(), HasSubstr("there is no focal length"));
  root_ = good;
  frame(1).erase("file_path");
  EXPECT_THAT(error(), HasSubstr("frame 1: file_path"));
  frame(1)["file_path"] = "images/../images/a.png";
  EXPECT_THAT(error(), HasSubstr("listed twice"));
  frame(1)["file_path"] = "images/c";
  EXPECT_THAT(error(), AllOf(HasSubstr("frame 1"), HasSubstr("was not found (images/c;")));
}

TEST_F(ReadTransforms, BrokenJsonIsNamed) {
  const auto error_for = [&](const std::string& text) {
    return error_of([&] { load_scene(put("transforms.json", text)); });
  };
  EXPECT_THAT(error_for("{\"frames\": [\n NaN]}"),
              AllOf(HasSubstr("not valid JSON"), HasSubstr("line 2")));
  EXPECT_THAT(error_for("{\"frames\": [1e999]}"), HasSubstr("not valid JSON"));
  EXPECT_THAT(error_for(""), HasSubstr("the file is empty"));
  EXPECT_THAT(error_for("[]"), HasSubstr("\"frames\" is missing"));
  EXPECT_THAT(error_for(std::string(1000000, '[')), HasSubstr("levels"));
}

TEST_F(ReadTransforms, StatedMasksAreUsed) {
  put_image("cut/a.png", 8, 6, 255);
  frame(0)["mask_path"] = "cut/a.png";
  Scene scene = load();
  EXPECT_EQ(scene.views[0].mask, folder_ / "cut/a.png");
  EXPECT_FALSE(scene.views[0].mask_made);
  EXPECT_TRUE(scene.views[1].mask.empty());
  frame(0)["mask_made"] = true;
  EXPECT_TRUE(load().views[0].mask_made);
  frame(0)["mask_made"] = 1;
  EXPECT_THAT(error(), HasSubstr("mask_made must be true or false"));
  frame(0).erase("mask_made");
  frame(0)["mask_path"] = "cut/b.png";
  EXPECT_THAT(error(), AllOf(HasSubstr("frame 0: mask_path"), HasSubstr("cut/b.png")));
  LoadSceneOptions options;
  options.masks = MaskSource::kNone;
  EXPECT_TRUE(load(options).views[0].mask.empty());
}

constexpr const char* kPoints =
    "ply\nformat ascii 1.0\nelement vertex 12\nproperty float x\nproperty float y\nproperty float "
    "z\nproperty uchar red\nend_header\n";

TEST_F(ReadTransforms, SparsePointsOfNerfstudioAreReadAndGiveABox) {
  root_["ply_file_path"] = "sparse/pc.ply";
  std::string text = kPoints;
  for (int i = 0; i < 12; ++i) text += concat(i, " ", 2 * i, " ", -i, " 200\n");
  put("sparse/pc.ply", text);
  const Scene scene = load();
  ASSERT_EQ(scene.points.size(), 12u);
  EXPECT_LT(glm::length(scene.points[3] - glm::dvec3(3, 6, -3)), 1e-5);
  EXPECT_TRUE(scene.warnings.empty());
  ASSERT_TRUE(scene.box);
  EXPECT_EQ(scene.box_source, "sparse points");
  root_["aabb"] = {{0, 0, 0}, {1, 1, 1}};
  EXPECT_EQ(load().box->max, glm::dvec3(1));
}

TEST_F(ReadTransforms, ScenesDoWithoutPointsThatCannotBeRead) {
  root_["ply_file_path"] = "pc.ply";
  const auto warned = [&] {
    const Scene scene = load();
    EXPECT_TRUE(scene.points.empty());
    return scene.warnings.empty() ? "" : scene.warnings.front();
  };
  EXPECT_THAT(warned(), AllOf(HasSubstr("ply_file_path"), HasSubstr("is not there")));
  put("pc.ply", concat(kPoints, "1 2 3 200\n"));
  EXPECT_THAT(warned(), AllOf(HasSubstr("pc.ply"), HasSubstr("too short")));
  put("pc.ply", "no points\n");
  EXPECT_THAT(warned(), HasSubstr("not a PLY file"));
  root_["ply_file_path"] = 7;
  EXPECT_THAT(error(), HasSubstr("ply_file_path must be a string"));
}

}  // namespace
}  // namespace photohull::io
