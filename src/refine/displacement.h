// From scores against offsets to one displacement for each vertex.
#pragma once

#include <span>
#include <vector>

#include "core/describe.h"
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
  double least_score = 0.3, full_score = 0.8, thick = 4;
};

inline void describe(Described& to, PeakOptions& o) {
  to.number("least_score", &o.least_score, from_to(-1, 1), "",
            "score of a curve's peak below which it is no evidence");
  to.number("full_score", &o.full_score, from_to(-1, 1), "",
            "score of a curve's peak from which it has full weight");
  to.rule(o.least_score < o.full_score, "least_score", "must lie below", "full_score");
  to.number("thick", &o.thick, above(0, 1000), "voxels",
            "body behind a vertex that gives full weight");
}

/// The best interior maximum of each curve, to a fraction of a step by a parabola. What known noise
/// takes from a true match's correlation (Matches::texture) is made up for.
std::vector<Peak> find_peaks(const Matches& matches, const PeakOptions& options);

struct RegularizeOptions {
  double membrane = 2, fairing = 0.4, robust = 1;
  int reweightings = 3, iterations = 15;
};

inline void describe(Described& to, RegularizeOptions& o) {
  to.number("membrane", &o.membrane, at_least(0), "",
            "weight of a difference between neighbours' displacements");
  to.number("fairing", &o.fairing, at_least(0), "",
            "weight of the moved surface's bending otherwise than its neighbours");
  to.number("robust", &o.robust, above(0), "voxels",
            "distance from the smooth surface at which a peak counts a quarter");
  to.number("reweightings", &o.reweightings, at_least(0), "",
            "rounds of weighting peaks by how far they are from the smooth surface");
  to.number("iterations", &o.iterations, at_least(1), "",
            "iterations of Jacobi's method for each reweighting");
}

/// Least squares on the surface graph: displacements near the peaks, by their weights, and smooth.
/// `positions` (voxels) and unit `normals` are the vertices', and `fair` in [0, 1] is the share of
/// the fairing that acts on each.
std::vector<float> regularize(const VertexGraph& graph, const std::vector<Peak>& peaks,
                              std::span<const glm::vec3> positions,
                              std::span<const glm::vec3> normals, std::span<const float> fair,
                              const RegularizeOptions& options);

}  // namespace photohull::refine
