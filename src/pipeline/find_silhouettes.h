// The stage that turns masks into silhouettes to carve by: outlines where the photographs have
// them, views that contradict all others left out, and room for what cannot be known better.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "core/box.h"
#include "core/prepared_view.h"
#include "core/progress.h"
#include "pipeline/findings.h"
#include "pipeline/reconstruct_options.h"

namespace photohull::pipeline {

struct FoundSilhouettes {
  std::vector<PreparedView> views;  ///< those that are left, with silhouettes
  double full_evidence = 0;         ///< pixels (carving::HullOptions)
  SilhouetteFindings findings;
};

/// What the stage goes by.
struct SilhouetteJob {
  const ReconstructOptions& options;
  const Box& box;
  const std::set<std::string>& right_cameras;  ///< names of views
  const ViewFindings& photographs;             ///< their noise, scale and masks
};

/// In this order: distances to the masks' outlines; views that are strongly blurred go; masks that
/// are all too small or too large are moved, and what they have lost of stems is put back; lines
/// and outlines are traced; views that contradict all others go; outlines that are off get as much
/// room; stems get the room that voxels need; what most masks show is put into those that leave it
/// out.
FoundSilhouettes find_silhouettes(const SilhouetteJob& job, std::vector<PreparedView> views,
                                  Progress& progress);

}  // namespace photohull::pipeline
