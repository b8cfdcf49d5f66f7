// From scores against offsets to one displacement for each vertex.
#pragma once

#include <span>
#include <vector>

#include "core/mesh.h"
#include "refine/match.h"
#include "refine/surface.h"

namespace photohull::refine {

/// Mixes each vertex's score curve with the mean of its neighbours', `passes` times over;
/// unknown scores take no part.
void aggregate(const VertexGraph& graph, int passes, Matches& matches);

/// Where a vertex wants to go: nowhere known when weight is 0.
struct Peak {
  float offset = 0;  ///< voxels along the normal
  float weight = 0;  ///< [0, 1]
  float score = 0;   ///< [-1, 1]
};

struct PeakOptions {
  double least_score = 0.3;  ///< below: no evidence
  double sure_score = 0.8;   ///< above: full weight
  double thick = 4;          ///< voxels of body behind a vertex that give full weight
  double distinct_by = 0.1;  ///< lead over the second peak that gives full weight
};

/// The best interior maximum of each curve, to a fraction of a step by a parabola. What known noise
/// takes from a true match's correlation (Matches::texture) is made up for.
std::vector<Peak> find_peaks(const Matches& matches, const PeakOptions& options);

struct RegularizeOptions {
  double membrane = 2.0;  ///< weight of a difference between neighbours' displacements
  double fairing = 0.4;   ///< weight of the moved surface's bending otherwise than its neighbours
  double robust = 1.0;    ///< voxels from the smooth surface at which a peak counts a quarter
  int reweightings = 3;
  int iterations = 15;  ///< of Jacobi's method for each reweighting
};

/// Least squares on the surface graph: displacements near the peaks, by their weights, and smooth.
/// `positions` (voxels) and unit `normals` are the vertices', and `fair` in [0, 1] is the share of
/// the fairing that acts on each.
std::vector<float> regularize(const VertexGraph& graph, const std::vector<Peak>& peaks,
                              std::span<const glm::vec3> positions,
                              std::span<const glm::vec3> normals, std::span<const float> fair,
                              const RegularizeOptions& options);

}  // namespace photohull::refine
