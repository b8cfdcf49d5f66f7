// Photographs that are missing, damaged or of another size than their cameras are for.
#include <OpenImageIO/imageio.h>

#include <fstream>
#include <set>

#include "core/scaled_size.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "io/write_scene.h"
#include "scene_fixture.h"
#include "support/cameras.h"

namespace photohull::io {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kViews = 12, kWidth = 32, kHeight = 24;

/// A scene of 12 views, of which each is named v0.png to v11.png, written as transforms.json.
class UsableViews : public TemporaryFolder {
 protected:
  UsableViews() {
    const auto cameras = test::cameras_around({0, 0, 0}, 4, kViews, 40, kWidth, kHeight);
    scene_.box = Box{{-1, -1, -1}, {1, 1, 1}};
    for (const Camera& camera : cameras) {
      SourceView view;
      view.name = concat("v", scene_.views.size(), ".png");
      view.camera = camera;
      view.camera.intrinsics.cx += 1.25;
      view.camera.intrinsics.cy -= 0.5;
      view.distortion = {DistortionModel::kBrown, {-0.1, 0.02, 0.001, -0.002}};
      view.image = put_image("images/" + view.name, kWidth, kHeight);
      scene_.views.push_back(view);
    }
    write_transforms(scene_, folder_);
  }

  std::string image(int view) const { return concat("images/v", view, ".png"); }
  void remove(int first, int last) const {
    for (int i = first; i <= last; ++i) fs::remove(folder_ / image(i));
  }
  static LoadSceneOptions strict() {
    LoadSceneOptions options;
    options.strict = true;
    return options;
  }
  std::string error_with(const LoadSceneOptions& options = {}) const {
    return error_of([&] { load_scene(folder_, options); });
  }

