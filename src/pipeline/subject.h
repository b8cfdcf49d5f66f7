// What is carved: views with their silhouettes, the box and the lattice. The stages from the hull
// on read it. Only `Reconstructor` gives it other views: divided by gains, or without the masks and
// pixels that are not needed any more.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "carving/hull.h"
#include "core/box.h"
#include "core/grid.h"
#include "core/prepared_view.h"
#include "core/scene.h"
#include "pipeline/reconstruct_options.h"

namespace photohull::pipeline {

struct Subject {
  Box box;
  std::string box_source;
  bool box_found = false;   ///< not given
  std::optional<Box> seen;  ///< around what the photographs show, where the box was found
  GridSpec grid;
  std::vector<PreparedView> views;  ///< undistorted, and around the box alone but for surroundings
  double noise_sigma = 0;           ///< of the photographs, square-root-encoded units of full scale
  double mask_confidence = 0;       ///< [0, 1]: the least of the views' that have masks
  double full_evidence = 0;         ///< pixels (carving::HullOptions)
  std::int64_t held_bytes = 0;      ///< for photographs that are matched larger (Plan::held_bytes)
};

bool any_mask(std::span<const PreparedView> views);

/// Parts of the views, which must outlive them: what the hull and the refinement go by.
std::vector<carving::Silhouette> silhouettes_of(std::span<const PreparedView> views);

/// nullptr for views without mask.
std::vector<const SilhouetteDistance*> distances_of(std::span<const PreparedView> views);

/// What the scene lists of each.
std::vector<SourceView> sources_of(std::span<const PreparedView> views);

/// Does anything after the hull go by masks? The other samplers weight by them, and lines get
/// their width from them.
bool masks_are_needed(const ReconstructOptions& options, std::span<const PreparedView> views);

/// To free memory; what was made of the masks stays.
std::vector<PreparedView> without_masks(std::vector<PreparedView> views);

/// To free memory: hulls cannot be carved any more.
void drop_distances(std::vector<PreparedView>& views);

/// To free memory: frees the pixels of the other photographs.
void keep_only_photograph(int kept, std::vector<PreparedView>& views);

}  // namespace photohull::pipeline
