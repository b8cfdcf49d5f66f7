#include "io/load_scene.h"

#include "io/image_file.h"
#include "io/write_scene.h"
#include "scene_fixture.h"

namespace photohull::io {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A Middlebury scene of a.png, b.png and c.png in images/.
class LoadScene : public TemporaryFolder {
 protected:
  LoadScene() {
    for (const char* name : {"images/a.png", "images/b.png", "images/c.png"}) put_image(name);
    write_middlebury(example_scene(folder_ / "images"), folder_);
  }
  std::vector<std::string> names(const std::string& views) const {
    LoadSceneOptions options;
    options.views = views;
    std::vector<std::string> result;
    for (const SourceView& view : load_scene(folder_, options).views) result.push_back(view.name);
    return result;
  }
  std::string error_with(const LoadSceneOptions& options) const {
    return error_of([&] { load_scene(folder_, options); });
  }
};

TEST_F(LoadScene, FormatIsDetectedFromFolderAndFile) {
  EXPECT_EQ(load_scene(folder_).format, SceneFormat::kMiddlebury);
  EXPECT_EQ(load_scene(folder_ / "scene_par.txt").format, SceneFormat::kMiddlebury);
  EXPECT_THAT(load_scene(folder_).warnings, IsEmpty());
  write_colmap_binary(load_scene(folder_), folder_ / "sparse");
  EXPECT_EQ(load_scene(folder_ / "sparse").format, SceneFormat::kColmapBinary);
  EXPECT_EQ(load_scene(folder_ / "sparse" / "images.bin").format, SceneFormat::kColmapBinary);
  const Scene scene = load_scene(folder_);
  EXPECT_EQ(scene.format, SceneFormat::kMiddlebury);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("also holds a colmap-binary scene")));
  LoadSceneOptions options;
  options.format = SceneFormat::kColmapBinary;
  EXPECT_EQ(load_scene(folder_, options).format, SceneFormat::kColmapBinary);
}

TEST_F(LoadScene, WhatWasLookedForIsTold) {
  fs::create_directory(folder_ / "empty");
  EXPECT_THAT(error_of([&] { load_scene(folder_ / "empty"); }),
              AllOf(HasSubstr("*_par.txt"), HasSubstr("cameras.bin"), HasSubstr("cameras.txt"),
                    HasSubstr("transforms.json")));
  LoadSceneOptions options;
  options.format = SceneFormat::kTransforms;
  EXPECT_THAT(error_with(options), HasSubstr("looked for transforms.json"));
  EXPECT_THAT(error_of([&] { load_scene(folder_ / "nowhere"); }), HasSubstr("nowhere"));
  EXPECT_THAT(error_of([&] { load_scene(folder_ / "images" / "a.png"); }), HasSubstr("a.png"));
  put("other_par.txt", "0\n");
  EXPECT_THAT(error_of([&] { load_scene(folder_); }), HasSubstr("several scenes"));
}

TEST_F(LoadScene, ABareFileNameIsInTheCurrentFolder) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  EXPECT_EQ(load_scene("scene_par.txt").views.size(), 3u);
  EXPECT_EQ(load_scene(".").views.size(), 3u);
  fs::current_path(before);
}

TEST_F(LoadScene, ViewsAreSelectedByIndexRangeNameAndPattern) {
  EXPECT_THAT(names(""), ElementsAre("a.png", "b.png", "c.png"));
  EXPECT_THAT(names("0-1"), ElementsAre("a.png", "b.png"));
  EXPECT_THAT(names("2, 0"), ElementsAre("a.png", "c.png"));
  EXPECT_THAT(names("c.png,1,1-2"), ElementsAre("b.png", "c.png"));
  EXPECT_THAT(names("[ab].*"), ElementsAre("a.png", "b.png"));
  EXPECT_THAT(names("*"), ElementsAre("a.png", "b.png", "c.png"));
}

