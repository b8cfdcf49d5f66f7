// Space carving from photographs to the surface, on a block with a notch that no silhouette shows.
#include "carving/photo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "carving/fit_grid.h"
#include "carving/hull.h"
#include "core/error.h"
#include "support/gl_context.h"
#include "support/ray_cast.h"

namespace photohull::carving {
namespace {

using glm::ivec3;

const Box kBlock{{-1, -1, -0.5}, {1, 1, 0}};
constexpr double kNotchHalf = 0.42, kNotchDepth = 0.25;
constexpr double kTexture = 0.05;  ///< size of the pattern's details: about three pixels

bool solid(const glm::dvec3& p) {
  const bool notch = std::abs(p.x) < kNotchHalf && std::abs(p.y) < kNotchHalf && p.z > -kNotchDepth;
  return kBlock.contains(p) && !notch;
}

/// Distance along the ray to where it enters the box; negative when it does not.
double enter(const Box& box, const glm::dvec3& eye, const glm::dvec3& ray) {
  double in = 0, out = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.min[axis] - eye[axis]) / ray[axis];
    const double b = (box.max[axis] - eye[axis]) / ray[axis];
    in = std::max(in, std::min(a, b));
    out = std::min(out, std::max(a, b));
  }
  return in < out ? in : -1;
}

/// Nearest crossing into the solid from outside: entry of the block, or floor and walls of the
/// notch.
glm::dvec3 trace(const glm::dvec3& eye, const glm::dvec3& ray) {
  const double in = enter(kBlock, eye, ray);
  if (in < 0) return glm::dvec3(0.02);
  std::vector<double> candidates{in, (-kNotchDepth - eye.z) / ray.z};
  for (int axis = 0; axis < 2; ++axis)
    for (const double wall : {-kNotchHalf, kNotchHalf})
      candidates.push_back((wall - eye[axis]) / ray[axis]);
  std::sort(candidates.begin(), candidates.end());
  for (const double t : candidates)
    if (t >= in && solid(eye + (t + 1e-9) * ray))
      return test::noise_colour(eye + t * ray, kTexture);
  return glm::dvec3(0.02);
}

std::vector<PreparedView> photograph() {
  std::vector<PreparedView> views;
  for (int i = 0; i < 8; ++i) {
    const double angle = 2 * M_PI * i / 7, tilt = i == 7 ? 0 : 0.42;
    const glm::dvec3 eye = 4.0 * glm::dvec3(std::sin(tilt) * std::cos(angle),
                                            std::sin(tilt) * std::sin(angle), std::cos(tilt));
    PreparedView view;
    view.camera = test::look_at(eye, {0, 0, -0.2}, 215, 160, 128);
    view.image = test::ray_cast(view.camera, trace, 2);
    views.push_back(view);
  }
  return views;
}

class CarvePhoto : public ::testing::Test {
 protected:
  CarvePhoto() : views_(photograph()) {
    for (const PreparedView& view : views_) cameras_.push_back(view.camera);
    const GridSpec grid = fit_grid(kBlock, 0.04);
    const std::vector<Silhouette> none(views_.size());
    hull_ = carve_silhouette(context_, {grid, kBlock}, {cameras_, none}, {2}, progress_);
  }
  void TearDown() override { context_.check_errors("carve photo test"); }

  SparseVolume carve(const PhotoOptions& options = {}, PhotoReport* report = nullptr) {
    const projtex::ImageSet images(views_);
    return carve_photo(context_, hull_, {images, cameras_}, options, progress_, report);
  }

  gpu::Context& context_ = test::gl_context();
  Progress progress_;
  std::vector<PreparedView> views_;
  std::vector<Camera> cameras_;
  SparseVolume hull_;
};

/// Height of the uppermost surface in a column of voxels, in world units.
double surface_height(const SparseVolume& volume, int x, int y) {
  for (int z = volume.grid.voxels().z - 1; z > 0; --z) {
    const double above = volume.at({x, y, z}), below = volume.at({x, y, z - 1});
    if (below < 0 && above >= 0)
      return volume.grid.world(glm::dvec3(x, y, z - above / (above - below))).z;
  }
  return -1e9;
}

/// Is the voxel more than `voxels` away from every surface, within the solid?
bool deep_inside(const GridSpec& grid, const ivec3& voxel, double voxels) {
  for (int face = 0; face < 6; ++face) {
    glm::dvec3 p(voxel);
    p[face / 2] += face % 2 ? voxels : -voxels;
    if (!solid(grid.world(p))) return false;
  }
  return true;
}

struct Judgement {
  double worst_floor = 0;  ///< voxels off the true floor, away from the walls
  int columns = 0;         ///< of the floor
  int wrongly_carved = 0;  ///< voxels more than 1.5 voxels inside the solid that are gone
};

