// Planes fitted to the photographs: where matching found the surface, to a fraction of a voxel. The
// kernel is kernels/fit_patches.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/describe.h"
#include "core/grid.h"
#include "refine/displacement.h"
#include "refine/match.h"
#include "refine/surface.h"
#include "refine/view_choice.h"

namespace photohull::refine {

struct FitOptions {
  int steps = 2, hold_out = 4;
  double least_spacing = 0.4, pixel_spacing = 1, noise = 0.6;
  double least_score = 0.3, full_score = 0.8, slope = 0.05;
  double largest_offset = 0.5, largest_step = 0.5, most_bend = 1;
  double unit_deviation = 0.1, most_weight = 4;
  /// Of the whole's grid, the voxel that a part's begins with: surfels at one place hold out alike.
  glm::ivec3 first_voxel{0};
};

inline void describe(Described& to, FitOptions& o) {
  to.number("steps", &o.steps, from_to(0, 100), "", "steps of Gauss and Newton in a pass");
  to.number("hold_out", &o.hold_out, at_least(0), "",
            "one surfel in so many leaves a view out, to tell whether a pass helps; 0: none does");
  to.number("least_spacing", &o.least_spacing, above(0, 1000), "voxels",
            "least distance between a patch's taps");
  to.number("pixel_spacing", &o.pixel_spacing, from_to(0, 1000), "pixels",
            "least distance between a patch's taps in the reference view");
  to.number("noise", &o.noise, from_to(0, 1), "",
            "share of the pixels' variance by noise that samples have");
  to.number("least_score", &o.least_score, from_to(-1, 1), "",
            "correlation with the other views below which a view has no weight");
  to.number("full_score", &o.full_score, from_to(-1, 1), "",
            "correlation with the other views from which a view has full weight");
  to.rule(o.least_score < o.full_score, "least_score", "must lie below", "full_score");
  to.number("slope", &o.slope, above(0, 1000), "", "standard deviation of the surfels' slopes");
  to.number("largest_offset", &o.largest_offset, below(0, SparseVolume::kBand), "voxels",
            "offset of a fit from which on it does not count");
  to.number("largest_step", &o.largest_step, above(0, 1000), "voxels", "longest step of a fit");
  to.number("most_bend", &o.most_bend, from_to(0, 1000), "1 / voxel",
            "largest curvature that a patch follows");
  to.number("unit_deviation", &o.unit_deviation, from_to(0, 1000), "voxels",
            "standard deviation of an offset that weighs 1");
  to.number("most_weight", &o.most_weight, above(0, 1000), "",
            "greatest weight of an offset when they are smoothed");
}

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

/// Tangents u and v as those of tangent_patch (shaders/include/patch.glsl), but of unit length.
struct TangentAxes {
  glm::dvec3 u, v;
};
TangentAxes tangent_axes(const glm::dvec3& normal);

/// A patch fitted to the photographs.
struct PatchFit {
  glm::vec3 normal{0};    ///< unit
  float offset = 0;       ///< voxels along the surfel's own normal
  float information = 0;  ///< on the offset, 1 / voxel^2
  float score = kNoScore;
  float held_before = kNoScore;  ///< score of the view that is held out, before the fit
  float held_after = kNoScore;   ///< the same after it
};

/// Voxels between the taps of each vertex's patch.
std::vector<float> tap_spacings(const GridSpec& grid, std::span<const glm::vec3> positions,
                                std::span<const Camera> cameras,
                                std::span<const ViewChoice> choices, const FitOptions& options);

/// The fitted offsets as peaks, weighed by their information: 1 at a standard deviation of
/// options.unit_deviation, never more than options.most_weight, both for taps a voxel apart. By the
/// inverse fourth power of the spacing, the surface is smoothed over as many pixels whatever the
/// voxels' size: more vertices share a tap's evidence, and smoothing must reach across more of
/// them.
std::vector<Peak> peaks_of(std::span<const PatchFit> results, std::span<const float> spacings,
                           const FitOptions& options);

/// Texture samples that fitting takes.
std::int64_t samples_of(std::span<const ViewChoice> choices, const FitOptions& options);

HeldOut held_out(std::span<const PatchFit> results);

}  // namespace photohull::refine
