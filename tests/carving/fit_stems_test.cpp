// Tubes that are too thick and beside their place, against masks of the rods that they should be.
#include "carving/fit_stems.h"

#include <gtest/gtest.h>

#include <numbers>

#include "carving/rods.h"
#include "masks/mask_lines.h"
#include "render/meshes.h"

namespace photohull::carving {
namespace {

using glm::dvec3;
using test::Rod;

constexpr int kSize = 256;
constexpr double kDistance = 6, kFocal = 700;
constexpr double kPixel = kDistance / kFocal;  ///< world size of a pixel at the middle
constexpr double kVoxel = 1.5 * kPixel;

Rod straight(double width) {
  return test::straight_rod({-0.5, -0.35, -0.3}, {0.45, 0.5, 0.4}, 0.5 * width * kPixel, 100);
}

/// Three quarters of a slanted circle.
Rod curved(double width) {
  Rod rod{{}, 0.5 * width * kPixel};
  const dvec3 x = glm::normalize(dvec3(1, 0.2, 0.3)),
              y = glm::normalize(glm::cross(x, dvec3(0.1, -0.4, 1)));
  for (int i = 0; i <= 180; ++i) {
    const double angle = 1.5 * std::numbers::pi * i / 180;
    rod.axis.push_back(0.5 * (std::cos(angle) * x + std::sin(angle) * y));
  }
  return rod;
}

struct Views {
  explicit Views(std::vector<Camera> of) : cameras(std::move(of)) {
    for (const Camera& c : cameras) drawings.emplace_back(c.intrinsics.width, c.intrinsics.height);
  }
  explicit Views(const Rod& rod)
      : Views(test::cameras_around(dvec3(0), kDistance, 16, kFocal, kSize, kSize)) {
    for (std::size_t i = 0; i < cameras.size(); ++i) draw(rod, cameras[i], drawings[i]);
  }

  std::size_t fit(TriMesh& mesh, bool hard = false) const {
    std::vector<Mask> masks;
    std::vector<std::vector<LinePoint>> lines;
    for (const test::Drawing& d : drawings) {
      masks.push_back(hard ? d.hard_mask() : d.mask());
      lines.push_back(find_lines(masks.back()));
    }
    std::vector<StemView> views;
    for (std::size_t i = 0; i < cameras.size(); ++i)
      views.push_back({cameras[i], &masks[i], &lines[i]});
    return fit_stems(views, kVoxel, mesh);
  }

