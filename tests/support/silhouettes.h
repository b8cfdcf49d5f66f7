// Silhouettes whose contour is known.
#pragma once

#include <functional>

#include "core/camera.h"
#include "core/image.h"
#include "core/silhouette.h"
#include "support/cameras.h"

namespace photohull::test {

/// A mask and the distances that belong to it.
struct Outline {
  Mask mask;
  SilhouetteDistance distance;
};

/// Signed distance in pixels at a pixel position, negative inside.
using Shape = std::function<double(const glm::dvec2& pixel)>;

/// Coverage as a straight edge at the same distance would give.
Outline rasterise(int width, int height, const Shape& shape);

/// A union of a few random discs, some of them across the border.
Outline random_outline(Rng& rng, int width, int height);

/// What a camera outside a sphere sees of it.
Outline sphere_outline(const Camera& camera, const glm::dvec3& centre, double radius);

/// What a camera sees of a cylinder with flat ends that are left out: a wire from a to b.
Outline wire_outline(const Camera& camera, const glm::dvec3& a, const glm::dvec3& b, double radius);

}  // namespace photohull::test
