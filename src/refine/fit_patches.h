// Planes fitted to the photographs: where matching found the surface, to a fraction of a voxel.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.h"
#include "core/mesh.h"
#include "gpu/context.h"
#include "projtex/image_set.h"
#include "refine/displacement.h"
#include "refine/surface.h"
#include "shared/refine.h"

namespace photohull::refine {

struct FitOptions {
  int steps = 2;                ///< of Gauss and Newton
  int hold_out = 4;             ///< one surfel in so many leaves a view out; 0: none does
  double least_spacing = 0.4;   ///< of a patch's taps, voxels
  double pixel_spacing = 1.0;   ///< of a patch's taps, pixels of the reference view
  double noise = 0.6;           ///< share of the pixels' variance by noise that samples have
  double least_score = 0.3;     ///< correlation with the other views below which one has no weight
  double sure_score = 0.8;      ///< from which it has full weight
  double slope = 0.05;          ///< standard deviation of the surfels' slopes
  double largest_offset = 0.5;  ///< voxels; fits that reach it do not count
  double largest_step = 0.5;    ///< voxels
  double most_bend = 1.0;       ///< largest curvature that a patch follows, 1 / voxel
  double sure = 0.1;            ///< standard deviation (voxels) of an offset that weighs 1
  double most_weight = 4;       ///< of an offset in the regularisation
  double membrane = 30;         ///< as RegularizeOptions has them, for the fitted offsets
  double fairing = 3;
};

/// Standing of a surface in the views that were held out.
struct HeldOut {
  double before = 0, after = 0;  ///< mean correlations, in [-1, 1]
  std::size_t surfels = 0;
};

/// Curvature of the mesh at its vertices (unit normals; positions in voxels), smoothed over
/// neighbours: second derivatives of the height over the tangent plane, 1 / voxel, along uu, uv
/// and vv of tangent_axes(normal); negative where the body is convex. At most `most` in size.
std::vector<glm::vec3> curvatures(const VertexGraph& graph, std::span<const glm::vec3> positions,
                                  std::span<const glm::vec3> normals, double most);

/// Does a surfel at a position (voxels) leave a view out? The same in every pass, so that passes
/// can be compared.
bool holds_out(const glm::vec3& position, int one_in);

/// Unit tangents u and v, as patch_axes (shaders/include/patch.glsl) has them but for their length.
struct TangentAxes {
  glm::dvec3 u, v;
};
TangentAxes tangent_axes(const glm::dvec3& normal);

/// Fits a patch to every vertex of `mesh` (with normals), in the views that `choices` (from
/// match_patches, one per vertex) names: minimises over offset and slopes the robust squared
/// differences of the views' patches from their mean, gain and offset of each eliminated
/// [Goesele07; Furukawa10].
std::vector<shaders::FitResult> fit_patches(gpu::Context& context, const GridSpec& grid,
                                            const TriMesh& mesh, const VertexGraph& graph,
                                            const projtex::ImageSet& images,
                                            std::span<const Camera> cameras,
                                            std::span<const shaders::MatchChoice> choices,
                                            double noise_sigma, const FitOptions& options);

/// Voxels between the taps of each vertex's patch.
std::vector<float> tap_spacings(const GridSpec& grid, std::span<const glm::vec3> positions,
                                std::span<const Camera> cameras,
                                std::span<const shaders::MatchChoice> choices,
                                const FitOptions& options);

/// The fitted offsets as peaks, weighed by their information: 1 at a standard deviation of
/// options.sure, never more than options.most_weight, both for taps a voxel apart. By the inverse
/// fourth power of the spacing, the surface is smoothed over as many pixels whatever the voxels'
/// size: more vertices share a tap's evidence, and smoothing must reach across more of them.
std::vector<Peak> peaks_of(std::span<const shaders::FitResult> results,
                           std::span<const float> spacings, const FitOptions& options);

/// Texture samples that fitting takes.
std::int64_t samples_of(std::span<const shaders::MatchChoice> choices, const FitOptions& options);

HeldOut held_out(std::span<const shaders::FitResult> results);

}  // namespace photohull::refine
