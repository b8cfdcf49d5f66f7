// Private to module texture: which photographs show a triangle, and how well.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "core/progress.h"
#include "texture/view_sources.h"

namespace photohull::texture {

/// A photograph that a triangle may have its colours from.
struct FaceView {
  std::uint32_t view = 0;
  float quality = 0;  ///< beside the triangle's best; 0 of those that nothing shows clearly
};

/// The photographs of every triangle, in their order: those that show it clear of outlines. Where
/// there are none, those whose cameras it faces: it can lie on their charts all the same.
struct FaceViews {
  std::vector<std::size_t> first;  ///< of each triangle, and one more: its end
  std::vector<FaceView> views;
  std::vector<std::uint8_t> clear;  ///< of each triangle: does any show it?

  std::span<const FaceView> of(std::size_t face) const {
    return {views.data() + first[face], first[face + 1] - first[face]};
  }
};

/// Quality is the share of the triangle's pixels that are clear, squared, times its size in the
/// photograph (so it falls with distance and angle), times the photograph's sharpness to the
/// fourth power, less where outlines are near or where the colour is not the mesh's own there: a
/// highlight, or something that the mesh does not have. In parallel; the same for any number of
/// threads. Throws Cancelled.
FaceViews find_face_views(const TriMesh& mesh, std::span<const PreparedView> views,
                          ViewSources& sources, Progress& progress);

/// How much one photograph counts at each vertex, [0, 1]: the mean of its qualities in the
/// triangles around, so that it changes steadily over the surface and is 0 where it shows nothing
/// clearly.
std::vector<float> weights_at_vertices(const TriMesh& mesh, const FaceViews& views,
                                       std::uint32_t view);

}  // namespace photohull::texture
