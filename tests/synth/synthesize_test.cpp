#include "synth/synthesize.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <map>
#include <set>

#include "core/error.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "io/mesh/write_mesh.h"
#include "support/scratch_folder.h"
#include "synth/degrade_cameras.h"
#include "synth/place_cameras.h"

namespace photohull::synth {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

Spec small(const std::string& text) {
  Spec spec = parse_spec(text, "test", "");
  spec.image = {96, 72, 2};
  spec.truth_samples = 500;
  return spec;
}

constexpr const char* kBlock = R"({"geometry": {"shape": "block"},
    "cameras": {"layout": "arc", "count": 3, "arc": 60, "roll": 10}})";

/// Every file of a folder with its bytes.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      all[fs::relative(entry.path(), folder).string()] = read_text(entry.path());
  return all;
}

std::string failure_of(const Spec& spec, const fs::path& folder) {
  try {
    Progress silent;
    synthesize(spec, folder, silent);
  } catch (const Error& e) {
    return e.what();
  }
  return "succeeded";
}

void make(const Spec& spec, const fs::path& folder) {
  Progress silent;
  synthesize(spec, folder, silent);
}

void expect_cameras(const Scene& scene, const std::vector<LensCamera>& exact) {
  ASSERT_EQ(scene.views.size(), exact.size());
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const Camera &a = scene.views[i].camera, &b = exact[i].camera;
    EXPECT_NEAR(a.intrinsics.fx, b.intrinsics.fx, 1e-9);
    EXPECT_NEAR(a.intrinsics.cx, b.intrinsics.cx, 1e-9);
    EXPECT_NEAR(a.intrinsics.cy, b.intrinsics.cy, 1e-9);
    EXPECT_LT(length(a.center() - b.center()), 1e-9);
    for (int k = 0; k < 3; ++k)
      EXPECT_LT(length(a.cam_from_world.rotation[k] - b.cam_from_world.rotation[k]), 1e-9);
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(scene.views[i].distortion.coefficients[k], exact[i].distortion.coefficients[k],
                  1e-12);
    EXPECT_FALSE(scene.views[i].mask.empty());
    EXPECT_TRUE(fs::exists(scene.views[i].image));
  }
}

TEST(Synthesize, EveryFormatLoadsToTheSameCameras) {
  const ScratchFolder scratch;
  const Spec spec = small(kBlock);
  make(spec, scratch / "scene");
  const auto exact = place_cameras(spec, make_surface(spec.geometry));
  const Scene scene = io::load_scene(scratch / "scene");
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
  expect_cameras(scene, exact);
  ASSERT_TRUE(scene.box);
  EXPECT_LT(scene.box->min.x, -1);
  EXPECT_GT(scene.box->min.x, -1.1);
  for (const char* format : {"middlebury", "colmap_text", "colmap_binary"}) {
    SCOPED_TRACE(format);
    const Scene other = io::load_scene(scratch / "scene" / format);
    expect_cameras(other, exact);
    EXPECT_TRUE(other.box);
  }
}

TEST(Synthesize, LensDistortionIsWrittenWhereTheFormatCan) {
  const ScratchFolder scratch;
  Spec spec = small(kBlock);
  make(spec, scratch / "scene");
  EXPECT_TRUE(fs::exists(scratch / "scene" / "middlebury" / "scene_par.txt"));
  spec.degradations.k1 = -0.1, spec.degradations.p2 = 0.002;
  make(spec, scratch / "scene");
  const auto exact = place_cameras(spec, make_surface(spec.geometry));
  expect_cameras(io::load_scene(scratch / "scene"), exact);
  expect_cameras(io::load_scene(scratch / "scene" / "colmap_text"), exact);
  expect_cameras(io::load_scene(scratch / "scene" / "colmap_binary"), exact);
  EXPECT_FALSE(fs::exists(scratch / "scene" / "middlebury" / "scene_par.txt"));
}

