#include "io/write_scene.h"

#include "io/load_scene.h"
#include "scene_fixture.h"

namespace photohull::io {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

using Writer = void (*)(const Scene&, const fs::path&);

class WriteScene : public TemporaryFolder {
 protected:
  WriteScene() {
    for (const char* name : {"a.png", "b.png", "c.png"}) put_image(std::string("images/") + name);
    scene_ = example_scene(folder_ / "images");
  }
  /// What comes back from a folder that the writer filled.
  Scene round_trip(Writer write, const std::string& name) const {
    write(scene_, folder_ / name);
    return load_scene(folder_ / name);
  }

  Scene scene_;
};

constexpr double kTolerance = 1e-6;  // pixels

TEST_F(WriteScene, AllFormatsReadBackToTheSameCameras) {
  for (const Writer write :
       {write_middlebury, write_colmap_text, write_colmap_binary, write_transforms}) {
    const std::string name = concat("out", write == write_middlebury, write == write_colmap_text,
                                    write == write_colmap_binary);
    const Scene back = round_trip(write, name);
    EXPECT_LT(largest_shift(scene_, back), kTolerance) << to_string(back.format);
    ASSERT_EQ(back.views.size(), 3u);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(back.views[i].name, scene_.views[i].name);
      EXPECT_TRUE(fs::equivalent(back.views[i].image, scene_.views[i].image));
      EXPECT_EQ(back.views[i].distortion.model, DistortionModel::kNone);
    }
    EXPECT_EQ(back.box->min, scene_.box->min);
    EXPECT_EQ(back.box->max, scene_.box->max);
  }
}

TEST_F(WriteScene, FormatsConvertIntoEachOther) {
  Scene scene = round_trip(write_transforms, "1");
  write_colmap_binary(scene, folder_ / "2");
  scene = load_scene(folder_ / "2");
  write_middlebury(scene, folder_ / "3");
  scene = load_scene(folder_ / "3");
  write_colmap_text(scene, folder_ / "4");
  EXPECT_LT(largest_shift(scene_, load_scene(folder_ / "4")), kTolerance);
}

TEST_F(WriteScene, SparsePointsSurviveInColmap) {
  EXPECT_EQ(round_trip(write_colmap_text, "t").points, scene_.points);
  EXPECT_EQ(round_trip(write_colmap_binary, "b").points, scene_.points);
}

TEST_F(WriteScene, MasksSurviveInTransforms) {
  scene_.views[1].mask = put_image("elsewhere/m.png");
  scene_.views[1].mask_made = true;
  const Scene back = round_trip(write_transforms, "t");
  EXPECT_TRUE(back.views[0].mask.empty());
  EXPECT_FALSE(back.views[0].mask_made);
  EXPECT_TRUE(back.views[1].mask_made);
  EXPECT_TRUE(fs::equivalent(back.views[1].mask, scene_.views[1].mask));
}

TEST_F(WriteScene, SparsePointsLieBesideTransforms) {
  ASSERT_FALSE(scene_.points.empty());
  const Scene back = round_trip(write_transforms, "t");
  EXPECT_TRUE(fs::exists(folder_ / "t/points.ply"));
  ASSERT_EQ(back.points.size(), scene_.points.size());
  for (std::size_t i = 0; i < back.points.size(); ++i)
    EXPECT_LT(glm::length(back.points[i] - scene_.points[i]), 1e-6);
  EXPECT_TRUE(back.warnings.empty());
  scene_.points.clear();
  EXPECT_TRUE(round_trip(write_transforms, "none").points.empty());
  EXPECT_FALSE(fs::exists(folder_ / "none/points.ply"));
}

TEST_F(WriteScene, SkewSurvivesInMiddleburyOnly) {
  scene_.views[1].camera.intrinsics.skew = 0.75;
  EXPECT_LT(largest_shift(scene_, round_trip(write_middlebury, "m")), kTolerance);
  for (const Writer write : {write_colmap_text, write_colmap_binary, write_transforms})
    EXPECT_THAT(error_of([&] { write(scene_, folder_ / "x"); }),
                AllOf(HasSubstr("b.png"), HasSubstr("skew of 0.75")));
}

TEST_F(WriteScene, DistortionSurvivesWhereTheFormatHasIt) {
  scene_.views[0].distortion = {DistortionModel::kBrown, {0.1, -0.2, 0.03, 0.04, 0.5}};
  scene_.views[1].distortion = {DistortionModel::kFisheye, {0.1, 0.2, -0.3, 0.4}};
  scene_.views[2].distortion = {DistortionModel::kBrown, {0.25}};
  for (const Writer write : {write_colmap_text, write_colmap_binary, write_transforms}) {
    const Scene back = round_trip(write, write == write_transforms ? "j" : "c");
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(back.views[i].distortion.model, scene_.views[i].distortion.model);
      EXPECT_EQ(back.views[i].distortion.coefficients, scene_.views[i].distortion.coefficients);
    }
  }
  EXPECT_THAT(error_of([&] { write_middlebury(scene_, folder_ / "m"); }),
              AllOf(HasSubstr("a.png"), HasSubstr("distortion")));
}

TEST_F(WriteScene, UnwritablePlacesAreNamed) {
  put("file", "");
  EXPECT_THAT(error_of([&] { write_middlebury(scene_, folder_ / "file" / "x"); }),
              HasSubstr("cannot be made"));
}

}  // namespace
}  // namespace photohull::io
