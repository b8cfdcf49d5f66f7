// Rays before an inclined plane, and rays that meet no known surface.
#include "refine/ray_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "projtex/gpu_views.h"
#include "refine/ray_maps.h"
#include "refine/ray_partners.h"
#include "support/gl_context.h"
#include "wall_scene.h"

namespace photohull::refine {
namespace {

using glm::dvec3;

const dvec3 kOn(24, 24, 22), kNormal = glm::normalize(dvec3(1, 0, 1));  // voxels; 45 degrees
constexpr int kEdge = 16;                                               // rays

class RaySearchTest : public WallScene {
 protected:
  RaySearchTest() {
    const dvec3 on = test::kGrid.world(kOn);
    photograph(0.12, [&](const dvec3& eye, const dvec3& ray) {
      const double t = glm::dot(on - eye, kNormal) / glm::dot(ray, kNormal);
      return t > 0 ? t : kNever;
    });
    for (const Camera& camera : projtex::cameras_of(views_))
      cameras_.push_back(projtex::to_grid(camera, test::kGrid));
    partners_ = choose_partners(cameras_, {dvec3(0), dvec3(test::kGrid.voxels())},
                                VoteOptions{}.nearest_partner, 1);
    // From the middle view through points of the plane that lie well before the wall.
    const dvec3 eye = cameras_[kView].centre;
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x) {
        const dvec3 across(16.0 + x, 16.0 + y, 0);
        const dvec3 p(across.x, across.y, kOn.z + kOn.x - across.x);
        const dvec3 d = glm::normalize(p - eye);
        rays_.push_back({x, y, p - 12.0 * d, d, 24, 1, -1});
      }
  }

  std::vector<Finding> search(const VoteOptions& options, std::vector<Finding> findings) {
    gpu::Context& context = test::gl_context();
    const projtex::ImageSet images(views_);
    const RaySearch search(context, images, cameras_, 0.01, options);
    search.sweep(rays_, partners_[kView], findings);
    search.spread(rays_, kEdge, kEdge, partners_[kView], findings);
    return findings;
  }
  std::vector<Finding> search(const VoteOptions& options) {
    return search(options, std::vector<Finding>(rays_.size()));
  }

  /// Over all rays: the median distance from the truth in voxels, and the angle of the normal in
  /// degrees.
  static std::pair<double, double> errors(const std::vector<Finding>& findings) {
    std::vector<double> off, turned;
    for (const Finding& found : findings) {
      off.push_back(std::abs(found.along - 12));
      turned.push_back(
          glm::degrees(std::acos(std::clamp(glm::dot(found.normal, kNormal), -1.0, 1.0))));
    }
    const auto median = [](std::vector<double>& v) {
      std::nth_element(v.begin(), v.begin() + long(v.size() / 2), v.end());
      return v[v.size() / 2];
    };
    return {median(off), median(turned)};
  }

  static constexpr std::size_t kView = 3;
  std::vector<projtex::GridCamera> cameras_;
  std::vector<ViewPartners> partners_;
  std::vector<Ray> rays_;
};

TEST_F(RaySearchTest, PlanesTurnToTheSurface) {
  VoteOptions options;
  options.rounds = 0;
  const auto [off, turned] = errors(search(options));
  options.rounds = 3;
  const auto [off_after, turned_after] = errors(search(options));
  EXPECT_LT(off, 1);
  EXPECT_NEAR(turned, 45, 12);  // patches of the sweep face the camera
  EXPECT_LT(off_after, off);
  EXPECT_LT(turned_after, 0.5 * turned);
}

TEST_F(RaySearchTest, ScoresNeverFall) {
  VoteOptions options;
  options.rounds = 0;
  const std::vector<Finding> before = search(options);
  options.rounds = 2;
  const std::vector<Finding> after = search(options);
  int better = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_GE(after[i].score, before[i].score);
    EXPECT_EQ(after[i].moved, after[i].score > before[i].score);
    better += after[i].moved;
  }
  EXPECT_GT(better, int(before.size()) / 2);
}

TEST_F(RaySearchTest, WhatFoundNothingWorthTellingIsLeftOut) {
  VoteOptions options;
  options.least_score = 1.25;  // no score is near it
  for (const Finding& found : search(options)) EXPECT_FALSE(found.moved);
}

