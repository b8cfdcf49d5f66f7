// How large photographs are read, so that they cost what the voxels need.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/box.h"
#include "core/scene.h"
#include "pipeline/photographs.h"

namespace photohull::pipeline {

/// Pixels, along an edge, that the smallest voxels keep at the least when photographs are reduced.
/// docs/guide/limits.md has the comparison that it comes from.
inline constexpr double kPixelsPerVoxel = 3;

/// Reads "1/4" or "0.25"; nothing for what is not in (0, 1].
std::optional<double> parse_image_scale(const std::string& text);

/// "1", "1/8" or "0.3".
std::string image_scale_text(double scale);

/// For every view the scale to read it at, 1 or a half of it again and again: pixels are no coarser
/// at the box's centre than 1/kPixelsPerVoxel voxels. That is so for the median of all views and
/// for that of the views whose photographs are as large, which get the same scale (a background
/// that they share stays comparable). Pictures of 640 x 480 pixels cost less than the voxels do:
/// none becomes smaller than that.
std::vector<double> image_scales(const Box& box, std::span<const SourceView> views,
                                 double voxel_size);

/// Halves the scales of views that stay above 640 x 480 pixels, and whose pixels, by the same
/// medians, stay no larger than a voxel. False, and nothing changed, where there is no such view.
bool halve_image_scales(const Box& box, std::span<const SourceView> views, double voxel_size,
                        std::vector<double>& scales);

/// Scales below 1 become 1 where the photograph's header tells another size than the camera is for,
/// or cannot be read: decoding tells what is wrong.
void keep_unexpected_sizes(const PhotographReader& reader, std::span<const SourceView> views,
                           std::vector<double>& scales);

/// The scene as its photographs are at these scales: intrinsics and places of tracks.
void scale_scene(std::span<const double> scales, Scene& scene);

}  // namespace photohull::pipeline