  std::vector<Camera> cameras;
  std::vector<test::Drawing> drawings;
};

/// How far the tube's vertices are from the rod's axis, its ends left out. Pixels.
struct Fit {
  double mean = 0, worst = 0;  ///< distance from the axis; greatest difference from the radius
};

Fit compare(const TriMesh& mesh, const Rod& rod) {
  Fit fit;
  int count = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const dvec3 p = mesh.world(i);
    if (std::min(glm::distance(p, rod.axis.front()), glm::distance(p, rod.axis.back())) <
        6 * kPixel)
      continue;
    const double distance = rod.distance(p);
    fit.mean += distance / kPixel, ++count;
    fit.worst = std::max(fit.worst, std::abs(distance - rod.radius) / kPixel);
  }
  fit.mean /= count;
  return fit;
}

const dvec3 kOff = 0.7 * kPixel * glm::normalize(dvec3(0.5, -0.8, 0.3));

TEST(FitStems, TubesBecomeAsThinAsTheMasksSayAndWhereTheySay) {
  for (const bool bent : {false, true})
    for (const double width : {0.4, 0.7, 1.0, 1.5, 2.0}) {
      const Rod rod = bent ? curved(width) : straight(width);
      TriMesh mesh;
      mesh.origin = {3, -2, 1};
      test::add_tube(rod, 1.5 * rod.radius, kOff, mesh);
      const TriMesh before = mesh;
      ASSERT_GT(compare(mesh, rod).worst, 0.5);
      EXPECT_GT(Views(rod).fit(mesh), 0.95 * double(mesh.positions.size()));
      const Fit fit = compare(mesh, rod);
      EXPECT_LT(fit.worst, bent ? 0.15 : 0.1) << width << " px wide, bent: " << bent;
      EXPECT_NEAR(fit.mean, 0.5 * width, 0.05) << width << " px wide, bent: " << bent;
      EXPECT_EQ(mesh.triangles, before.triangles);
      EXPECT_EQ(mesh.normals, before.normals);
      EXPECT_EQ(mesh.origin, before.origin);
      ASSERT_EQ(mesh.positions.size(), before.positions.size());
    }
}

TEST(FitStems, HardMasksTellTheMeanRadius) {
  for (const double width : {0.6, 0.8, 1.0, 1.5, 2.0}) {
    // The second one is upright in all views, and comes and goes in long dashes.
    for (const Rod& rod : {straight(width), test::straight_rod({-0.01, 0, -0.5}, {0.01, 0.004, 0.5},
                                                               0.5 * width * kPixel, 80)}) {
      TriMesh mesh;
      test::add_tube(rod, 1.5 * rod.radius, kOff, mesh);
      EXPECT_GT(Views(rod).fit(mesh, true), 0.85 * double(mesh.positions.size()));
      EXPECT_NEAR(compare(mesh, rod).mean, 0.5 * width, 0.1) << width;
    }
  }
}

TEST(FitStems, AThickBallBesideAStemDoesNotMove) {
  const dvec3 centre(0.15, -0.1, -0.45);
  const double radius = 0.2;
  const Rod rod = test::straight_rod({-0.5, 0.1, 0.2}, {0.5, 0.3, 0.4}, 0.5 * kPixel, 90);
  Views views(rod);
  for (std::size_t i = 0; i < views.cameras.size(); ++i) {
    const Camera& camera = views.cameras[i];
    const auto pixel = camera.project(centre);
    // As large as its cone, and round, near the middle of the image.
    const double depth = glm::distance(camera.center(), centre);
    views.drawings[i].add_disc(*pixel, kFocal * std::tan(std::asin(radius / depth)));
  }
  TriMesh mesh = test::sphere_mesh(centre, radius, 60);
  const std::size_t ball = mesh.positions.size();
  test::add_tube(rod, 1.5 * rod.radius, kOff, mesh);
  const TriMesh before = mesh;
  EXPECT_GT(views.fit(mesh), 300u);
  for (std::size_t i = 0; i < ball; ++i) ASSERT_EQ(mesh.positions[i], before.positions[i]);
}

TEST(FitStems, SheetsThatShowOnEdgeBecomeAsThinAsTheMasksSay) {
  // A disc in the plane of a ring of cameras: a line in each of them.
  const double half = 0.6 * kPixel, radius = 0.4;
  std::vector<Camera> cameras;
  for (int i = 0; i < 12; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.3) / 12;
    cameras.push_back(test::look_at(kDistance * dvec3(std::cos(angle), std::sin(angle), 0), {},
                                    kFocal, kSize, kSize, {0.3, 0.2, -1}));
  }
  Views views(cameras);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const dvec3 side = radius * glm::normalize(glm::cross(cameras[i].center(), dvec3(0, 0, 1)));
    const dvec3 up(0, 0, half);
    views.drawings[i].add({*cameras[i].project(side + up), *cameras[i].project(up - side),
                           *cameras[i].project(-side - up), *cameras[i].project(side - up)});
  }
  TriMesh mesh;
  const int n = int(radius / kVoxel);
  for (int face = 0; face < 2; ++face)
    for (int y = -n; y <= n; ++y)
      for (int x = -n; x <= n; ++x) {
        mesh.positions.emplace_back(x * kVoxel, y * kVoxel,
                                    (face ? 1.5 : -1.5) * half + kPixel / 2);
        mesh.normals.emplace_back(0, 0, face ? 1 : -1);
      }
  const TriMesh before = mesh;
  EXPECT_GT(views.fit(mesh), 0u);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (glm::length(glm::dvec2(before.positions[i])) > 0.9 * radius) continue;
    const dvec3 p = mesh.world(i);
    EXPECT_NEAR(p.z, (mesh.normals[i].z > 0 ? 1 : -1) * half, 0.15 * kPixel);
    EXPECT_LT(glm::distance(glm::dvec2(p), glm::dvec2(before.positions[i])), 0.2 * kPixel);
  }
}

TEST(FitStems, NothingMovesWithoutLines) {
  const Rod rod = straight(1);
  TriMesh mesh;
  test::add_tube(rod, 1.5 * rod.radius, kOff, mesh);
  const TriMesh before = mesh;
  Views views(rod);
  for (test::Drawing& d : views.drawings) d = test::Drawing(kSize, kSize);
  EXPECT_EQ(views.fit(mesh), 0u);
  EXPECT_EQ(fit_stems({}, kVoxel, mesh), 0u);
  std::vector<StemView> unknown(8);
  EXPECT_EQ(fit_stems(unknown, kVoxel, mesh), 0u);
  EXPECT_EQ(mesh.positions, before.positions);
  TriMesh empty;
  EXPECT_EQ(Views(rod).fit(empty), 0u);
}

TEST(FitStems, NothingMovesThatTooFewViewsShowAsALine) {
  const Rod rod = straight(1);
  TriMesh mesh;
  test::add_tube(rod, 1.5 * rod.radius, kOff, mesh);
  const TriMesh before = mesh;
  Views two(rod);
  two.cameras.resize(2), two.drawings.erase(two.drawings.begin() + 2, two.drawings.end());
  EXPECT_EQ(two.fit(mesh), 0u);
  Views four(rod);  // of 16
  for (std::size_t i = 4; i < four.drawings.size(); ++i)
    four.drawings[i] = test::Drawing(kSize, kSize);
  EXPECT_EQ(four.fit(mesh), 0u);
  EXPECT_EQ(mesh.positions, before.positions);
}

TEST(FitStems, ATubeFarFromAllLinesStays) {
  const Rod rod = straight(1);
  TriMesh mesh;
  test::add_tube(rod, 1.5 * rod.radius, 12.0 * kOff, mesh);
  const TriMesh before = mesh;
  EXPECT_EQ(Views(rod).fit(mesh), 0u);
  EXPECT_EQ(mesh.positions, before.positions);
}

}  // namespace
}  // namespace photohull::carving
