// The box as a picture that helps to correct it by hand.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cameras/scene_points.h"
#include "core/scene.h"

namespace photohull::pipeline {

/// 8-bit sRGB, row-major from the top-left.
struct BoxPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// The scene's box drawn into up to three photographs that see it from different sides, with its
/// corners' coordinates, its x, y and z edges in red, green and blue, and a magnified part with
/// voxels of `voxel_size` (world); and a plan of box, cameras and `points` (any, world) seen from
/// above, with a ruler. Decodes these photographs alone, at their `scales`, one for each view of
/// the scene, which is in its files' pixels and must have a box. Throws Error where a photograph
/// cannot be read.
BoxPicture draw_box(const Scene& scene, std::span<const double> scales, double voxel_size,
                    std::span<const ScenePoint> points);

}  // namespace photohull::pipeline
