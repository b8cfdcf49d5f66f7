// What silhouettes say where photographs say little.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/describe.h"
#include "core/grid.h"
#include "refine/displacement.h"
#include "refine/surface.h"

namespace photohull::refine {

/// How far the hull can be believed, [0, 1]: at its own voxels, and, as these tell, where they are
/// halved once, twice and so on.
using HullTrust = std::array<double, 5>;

struct HullPriorOptions {
  double weight = 30, evidence = 0.2;
  /// How far the hull can be believed, where that is known already; it is no choice.
  std::optional<double> trust;
  /// What it returned for voxels twice as large, which counts where little is told at these;
  /// nothing: it was not asked. No choice either.
  std::optional<HullTrust> coarser;
};

inline void describe(Described& to, HullPriorOptions& o) {
  to.number("weight", &o.weight, from_to(0, 1000), "",
            "weight of a tight hull among the peaks, where nothing has texture; 0: none");
  to.number("evidence", &o.evidence, above(0, 1000), "",
            "mean weight of the peaks around at which the hull has lost its say, too");
}

/// What a patch at each surfel is worth, [0, 1].
struct PatchQuality {
  std::span<const float> texture;  ///< Matches::texture
  std::span<const float> trust;    ///< by the body behind it (trust_thickness)
};

/// Mixes into the peaks of vertices on the hull, or just under it, that they want to lie on it:
/// the less texture a vertex has (`patches.texture`), and the less the photographs tell around it,
/// the more it counts. The hull holds the object with room to spare: where noise makes single
/// peaks weak, many that agree still know better. A hull that is loose where photographs check it
/// is not believed where they do not: the weight falls with the fourth power of the share of what
/// they tell surely that lies on it. Nor is it at thin parts, which it makes too thick: the weight
/// falls with the square of `patches.trust`. Where photographs tell little surely, as where voxels
/// are far smaller than pixels, what they told at larger voxels stands. `positions` in voxels of
/// the hull's grid. Returns how far the hull can be believed.
HullTrust pull_to_hull(const SparseVolume& hull, const VertexGraph& graph,
                       std::span<const glm::vec3> positions, const PatchQuality& patches,
                       const HullPriorOptions& options, std::vector<Peak>& peaks);

}  // namespace photohull::refine
