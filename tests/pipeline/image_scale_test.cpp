// How large photographs are read: the rule, its limits, and what becomes of cameras and tracks.
#include "pipeline/image_scale.h"
#include "pipeline/larger_photographs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/error.h"
#include "io/image_file.h"
#include "pipeline/plan.h"
#include "pipeline/read_scene.h"
#include "pipeline/reconstruct.h"
#include "support/scratch_folder.h"

namespace photohull::pipeline {
namespace {

constexpr Box kBox{glm::dvec3(-1), glm::dvec3(1)};

/// Looks along z at the box from `distance`; a pixel is distance / focal large there.
SourceView view(int width, int height, double focal, double distance = 10) {
  SourceView out;
  out.name = "a.png";
  out.camera.intrinsics = {width, height, focal, focal, 0, width / 2.0, height / 2.0};
  out.camera.cam_from_world.translation = {0, 0, distance};
  return out;
}

Scene scene_of(std::vector<SourceView> views) {
  Scene scene;
  scene.views = std::move(views);
  scene.box = kBox;
  return scene;
}

TEST(ParseImageScale, AutoAFractionOrANumber) {
  EXPECT_EQ(parse_image_scale("1"), 1.0);
  EXPECT_EQ(parse_image_scale("1/4"), 0.25);
  EXPECT_EQ(parse_image_scale("0.3"), 0.3);
}

TEST(ParseImageScale, TakesNothingElse) {
  for (const char* bad : {"", "0", "-1", "1.5", "2/1", "1/0", "1/", "/2", "half", "1/2x", "nan"})
    EXPECT_EQ(parse_image_scale(bad), std::nullopt) << bad;
}

TEST(ImageScaleText, SaysFractions) {
  EXPECT_EQ(image_scale_text(1), "1");
  EXPECT_EQ(image_scale_text(0.125), "1/8");
  EXPECT_EQ(image_scale_text(0.3), "0.3");
}

TEST(ImageScales, LeaveTheLeastPixelsToAVoxel) {
  const std::vector<SourceView> views(3, view(6000, 4000, 5000));  // a pixel is 0.002
  const double pixel = 10 / 5000.0;
  const auto at = [&](double voxel) { return image_scales(kBox, views, voxel)[0]; };
  EXPECT_EQ(at(kPixelsPerVoxel * pixel), 1);
  EXPECT_EQ(at(1.99 * kPixelsPerVoxel * pixel), 1);
  EXPECT_EQ(at(2 * kPixelsPerVoxel * pixel), 0.5);
  EXPECT_EQ(at(4 * kPixelsPerVoxel * pixel), 0.25);
  EXPECT_EQ(at(8 * kPixelsPerVoxel * pixel), 0.125);
  EXPECT_EQ(at(1e6 * pixel), 0.125) << "no smaller than 640 x 480";
}

TEST(ImageScales, SmallPhotographsStay) {
  const std::vector<SourceView> views(3, view(1024, 768, 900));
  EXPECT_EQ(image_scales(kBox, views, 1), std::vector<double>(3, 1.0));
}

TEST(ImageScales, NoViewLosesMoreThanTheMedianOrItsOwnSizeBears) {
  std::vector<SourceView> views(5, view(6000, 4000, 5000));
  views.push_back(view(6000, 4000, 5000, 2));  // near: as its photograph's size
  views.push_back(view(3000, 2000, 2500));     // pixels twice as large
  views.push_back(view(8000, 6000, 20000));    // pixels a quarter as large: as the median
  const double pixel = 10 / 5000.0;
  const auto scales = image_scales(kBox, views, 4 * kPixelsPerVoxel * pixel);
  EXPECT_EQ(scales, (std::vector<double>{0.25, 0.25, 0.25, 0.25, 0.25, 0.25, 0.5, 0.25}));
}

TEST(ScaleScene, MovesIntrinsicsAndTracks) {
  Scene scene = scene_of({view(6001, 4000, 5000), view(6001, 4000, 5000)});
  scene.tracks = {{{{0, {100, 200}}, {1, {3000, 1000}}}}};
  scene.views[0].distortion.coefficients[0] = 0.1;
  const glm::dvec3 point(0.3, -0.2, 0.1);
  const glm::dvec2 before = *scene.views[0].camera.project(point);
  scale_scene(std::vector<double>{0.25, 1}, scene);
  const Intrinsics& k = scene.views[0].camera.intrinsics;
  EXPECT_EQ(k.width, 1501);
  EXPECT_EQ(k.height, 1000);
  // Pixel 100 covers [100, 101): its centre is 100.5 pixels from the border, 25.125 of the new.
  EXPECT_EQ(scene.tracks[0].observations[0].pixel, glm::dvec2(24.625, 49.625));
  EXPECT_EQ(scene.tracks[0].observations[1].pixel, glm::dvec2(3000, 1000));
  const glm::dvec2 after = *scene.views[0].camera.project(point);
  EXPECT_NEAR(after.x, (before.x + 0.5) / 4 - 0.5, 1e-9);
  EXPECT_NEAR(after.y, (before.y + 0.5) / 4 - 0.5, 1e-9);
  EXPECT_EQ(scene.views[0].distortion.coefficients[0], 0.1);
  EXPECT_EQ(scene.views[1].camera.intrinsics.width, 6001);
}

TEST(KeepUnexpectedSizes, LetsDecodingTell) {
  const ScratchFolder folder;
  std::vector<std::uint8_t> grey(8 * 6, 100);
  io::write_png(folder / "right.png", 8, 6, 1, grey);
  std::ofstream(folder / "broken.png") << "no image";
  std::vector<SourceView> views(4, view(8, 6, 5));
  views[0].image = folder / "right.png";
  views[1].image = folder / "right.png";
  views[1].camera.intrinsics.width = 16;
  views[2].image = folder / "broken.png";
  views[3].image = folder / "absent.png";
  std::vector<double> scales(4, 0.5);
  keep_unexpected_sizes(file_reader(), views, scales);
  EXPECT_EQ(scales, (std::vector<double>{0.5, 1, 1, 1}));
}

/// Every file comes in the size that its view's camera gets.
TEST(ReducedLoader, ReadsMasksOfTheCamerasSizeAsThoseOfScaledCopies) {
  const ScratchFolder folder;
  // The camera was calibrated for 101 x 75 pixels, the photograph is a copy of 50 x 37.
  const auto disc = [&](const char* name, int width, int height) {
    std::vector<std::uint8_t> values;
    const double x0 = 0.4 * width, y0 = 0.55 * height, radius = 0.3 * height;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        values.push_back(std::uint8_t(
            255 * std::clamp(radius - std::hypot(x + 0.5 - x0, y + 0.5 - y0) + 0.5, 0.0, 1.0)));
    io::write_png(folder / name, width, height, 1, values);
    return folder / name;
  };
  Scene scene = scene_of({view(50, 37, 40), view(50, 37, 40)});
  scene.views[0].image = disc("a.png", 50, 37);
  scene.views[0].mask = disc("small.png", 50, 37);
  scene.views[1].image = disc("b.png", 50, 37);
  scene.views[1].mask = disc("large.png", 101, 75);
  const std::vector<double> scales{0.3, 0.3};
  const ViewLoader loader = reduced_loader(file_reader(), scene, scales);
  scale_scene(scales, scene);
  const Intrinsics& k = scene.views[0].camera.intrinsics;
  EXPECT_EQ(k.width, 15);
  EXPECT_EQ(k.height, 12);  // the last row covers a third of a pixel
  const ColourImage image = loader.image(folder / "a.png");
  const Mask small = loader.mask(folder / "small.png"), large = loader.mask(folder / "large.png");
  EXPECT_EQ(image.width, k.width);
  EXPECT_EQ(image.height, k.height);
  ASSERT_EQ(small.width, k.width);
  ASSERT_EQ(small.height, k.height);
  ASSERT_EQ(large.width, k.width);
  ASSERT_EQ(large.height, k.height);
  // Two drawings of one disc: their edges differ by less than a pixel of the small one's.
  for (std::size_t i = 0; i < small.coverage.size(); ++i)
    EXPECT_NEAR(large.coverage[i], small.coverage[i], 20) << i;
  scene.views[0].camera.intrinsics = scene.views[1].camera.intrinsics =
      view(50, 37, 40).camera.intrinsics;
  const ViewLoader whole = reduced_loader(file_reader(), scene, std::vector<double>{1, 1});
  EXPECT_EQ(whole.mask(folder / "large.png").width, 101) << "left to those who resize masks";
}

/// A plan for photographs that are there.
class PlanJob : public testing::Test {
 protected:
  PlanJob() : scene_(scene_of(std::vector<SourceView>(12, view(1600, 1200, 1300)))) {
    io::write_png(folder_ / "a.png", 1600, 1200, 1, std::vector<std::uint8_t>(1600 * 1200, 9));
    for (SourceView& v : scene_.views) v.image = folder_ / "a.png";
  }
  Plan plan(std::int64_t limit) { return plan_job({options_}, scene_, kBox, true, limit); }

