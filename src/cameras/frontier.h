// Silhouettes against each other: the planes through two cameras that touch the object touch both
// silhouettes [Cipolla00; Wong01]. Needs no surface and no texture.
#pragma once

#include <span>
#include <vector>

#include "core/image.h"
#include "core/prepared_view.h"
#include "core/silhouette.h"

namespace photohull {

/// The convex hull of a silhouette's contour, to sub-pixel places, counter-clockwise as seen with y
/// up; empty where there is no contour.
struct Outline {
  std::vector<glm::dvec2> corners;
  int width = 0, height = 0;  ///< of the image
};

Outline outline_of(const Mask& mask);
/// `lines`: of the mask (find_lines).
Outline outline_of(const Mask& mask, std::span<const LinePoint> lines);
/// One for each view, empty where it has no mask.
std::vector<Outline> outlines_of(std::span<const PreparedView> views);

/// Where a tangent plane through two cameras touches each one's silhouette.
struct FrontierPair {
  int view_a = 0, view_b = 0;
  glm::dvec2 pixel_a{0.0}, pixel_b{0.0};
};

/// Both tangents of every pair of views whose epipoles are outside the outlines; those that touch
/// within two pixels of the frame are left out.
std::vector<FrontierPair> frontier_pairs(std::span<const Camera> cameras,
                                         std::span<const Outline> outlines);

/// Distances of each pixel from the other's epipolar line, pixels.
glm::dvec2 epipolar_distances(const Camera& a, const Camera& b, const FrontierPair& pair);

}  // namespace photohull
