// Colours of a mesh's vertices from the photographs that see them best.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid.h"
#include "core/image.h"
#include "core/mesh.h"
#include "core/progress.h"
#include "gpu/context.h"
#include "projtex/gpu_views.h"
#include "projtex/photographs.h"
#include "render/confidence.h"
#include "shared/depth_map.h"

namespace photohull {

struct BakeReport {
  std::int64_t vertices = 0;
  std::int64_t seen = 0;                         ///< by at least one view
  double mean_confidence = 0;                    ///< over the seen vertices
  std::vector<render::PooledEvidence> evidence;  ///< of every vertex: what confidence came from
};

/// Fills mesh.colours and mesh.confidence.
///
/// A view sees a vertex when the cosine c between normal and viewing direction exceeds
/// kBakeMinCosine, the vertex lies in front of the camera and on its image, and nothing of the mesh
/// hides the point kBakeShift voxels above it in depth maps of voxel-sized texels [Williams78].
/// Each view weighs w = c^3 (focal / depth)^2 q^8, q its sharpness where others of the same are
/// sharper (ImageSet::sharpness), and the kMaxBakeViews heaviest give their colours, sampled
/// at the mip level on which a pixel is a voxel large. Distances d between colours are taken on
/// square roots of linear light, where noise is even. The colour is the mean in linear
/// light with the weights w / (1 + (d / s)^2)^2, d from the medoid (the sample with the least
/// weighted sum of distances) and s two noise deviations plus the medoid's mean distance: a
/// highlight that one view sees has next to no say.
///
/// Confidence is the chance that the vertex lies within a voxel of the true surface, from how well
/// those colours agree around it (render/confidence.h); `shaping` says what shaped the mesh. The
/// means in SurfaceEvidence have the weights w.
///
/// A vertex that nobody sees has confidence 0 and takes the colours of its nearest seen neighbours
/// along the mesh; pieces of mesh that nobody sees at all take the mean colour of the rest.
///
/// `photographs.noise_sigma` is > 0. mesh.normals must be present, a zero normal makes its vertex
/// unseen. `grid` gives the size of a voxel, about the spacing of the vertices; coarser meshes are
/// sampled in between. Throws Error when the device cannot hold the data, Cancelled.
BakeReport bake_colour(gpu::Context& context, const GridSpec& grid,
                       const projtex::Photographs& photographs, render::Shaping shaping,
                       TriMesh& mesh, Progress& progress);

namespace render {

/// Gives every vertex of confidence 0 the mean colour of its neighbours along triangles, ring by
/// ring outward from the others. What is not reached takes the mean of the seen, or mid grey.
void fill_unseen(TriMesh& mesh);

namespace reference {

/// What the reference needs of one view.
struct BakeView {
  projtex::GridCamera camera;
  shaders::DepthMapInfo depth_info;
  std::vector<double> depths;  ///< voxels, row-major as depth_info says
  const ColourImage* image = nullptr;
  double sharpness = 1;  ///< as ImageSet has it
};

struct BakedVertex {
  glm::dvec3 colour{0.0};    ///< linear
  SurfaceEvidence evidence;  ///< of 0 views: the colour is black
};

/// Draws a point that faces the camera into a map, as the kernel does.
void splat_point(const glm::dvec3& position, const glm::dvec3& normal, BakeView& view);

/// The same as the kernel for one vertex (position in voxel coordinates), in double precision.
BakedVertex bake_vertex(std::span<const BakeView> views, double noise_sigma,
                        const glm::dvec3& position, const glm::dvec3& normal);

/// Linear RGBA at a pixel position of a mip level: bilinear between means of 2^level squared
/// pixels, borders repeated.
glm::dvec4 sample(const ColourImage& image, const glm::dvec2& pixel, int level);

}  // namespace reference
}  // namespace render
}  // namespace photohull
