// The box as a picture that helps to correct it by hand.
#pragma once

#include <span>

#include "cameras/scene_points.h"
#include "core/rgb_image.h"
#include "core/scene.h"

namespace photohull::pipeline {

/// The scene's box drawn into up to three photographs that see it from different sides, with its
/// corners' coordinates, its x, y and z edges in red, green and blue, and a magnified part with
/// voxels of `voxel_size` (world); and a plan of box, cameras and `points` (any, world) seen from
/// above, with a ruler. Decodes these photographs alone, at their `scales`, one for each view of
/// the scene, which is in its files' pixels and must have a box. Throws Error where a photograph
/// cannot be read.
RgbImage draw_box(const Scene& scene, std::span<const double> scales, double voxel_size,
                  std::span<const ScenePoint> points);

}  // namespace photohull::pipeline