TEST_F(RaySearchTest, WhatIsKnownStaysAndSpreads) {
  std::vector<Finding> findings(rays_.size());
  for (std::size_t i = 0; i < rays_.size(); i += 2) {
    findings[i].known = true;
    findings[i].along = 12;
    findings[i].normal = kNormal;
  }
  VoteOptions options;
  options.rounds = 1;
  const std::vector<Finding> after = search(options, findings);
  int taken = 0;
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    if (i % 2 == 0) {
      EXPECT_EQ(after[i].along, 12);
      EXPECT_EQ(after[i].normal, kNormal);
    } else {
      taken += std::abs(after[i].along - 12) < 0.3;
    }
  }
  EXPECT_GT(taken, 0.6 * double(rays_.size()) / 2);
}

TEST_F(RaySearchTest, LeadIsOverWhatWasSweptElsewhere) {
  Finding found;
  found.swept = {0.65f, 0.6f, 0.7f, 0.8f, 0.5f, 0.3f, 0.9f, 0.4f, 0.3f};
  found.along = 6;
  found.score = 0.9f;
  EXPECT_NEAR(found.lead(), 0.9 - 0.8, 1e-6);
  found.along = 5;  // 0.8 is beside now, and 0.7 only its slope
  EXPECT_NEAR(found.lead(), 0.9 - 0.7, 1e-6);
  found.moved = true;
  EXPECT_NEAR(found.lead(), 0.9 - 0.65, 1e-6);  // the only peak elsewhere
}

/// A surface that the left half of the wall's rays meet.
class BareRays : public WallScene {
 protected:
  BareRays() {
    photograph(0.12, [](const dvec3&, const dvec3&) { return kNever; });
  }

  /// Shares of the rays left and right of the surface's edge that say something.
  std::pair<double, double> told(int reach) {
    SparseVolume hull = sample_volume(test::kGrid.bricks, box(dvec3(6, 6, 2), dvec3(42, 42, 36)));
    SparseVolume half = sample_volume(test::kGrid.bricks, [](const dvec3& p) {
      return std::max(box(dvec3(6, 6, 2), dvec3(42, 42, 36))(p), std::max(p.z - kWall, p.x - 16));
    });
    hull.grid = half.grid = test::kGrid;
    VoteOptions options;
    options.bare_reach = reach;
    gpu::Context& context = test::gl_context();  // before the images need it
    const projtex::ImageSet images(views_);
    const std::vector<Camera> cameras = projtex::cameras_of(views_);
    const RayMap map = match_rays_again(context, hull, half, {images, cameras, 0.01}, options)[3];
    int count[2] = {0, 0}, all[2] = {0, 0};
    for (int y = map.height / 3; y < 2 * map.height / 3; ++y)
      for (int x = map.width / 4; x < 3 * map.width / 4; ++x) {
        // The camera looks down on the wall from z, x to the left or to the right.
        const bool right = x >= map.width / 2;
        ++all[right];
        count[right] += map.weight[std::size_t(y) * map.width + x] > 0;
      }
    return {count[0] / double(all[0]), count[1] / double(all[1])};
  }
};

TEST_F(BareRays, OnlyThoseVoteThatAreAsNearToASurfaceAsAsked) {
  const auto none = told(0), few = told(2), all = told(1 << 20);
  const double least_none = std::min(none.first, none.second);
  EXPECT_LT(least_none, 0.1);
  EXPECT_GT(std::max(none.first, none.second), 0.3);
  EXPECT_GT(std::min(all.first, all.second), 0.7);
  EXPECT_LT(few.first + few.second, all.first + all.second - 0.3);
  EXPECT_GT(few.first + few.second, none.first + none.second);
}

TEST_F(BareRays, PlainBackgroundIsNotSearched) {
  for (PreparedView& view : views_)
    view.image = {test::kImageEdge, test::kImageEdge, ColourImage::Encoding::kSrgb8, false,
                  std::vector<std::uint8_t>(4 * 64 * 64, 120)};
  const auto [left, right] = told(1 << 20);
  EXPECT_EQ(left, 0);
  EXPECT_EQ(right, 0);
}

}  // namespace
}  // namespace photohull::refine
