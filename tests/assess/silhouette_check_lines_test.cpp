// Lines of masks, and masks that are in doubt, against surfaces.
#include <gtest/gtest.h>

#include "assess/silhouette_check.h"
#include "carving/rods.h"
#include "masks/mask_lines.h"
#include "masks/silhouette.h"
#include "meshes.h"
#include "support/silhouettes.h"

namespace photohull::assess {
namespace {

using glm::dvec3;
using test::Rod;

constexpr double kTolerance = 1.5;
const Box kBox{dvec3(-1), dvec3(1)};
const std::vector<Camera> kCameras = test::cameras_around({0, 0, 0}, 5, 6, 180, 120, 90);
constexpr double kPixel = 5.0 / 180;
const dvec3 kBall(0.2, 0.1, -0.5);
constexpr double kBallRadius = 0.3;

/// As long and as wide as each other.
const Rod kOne = test::straight_rod({-0.6, -0.3, 0.2}, {0.5, -0.2, 0.6}, 0.4 * kPixel, 40);
const Rod kOther = test::straight_rod({-0.5, 0.4, 0.1}, {0.6, 0.5, 0.5}, 0.4 * kPixel, 40);

struct Shown {
  explicit Shown(const std::vector<Rod>& rods, bool ball = false) {
    for (const Camera& camera : kCameras) {
      test::Drawing drawing(camera.intrinsics.width, camera.intrinsics.height);
      for (const Rod& rod : rods) draw(rod, camera, drawing);
      masks.push_back(drawing.mask());
      lines.push_back(find_lines(masks.back()));
      if (ball) {
        const test::Outline outline = test::sphere_outline(camera, kBall, kBallRadius);
        for (std::size_t i = 0; i < outline.mask.coverage.size(); ++i)
          masks.back().coverage[i] = std::max(masks.back().coverage[i], outline.mask.coverage[i]);
      }
      distances.push_back(silhouette_distance(masks.back()));
    }
  }

  /// Means over all views.
  SilhouetteFit check(const TriMesh& mesh) const {
    std::vector<CheckedSilhouette> silhouettes;
    for (std::size_t i = 0; i < masks.size(); ++i)
      silhouettes.push_back({&distances[i], &distances[i], &lines[i]});
    SilhouetteFit mean;
    for (const SilhouetteFit& fit :
         check_silhouettes(RayScene(mesh), kBox, kCameras, silhouettes, kTolerance)) {
      mean.missed += fit.missed / double(masks.size());
      mean.excess += fit.excess / double(masks.size());
      mean.foreground += fit.foreground;
    }
    return mean;
  }

