// A model on a turntable.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/camera.h"
#include "core/describe.h"
#include "core/mesh.h"
#include "render/choose_views.h"

namespace photohull::render {

struct TurntableOptions {
  int frames = 120;       ///< of one turn
  double elevation = 15;  ///< degrees that the camera stands above the model's middle
};

void describe(Described& to, TurntableOptions& options);

/// What a picture shows: all of the camera's image, from the nearest depth to the farthest.
struct Shot {
  Camera camera;
  Window window;
};

/// The cameras of one turn around the mesh, evenly from the side of `from` (world; any place), with
/// `up` (unit, world) upward. The axis goes through the middle of the mesh's bounds along `up` and
/// across it. The camera's distance is the same in all, such that all of the mesh stays in every
/// picture of `width` x `height` pixels with a margin around it. The mesh must have vertices.
std::vector<Shot> turntable(const TriMesh& mesh, const glm::dvec3& up, const glm::dvec3& from,
                            const TurntableOptions& options, int width, int height);

/// What a camera sees of the mesh on a picture of `width` x `height` pixels: all of its own image,
/// and more beside it where that has other proportions.
Shot seen_from(const TriMesh& mesh, const Camera& camera, int width, int height);

}  // namespace photohull::render
