// Which way is up in a scene.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "core/camera.h"

namespace photohull::render {

/// The direction (unit, world) that is upward in the photographs, or beside where cameras were
/// turned on their sides and circle the object all the same: the axis that most of them share as
/// one of theirs. Where they do not say which end of it is up, as with cameras that were turned
/// about, it is the one on the cameras' side of `middle` (world, of the object), or else the one
/// towards the positive axes. +z without cameras.
glm::dvec3 scene_up(std::span<const Camera> cameras, const glm::dvec3& middle);

}  // namespace photohull::render
