// Lines of photographs that are one thing in space.
#pragma once

#include <span>
#include <vector>

#include "carving/hull.h"
#include "core/box.h"
#include "core/camera.h"
#include "core/progress.h"

namespace photohull::carving {

struct ConfirmOptions {
  /// Share of the views that may show neither foreground nor a line at a place, [0, 0.5].
  double most_missing = 0.34;
  /// Views in which a line runs through the place along one direction in space, at least, and
  /// their share of the views that have it on their image.
  int least_support = 4;
  double support_share = 0.25;
  /// Pixels from its own view's mask within which a line needs no other lines: the tip of a leaf,
  /// which other views show from its broad side.
  double continues_mask = 0;
};

struct ConfirmedLines {
  std::vector<std::vector<LinePoint>> lines;  ///< one list for each view
  std::vector<glm::dvec3> places;             ///< in space, one for each of their points
};

/// Of each view's candidates (masks/photo_lines.h) those that views confirm: there is a place on
/// the point's ray, in the box, at which most of the views that see it have foreground or a
/// candidate, and enough of them a candidate that runs along the same direction in space. Lines are
/// then followed as far as most views have anything there. Views without a distance say nothing,
/// and their candidates are dropped. `silhouettes`: mask and distance of each camera's view; lines
/// are not used. Throws Cancelled when `progress` was asked to stop.
ConfirmedLines confirm_lines(const Box& box, std::span<const Camera> cameras,
                             std::span<const Silhouette> silhouettes,
                             std::vector<std::vector<LinePoint>> candidates,
                             const ConfirmOptions& options, Progress* progress = nullptr);

}  // namespace photohull::carving
