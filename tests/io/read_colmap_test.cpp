#include <cmath>

#include "io/load_scene.h"
#include "scene_fixture.h"

namespace photohull::io {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kImages =
    "# comment\n"
    "1 1 0 0 0 0 0 5 1 a.png\n"
    "4.5 3 -1 2 2 7\n"
    "2 0.70710678118654757 0 0 0.70710678118654757 0 0 5 1 b.png\n"
    "\n";

class ReadColmap : public TemporaryFolder {
 protected:
  ReadColmap() {
    put_image("images/a.png");
    put_image("images/b.png");
    put("sparse/0/images.txt", kImages);
    put("sparse/0/cameras.txt", "1 PINHOLE 8 6 100 110 4.5 2.5\n");
  }
  Scene load() const { return load_scene(folder_); }
  Scene load_with_camera(const std::string& line) const {
    put("sparse/0/cameras.txt", "# list\n" + line + "\n");
    return load();
  }
  std::string error_with_camera(const std::string& line) const {
    return error_of([&] { load_with_camera(line); });
  }
  std::string error_with_image(const std::string& text) const {
    put("sparse/0/images.txt", text);
    return error_of([&] { load(); });
  }
};

TEST_F(ReadColmap, QuaternionsAndHalfPixelsAreConverted) {
  const Scene scene = load();
  EXPECT_EQ(scene.format, SceneFormat::kColmapText);
  ASSERT_EQ(scene.views.size(), 2u);
  const glm::dvec2 first = scene.views[0].camera.project({1, 2, 0}).value();
  EXPECT_DOUBLE_EQ(first.x, 4.0 + 100 / 5.0);
  EXPECT_DOUBLE_EQ(first.y, 2.0 + 220 / 5.0);
  // A quarter turn about z takes world x to camera y.
  const glm::dvec2 second = scene.views[1].camera.project({1, 0, 0}).value();
  EXPECT_NEAR(second.x, 4.0, 1e-12);
  EXPECT_NEAR(second.y, 2.0 + 110 / 5.0, 1e-12);
  EXPECT_FALSE(scene.box.has_value());
}

TEST_F(ReadColmap, EveryLensModelMapsToItsDistortion) {
  const auto coefficients = [&](const std::string& line, DistortionModel expected) {
    const Scene scene = load_with_camera(line);
    const SourceView& view = scene.views[0];
    EXPECT_EQ(view.distortion.model, expected) << line;
    EXPECT_EQ(view.camera.intrinsics.fx, 100) << line;
    EXPECT_EQ(view.camera.intrinsics.cx, 4) << line;
    EXPECT_EQ(view.camera.intrinsics.cy, 2) << line;
    return view.distortion.coefficients;
  };
  const auto none = DistortionModel::kNone, brown = DistortionModel::kBrown,
             fisheye = DistortionModel::kFisheye;
  coefficients("1 SIMPLE_PINHOLE 8 6 100 4.5 2.5", none);
  coefficients("1 PINHOLE 8 6 100 110 4.5 2.5", none);
  coefficients("1 SIMPLE_RADIAL 8 6 100 4.5 2.5 0", none);
  EXPECT_THAT(coefficients("1 SIMPLE_RADIAL 8 6 100 4.5 2.5 .1", brown),
              ElementsAre(.1, 0, 0, 0, 0, 0, 0, 0));
  EXPECT_THAT(coefficients("1 RADIAL 8 6 100 4.5 2.5 .1 .2", brown),
              ElementsAre(.1, .2, 0, 0, 0, 0, 0, 0));
  EXPECT_THAT(coefficients("1 OPENCV 8 6 100 110 4.5 2.5 .1 .2 .3 .4", brown),
              ElementsAre(.1, .2, .3, .4, 0, 0, 0, 0));
  EXPECT_THAT(coefficients("1 FULL_OPENCV 8 6 100 110 4.5 2.5 .1 .2 .3 .4 .5 .6 .7 .8", brown),
              ElementsAre(.1, .2, .3, .4, .5, .6, .7, .8));
  EXPECT_THAT(coefficients("1 OPENCV_FISHEYE 8 6 100 110 4.5 2.5 .1 .2 .3 .4", fisheye),
              ElementsAre(.1, .2, .3, .4, 0, 0, 0, 0));
  EXPECT_THAT(coefficients("1 SIMPLE_RADIAL_FISHEYE 8 6 100 4.5 2.5 0", fisheye),
              ElementsAre(0, 0, 0, 0, 0, 0, 0, 0));
  EXPECT_THAT(coefficients("1 RADIAL_FISHEYE 8 6 100 4.5 2.5 .1 .2", fisheye),
              ElementsAre(.1, .2, 0, 0, 0, 0, 0, 0));
}

TEST_F(ReadColmap, BadCamerasAreNamed) {
  EXPECT_THAT(error_with_camera("1 FOV 8 6 100 110 4.5 2.5 0.9"),
              AllOf(HasSubstr("cameras.txt line 2"), HasSubstr("FOV"), HasSubstr("PINHOLE")));
  EXPECT_THAT(error_with_camera("1 PINHOLE 8 6 100 110 4.5"),
              AllOf(HasSubstr("3 parameters"), HasSubstr("PINHOLE has 4")));
  EXPECT_THAT(error_with_camera("1 PINHOLE 8 6 100 0 4.5 2.5"), HasSubstr("focal length is 0"));
  EXPECT_THAT(error_with_camera("1 PINHOLE 8 6 nan 100 4.5 2.5"), HasSubstr("'nan'"));
  EXPECT_THAT(error_with_camera("1 PINHOLE -8 6 100 100 4.5 2.5"), HasSubstr("impossible"));
  EXPECT_THAT(error_with_camera("1 PINHOLE 16 6 100 100 4.5 2.5"), HasSubstr("16 x 6"));
  EXPECT_THAT(error_with_camera("-1 PINHOLE 8 6 100 100 4.5 2.5"), HasSubstr("CAMERA_ID is -1"));
  EXPECT_THAT(error_with_camera("3 PINHOLE 8 6 100 100 4.5 2.5"),
              AllOf(HasSubstr("images.txt line 2"), HasSubstr("camera 1")));
  EXPECT_THAT(error_with_camera("1 PINHOLE 8 6 9 9 4 2\n1 PINHOLE 8 6 9 9 4 2"),
              HasSubstr("listed twice"));
  EXPECT_THAT(error_with_camera("1 PINHOLE"), HasSubstr("2 fields"));
}

TEST_F(ReadColmap, BadImagesAreNamed) {
  EXPECT_THAT(error_with_image("1 1 0 0 0 0 0 5 1\n"),
              AllOf(HasSubstr("images.txt line 1"), HasSubstr("NAME")));
  EXPECT_THAT(error_with_image("1 0 0 0 0 0 0 5 1 a.png\n\n"), HasSubstr("length 0"));
  EXPECT_THAT(error_with_image("1 1 0 x 0 0 0 5 1 a.png\n\n"), HasSubstr("QY is 'x'"));
  EXPECT_THAT(error_with_image("1 1 0 0 0 0 0 inf 1 a.png\n\n"), HasSubstr("TZ is 'inf'"));
  EXPECT_THAT(error_with_image("1 1 0 0 0 0 0 5 1 a.png\n\n2 1 0 0 0 0 0 5 1 a.png\n\n"),
              AllOf(HasSubstr("line 3"), HasSubstr("listed twice")));
  EXPECT_THAT(error_with_image("1 1 0 0 0 0 0 5 1 c.png\n\n2 1 0 0 0 0 0 5 1 a.png\n\n"),
              AllOf(HasSubstr("1 of 2 photographs was not found (c.png"),
                    HasSubstr((folder_ / "images").string())));
}

// Every other image would be lost in silence.
TEST_F(ReadColmap, MissingLinesOfPointsAreNamed) {
  EXPECT_THAT(error_with_image("1 1 0 0 0 0 0 5 1 a.png\n2 1 0 0 0 0 0 5 1 b.png\n"),
              AllOf(HasSubstr("images.txt line 2"), HasSubstr("empty line")));
}

TEST_F(ReadColmap, NamesInSubfoldersStayUnique) {
  put_image("images/left/x.png");
  put_image("images/right/x.png");
  put("sparse/0/images.txt", "1 1 0 0 0 0 0 5 1 left/x.png\n\n2 1 0 0 0 0 0 5 1 right/x.png\n\n");
  put_image("masks/left/x.png.png");
  put_image("masks/right/x.png");
  const Scene scene = load();
  EXPECT_EQ(scene.views[0].name, "left/x.png");
  EXPECT_EQ(scene.views[1].name, "right/x.png");
  EXPECT_EQ(scene.views[0].mask.filename(), "x.png.png");
  EXPECT_EQ(scene.views[1].mask, (folder_ / "masks/right/x.png"));
}

// A few stray points must not blow the box up.
TEST_F(ReadColmap, BoxLeavesOutStrayPoints) {
  std::string points = "# POINT3D_ID X Y Z R G B ERROR TRACK[]\n";
  for (int i = 0; i <= 100; ++i) points += concat(i, " ", i, " ", -2 * i, " 3 9 9 9 0.5 1 0 2 0\n");
  points += "101 1e6 -1e7 1e8 0 0 0 0\n";
  put("sparse/0/points3D.txt", points);
  const Scene scene = load();
  EXPECT_EQ(scene.points.size(), 102u);
  ASSERT_TRUE(scene.box.has_value());
  EXPECT_EQ(scene.box_source, "sparse points");
  EXPECT_DOUBLE_EQ(scene.box->min.x, 2 - 9.7);  // 2 to 99, grown by a tenth of 97
  EXPECT_DOUBLE_EQ(scene.box->max.x, 99 + 9.7);
  EXPECT_LT(scene.box->min.y, -198);
  EXPECT_LT(scene.box->min.z, 3);  // flat, but the box is not
  EXPECT_GT(scene.box->max.z, 3);
  put("sparse/0/points3D.txt", "1 0 nan 0 0 0 0 0\n");
  EXPECT_THAT(error_of([&] { load(); }),
              AllOf(HasSubstr("points3D.txt line 1"), HasSubstr("'nan'")));
}

TEST_F(ReadColmap, ASecondModelIsReported) {
  put("sparse/1/cameras.txt", "");
  EXPECT_THAT(load().warnings, ElementsAre(HasSubstr("separate COLMAP model")));
}

}  // namespace
}  // namespace photohull::io