TEST_F(LoadScene, BadSelectionsAreNamed) {
  const auto error_for = [&](const std::string& views) {
    LoadSceneOptions options;
    options.views = views;
    return error_with(options);
  };
  EXPECT_THAT(error_for("0-3"), AllOf(HasSubstr("'0-3'"), HasSubstr("0 to 2")));
  EXPECT_THAT(error_for("99999999999999999999"), HasSubstr("out of range"));
  EXPECT_THAT(error_for("2-0"), HasSubstr("backwards"));
  EXPECT_THAT(error_for("0,,1"), HasSubstr("empty item"));
  EXPECT_THAT(error_for("0,1,"), HasSubstr("empty item"));
  EXPECT_THAT(error_for("0,d.png"), HasSubstr("'d.png'"));
  EXPECT_THAT(error_for("x*"), HasSubstr("'x*'"));
  EXPECT_THAT(error_for("1"), HasSubstr("at least 2"));
}

TEST_F(LoadScene, ViewsAreHeldOut) {
  const auto rest = [&](const std::string& views, const std::string& hold_out) {
    LoadSceneOptions options;
    options.views = views;
    options.hold_out = hold_out;
    std::vector<std::string> result;
    for (const SourceView& view : load_scene(folder_, options).views) result.push_back(view.name);
    return result;
  };
  EXPECT_THAT(rest("", "1"), ElementsAre("a.png", "c.png"));
  EXPECT_THAT(rest("", "c*"), ElementsAre("a.png", "b.png"));
  EXPECT_THAT(rest("0-1", "2"), ElementsAre("a.png", "b.png"));  // an index into all views
  LoadSceneOptions options;
  options.hold_out = "3";
  EXPECT_THAT(error_with(options), HasSubstr("hold_out: '3' is out of range"));
  options.hold_out = "0-1";
  EXPECT_THAT(error_with(options), HasSubstr("1 view is left by hold_out, but at least 2"));
  options.hold_out = "*";
  EXPECT_THAT(error_with(options), HasSubstr("0 views are left by hold_out"));
}

// Leaving a view out is the mend that the error for a missing image proposes.
TEST_F(LoadScene, UnselectedImagesMayBeMissing) {
  fs::remove(folder_ / "images" / "b.png");
  EXPECT_THAT(names("a.png,2"), ElementsAre("a.png", "c.png"));
  EXPECT_THAT(error_with({}), HasSubstr("1 of 3 photographs was not found (b.png; looked in"));
}

TEST_F(LoadScene, MasksAreFoundBesideTheImagesFolder) {
  EXPECT_TRUE(load_scene(folder_).views[0].mask.empty());
  put_image("masks/a.png");
  put_image("masks/b.png.png");
  Scene scene = load_scene(folder_);
  EXPECT_EQ(scene.views[0].mask, folder_ / "masks/a.png");
  EXPECT_EQ(scene.views[1].mask, folder_ / "masks/b.png.png");
  EXPECT_TRUE(scene.views[2].mask.empty());
  EXPECT_THAT(scene.warnings, ElementsAre(AllOf(HasSubstr("1 of 3"), HasSubstr("c.png"))));
  LoadSceneOptions options;
  options.masks = MaskSource::kNone;
  scene = load_scene(folder_, options);
  EXPECT_TRUE(scene.views[0].mask.empty());
  EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(LoadScene, MasksMayBeCalledNameMask) {
  put_image("masks/a_mask.png");
  put_image("masks/b_mask.jpg");
  put_image("masks/c.png");
  Scene scene = load_scene(folder_);
  EXPECT_EQ(scene.views[0].mask, folder_ / "masks/a_mask.png");
  EXPECT_EQ(scene.views[1].mask, folder_ / "masks/b_mask.jpg");
  EXPECT_EQ(scene.views[2].mask, folder_ / "masks/c.png");
  fs::remove_all(folder_ / "masks");
  // Without such a folder beside the photographs.
  put_image("images/a_mask.png");
  put_image("images/c_mask.png");
  scene = load_scene(folder_);
  EXPECT_EQ(scene.views[0].mask, folder_ / "images/a_mask.png");
  EXPECT_EQ(scene.views[2].mask, folder_ / "images/c_mask.png");
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("no mask for 1 of 3 views (b.png)")));
}