TEST(Synthesize, BytesDependOnSpecAndSeedOnly) {
  const ScratchFolder scratch;
  Spec spec = small(R"({"geometry": {"shape": "leaves"}, "background": {"type": "clutter"},
      "cameras": {"layout": "arc", "count": 3},
      "degradations": {"read_noise": 0.01, "jpeg": 80, "exposure": 0.2, "pose_error": 1,
                       "mask_holes": 2}})");
  make(spec, scratch / "a");
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    make(spec, scratch / "b");
  }
  const auto a = contents(scratch / "a"), b = contents(scratch / "b");
  EXPECT_EQ(a.size(), b.size());
  for (const auto& [name, bytes] : a) EXPECT_TRUE(b.at(name) == bytes) << name;
  spec.seed = 2;
  make(spec, scratch / "c");
  EXPECT_TRUE(contents(scratch / "c").at("images/0001.png") != a.at("images/0001.png"));
}

TEST(Synthesize, MaskIsTheCoverageAndTruthTheMesh) {
  const ScratchFolder scratch;
  make(small(kBlock), scratch / "scene");
  const Mask mask = io::read_mask(scratch / "scene" / "masks" / "0001.png");
  const ColourImage image = io::read_image(scratch / "scene" / "images" / "0001.png");
  for (int y = 0; y < 72; ++y)
    for (int x = 0; x < 96; ++x)
      if (mask.coverage[std::size_t(y) * 96 + x] == 0) {
        ASSERT_EQ(image.linear(x, y).g, 0);  // black behind the object
      }
  EXPECT_EQ(read_ply(scratch / "scene" / "gt.ply").triangles.size(), 1052u);
  const std::string visible = read_text(scratch / "scene" / "gt_visible.ply");
  EXPECT_THAT(visible, HasSubstr("element vertex 500\n"));
  EXPECT_THAT(visible, HasSubstr("property ushort views\n"));
  const auto data = visible.find("end_header\n") + 11;
  EXPECT_EQ(visible.size() - data, 500u * (24 + 12 + 2));
}

TEST(Synthesize, SpecOfTheResultMakesItAgain) {
  const ScratchFolder scratch;
  make(small(kBlock), scratch / "a");
  make(read_spec(scratch / "a" / "spec.json"), scratch / "b");
  EXPECT_TRUE(contents(scratch / "a") == contents(scratch / "b"));
}

TEST(Synthesize, MissingViewsAndWrongMasks) {
  const ScratchFolder scratch;
  Spec spec = small(R"({"geometry": {"shape": "steps"},
      "cameras": {"layout": "arc", "count": 8, "arc": 360},
      "degradations": {"missing_views": [2], "missing": 0.25, "mask_wrong": [0]}})");
  make(spec, scratch / "scene");
  const Scene scene = io::load_scene(scratch / "scene");
  EXPECT_LE(scene.views.size(), 6u);
  EXPECT_GE(scene.views.size(), 5u);
  EXPECT_FALSE(fs::exists(scratch / "scene" / "images" / "0002.png"));
  // View 0 is kept with this seed, and has the mask of the next one kept.
  ASSERT_EQ(scene.views[0].name, "0000.png");
  EXPECT_EQ(read_text(scene.views[0].mask), read_text(scene.views[1].mask));
  EXPECT_NE(read_text(scene.views[1].mask), read_text(scene.views[2].mask));
  spec.degradations.missing_views = {0, 1, 2, 3, 4, 5, 6, 7};
  EXPECT_THAT(failure_of(spec, scratch / "none"), HasSubstr("all views are missing"));
}

TEST(Synthesize, WarnsOfWrongMasksForMissingViews) {
  const ScratchFolder scratch;
  struct Listening : Progress {
    void warn(const std::string& message) override { heard += message; }
    std::string heard;
  } listening;
  Spec spec = small(kBlock);
  spec.degradations.mask_wrong = {0, 1};
  spec.degradations.missing_views = {1};
  synthesize(spec, scratch / "scene", listening);
  EXPECT_THAT(listening.heard, HasSubstr("mask_wrong: view 1"));
  EXPECT_EQ(listening.heard.find("view 0"), std::string::npos);
}

TEST(Synthesize, WrittenPosesAreOffAndTheTrueOnesKept) {
  const ScratchFolder scratch;
  Spec spec = small(kBlock);
  spec.degradations.pose_error = 2;
  make(spec, scratch / "scene");
  const auto exact = place_cameras(spec, make_surface(spec.geometry));
  expect_cameras(io::load_scene(scratch / "scene" / "true_cameras"), exact);
  const Scene off = io::load_scene(scratch / "scene");
  EXPECT_GT(length(off.views[0].camera.center() - exact[0].camera.center()), 1e-4);
}

