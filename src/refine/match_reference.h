// Double-precision references of the kernels that match patches, written from the definitions.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "projtex/gpu_views.h"
#include "projtex/project_layer_reference.h"
#include "refine/match.h"
#include "shared/depth_map.h"

namespace photohull::refine::reference {

/// What the references need of one view.
struct MatchView {
  projtex::GridCamera camera;
  shaders::DepthMapInfo depth_info;
  std::vector<double> depths;  ///< voxels, row-major as depth_info says
  std::vector<projtex::reference::LinearImage> mips;
  double sharpness = 1;  ///< as ImageSet has it
};

/// How a step in space moves the pixel position of a point: the projection's derivative.
glm::dvec2 derivative(const projtex::GridCamera& camera, const glm::dvec3& at,
                      const glm::dvec3& step);

/// Square-root encoded colour; `pixel` counts in pixels of level 0, borders are repeated.
glm::dvec3 sample(const MatchView& view, const glm::dvec2& pixel, int level);

struct Choice {
  std::vector<int> views;   ///< the reference view first; at most ViewChoice::kMostViews
  int seen = 0;             ///< views that see the surfel
  std::vector<int> hidden;  ///< the most frontal of those in whose frame something hides it
};

/// The views that a surfel (voxel coordinates; unit outward normal, or zero) is matched in
/// (refine_choose_views.comp.glsl). The worthiest view that sees it is the reference. The others
/// follow by falling worth, a third of it for near-duplicates of what was chosen, among those of
/// the ViewChoice::kCandidates worthiest whose angle to the reference lies in the options' range.
/// Worth is the cosine between normal and direction times the fourth power of the view's sharpness:
/// the square of its gradients' energy, which places a patch. Least cosines are of the direction
/// alone.
///
/// `ties`: a choice that is taken where it is the best but for rounding.
Choice choose_views(std::span<const MatchView> views, const glm::dvec3& position,
                    const glm::dvec3& normal, const MatchOptions& options,
                    std::span<const int> ties = {});

struct Patch {
  glm::dvec3 centre{0.0};  ///< voxel coordinates
  glm::dvec3 normal{0.0};  ///< unit
  int radius = kPatchRadius;
  glm::dvec3 bend{0.0};  ///< curvature along uu, uv, vv of the patch's axes, 1 / voxel
};

/// Score in [-1, 1] of a patch in the chosen views (the reference view first), kNoScore below two
/// (refine_match_patches.comp.glsl): the mean of the best share of the correlations with the
/// reference view. Zero-mean normalised cross-correlation over the three channels together, the
/// variance of each patch raised by variance_floor; taps on a square lattice in the tangent plane
/// (beyond a radius of 1 on every other place, as on a chessboard) or in the paraboloid of the
/// bend, projected by the derivatives at the centre, bilinear at the mip level nearest to the size
/// of a tap's footprint.
double match_patch(std::span<const MatchView> views, std::span<const int> chosen,
                   const Patch& patch, double noise_sigma, const MatchOptions& options);

/// Share of the variance of the patch in the reference view that noise does not explain; 1 below
/// two views.
double texture_of(std::span<const MatchView> views, std::span<const int> chosen, const Patch& patch,
                  double noise_sigma, const MatchOptions& options);

}  // namespace photohull::refine::reference
