// A textured wall under a row of cameras, and what may stand before it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "match_scene.h"
#include "support/analytic_volumes.h"

namespace photohull::refine {

inline constexpr double kWall = 12;  ///< voxels below are body
inline constexpr double kNever = std::numeric_limits<double>::infinity();

/// How far along a ray a body is entered; kNever where it is not. All in world units.
using Entry = std::function<double(const glm::dvec3& eye, const glm::dvec3& ray)>;

class WallScene : public ::testing::Test {
 protected:
  WallScene() {
    for (int i = 0; i < 7; ++i) {
      const double tilt = glm::radians(-36.0 + 12 * i);
      const glm::dvec3 target = test::kGrid.world({24, 24, kWall});
      PreparedView view;
      view.camera = test::look_at(target + 10.0 * glm::dvec3(std::sin(tilt), 0, std::cos(tilt)),
                                  target, 200, test::kImageEdge, test::kImageEdge, {0, 1, 0});
      views_.push_back(view);
    }
  }

  /// Noise with details of so many world units on the wall and on what stands before it.
  void photograph(double detail, const Entry& before) {
    const double z = test::kGrid.world({0, 0, kWall}).z;
    for (PreparedView& view : views_)
      view.image = test::ray_cast(
          view.camera,
          [&](const glm::dvec3& eye, const glm::dvec3& ray) {
            const double t = std::min((z - eye.z) / ray.z, before(eye, ray));
            return test::noise_colour(eye + t * ray, detail);
          },
          4);
  }

  std::vector<PreparedView> views_;
};

}  // namespace photohull::refine
