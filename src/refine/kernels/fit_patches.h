// Patches fitted to the photographs (refine_fit_patches.comp.glsl).
#pragma once

#include <span>
#include <vector>

#include "gpu/context.h"
#include "refine/fit_patches.h"
#include "refine/matching_photographs.h"
#include "refine/surface.h"
#include "refine/view_choice.h"

namespace photohull::refine {

/// Surfels of one grid, one of each a surfel.
struct SurfelShapes {
  std::vector<glm::vec3> positions;  ///< voxels
  std::vector<glm::vec3> normals;    ///< unit
  std::vector<glm::vec3> bends;      ///< as curvatures() gives them
};

/// The vertices of a mesh with normals.
SurfelShapes shapes_of(const MeshSurfels& surfels, const FitOptions& options);
/// What is known of surfels before they are fitted.
std::vector<PatchFit> unfitted(std::span<const glm::vec3> normals);

/// Fits a patch to every vertex of the surfels' mesh (with normals), in the views that `choices`
/// (one a vertex) names: minimises over offset and slopes the robust squared differences of the
/// views' patches from their mean, gain and offset of each eliminated [Goesele07; Furukawa10].
/// Patches follow the mesh's curvature. Throws Error when the device cannot hold a batch.
std::vector<PatchFit> fit_patches(gpu::Context& context, const MeshSurfels& surfels,
                                  const MatchingPhotographs& photographs,
                                  std::span<const ViewChoice> choices, const FitOptions& options);

/// The same of surfels by themselves.
std::vector<PatchFit> fit_surfels(gpu::Context& context, const GridSpec& grid,
                                  const SurfelShapes& surfels,
                                  const MatchingPhotographs& photographs,
                                  std::span<const ViewChoice> choices, const FitOptions& options);

}  // namespace photohull::refine
