// What a reconstruction says of itself, without knowing the truth (docs/measurements/verdict.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "assess/common_error.h"
#include "assess/explained.h"
#include "assess/match_probes.h"

namespace photohull::assess {

/// What the verdict rests on. Shares are in [0, 1].
struct Signals {
  int views = 0;                   ///< that were used
  bool masks = false;              ///< has any view a silhouette?
  double stems = 0;                ///< share of the mesh's vertices that silhouettes' lines placed
  double stems_restored = 0;       ///< of what silhouettes show of stems: put into eaten masks
  bool hull = false;               ///< is the surface the silhouettes' alone (--method hull)?
  double mask_confidence = 0;      ///< 1 for masks that were given
  double cameras_within = 0;       ///< share of the cameras that stand inside the box
  double pixel_size = 0;           ///< world units that a pixel covers at the object
  double voxel_size = 0;           ///< world units
  int resolution = 0;              ///< voxels along the box's longest side
  double far = 0;                  ///< world units: half a percent of the surface's diagonal
  double cameras_moved = 0;        ///< pixels, by --refine-cameras
  double cameras_moved_alike = 0;  ///< pixels, of it what all views have in common
  double contradiction = 0;        ///< share of the silhouettes that no hull of all views fills
  double missed = 0, excess = 0;   ///< SilhouetteFit, means over the views
  double missed_width = 0;         ///< pixels, mean width of what is missed
  double beyond_box = 0;           ///< SilhouetteFit, mean over the views
  double beyond_views = 0;         ///< share of the views that show something beyond the box
  double mean_confidence = 0;      ///< of the surface, the unseen with 0
  double unsure = 0;               ///< share of the surface with confidence below one half
  double unseen = 0;               ///< share of the surface that no view sees
  double few_views = 0;            ///< share of the surface that fewer than three views see
  double at_box = 0;               ///< share of the surface, seen, that lies on the box's sides
  double hull_beyond = 1;          ///< share of the hull's surface that goes on beyond the box
  MatchEvidence match;
  Explained explained;  ///< without places unless no view has a silhouette
  Explained compared;   ///< where silhouettes bound it: places on the surface alone
  CommonError common;   ///< that the views' outlines have
};

enum class Level { kGood, kDoubtful, kFailed };

const char* to_string(Level level);

struct Verdict {
  Level level = Level::kGood;
  std::vector<std::string> reasons;  ///< sentences: what is wrong, and what to do; empty if good
  std::vector<std::string> notes;    ///< what a result of this kind means, however good
  std::string coverage;              ///< how much of the surface is seen; no matter of quality
};

/// `names` are the views', in the order of signals.match.views.
Verdict judge(const Signals& signals, const std::vector<std::string>& names);

}  // namespace photohull::assess
