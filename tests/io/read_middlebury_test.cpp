#include "io/load_scene.h"
#include "scene_fixture.h"
#include "support/places.h"

namespace photohull::io {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kFirst = "a.png 100 2 50 0 110 40 0 0 1 1 0 0 0 1 0 0 0 1 0 0 5\n";
constexpr const char* kSecond = "b.png 100 2 50 0 110 40 0 0 1 0 -1 0 1 0 0 0 0 1 0 0 5\n";

class ReadMiddlebury : public TemporaryFolder {
 protected:
  ReadMiddlebury() {
    put_image("a.png");
    put_image("b.png");
  }
  Scene load(const std::string& text, const LoadSceneOptions& options = {}) const {
    return load_scene(put("x_par.txt", text), options);
  }
  /// The error for a file whose second line is replaced.
  std::string error_with(const std::string& line) const {
    return error_of([&] { load("2\n" + line + "\n" + kSecond); });
  }
};

// u = (100 x + 2 y) / z + 50, v = 110 y / z + 40 by hand.
TEST_F(ReadMiddlebury, ProjectsAsTheFileStates) {
  const Scene scene = load(std::string("2\n") + kFirst + kSecond);
  ASSERT_EQ(scene.views.size(), 2u);
  EXPECT_EQ(scene.format, SceneFormat::kMiddlebury);
  const Camera& camera = scene.views[0].camera;
  EXPECT_EQ(camera.intrinsics.width, 8);
  EXPECT_EQ(camera.intrinsics.height, 6);
  const glm::dvec2 first = camera.project({1, 1, 0}).value();
  EXPECT_DOUBLE_EQ(first.x, 70.4);
  EXPECT_DOUBLE_EQ(first.y, 62.0);
  // The second camera is turned about its axis: world (1, 1) is camera (-1, 1).
  const glm::dvec2 second = scene.views[1].camera.project({1, 1, 0}).value();
  EXPECT_DOUBLE_EQ(second.x, 30.4);
  EXPECT_DOUBLE_EQ(second.y, 62.0);
  EXPECT_EQ(scene.views[1].name, "b.png");
  EXPECT_EQ(scene.views[1].distortion.model, DistortionModel::kNone);
  EXPECT_FALSE(scene.box.has_value());
}

TEST_F(ReadMiddlebury, ScaledKIsNormalised) {
  const Scene scene =
      load(std::string("2\n") + kFirst + "b.png 200 4 100 0 220 80 0 0 2 1 0 0 0 1 0 0 0 1 0 0 5");
  EXPECT_EQ(scene.views[0].camera.intrinsics.fx, scene.views[1].camera.intrinsics.fx);
  EXPECT_EQ(scene.views[0].camera.intrinsics.cx, scene.views[1].camera.intrinsics.cx);
}

TEST_F(ReadMiddlebury, WindowsLinesMarkBlanksAndPlusSignsAreAccepted) {
  put_image("my image.png");
  const Scene scene = load(std::string("\xef\xbb\xbf") + "2\r\n\r\n" +
                           "my image.png +100 2 50 0 110 40 0 0 1 1 0 0 0 1 0 0 0 1 0 0 5\r\n" +
                           kSecond + "\r\n\r\n");
  EXPECT_EQ(scene.views[0].name, "my image.png");
}

TEST_F(ReadMiddlebury, PixelCenterOverrideMovesThePrincipalPoint) {
  LoadSceneOptions options;
  options.pixel_center = 0.5;
  const Scene scene = load(std::string("2\n") + kFirst + kSecond, options);
  EXPECT_DOUBLE_EQ(scene.views[0].camera.intrinsics.cx, 49.5);
  EXPECT_DOUBLE_EQ(scene.views[0].camera.intrinsics.cy, 39.5);
}

TEST_F(ReadMiddlebury, SlightlyRoundedRotationsAreCleaned) {
  const Scene scene = load(std::string("2\n") + kSecond +
                           "a.png 100 0 50 0 110 40 0 0 1 0.8 -0.6001 0 0.6 0.8 0 0 0 1 0 0 5\n");
  const glm::dmat3 r = scene.views[1].camera.cam_from_world.rotation;
  const glm::dmat3 gram = glm::transpose(r) * r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(gram[i][j], i == j, 1e-15);
  EXPECT_NEAR(r[1][0], -0.6, 1e-4);
}

TEST_F(ReadMiddlebury, BadRotationsAreNamed) {
  const std::string k = "a.png 100 0 50 0 110 40 0 0 1 ";
  EXPECT_THAT(error_with(k + "1 0 0 0 1 0 0 0 -1 0 0 5"),
              AllOf(HasSubstr("x_par.txt line 2"), HasSubstr("R "), HasSubstr("determinant -1")));
  EXPECT_THAT(error_with(k + "2 0 0 0 2 0 0 0 2 0 0 5"), HasSubstr("uniform scale of 2"));
  EXPECT_THAT(error_with(k + "1 0 0 0 1 0.1 0 0 1 0 0 5"), HasSubstr("is not a rotation"));
  EXPECT_THAT(error_with(k + "0 0 0 0 0 0 0 0 0 0 0 5"), HasSubstr("is not a rotation"));
  EXPECT_THAT(error_with(k + "1e300 0 0 0 1e300 0 0 0 1e300 0 0 5"),
              HasSubstr("is not a rotation"));
}

TEST_F(ReadMiddlebury, BadIntrinsicsAreNamed) {
  const std::string pose = " 1 0 0 0 1 0 0 0 1 0 0 5";
  EXPECT_THAT(error_with("a.png 0 0 50 0 110 40 0 0 1" + pose),
              AllOf(HasSubstr("line 2"), HasSubstr("K is singular")));
  EXPECT_THAT(error_with("a.png 100 0 50 0 110 40 0 0 0" + pose), HasSubstr("K is singular"));
  EXPECT_THAT(error_with("a.png -100 0 50 0 110 40 0 0 1" + pose),
              HasSubstr("focal length is -100"));
  EXPECT_THAT(error_with("a.png 100 0 50 3 110 40 0 0 1" + pose), HasSubstr("upper triangular"));
  EXPECT_THAT(error_with("a.png 100 0 nan 0 110 40 0 0 1" + pose),
              AllOf(HasSubstr("line 2"), HasSubstr("k13"), HasSubstr("'nan'")));
  EXPECT_THAT(error_with("a.png 100 0 1e999 0 110 40 0 0 1" + pose), HasSubstr("k13"));
  EXPECT_THAT(error_with("a.png 100 0 5o 0 110 40 0 0 1" + pose), HasSubstr("'5o'"));
  EXPECT_THAT(error_with("a.png 100 0 50 0 110 40 0 0 1 1 0 0 0 1 0 0 0 1 0 0 inf"),
              AllOf(HasSubstr("t3"), HasSubstr("'inf'")));
}

TEST_F(ReadMiddlebury, WrongCountsAreNamed) {
  EXPECT_THAT(error_of([&] { load(std::string("3\n") + kFirst + kSecond); }),
              AllOf(HasSubstr("x_par.txt"), HasSubstr("states 3 images but lists 2")));
  EXPECT_THAT(error_of([&] { load(std::string("1\n") + kFirst + kSecond); }),
              AllOf(HasSubstr("line 3"), HasSubstr("states 1")));
  EXPECT_THAT(error_of([&] { load(std::string("many\n") + kFirst); }), HasSubstr("'many'"));
  EXPECT_THAT(error_of([&] { load("99999999999999\n"); }), HasSubstr("lists 0"));
  EXPECT_THAT(error_of([&] { load(""); }), HasSubstr("empty"));
  EXPECT_THAT(error_with("a.png 100 0 50 0 110 40 0 0 1"), HasSubstr("10 fields found"));
  EXPECT_THAT(error_with("a.png 1 " + std::string(kFirst + 6)), HasSubstr("23 fields found"));
}

TEST_F(ReadMiddlebury, OneViewIsTooFew) {
  EXPECT_THAT(error_of([&] { load(std::string("1\n") + kFirst); }), HasSubstr("at least 2"));
  EXPECT_THAT(error_of([&] { load("0\n"); }), HasSubstr("at least 2"));
}

TEST_F(ReadMiddlebury, DuplicateAndMissingImagesAreNamed) {
  EXPECT_THAT(error_of([&] { load(std::string("2\n") + kFirst + kFirst); }),
              AllOf(HasSubstr("line 3"), HasSubstr("a.png is listed twice"), HasSubstr("line 2")));
  EXPECT_THAT(error_with("c.png 100 2 50 0 110 40 0 0 1 1 0 0 0 1 0 0 0 1 0 0 5"),
              AllOf(HasSubstr("line 2"), HasSubstr("photographs was not found (c.png"),
                    HasSubstr((folder_ / "images").string())));
}

TEST_F(ReadMiddlebury, ReadmeBoxIsFoundAmongOtherNumbers) {
  put("README.txt",
      "set -- 2 views (3 4 5)\nimages are 640 480\n\n"
      "(1 2 3)\n"
      "A bounding box for nothing in particular\n"
      "The (tight) bounding box for the x model is\n\n"
      "(-0.5 -1e-2 0)\r\n(0.5 1 2.25)\n(7 7 7)\n"
      "Created 2006 by 5 people\n");
  const Scene scene = load(std::string("2\n") + kFirst + kSecond);
  ASSERT_TRUE(scene.box.has_value());
  EXPECT_EQ(scene.box->min, glm::dvec3(-0.5, -0.01, 0));
  EXPECT_EQ(scene.box->max, glm::dvec3(0.5, 1, 2.25));
  EXPECT_EQ(scene.box_source, "README.txt");
}

TEST_F(ReadMiddlebury, InvertedReadmeBoxIsNamed) {
  put("README.txt", "bounding box\n(0 0 0)\n(1 -1 1)\n");
  EXPECT_THAT(error_of([&] { load(std::string("2\n") + kFirst + kSecond); }),
              AllOf(HasSubstr("README.txt"), HasSubstr("along y")));
}

TEST_F(ReadMiddlebury, ImagesWithoutUsableSilhouettesAreReported) {
  put("x_good_silhouette_images.txt", "a.png\n");
  const Scene scene = load(std::string("2\n") + kFirst + kSecond);
  EXPECT_THAT(scene.warnings,
              ElementsAre(AllOf(HasSubstr("x_good_silhouette_images.txt"), HasSubstr("b.png"))));
  EXPECT_TRUE(scene.views[0].silhouette);
  EXPECT_FALSE(scene.views[1].silhouette);
  put("x_good_silhouette_images.txt", "a.png\nb.png\n");
  EXPECT_THAT(load(std::string("2\n") + kFirst + kSecond).warnings, ElementsAre());
}

// The real thing: every camera must see the box that the README states, most of it on its image.
TEST(MiddleburyDataset, TempleCamerasSeeTheirBox) {
  const std::filesystem::path folder = test::in_checkout("datasets/templeSparseRing");
  const Scene scene = load_scene(folder);
  ASSERT_EQ(scene.views.size(), 16u);
  EXPECT_EQ(scene.box_source, "README.txt");
  ASSERT_TRUE(scene.box.has_value());
  for (const SourceView& view : scene.views) {
    EXPECT_EQ(view.camera.intrinsics.width, 640);
    EXPECT_EQ(view.camera.intrinsics.height, 480);
    const auto pixel = view.camera.project(scene.box->center());
    ASSERT_TRUE(pixel.has_value());
    EXPECT_LT(glm::distance(*pixel, glm::dvec2(320, 240)), 100.0) << view.name;
  }
}

}  // namespace
}  // namespace photohull::io
