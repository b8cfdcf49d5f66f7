// What must be true of a scene before and after carving, said in the user's words.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "carving/hull.h"
#include "core/prepared_view.h"
#include "core/scene.h"

namespace photohull::pipeline {

/// Throws Error when the scene has no usable box or no camera has it on its image; returns warnings
/// about cameras that miss it.
std::vector<std::string> check_box(const Box& box, const std::string& source,
                                   std::span<const SourceView> views);

/// Why cameras and box, as they stand, cannot show any shape: all cameras in one place, or a box of
/// a few pixels in every view. Nothing where they can.
std::optional<std::string> hopeless_setup(const Box& box, const std::string& source,
                                          std::span<const SourceView> views);

/// How many cameras stand inside the box.
std::size_t cameras_within(const Box& box, std::span<const SourceView> views);

/// "; N of M cameras stand inside the box", with what to do: the end of a sentence that says that
/// nothing was found. Empty where none does.
std::string sentence_about_cameras(const Box& box, const std::string& source,
                                   std::span<const SourceView> views);

/// Throws Error when a camera stands inside the box.
void check_cameras_outside(const Box& box, const std::string& source,
                           std::span<const SourceView> views);

/// What a job takes.
struct MemoryNeed {
  std::int64_t bytes = 0;  ///< in all
  std::int64_t fixed = 0;  ///< of these, what it takes however few voxels it has
  double voxel_size = 0;   ///< world units
};

/// Throws TooManyVoxels when a job would exceed `limit`.
void check_memory(const MemoryNeed& need, std::int64_t limit);

/// Why nothing of the box is left: voxels that are too large, or the views whose silhouettes alone
/// remove the most of it. `silhouettes`: one for each view, as the hull had them.
std::string explain_empty_hull(const Box& box, std::span<const PreparedView> views,
                               std::span<const carving::Silhouette> silhouettes, double voxel_size);

}  // namespace photohull::pipeline