TEST_F(LoadScene, AMaskDirectoryMayLackSome) {
  LoadSceneOptions options;
  options.masks = MaskSource::kDirectory;
  EXPECT_THAT(error_with(options), HasSubstr("masks is empty"));
  options.mask_directory = folder_ / "cut";
  EXPECT_THAT(error_with(options), HasSubstr("no such mask folder"));
  put_image("cut/b.png.png");
  const Scene scene = load_scene(folder_, options);
  EXPECT_TRUE(scene.views[0].mask.empty());
  EXPECT_EQ(scene.views[1].mask, folder_ / "cut/b.png.png");
  EXPECT_TRUE(scene.views[2].mask.empty());
  EXPECT_THAT(scene.warnings, ElementsAre(AllOf(HasSubstr("cut holds no mask for 2 of 3 views"),
                                                HasSubstr("(a.png, c.png)"))));
  options.strict = true;
  EXPECT_THAT(error_with(options),
              AllOf(HasSubstr("cut holds no mask for 2 of 3 views (a.png, c.png)"),
                    HasSubstr("strict asks"), HasSubstr("a.png.png and a.png, .jpg")));
  put_image("cut/a.png");
  put_image("cut/c.png", 8, 7);
  EXPECT_THAT(error_with(options), AllOf(HasSubstr("c.png"), HasSubstr("8 x 7")));
  put_image("cut/c.png");
  const Scene complete = load_scene(folder_, options);
  EXPECT_EQ(complete.views[2].mask, folder_ / "cut/c.png");
  EXPECT_THAT(complete.warnings, IsEmpty());
}

TEST(NameWithin, StaysInTheFolder) {
  EXPECT_EQ(name_within("left/a.png"), "left/a.png");
  EXPECT_EQ(name_within("./left/../a.png"), "a.png");
  EXPECT_EQ(name_within("../../photos/a.png"), "photos/a.png");
  EXPECT_EQ(name_within("left/../../a.png"), "a.png");
  EXPECT_EQ(name_within("/photos/a.png"), "photos/a.png");
}

TEST_F(LoadScene, AMaskDirectoryMustHoldOne) {
  LoadSceneOptions options;
  options.masks = MaskSource::kDirectory;
  options.mask_directory = folder_ / "cut";
  put_image("cut/other.png");
  EXPECT_THAT(error_with(options), AllOf(HasSubstr("cut: there is no mask for any of the 3 views"),
                                         HasSubstr("a.png.png and a.png, .jpg")));
  // The images' own folder is no mask folder, though every name is in it.
  options.mask_directory = folder_ / "images";
  EXPECT_THAT(error_with(options), HasSubstr("images: there is no mask for any"));
}

TEST_F(LoadScene, MissingMasksAreNamedUpToThree) {
  LoadSceneOptions options;
  options.masks = MaskSource::kDirectory;
  options.mask_directory = folder_ / "cut";
  put_image("cut/a.png");
  Scene scene = example_scene(folder_ / "images");
  for (const char* name : {"d.png", "e.png"}) {
    SourceView more = scene.views[2];
    more.name = name;
    more.image = folder_ / "images" / name;
    put_image(std::string("images/") + name);
    scene.views.push_back(more);
  }
  write_middlebury(scene, folder_);
  EXPECT_THAT(load_scene(folder_, options).warnings,
              ElementsAre(HasSubstr("4 of 5 views (b.png, c.png, d.png and 1 more)")));
}

TEST_F(LoadScene, AnAutomaticMaskFolderThatLacksSomeIsRefusedWhenStrict) {
  put_image("masks/a.png");
  put_image("masks/b.png");
  LoadSceneOptions options;
  options.strict = true;
  EXPECT_THAT(error_with(options),
              AllOf(HasSubstr("1 of 3 views (c.png)"), HasSubstr("strict asks")));
  put_image("masks/c.png");
  EXPECT_THAT(load_scene(folder_, options).warnings, IsEmpty());
}

TEST_F(LoadScene, BoxOptionComesFirst) {
  EXPECT_EQ(load_scene(folder_).box_source, "bbox.txt");
  LoadSceneOptions options;
  options.box = Box{{0, 0, 0}, {1, 2, 3}};
  const Scene scene = load_scene(folder_, options);
  EXPECT_EQ(scene.box_source, "box");
  EXPECT_EQ(scene.box->max, glm::dvec3(1, 2, 3));
}

TEST_F(LoadScene, SwappedCornersOfTheBoxOptionAreSortedAndTold) {
  LoadSceneOptions options;
  options.box = Box{{1, 0, 3}, {0, 2, 0}};
  Scene scene = load_scene(folder_, options);
  EXPECT_EQ(scene.box->min, glm::dvec3(0, 0, 0));
  EXPECT_EQ(scene.box->max, glm::dvec3(1, 2, 3));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("of box are swapped along x, z")));
  options.box = Box{{0, 0, 0}, {1, 2, 3}};
  EXPECT_THAT(load_scene(folder_, options).warnings, IsEmpty());
}

