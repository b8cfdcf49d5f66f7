// Cameras for tests.
#pragma once

#include <random>
#include <vector>

#include "core/box.h"
#include "core/camera.h"

namespace photohull::test {

using Rng = std::mt19937_64;

double uniform(Rng& rng, double low, double high);
/// A point in the box.
glm::dvec3 uniform_in(Rng& rng, const Box& box);
glm::dvec3 random_direction(Rng& rng);

/// A camera at `eye` that looks at `target`, square pixels, the principal point in the middle.
/// `down` is the direction in the world that the image's y axis leans to.
Camera look_at(const glm::dvec3& eye, const glm::dvec3& target, double focal, int width, int height,
               const glm::dvec3& down = {0, 0, -1});

/// The camera turned by about so many pixels at the middle of its image, each `index` another way.
Camera put_off(const Camera& camera, double pixels, int index);

/// A camera of random position, roll, focal length, aspect, skew and principal point that has most
/// of the box in view, from one to three diagonals away.
Camera random_camera(Rng& rng, const Box& box, int width, int height);

/// `count` cameras spread evenly over the sphere of `distance` around `target`.
std::vector<Camera> cameras_around(const glm::dvec3& target, double distance, int count,
                                   double focal, int width, int height);

}  // namespace photohull::test
