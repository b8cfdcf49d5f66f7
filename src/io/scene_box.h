// Where a scene's region of interest comes from. Internal to io.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/box.h"

namespace photohull::io {

/// Throws Error opening with `source` unless the box is finite and its min below its max.
void check_box(const Box& box, const std::string& source);

/// Gives the box its smaller corner first. Returns the axes along which that changes it: "x, z".
std::string sort_corners(Box& box);

/// Six numbers, smallest corner first, from a folder's bbox.txt; nothing where there is none.
/// Throws Error when the file holds anything else.
std::optional<Box> read_bbox_file(const std::filesystem::path& folder);

/// The two corners after the words "bounding box" in a Middlebury README.txt, each on a line of
/// its own as "(x y z)"; nothing where the folder's README says no such thing.
std::optional<Box> read_readme_box(const std::filesystem::path& folder);

/// A box around most of the sparse points: per axis the 2nd to the 98th percentile, grown on both
/// sides by 10 % of that extent, at least by 1 % of the diagonal. Nothing for fewer than 10 points
/// or when they coincide.
std::optional<Box> box_of_points(const std::vector<glm::dvec3>& points);

}  // namespace photohull::io
