// Where the voxels lie: the box made as small as the object, the lattice in it, and of the
// photographs what the box can touch.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/box.h"
#include "core/grid.h"
#include "core/prepared_view.h"
#include "core/progress.h"
#include "pipeline/reconstruct_options.h"

namespace photohull::pipeline {

/// The object's own box where `box` is much larger than what the views' silhouettes leave, and may
/// be changed.
std::optional<Box> smaller_box(const ReconstructOptions& options, const Box& box,
                               const std::vector<PreparedView>& views);

struct SourcedBox {
  Box box;
  std::string source;
};

/// A box that is much larger than the object would waste the voxels, and far from the object few
/// views see what silhouettes do not reject: it becomes the object's own, with a warning.
SourcedBox tighten_box(const ReconstructOptions& options, const SourcedBox& given,
                       const std::vector<PreparedView>& views, Progress& progress);

/// The lattice that the options ask for. Throws Error where cameras stand in a box that silhouettes
/// bound, and where without these the voxels do not fit into memory.
GridSpec place_lattice(const ReconstructOptions& options, const SourcedBox& box,
                       const std::vector<PreparedView>& views);

/// Is what surrounds the box to be reconstructed too, if silhouettes do not bound the object?
bool has_surroundings(const ReconstructOptions& options, bool box_found,
                      const std::vector<PreparedView>& views);

inline constexpr int kCropMargin = 24;  ///< pixels around the box's projection: patches, mip levels

/// Views of the pixels that the box can touch alone.
std::vector<PreparedView> crop_views(std::vector<PreparedView> views, const Box& box);

}  // namespace photohull::pipeline