Judgement judge(const SparseVolume& volume) {
  const GridSpec& grid = volume.grid;
  Judgement out;
  const ivec3 size = grid.voxels();
  for (int x = 0; x < size.x; ++x)
    for (int y = 0; y < size.y; ++y) {
      const glm::dvec3 p = grid.world({x, y, 0});
      // The patches of the last two voxels mix wall and floor.
      if (std::max(std::abs(p.x), std::abs(p.y)) < kNotchHalf - 2.5 * grid.voxel_size) {
        const double error = (surface_height(volume, x, y) + kNotchDepth) / grid.voxel_size;
        out.worst_floor = std::max(out.worst_floor, std::abs(error));
        ++out.columns;
      }
      for (int z = 0; z < size.z; ++z)
        out.wrongly_carved += deep_inside(grid, {x, y, z}, 1.5) && volume.at({x, y, z}) >= 0;
    }
  return out;
}

TEST_F(CarvePhoto, TheHullDoesNotKnowTheNotch) {
  const Judgement hull = judge(hull_);
  EXPECT_NEAR(hull.worst_floor, kNotchDepth / 0.04, 0.1);
  EXPECT_EQ(hull.wrongly_carved, 0);
}

TEST_F(CarvePhoto, SpaceCarvingFindsTheFloorAndCarvesNoTrueSurface) {
  PhotoReport report;
  const Judgement found = judge(carve({}, &report));
  // Measured: 1.07; the floor lies between two layers of voxels.
  EXPECT_LT(found.worst_floor, 1.5);
  EXPECT_GT(found.columns, 200);
  EXPECT_EQ(found.wrongly_carved, 0);
  EXPECT_GT(report.carved, 0);
  EXPECT_GT(report.judged, report.carved);
  EXPECT_EQ(report.sweeps, 6 * report.rounds);
}

TEST_F(CarvePhoto, OneSweepOfVoxelColoringFindsTheFloor) {
  PhotoOptions options;
  options.method = PhotoMethod::kVoxelColoring;
  PhotoReport report;
  const Judgement found = judge(carve(options, &report));
  EXPECT_LT(found.worst_floor, 1.5);
  EXPECT_EQ(found.wrongly_carved, 0);
  EXPECT_EQ(report.sweeps, 1);
}

// Principal points that are off by a pixel and more, each its own way.
TEST_F(CarvePhoto, SearchBearsCamerasThatAreWrong) {
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    cameras_[i].intrinsics.cx += 1.4 * std::cos(2.4 * double(i));
    cameras_[i].intrinsics.cy += 1.4 * std::sin(2.4 * double(i));
  }
  PhotoOptions options;
  PhotoReport without, with;
  const Judgement blurred = judge(carve(options, &without));
  options.search_radius = 1.5;
  const Judgement found = judge(carve(options, &with));
  EXPECT_LT(found.worst_floor, blurred.worst_floor);
  EXPECT_EQ(found.wrongly_carved, 0);
  EXPECT_GT(with.samples, without.samples);
}

TEST_F(CarvePhoto, TwoRunsGiveTheSameBytes) {
  const SparseVolume a = carve(), b = carve();
  EXPECT_EQ(a.table, b.table);
  EXPECT_EQ(a.bricks, b.bricks);
  EXPECT_EQ(a.distance, b.distance);
}

TEST_F(CarvePhoto, BlankPhotographsCarveNothing) {
  for (PreparedView& view : views_)
    std::fill(view.image.bytes.begin(), view.image.bytes.end(), 128);
  PhotoReport report;
  const SparseVolume volume = carve({}, &report);
  EXPECT_EQ(report.carved, 0);
  EXPECT_EQ(volume.inside_voxels(), hull_.inside_voxels());
}

TEST_F(CarvePhoto, StopsWhenAsked) {
  process_cancellation().cancel();
  EXPECT_THROW(carve(), Cancelled);
  process_cancellation().reset();
}

TEST(PhotoOptions, NamesTheFieldThatIsOutOfRange) {
  EXPECT_NO_THROW(PhotoOptions().validate());
  const auto refuses = [](auto change) {
    PhotoOptions options;
    change(options);
    EXPECT_THROW(options.validate(), UsageError);
  };
  refuses([](PhotoOptions& o) { o.keep_score = 1; });
  refuses([](PhotoOptions& o) { o.keep_score = NAN; });
  refuses([](PhotoOptions& o) { o.better_by = -0.1; });
  refuses([](PhotoOptions& o) { o.min_views = 1; });
  refuses([](PhotoOptions& o) { o.noise_sigma = 0; });
  refuses([](PhotoOptions& o) { o.noise_sigma = NAN; });
  refuses([](PhotoOptions& o) { o.min_texture = NAN; });
  refuses([](PhotoOptions& o) { o.supersample = 9; });
  refuses([](PhotoOptions& o) { o.depth_bias = -1; });
  refuses([](PhotoOptions& o) { o.search_radius = 5; });
  refuses([](PhotoOptions& o) { o.max_rounds = 0; });
}

}  // namespace
}  // namespace photohull::carving