  static constexpr std::int64_t kNoLimit = std::int64_t(1) << 60;
  ScratchFolder folder_;
  Scene scene_;
  ReconstructOptions options_;
};

TEST_F(PlanJob, DefaultVoxelsReadPhotographsAsTheyAre) {
  EXPECT_EQ(plan(kNoLimit).scales, std::vector<double>(12, 1.0));
  options_.quality = Quality::kDraft;
  EXPECT_EQ(plan(kNoLimit).scales, std::vector<double>(12, 1.0));
}

TEST_F(PlanJob, CoarseVoxelsReadThemSmaller) {
  options_.resolution = 40;  // a voxel is 6.5 pixels
  const Plan found = plan(kNoLimit);
  EXPECT_EQ(found.scales, std::vector<double>(12, 0.5));
  EXPECT_EQ(found.wanted, found.scales);
  EXPECT_EQ(found.grid.voxel_size, 2 / 40.0);
  options_.image_scale = 0.3;
  EXPECT_EQ(plan(kNoLimit).scales, std::vector<double>(12, 0.3));
}

TEST_F(PlanJob, MemoryAsksForSmallerOnesUnlessForced) {
  options_.resolution = 110;  // a voxel is 2.4 pixels
  const Plan whole = plan(kNoLimit);
  ASSERT_EQ(whole.scales[0], 1);
  const Plan less = plan(whole.cost.bytes - 1);
  EXPECT_EQ(less.wanted[0], 1);
  EXPECT_EQ(less.scales, std::vector<double>(12, 0.5));
  EXPECT_LT(less.cost.bytes, whole.cost.bytes);
  EXPECT_GT(plan(1).cost.bytes, 1) << "not possible, and said so";
  options_.image_scale = 1;
  EXPECT_EQ(plan(whole.cost.bytes - 1).scales[0], 1);
}

TEST_F(PlanJob, WhereMemoryIsShortSomePhotographsAreHeldAsLargeAsTheyAreWanted) {
  const Plan whole = plan(kNoLimit);
  EXPECT_EQ(whole.held_bytes, 0);
  const Plan less = plan(whole.cost.bytes - 1);
  EXPECT_EQ(less.scales[0], 0.5);
  EXPECT_GT(less.held_bytes, 0);
  EXPECT_EQ(less.grid.voxel_size, whole.grid.voxel_size) << "they follow the wanted pixels";
  options_.resolution = 110;
  options_.image_scale = 0.5;
  const std::int64_t half = plan(kNoLimit).cost.bytes;
  options_.image_scale.reset();
  const std::int64_t fewest = held_bytes(fewest_held(12), 1600 * 1200, 1600 * 1200);
  const Plan some = plan(half + fewest + (1 << 20));
  EXPECT_EQ(some.scales[0], 0.5);
  EXPECT_EQ(some.wanted[0], 1);
  EXPECT_GT(some.held_bytes, fewest);
  EXPECT_LE(some.cost.bytes, half + fewest + (1 << 20));
  const Plan none = plan(half + fewest - (1 << 20));
  EXPECT_EQ(none.scales[0], 0.5);
  EXPECT_EQ(none.held_bytes, 0);
  for (SourceView& v : scene_.views) v.camera.intrinsics.width = 40000;  // no texture holds eight
  options_.resolution.reset();
  EXPECT_EQ(plan(plan(kNoLimit).cost.bytes - 1).held_bytes, 0);
  for (SourceView& v : scene_.views) v.camera.intrinsics.width = 1600;
  options_.resolution = 110;
  options_.method = Method::kHull;  // matches nothing
  EXPECT_EQ(plan(half + fewest + (1 << 20)).held_bytes, 0);
}

TEST_F(PlanJob, VoxelsCountBeforeMasksAreSeen) {
  // Default voxels, and masks that may be made from the background or not.
  const auto reading = [&](std::int64_t limit, const Box& box = kBox, bool known = false) {
    return plan_reading({options_}, scene_, box, known, limit);
  };
  const Plan whole = plan(kNoLimit);
  EXPECT_EQ(reading(kNoLimit).scales[0], 1);
  EXPECT_EQ(reading(kNoLimit).cost.bytes, whole.cost.bytes);
  options_.image_scale = 0.5;
  const std::int64_t half = plan(kNoLimit).cost.bytes;
  options_.image_scale.reset();
  const Plan less = reading(half);
  EXPECT_EQ(less.scales, std::vector<double>(12, 0.5));
  EXPECT_EQ(less.wanted, std::vector<double>(12, 1.0));
  EXPECT_LT(less.cost.bytes, whole.cost.bytes);
  // Where all of the box fits at no scale, what masks leave of it may: photographs alone count.
  const Plan least = plan(less.cost.bytes - 1);
  ASSERT_GT(least.cost.bytes, less.cost.bytes - 1);
  EXPECT_LT(reading(less.cost.bytes - 1).cost.bytes, least.cost.bytes);
  EXPECT_EQ(reading(less.cost.bytes - 1, kBox, true).cost.bytes, least.cost.bytes);
  EXPECT_EQ(reading(less.cost.bytes - 1).scales, least.scales);
  // Of such a box no lattice can be made.
  const Box huge{kBox.min * 10.0, kBox.max * 10.0};
  options_.image_scale = 1;
  options_.voxel_size = 1e-3;
  EXPECT_THROW(reading(kNoLimit, huge, true), Error);
  EXPECT_EQ(reading(kNoLimit, huge).scales[0], 1);
}

/// Photographs that cannot be decoded are never looked at.
TEST(MaxMemory, RefusesBeforeDecoding) {
  const ScratchFolder folder;
  std::ofstream par(folder / "x_par.txt");
  par << "3\n";
  for (int i = 0; i < 3; ++i) {
    const std::string name = "i" + std::to_string(i) + ".png";
    std::vector<std::uint8_t> noise(640 * 480);
    for (std::size_t k = 0; k < noise.size(); ++k) noise[k] = std::uint8_t(k * k * 40503 >> 16);
    io::write_png(folder / name, 640, 480, 1, noise);
    std::filesystem::resize_file(folder / name, std::filesystem::file_size(folder / name) / 2);
    EXPECT_THROW(io::read_image(folder / name), Error);
    par << name << " 900 0 320 0 900 240 0 0 1  1 0 0 0 1 0 0 0 1  " << i << " 0 10\n";
  }
  par.close();
  ReconstructOptions options;
  io::LoadSceneOptions load;
  load.box = kBox;
  options.resolution = 64;
  options.max_memory = std::int64_t(100) << 20;
  Progress silent;
  try {
    Reconstructor(options).run(load_photographs(folder / "x_par.txt", load), silent);
    ADD_FAILURE() << "it was taken";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("may take 100 MiB (max_memory)"), std::string::npos)
        << e.what();
  }
}

/// Is a job of 4000 voxels along the box and five small photographs begun where it may take 2 GiB?
bool is_begun(io::MaskSource masks) {
  Photographs photographs;
  photographs.scene = scene_of(std::vector<SourceView>(5, view(640, 480, 900)));
  photographs.load.masks = masks;
  ReconstructOptions options;
  options.resolution = 4000;
  options.max_memory = std::int64_t(2) << 30;
  Progress silent;
  try {
    choose_reading(photographs, photographs.scene, kBox, options, silent);
    return true;
  } catch (const Error&) {
    return false;
  }
}

TEST(ChooseReading, WithMasksTheSurfaceIsNotKnownBeforeTheyAreSeen) {
  EXPECT_TRUE(is_begun(io::MaskSource::kAuto));
  EXPECT_FALSE(is_begun(io::MaskSource::kNone));
}

}  // namespace
}  // namespace photohull::pipeline