  std::vector<Mask> masks;
  std::vector<std::vector<LinePoint>> lines;
  std::vector<SilhouetteDistance> distances;
};

TriMesh tubes(const std::vector<Rod>& rods, double pixels = 0.15, double beside = 0) {
  TriMesh mesh;
  for (const Rod& rod : rods)
    test::add_tube(rod, pixels * kPixel, dvec3(0, 0, beside * kPixel), mesh);
  return mesh;
}

TEST(SilhouetteCheckLines, ALineThatAThinTubeCoversIsNotMissed) {
  const SilhouetteFit fit = Shown({kOne, kOther}).check(tubes({kOne, kOther}));
  EXPECT_GT(fit.foreground, 300);
  EXPECT_LT(fit.missed, 0.03);  // at its ends
  EXPECT_EQ(fit.excess, 0);
}

TEST(SilhouetteCheckLines, ALineWithoutSurfaceIsMissedByItsShare) {
  const Shown both({kOne, kOther});
  EXPECT_NEAR(both.check(tubes({kOne})).missed, 0.5, 0.06);
  EXPECT_NEAR(both.check(tubes({kOther})).missed, 0.5, 0.06);
  EXPECT_DOUBLE_EQ(Shown({kOne}).check(test::sphere_mesh({0, 0, -0.7}, 0.1, 20)).missed, 1);
}

TEST(SilhouetteCheckLines, LinesCountByTheirArea) {
  TriMesh mesh = test::sphere_mesh(kBall, kBallRadius, 60);
  const SilhouetteFit fit = Shown({kOne}, true).check(mesh);
  // The rod's length is seen at slants; what lies within the tolerance of the ball's outline does
  // not count.
  const double line = 0.8 * glm::distance(kOne.axis.front(), kOne.axis.back()) / kPixel;
  const double ball = 3.14 * std::pow(kBallRadius / kPixel - kTolerance, 2);
  EXPECT_NEAR(fit.missed, 0.85 * line / (0.85 * line + ball), 0.05);
  test::add_tube(kOne, 0.15 * kPixel, {}, mesh);
  EXPECT_LT(Shown({kOne}, true).check(mesh).missed, 0.01);
}

TEST(SilhouetteCheckLines, CoveredWithinTheToleranceOnly) {
  const Shown one({kOne});
  EXPECT_LT(one.check(tubes({kOne}, 0.15, 1)).missed, 0.05);
  EXPECT_GT(one.check(tubes({kOne}, 0.15, 8)).missed, 0.4);
}

TEST(SilhouetteCheckLines, ExcessIsJudgedByWhatWasUsed) {
  const TriMesh mesh = test::sphere_mesh({0, 0, 0}, 0.6, 60);
  const RayScene rays(mesh);
  const test::Outline given = test::sphere_outline(kCameras[0], {0, 0, 0}, 0.5);
  const test::Outline used = test::sphere_outline(kCameras[0], {0, 0, 0}, 0.6);
  const auto excess = [&](const test::Outline& u) {
    const std::vector<CheckedSilhouette> one{{&given.distance, &u.distance}};
    return check_silhouettes(rays, kBox, std::span(kCameras).first(1), one, 1)[0].excess;
  };
  EXPECT_GT(excess(given), 0.2);
  EXPECT_EQ(excess(used), 0);
}

TEST(SilhouetteCheckLines, MissedIsJudgedByWhatWasGiven) {
  const RayScene rays(test::sphere_mesh({0, 0, 0}, 0.4, 60));
  const test::Outline given = test::sphere_outline(kCameras[0], {0, 0, 0}, 0.4);
  const test::Outline used = test::sphere_outline(kCameras[0], {0, 0, 0}, 0.6);
  const std::vector<CheckedSilhouette> one{{&given.distance, &used.distance}};
  EXPECT_EQ(check_silhouettes(rays, kBox, std::span(kCameras).first(1), one, 1)[0].missed, 0);
}

TEST(SilhouetteCheckLines, LinesInDoubtCountLittle) {
  // Of two lines as long as each other the surface lacks the one of which the mask is hardly sure.
  const Camera& camera = kCameras[0];
  Mask mask{120, 90, std::vector<std::uint8_t>(120 * 90, 0)};
  std::vector<LinePoint> lines;
  for (int y = 20; y < 70; ++y) {
    mask.coverage[std::size_t(y * 120 + 40)] = 255, mask.coverage[std::size_t(y * 120 + 80)] = 140;
    lines.push_back({40, float(y), 1, 0, 1}), lines.push_back({80, float(y), 1, 0, 1});
  }
  const SilhouetteDistance distance = silhouette_distance(mask);
  TriMesh plate;
  for (const glm::dvec2& p : {glm::dvec2(35, 15), {45, 15}, {45, 75}, {35, 75}})
    plate.positions.emplace_back(camera.center() + 5.0 * camera.ray(p));
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  const RayScene rays(plate);
  const auto missed = [&](const Mask* sure) {
    const std::vector<CheckedSilhouette> one{{&distance, &distance, &lines, sure}};
    return check_silhouettes(rays, kBox, std::span(kCameras).first(1), one, kTolerance)[0].missed;
  };
  EXPECT_NEAR(missed(nullptr), 0.5, 0.1);
  EXPECT_NEAR(missed(&mask), 0.09, 0.03);  // 140 / 127.5 - 1 against 1
}

TEST(SilhouetteCheckLines, ForegroundInDoubtCountsLittle) {
  // The surface lacks the right half of what the mask shows, of which it is hardly sure.
  const Camera& camera = kCameras[0];
  test::Drawing drawing(120, 90);
  drawing.add({{30, 30}, {59.5, 30}, {59.5, 60}, {30, 60}});
  Mask mask = drawing.mask();
  for (int y = 30; y < 60; ++y)
    for (int x = 60; x < 90; ++x) mask.coverage[std::size_t(y * 120 + x)] = 140;
  const SilhouetteDistance distance = silhouette_distance(mask);
  // A plate across the left half of the view.
  TriMesh plate;
  for (const glm::dvec2& p : {glm::dvec2(20, 20), {59.5, 20}, {59.5, 70}, {20, 70}})
    plate.positions.emplace_back(camera.center() + 5.0 * camera.ray(p));
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  const RayScene rays(plate);
  const auto missed = [&](const Mask* sure) {
    const std::vector<CheckedSilhouette> one{{&distance, &distance, nullptr, sure}};
    return check_silhouettes(rays, kBox, std::span(kCameras).first(1), one, 1)[0].missed;
  };
  EXPECT_NEAR(missed(nullptr), 0.5, 0.03);
  EXPECT_NEAR(missed(&mask), 0.09, 0.02);
}

TEST(CoversLine, LooksAcrossAndAlong) {
  // A dash of one point says nothing of its direction.
  const Camera& camera = kCameras[0];
  const RayScene rays(tubes({kOne}));
  const glm::dvec2 a = *camera.project(kOne.axis[18]), b = *camera.project(kOne.axis[22]);
  const glm::dvec2 along = glm::normalize(b - a), across(-along.y, along.x);
  const auto covers = [&](double off, const glm::dvec2& normal) {
    const glm::dvec2 p = 0.5 * (a + b) + off * across;
    return covers_line(rays, camera, {float(p.x), float(p.y), float(normal.x), float(normal.y), 1},
                       kTolerance);
  };
  for (const double off : {-1.3, 0.0, 1.3}) {
    EXPECT_TRUE(covers(off, across)) << off;
    EXPECT_TRUE(covers(off, along)) << off;
  }
  EXPECT_FALSE(covers(2.5, across));
  EXPECT_FALSE(covers(-2.5, along));
}

}  // namespace
}  // namespace photohull::assess