  Scene scene_;
};

TEST_F(UsableViews, AllAreThere) {
  const Scene scene = load_scene(folder_, strict());
  EXPECT_EQ(scene.views.size(), 12u);
  EXPECT_EQ(scene.listed.size(), 12u);
  EXPECT_THAT(scene.left_out, IsEmpty());
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(UsableViews, AFewAreMissing) {
  remove(2, 5);
  const Scene scene = load_scene(folder_);
  ASSERT_EQ(scene.views.size(), 8u);
  EXPECT_EQ(scene.views[1].name, "v1.png");
  EXPECT_EQ(scene.views[2].name, "v6.png");
  EXPECT_EQ(scene.listed.size(), 12u);
  EXPECT_EQ(scene.listed[4], "v4.png");
  EXPECT_THAT(scene.warnings,
              ElementsAre(AllOf(HasSubstr("4 of 12 photographs were not found and are left out"),
                                HasSubstr("images/v2.png, images/v3.png, images/v4.png and 1 more"),
                                HasSubstr("looked in " + folder_.string()))));
  ASSERT_EQ(scene.left_out.size(), 4u);
  EXPECT_EQ(scene.left_out[3].reason, LeftOutView::Reason::kMissing);
  EXPECT_THAT(error_with(strict()), AllOf(HasSubstr("transforms.json frame 2"),
                                          HasSubstr("4 of 12"), HasSubstr("strict asks for all")));
  // Indices count all views that are listed; those that are not chosen do not matter.
  LoadSceneOptions options = strict();
  options.views = "0,1,6-11";
  EXPECT_THAT(load_scene(folder_, options).warnings, IsEmpty());
  options.views = "0,2,6";
  options.strict = false;
  EXPECT_THAT(error_with(options), HasSubstr("1 of 3 photographs was not found"));
}

TEST_F(UsableViews, HalfOrAllAreMissing) {
  remove(0, 5);
  EXPECT_THAT(error_with(),
              AllOf(HasSubstr("6 of 12 photographs were not found"), HasSubstr("images/v0.png"),
                    HasSubstr("and 3 more"), HasSubstr("looked in " + folder_.string()),
                    HasSubstr("two of three")));
  remove(6, 11);
  EXPECT_THAT(error_with(), HasSubstr("12 of 12 photographs were not found"));
}

TEST_F(UsableViews, TheTracksOfMissingViewsGo) {
  std::string images;
  for (int i = 0; i < 4; ++i)
    images += concat(i + 1, " 1 0 0 0 0 0 ", i, " 1 v", i, ".png\n", i + 1.5, " 2.5 7 ",
                     i < 2 ? "3.5 4.5 8" : "3.5 4.5 -1", "\n");
  put("sparse/cameras.txt", concat("1 PINHOLE ", kWidth, " ", kHeight, " 40 40 16 12\n"));
  put("sparse/images.txt", images);
  remove(1, 1);
  const Scene scene = load_scene(folder_ / "sparse");
  ASSERT_EQ(scene.views.size(), 3u);
  ASSERT_EQ(scene.tracks.size(), 1u);
  const auto& o = scene.tracks[0].observations;
  ASSERT_EQ(o.size(), 3u);
  EXPECT_EQ(o[1].view, 1);
  EXPECT_EQ(o[1].pixel, glm::dvec2(3, 2));  // in v2.png
  EXPECT_EQ(o[2].view, 2);
}

TEST_F(UsableViews, OneCannotBeRead) {
  put(image(3), "no picture at all\n");
  Scene scene = load_scene(folder_);
  EXPECT_EQ(scene.views.size(), 11u);
  EXPECT_THAT(scene.warnings, ElementsAre(AllOf(HasSubstr("1 of 12 photographs cannot be read"),
                                                HasSubstr("v3.png: cannot be read as an image"))));
  ASSERT_EQ(scene.left_out.size(), 1u);
  EXPECT_EQ(scene.left_out[0].name, "v3.png");
  EXPECT_EQ(scene.left_out[0].reason, LeftOutView::Reason::kUnreadable);
  EXPECT_THAT(error_with(strict()), HasSubstr("v3.png"));
}

TEST_F(UsableViews, OneHasAnotherShape) {
  put_image(image(3), kHeight, kWidth);
  put_image(image(4), kWidth, kHeight + 2);
  Scene scene = load_scene(folder_);
  EXPECT_EQ(scene.views.size(), 10u);
  EXPECT_EQ(scene.scaled, 0);
  EXPECT_THAT(
      scene.warnings,
      ElementsAre(AllOf(HasSubstr("2 of 12 photographs do not have their cameras' shape"),
                        HasSubstr("v3.png: it is 24 x 32, but its camera is for 32 x 24, the sides "
                                  "are swapped: a program has probably turned it by its EXIF"),
                        HasSubstr("v4.png: it is 32 x 26, but its camera is for 32 x 24)"))));
  EXPECT_EQ(scene.left_out.at(1).reason, LeftOutView::Reason::kSize);
  EXPECT_THAT(scene.warnings[0], testing::Not(HasSubstr("tag is")));
  OIIO::ImageSpec spec(kHeight, kWidth, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("Orientation", 6);
  const auto jpeg = OIIO::ImageOutput::create("turned.jpg");
  const std::vector<std::uint8_t> grey(std::size_t(kHeight * kWidth * 3), 90);
  ASSERT_TRUE(jpeg && jpeg->open((folder_ / image(3)).string(), spec) &&
              jpeg->write_image(OIIO::TypeDesc::UINT8, grey.data()) && jpeg->close());
  EXPECT_THAT(load_scene(folder_).warnings.at(0), HasSubstr("EXIF orientation tag is 6"));
  put_image(image(3), kHeight / 2, kWidth / 2);  // turned and scaled
  EXPECT_THAT(load_scene(folder_).warnings.at(0), HasSubstr("sides are swapped"));
}

/// Copies of another size give the cameras, tracks and masks of a scene that was written for them.
TEST_F(UsableViews, ScaledCopiesAreAsIfWrittenForTheirSize) {
  for (const double factor : {0.5, 2.0}) {
    const int width = int(factor * kWidth), height = int(factor * kHeight);
    for (int i = 0; i < kViews; ++i) put_image(image(i), width, height);
    const Scene scene = load_scene(folder_, strict());
    EXPECT_EQ(scene.scaled, 12);
    EXPECT_THAT(scene.warnings,
                ElementsAre(HasSubstr(concat("12 of 12 photographs are scaled copies of those that "
                                             "the cameras are for (v0.png is ",
                                             width, " x ", height))));
    Scene written = scene_;
    for (SourceView& view : written.views) {
      Intrinsics& k = view.camera.intrinsics;
      // The image's corner (-0.5, -0.5) stays where it is.
      k = {width,
           height,
           k.fx * factor,
           k.fy * factor,
           0,
           (k.cx + 0.5) * factor - 0.5,
           (k.cy + 0.5) * factor - 0.5};
    }
    write_transforms(written, folder_ / "small");
    const Scene small = load_scene(folder_ / "small");
    EXPECT_THAT(small.warnings, IsEmpty());
    EXPECT_LT(largest_shift(scene, small), 1e-9);
    for (std::size_t i = 0; i < scene.views.size(); ++i) {
      EXPECT_EQ(scene.views[i].camera.intrinsics.width, width);
      EXPECT_EQ(scene.views[i].distortion.coefficients, small.views[i].distortion.coefficients);
    }
  }
}

TEST_F(UsableViews, TracksAreScaledWithTheirPhotographs) {
  std::string images;
  for (int i = 0; i < 3; ++i)
    images += concat(i + 1, " 1 0 0 0 0 0 ", i, " 1 v", i, ".png\n9.5 7 7\n");
  put("sparse/cameras.txt", concat("1 PINHOLE ", kWidth, " ", kHeight, " 40 40 16 12\n"));
  put("sparse/images.txt", images);
  put_image(image(1), kWidth / 2, kHeight / 2);
  const Scene scene = load_scene(folder_ / "sparse");
  EXPECT_EQ(scene.scaled, 1);
  ASSERT_EQ(scene.tracks.size(), 1u);
  EXPECT_LT(glm::distance(scene.tracks[0].observations[0].pixel, {9, 6.5}), 1e-12);
  EXPECT_LT(glm::distance(scene.tracks[0].observations[1].pixel, {4.25, 3}), 1e-12);
  // From the principal point, as VisualSFM's are: no size is stated there, so none can differ.
  EXPECT_EQ(scene.views[1].camera.intrinsics.fx, 20);
  EXPECT_EQ(scene.views[1].camera.intrinsics.cx, 7.5);
}

TEST_F(UsableViews, MasksOfTheCamerasSizeServeScaledCopies) {
  for (int i = 0; i < kViews; ++i) {
    put_image(image(i), kWidth / 2, kHeight / 2);
    put_image(concat("masks/v", i, ".png"), kWidth, kHeight);
  }
  EXPECT_FALSE(load_scene(folder_).views[0].mask.empty());
  put_image("masks/v0.png", kWidth / 2, kHeight / 2);
  EXPECT_FALSE(load_scene(folder_).views[0].mask.empty());
  put_image("masks/v0.png", kWidth / 4, kHeight / 4);
  EXPECT_THAT(error_with(), HasSubstr("the mask is 8 x 6"));
}

/// A missing photograph must not be taken for another one's of the same name.
TEST_F(UsableViews, NamesAreShared) {
  Scene scene;
  for (int i = 0; i < 8; ++i) {
    SourceView view = scene_.views[std::size_t(i)];
    view.image = put_image(concat(i < 4 ? "images/left/x" : "images/right/x", i % 4, ".png"),
                           kWidth, kHeight);
    view.name = view.image.filename();
    scene.views.push_back(view);
  }
  write_transforms(scene, folder_ / "images/left");
  EXPECT_EQ(load_scene(folder_ / "images/left").views.size(), 8u);
  fs::remove(folder_ / "images/right/x2.png");
  const Scene loaded = load_scene(folder_ / "images/left");
  EXPECT_EQ(loaded.views.size(), 7u);
  EXPECT_THAT(loaded.warnings, ElementsAre(HasSubstr("1 of 8 photographs was not found")));
  std::set<fs::path> images;
  for (const SourceView& view : loaded.views) images.insert(view.image);
  EXPECT_EQ(images.size(), 7u);
  EXPECT_EQ(loaded.views[6].image.filename(), "x3.png");
}

TEST_F(UsableViews, FormatsThatReadTheImageThemselvesLeaveItOutToo) {
  for (SourceView& view : scene_.views) view.distortion = {};
  for (const SceneFormat format : {SceneFormat::kMve, SceneFormat::kRealityCapture}) {
    SCOPED_TRACE(to_string(format));
    const fs::path to = folder_ / to_string(format);
    Scene written = scene_;
    for (SourceView& view : written.views) {  // what these formats can express
      view.camera.intrinsics.fy = view.camera.intrinsics.fx;
      view.camera.intrinsics.cx = 0.5 * (kWidth - 1);
      view.camera.intrinsics.cy = 0.5 * (kHeight - 1);
    }
    write_scene(written, format, to);
    ASSERT_EQ(load_scene(to).views.size(), 12u);
    const Scene before = load_scene(to);
    fs::remove(before.views[2].image);
    fs::remove(before.views[5].image);
    std::ofstream(before.views[5].image) << "no picture";
    const Scene scene = load_scene(to);
    EXPECT_EQ(scene.views.size(), 10u);
    EXPECT_THAT(scene.warnings,
                ElementsAre(HasSubstr("1 of 12 photographs was not found"),
                            HasSubstr("1 of 12 photographs cannot be read and is left out")));
    for (int i : {2, 5}) put_image(image(i), kWidth, kHeight);
  }
}

}  // namespace
}  // namespace photohull::io
