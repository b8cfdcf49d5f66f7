// Space that photographs show to be free, because what lies behind it looks the same in them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/describe.h"
#include "core/grid.h"
#include "gpu/context.h"
#include "refine/displacement.h"
#include "refine/match.h"
#include "refine/matching_photographs.h"
#include "refine/view_choice.h"

namespace photohull::refine {

struct LookOptions {
  double least_score = 0.9, margin = 2;
  int least_lines = 2;
};

inline void describe(Described& to, LookOptions& o) {
  to.number("least_score", &o.least_score, from_to(-1, 1), "",
            "score of a surfel taken for surface, and of a view taken to show it");
  to.number("margin", &o.margin, from_to(0, 1000), "voxels",
            "height above such surface in which voxels stay");
  to.number("least_lines", &o.least_lines, at_least(1), "", "lines of sight that free a voxel");
}

/// The surface as matching found it: surfels at their peaks (voxels), with unit normals and the
/// views that they were matched in; only those whose score is at least LookOptions::least_score.
struct KnownSurface {
  std::vector<glm::vec3> positions, normals;
  std::vector<float> weights;  ///< of their peaks
  std::vector<ViewChoice> choices;
};

KnownSurface known_surface(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                           std::span<const Peak> peaks, std::span<const ViewChoice> choices,
                           const LookOptions& options);

/// A camera sees along this line, from a point a little above the surface on.
struct Sightline {
  glm::vec3 from{0};  ///< voxels
  int view = 0;
};

/// Lines of sight that the volume blocks and should not: from known surface to views that it is
/// hidden from (ViewChoice::hidden) and that show it all the same, by correlation with the view
/// nearest in direction that it was matched in.
std::vector<Sightline> find_sightlines(gpu::Context& context, const GridSpec& grid,
                                       const KnownSurface& known,
                                       const MatchingPhotographs& photographs,
                                       const MatchOptions& match, const LookOptions& options);

/// Takes out of the volume what enough lines of sight pass through, and then, a few times, voxels
/// that have more freed or empty neighbours than others; not the voxels about known surface.
/// Returns how many were freed. Their distance is a guess until it is measured anew.
std::size_t free_sightlines(std::span<const Sightline> lines,
                            std::span<const glm::vec3> known_positions,
                            std::span<const Camera> cameras, const LookOptions& options,
                            SparseVolume& volume);

}  // namespace photohull::refine
