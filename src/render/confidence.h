// How sure a surface is: the chance that it lies within a voxel of the true one, from what the
// photographs say of it.
#pragma once

#include <span>
#include <vector>

#include "core/mesh.h"

namespace photohull::render {

/// What the views that see a vertex best say of it. Colours are square roots of linear light, full
/// scale 1; fine detail is a colour less the mean of the pixels around it (kBakeDetailLevels).
struct SurfaceEvidence {
  float views = 0;              ///< whose colours are compared; 0: nobody sees the vertex
  float scatter = 0;            ///< sum |u - mean u|^2, u the unit directions to all that see it
  float disagreement = 0;       ///< mean squared distance of the views from the vertex's colour
  float fine_disagreement = 0;  ///< mean squared distance of their fine detail from its mean
  float fine_energy = 0;        ///< mean square of their fine detail
  float seeing = 0;             ///< all views that see the vertex, where `views` is above 0
};

/// The same of a vertex and its surroundings, about two voxels wide.
struct PooledEvidence {
  bool seen = false;
  float scatter = 0;       ///< mean
  float disagreement = 0;  ///< standard deviation between views, > 0
  float fine_share = 1;    ///< of fine detail that differs between views: 1 says nothing, 0 agrees
  float views = 0;         ///< of the vertex itself: SurfaceEvidence::views
  float seeing = 0;        ///< the same: SurfaceEvidence::seeing
};

/// What shaped a surface.
enum class Shaping { kSilhouettes, kPhotographs };

/// Sums the evidence of each seen vertex and of the seen ones around it. Variances are over the
/// degrees of freedom, so that a view alone says nothing; a weak prior stands in where all are
/// alone.
std::vector<PooledEvidence> pool_evidence(const TriMesh& mesh,
                                          std::span<const SurfaceEvidence> evidence);

/// The chance that a vertex lies within a voxel of the true surface, in (0, 1); 0 where nobody sees
/// it. A logistic function that falls with disagreement and share and rises with scatter, the
/// same for all scenes [NiculescuMizilCaruana05]; fitted by `python3 -m bench fit_confidence`.
double confidence_of(const PooledEvidence& evidence, Shaping shaping);

}  // namespace photohull::render
