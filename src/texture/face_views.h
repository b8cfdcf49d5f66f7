// Private to module texture: which photographs show a triangle, and how well.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "core/prepared_view.h"
#include "core/progress.h"

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
FaceViews find_face_views(const TriMesh& mesh, std::span<const PreparedView> views, double scale,
                          Progress& progress);

/// Calls `f(i)` for each view, in parallel, but few at a time: each holds maps of its photograph.
void for_views(std::size_t count, const std::function<void(std::size_t)>& f);

}  // namespace photohull::texture
