// Photographs that a scene lists and that cannot be used: which, why, and whether enough remain.
#pragma once

#include <vector>

#include "core/scene.h"

namespace photohull {

/// A job goes on without some of the photographs while at least this many remain ...
inline constexpr std::size_t kFewestRemaining = 3;
/// ... and at least two of three: with more gone, it is the folder or the scene file that is the
/// wrong one, and the views that are left need not lie around the object any more.
inline constexpr double kLeastRemainingShare = 2.0 / 3.0;

/// Takes the views out whose entry in `keep` (one a view) is false. Tracks keep their observations
/// in the others, by the new indices; those that are left with fewer than two go.
void keep_views(Scene& scene, const std::vector<bool>& keep);

/// Notes photographs that are no longer among scene.views: adds them to scene.left_out, lowers
/// scene.usable_share, and returns a warning for each kind of reason, which counts them and names
/// the first. Throws Error instead, with the counts, names, reasons and what to do, when too few
/// views remain of those that were chosen, over all calls for the scene, or when `strict` and
/// `unusable` is not empty.
std::vector<std::string> note_left_out(Scene& scene, const std::vector<LeftOutView>& unusable,
                                       bool strict);

}  // namespace photohull
