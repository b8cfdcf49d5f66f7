// Boxes of rendered scenes, from their files on.
#include "pipeline/complete_box.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/load_scene.h"
#include "pipeline/box_picture.h"
#include "support/scratch_folder.h"
#include "synth/synthesize.h"

namespace photohull::pipeline {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;

/// A textured block; `more` are fields of the spec.
void render(const std::string& more, const std::filesystem::path& folder, int width = 400) {
  synth::Spec spec = synth::parse_spec(
      R"({"geometry": {"shape": "block"}, "material": {"contrast": 0.9},)" + more + "}", "test",
      "");
  spec.image = {width, 3 * width / 4, 2};
  spec.truth_samples = 200;
  Progress progress;
  synth::synthesize(spec, folder, progress);
}

constexpr const char* kRings =
    R"("cameras": {"fill": 0.6, "rings": [{"count": 9, "elevation": 12},
                              {"count": 7, "elevation": 42, "phase": 0.5}]})";

Scene complete(const std::filesystem::path& folder, MaskPolicy masks, const BoxOptions& options) {
  Scene scene = io::load_scene(folder / "transforms.json");
  Progress silent;
  complete_box(options, masks, scene, silent);
  return scene;
}

/// Holds the block, whose own box (2 % larger) the scene gives, and at most 3 times its volume.
void expect_found(const std::filesystem::path& folder, MaskPolicy masks, const char* source) {
  const Box known = *io::load_scene(folder / "transforms.json").box;
  const glm::dvec3 slack(0.02 * known.diagonal() / 1.08);
  const Scene scene = complete(folder, masks, {.find = true});
  EXPECT_TRUE(glm::all(glm::lessThanEqual(scene.box->min, known.min + slack)));
  EXPECT_TRUE(glm::all(glm::greaterThanEqual(scene.box->max, known.max - slack)));
  const glm::dvec3 a = scene.box->size(), b = known.size() - 2.0 * slack;
  EXPECT_LT(a.x * a.y * a.z, 3 * b.x * b.y * b.z);
  EXPECT_THAT(scene.box_source, HasSubstr(source));
}

TEST(CompleteBox, FindsTheObjectOnPlainGround) {
  ScratchFolder folder;
  render(kRings, folder / "scene");
  expect_found(folder / "scene", MaskPolicy::kAuto, "the silhouettes of 16 views");
  expect_found(folder / "scene", MaskPolicy::kNone, "features triangulated");
}

/// Which are read at 800 pixels.
TEST(CompleteBox, FindsTheObjectInLargePhotographs) {
  ScratchFolder folder;
  render(kRings, folder / "scene", 1300);
  expect_found(folder / "scene", MaskPolicy::kAuto, "the silhouettes of 16 views");
  expect_found(folder / "scene", MaskPolicy::kNone, "features triangulated");
}

TEST(CompleteBox, FindsTheObjectBeforeClutter) {
  ScratchFolder folder;
  render(std::string(R"("background": {"type": "clutter"},)") + kRings, folder / "scene");
  expect_found(folder / "scene", MaskPolicy::kNone, "look at one place");
}

TEST(CompleteBox, FindsWhatCamerasOfOneSideSee) {
  ScratchFolder folder;
  render(R"("background": {"type": "clutter"},
            "cameras": {"layout": "arc", "count": 7, "arc": 50, "fill": 0.6})",
         folder / "scene");
  const Box known = *io::load_scene(folder / "scene/transforms.json").box;
  const Scene scene = complete(folder / "scene", MaskPolicy::kNone, {.find = true});
  EXPECT_TRUE(scene.box->contains(known.center()));
  // The side that faces the cameras, and not the clutter behind, 2.5 camera distances off.
  EXPECT_LT(scene.box->diagonal(), 2 * known.diagonal());
  EXPECT_GT(scene.box->diagonal(), 0.5 * known.diagonal());
}

TEST(CompleteBox, KeepsAndScalesTheScenesOwn) {
  ScratchFolder folder;
  render(kRings, folder / "scene");
  const Scene given = io::load_scene(folder / "scene/transforms.json");
  const Scene kept = complete(folder / "scene", MaskPolicy::kAuto, {});
  EXPECT_EQ(kept.box->min, given.box->min);
  EXPECT_EQ(kept.box_source, given.box_source);
  const Scene scaled = complete(folder / "scene", MaskPolicy::kAuto, {.scale = 1.5});
  EXPECT_LT(glm::distance(scaled.box->center(), given.box->center()), 1e-12);
  EXPECT_LT(glm::distance(scaled.box->size(), 1.5 * given.box->size()), 1e-12);
  EXPECT_THAT(scaled.box_source, testing::EndsWith(", scaled by 1.5"));
}

TEST(CompleteBox, RefusesAbsurdScales) {
  for (const double scale : {0.0, -1.0, 0.01, 21.0, double(NAN), double(INFINITY)})
    EXPECT_THAT([&] { (BoxOptions{.scale = scale}).validate(); },
                ThrowsMessage<UsageError>(StartsWith("box_scale=")));
  BoxOptions{.scale = 20}.validate();
}

TEST(CompleteBox, NamesTheSceneWherePlainPicturesTellNothing) {
  ScratchFolder folder;
  render(
      R"("light": {"ambient": [0, 0, 0], "directional": []}, "cameras": {"rings": [{"count": 4, "elevation": 12}]})",
      folder / "dark");
  EXPECT_THAT([&] { complete(folder / "dark", MaskPolicy::kNone, {.find = true}); },
              ThrowsMessage<Error>(AllOf(HasSubstr("transforms.json"), HasSubstr("give box"))));
}

/// Pixels of the colour that edges along an axis have.
std::array<int, 3> edge_pixels(const RgbImage& picture) {
  constexpr std::uint8_t kColours[3][3] = {{255, 70, 70}, {80, 220, 80}, {60, 150, 255}};
  std::array<int, 3> count{};
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3)
    for (int axis = 0; axis < 3; ++axis)
      count[std::size_t(axis)] += std::equal(kColours[axis], kColours[axis] + 3, &picture.rgb[i]);
  return count;
}

TEST(DrawBox, ShowsTheBoxInPhotographsAndFromAbove) {
  ScratchFolder folder;
  render(kRings, folder / "scene");
  Scene scene = io::load_scene(folder / "scene/transforms.json");
  const std::vector<double> scales(scene.views.size(), 1), halves(scene.views.size(), 0.5);
  const RgbImage whole = draw_box(scene, scales, 0.01 * scene.box->diagonal(), {});
  ASSERT_EQ(whole.rgb.size(), std::size_t(3) * whole.width * whole.height);
  const std::array<int, 3> edges = edge_pixels(whole);
  for (int axis = 0; axis < 3; ++axis) EXPECT_GT(edges[std::size_t(axis)], 300) << axis;
  // Photographs of fewer pixels are drawn as large, with the box at the same place.
  const RgbImage coarse = draw_box(scene, halves, 0.01 * scene.box->diagonal(), {});
  ASSERT_EQ(coarse.rgb.size(), whole.rgb.size());
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(edge_pixels(coarse)[std::size_t(axis)], edges[std::size_t(axis)],
                0.02 * edges[std::size_t(axis)]);
  EXPECT_NE(coarse.rgb, whole.rgb);
  // Half as long along x: fewer red pixels, and not in the same places.
  scene.box->max.x = scene.box->center().x;
  const RgbImage half = draw_box(scene, scales, 0.01 * scene.box->diagonal(), {});
  EXPECT_LT(edge_pixels(half)[0], 0.8 * edges[0]);
}

}  // namespace
}  // namespace photohull::pipeline
