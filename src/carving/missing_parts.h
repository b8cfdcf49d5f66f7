// What masks show and the visual hull lacks, because some cameras or masks are off.
#pragma once

#include <span>
#include <vector>

#include "carving/hull.h"
#include "core/box.h"
#include "core/camera.h"
#include "core/describe.h"
#include "core/progress.h"

namespace photohull::carving {

struct MissingOptions {
  double most_missing = 0.34;
  int least_support = 3;
  double support_share = 0.15, full_miss = 2;
};

inline void describe(Described& to, MissingOptions& o) {
  to.affects(Stage::kHull);
  to.number("most_missing", &o.most_missing, from_to(0, 0.5), "",
            "share of the views that may leave a place out and it is taken all the same");
  to.number("least_support", &o.least_support, at_least(1), "",
            "views in which a place must fall on foreground that no hull explains");
  to.number("support_share", &o.support_share, from_to(0, 1), "",
            "share of the views that have a place on their image in which it must fall on "
            "foreground that no hull explains");
  to.number("full_miss", &o.full_miss, from_to(0.5, 100), "pixels",
            "distance beside an outline at which a view leaves a place out altogether; nearer "
            "ones count in part");
}

/// A ball that belongs to the object. World units.
struct MissingPart {
  glm::dvec3 centre{0.0};
  double radius = 0;
};

/// What became of the foreground of one view.
struct ForegroundCounts {
  int looked_at = 0;    ///< places of the foreground whose rays were searched
  int unexplained = 0;  ///< of these, with no point that all silhouettes bear
  int placed = 0;       ///< of the unexplained, given a place that most views bear
};

struct MissingParts {
  std::vector<MissingPart> parts;
  std::vector<ForegroundCounts> views;  ///< one for each camera; zeros where there is no silhouette
};

/// Searches the rays of the silhouettes' lines, and of a lattice of places well within thicker
/// foreground, for a point that every silhouette bears. Where a ray has none in the box, nor in the
/// box twice as large, the point is taken that most views bear, if at least
/// 1 - most_missing of those that see it do and enough of them show unexplained foreground there,
/// too. Views that do not have a point on their image say nothing about it. `silhouettes`: one for
/// each camera; those without a distance count as not there. Throws Cancelled when `progress` was
/// asked to stop.
MissingParts find_missing_parts(const Box& box, std::span<const Camera> cameras,
                                std::span<const Silhouette> silhouettes,
                                const MissingOptions& options, Progress* progress = nullptr);

/// How parts are drawn into a silhouette, pixels.
struct Mending {
  double from = 0;  ///< signed distance from the outline, from where on a part lacks in the view
  double room = 0;  ///< around a part
};
/// For masks that may be trusted, where what lacks are sub-pixel parts: each gets room for what
/// cameras and interpolation err, where it is not well within the outline anyway.
constexpr Mending kMendThinParts{-0.1, 0.75};
/// For masks that are wrong in places, where parts of any width lack: only views that leave a part
/// out altogether get it, or all views would be mended until the object is too thick.
constexpr Mending kMendGaps{0.35, 0};

/// Draws the parts into a view's silhouette where it lacks them. `distance` is that of `mask`. Was
/// there any?
bool mend_silhouette(std::span<const MissingPart> parts, const Camera& camera,
                     const SilhouetteDistance& distance, const Mending& mending, Mask& mask);

}  // namespace photohull::carving