TEST_F(LoadScene, PhotographsElsewhereAreFoundByTheOption) {
  fs::rename(folder_ / "images", folder_ / "moved");
  EXPECT_THAT(error_with({}), AllOf(HasSubstr("not found"), HasSubstr("; images says where")));
  LoadSceneOptions options;
  options.images = folder_ / "moved";
  const Scene scene = load_scene(folder_, options);
  EXPECT_EQ(scene.views[1].image, folder_ / "moved" / "b.png");
  EXPECT_TRUE(scene.left_out.empty());
  // Nowhere else: copies of another size must not slip in.
  put_image("images/b.png");
  fs::remove(folder_ / "moved" / "b.png");
  EXPECT_THAT(error_with(options), HasSubstr("not found (b.png; looked in"));
  options.images = folder_ / "nowhere";
  EXPECT_THAT(error_with(options), AllOf(HasSubstr("nowhere"), HasSubstr("(images)")));
}

TEST_F(LoadScene, FormatsWhoseCamerasNeedPhotographsFindThemElsewhereToo) {
  for (const SceneFormat format : {SceneFormat::kRealityCapture, SceneFormat::kMatlab}) {
    const fs::path folder = folder_ / to_string(format);
    Scene square = example_scene(folder_ / "images");
    for (SourceView& view : square.views) {
      Intrinsics& k = view.camera.intrinsics;
      k.fy = k.fx, k.skew = 0;
      view.distortion = {};
    }
    write_scene(square, format, folder);
    const Scene beside = load_scene(folder);
    fs::rename(folder_ / "images", folder_ / "moved");
    LoadSceneOptions options;
    options.images = folder_ / "moved";
    EXPECT_LT(largest_shift(beside, load_scene(folder, options)), 1e-9) << to_string(format);
    fs::rename(folder_ / "moved", folder_ / "images");
  }
}

TEST_F(LoadScene, BadBoxFilesAreNamed) {
  const auto error_for = [&](const std::string& text) {
    put("bbox.txt", text);
    return error_with({});
  };
  EXPECT_THAT(error_for("0 0 0 1 1"), AllOf(HasSubstr("bbox.txt"), HasSubstr("5 numbers")));
  EXPECT_THAT(error_for("0 0 0 1 1 1 1"), HasSubstr("needs 6"));
  EXPECT_THAT(error_for("0 0 0\n1 1 x"), AllOf(HasSubstr("line 2"), HasSubstr("'x'")));
  EXPECT_THAT(error_for("0 0 0 1 1 inf"), HasSubstr("'inf'"));
  EXPECT_THAT(error_for("0 0 2 1 1 1"), HasSubstr("along z"));
  EXPECT_THAT(error_for(""), HasSubstr("0 numbers"));
}

TEST_F(LoadScene, OptionsAreUsageErrors) {
  const auto failure = [&](const LoadSceneOptions& options) -> std::optional<ErrorKind> {
    try {
      load_scene(folder_, options);
    } catch (const Error& error) {
      return error.kind();
    }
    return std::nullopt;
  };
  LoadSceneOptions options;
  options.pixel_center = 0.25;
  EXPECT_EQ(failure(options), ErrorKind::kUsage);
  options.pixel_center.reset();
  options.box = Box{{0, 0, 0}, {1, 1, 0}};
  EXPECT_EQ(failure(options), ErrorKind::kUsage);
  options.box.reset();
  options.views = "7";
  EXPECT_EQ(failure(options), ErrorKind::kUsage);
  options.views.clear();
  EXPECT_EQ(failure(options), std::nullopt);
}

// Sparse: the file occupies no disk, and must not be read.
TEST_F(LoadScene, HugeTextFilesAreRefused) {
  fs::resize_file(folder_ / "scene_par.txt", (std::uintmax_t(512) << 20) + 1);
  EXPECT_THAT(error_with({}), AllOf(HasSubstr("scene_par.txt"), HasSubstr("MiB")));
}

}  // namespace
}  // namespace photohull::io
