// How far tracks and tangents are from agreeing with cameras. Internal to cameras.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "cameras/feature_tracks.h"
#include "cameras/frontier.h"
#include "core/camera.h"

namespace photohull {

/// Standard deviation of one coordinate, were the residuals' lengths those of two normal ones.
double spread_of_lengths(std::vector<double> lengths);
/// Standard deviation of normal residuals, given without their signs.
double spread_of_distances(std::vector<double> distances);

/// Points of tracks by the cameras, NaN where there is none, and the tracks' residuals.
struct Triangulated {
  std::vector<glm::dvec3> points;
  std::vector<double> rms;
};

Triangulated triangulate_all(std::span<const Camera> cameras, std::span<const Track> tracks);

/// Of both pixels of each pair from the other's epipolar line, pixels.
std::vector<double> tangent_distances(std::span<const Camera> cameras,
                                      std::span<const FrontierPair> tangents);

/// Mean of log(1 + r^2 / (2 sigma^2)), r at most 10 sigma, as which residuals that are not finite
/// count: matches that were wrong from the start outweigh nothing, wherever they come to lie.
double robust_cost(const std::vector<double>& residuals, double sigma);

}  // namespace photohull