TEST(Synthesize, ShiftedViewsAreWrittenInEveryFormat) {
  const ScratchFolder scratch;
  Spec spec = small(kBlock);
  spec.degradations.view_shift = 1.5;
  spec.degradations.view_shift_views = 0.3;
  make(spec, scratch / "scene");
  const auto exact = place_cameras(spec, make_surface(spec.geometry));
  expect_cameras(io::load_scene(scratch / "scene" / "true_cameras"), exact);
  for (const char* format : {"", "middlebury", "colmap_text", "colmap_binary"}) {
    const Scene scene = io::load_scene(scratch / "scene" / format);
    int shifted = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const Intrinsics &a = scene.views[i].camera.intrinsics, &b = exact[i].camera.intrinsics;
      const double shift = std::hypot(a.cx - b.cx, a.cy - b.cy);
      if (shift < 1e-9) continue;
      ++shifted;
      EXPECT_NEAR(shift, 1.5, 1e-9) << format;
    }
    EXPECT_EQ(shifted, 1) << format;
  }
}

TEST(Synthesize, MasksHaveTheStyleAskedFor) {
  const ScratchFolder scratch;
  Spec spec = small(kBlock);
  std::map<std::string, Mask> masks;
  for (const char* style : {"coverage", "aliased", "cut", "eroded"}) {
    spec.degradations.mask_style = style;
    make(spec, scratch / "scene");
    masks[style] = io::read_mask(scratch / "scene" / "masks" / "0001.png");
  }
  int soft = 0, centres = 0, eaten = 0;
  for (std::size_t i = 0; i < 96 * 72; ++i) {
    const std::uint8_t share = masks["coverage"].coverage[i];
    const std::uint8_t aliased = masks["aliased"].coverage[i], cut = masks["cut"].coverage[i];
    soft += share > 0 && share < 255;
    ASSERT_TRUE(aliased == 0 || aliased == 255);
    ASSERT_EQ(cut, share >= 128 ? 255 : 0);
    ASSERT_LE(masks["eroded"].coverage[i], cut);
    centres += aliased != cut;
    eaten += masks["eroded"].coverage[i] != cut;
  }
  EXPECT_GT(soft, 50);
  EXPECT_GT(centres, 0);  // a pixel's centre and its area may tell otherwise
  EXPECT_LT(centres, soft);
  EXPECT_GT(eaten, 50);
}

TEST(Synthesize, ShuffledViewsAreTheSameInAnotherOrder) {
  const ScratchFolder folder;
  Spec spec = small(kBlock);
  make(spec, folder / "a");
  spec.degradations.shuffle = 2;
  make(spec, folder / "b");
  EXPECT_EQ(contents(folder / "a/images"), contents(folder / "b/images"));
  const Scene x = io::load_scene(folder / "a"), y = io::load_scene(folder / "b");
  std::map<std::string, glm::dvec3> centers;
  std::vector<std::string> first, second;
  for (const SourceView& view : x.views) {
    centers[view.name] = view.camera.center();
    first.push_back(view.name);
  }
  for (const SourceView& view : y.views) {
    EXPECT_LT(length(view.camera.center() - centers.at(view.name)), 1e-9) << view.name;
    second.push_back(view.name);
  }
  EXPECT_NE(first, second);
  EXPECT_TRUE(std::is_permutation(first.begin(), first.end(), second.begin(), second.end()));
}

TEST(Synthesize, WrittenBoxIsScaledAndShifted) {
  const ScratchFolder folder;
  Spec spec = small(kBlock);
  make(spec, folder / "a");
  spec.degradations.box_scale = 3;
  spec.degradations.box_shift = {0.5, 0, 0};
  make(spec, folder / "b");
  const Box a = *io::load_scene(folder / "a").box, b = *io::load_scene(folder / "b").box;
  const glm::dvec3 before = a.max - a.min, after = b.max - b.min, moved = b.center() - a.center();
  EXPECT_LT(length(after - 3.0 * before), 1e-6);
  const Surface surface = make_surface(spec.geometry);
  EXPECT_NEAR(moved.x, 0.5 * surface.diagonal, 1e-6);
  EXPECT_NEAR(moved.y, 0, 1e-6);
}

