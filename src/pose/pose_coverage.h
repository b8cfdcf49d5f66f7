// What is said of photographs with poses, and the picture of their sides.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/scene.h"
#include "pipeline/check_photographs.h"
#include "pipeline/coverage_picture.h"

namespace photohull::pose {

/// Photographs that were looked at, and where those stand that have a pose.
struct PosedSides {
  std::span<const pipeline::PhotoLook> looks;
  std::span<const SourceView> views;
  glm::dvec3 middle{0.0}, up{0.0};  ///< world; unit
  std::vector<pipeline::LeftOutPhoto> left_out;
};

/// Where the photograph was taken, as PosedSides has middle and up.
pipeline::SkyPlace place_of(const PosedSides& sides, const SourceView& view);

/// Writes coverage.png into the folder. Returns pipeline::check_photographs' warnings. Throws Error
/// where the picture cannot be written.
std::vector<std::string> check_sides(const std::filesystem::path& folder, const PosedSides& sides);

}  // namespace photohull::pose