TEST(Synthesize, SixteenBitsAndNoMapsOrMasks) {
  const ScratchFolder folder;
  Spec spec = small(kBlock);
  make(spec, folder / "a");
  spec.image.bits = 16;
  spec.image.maps = spec.image.masks = false;
  make(spec, folder / "a");
  for (const char* part : {"depth", "normals", "masks"})
    EXPECT_FALSE(fs::exists(folder / "a" / part)) << part;
  const Scene scene = io::load_scene(folder / "a");
  EXPECT_TRUE(scene.views[0].mask.empty());
  EXPECT_EQ(io::read_image(scene.views[0].image).encoding, ColourImage::Encoding::kLinearHalf);
}

TEST(Synthesize, OtherPeoplesFilesAreLeftAlone) {
  const ScratchFolder scratch;
  fs::create_directory(scratch / "mine");
  write_text(scratch / "mine" / "spec.json", "{}");
  EXPECT_THAT(failure_of(small(kBlock), scratch / "mine"), HasSubstr("nothing was written"));
  EXPECT_EQ(contents(scratch / "mine").size(), 1u);
  write_text(scratch / "file", "x");
  EXPECT_THAT(failure_of(small(kBlock), scratch / "file"), HasSubstr("not a folder"));
}

TEST(Synthesize, ReplacesAnOlderSceneWithoutLeavingItsViews) {
  const ScratchFolder scratch;
  Spec spec = small(kBlock);
  make(spec, scratch / "scene");
  write_text(scratch / "scene" / "images" / "notes.txt", "mine");
  spec.cameras.count = 2;
  make(spec, scratch / "scene");
  EXPECT_FALSE(fs::exists(scratch / "scene" / "images" / "0002.png"));
  EXPECT_FALSE(fs::exists(scratch / "scene" / "depth" / "0002.exr"));
  EXPECT_TRUE(fs::exists(scratch / "scene" / "images" / "notes.txt"));
  EXPECT_EQ(io::load_scene(scratch / "scene").views.size(), 2u);
}

TEST(Synthesize, StoppedItSaysSoAndCanBeRunAgain) {
  const ScratchFolder scratch;
  struct StopAtPictures : Progress {
    void stage(const std::string& name, double) override {
      if (name == "photographs") process_cancellation().cancel();
    }
  } stopping;
  EXPECT_THROW(synthesize(small(kBlock), scratch / "scene", stopping), Cancelled);
  process_cancellation().reset();
  EXPECT_TRUE(fs::exists(scratch / "scene" / "INCOMPLETE"));
  EXPECT_FALSE(fs::exists(scratch / "scene" / "spec.json"));
  make(small(kBlock), scratch / "scene");
  EXPECT_FALSE(fs::exists(scratch / "scene" / "INCOMPLETE"));
  EXPECT_TRUE(fs::exists(scratch / "scene" / "spec.json"));
}

TEST(Synthesize, MeshFilesAreReadAndBadOnesNamed) {
  const ScratchFolder scratch;
  const auto with_mesh = [&](const std::string& text) {
    write_text(scratch / "mesh.obj", text);
    Spec spec = small(kBlock);
    spec.geometry.mesh = (scratch / "mesh.obj").string();
    spec.geometry.shape.clear();
    return spec;
  };
  make(with_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"),
       scratch / "scene");
  EXPECT_EQ(read_ply(scratch / "scene" / "gt.ply").triangles.size(), 4u);
  EXPECT_THAT(failure_of(with_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\n"), scratch / "x"),
              HasSubstr("mesh.obj"));
  EXPECT_THAT(failure_of(with_mesh("v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n"), scratch / "x"),
              HasSubstr("mesh.obj"));
  EXPECT_THAT(failure_of(with_mesh("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), scratch / "x"),
              HasSubstr("mesh.obj"));
  Spec missing = small(kBlock);
  missing.geometry.mesh = (scratch / "none.ply").string();
  EXPECT_THAT(failure_of(missing, scratch / "x"), HasSubstr("none.ply"));
  EXPECT_FALSE(fs::exists(scratch / "x"));
}

TEST(Synthesize, ViewsThatSeeNothingAreAnError) {
  const ScratchFolder scratch;
  Spec spec = small(kBlock);
  spec.cameras.principal_offset = {500, 0};
  EXPECT_THAT(failure_of(spec, scratch / "scene"), HasSubstr("sees nothing"));
}

}  // namespace
}  // namespace photohull::synth
