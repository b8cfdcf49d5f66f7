// What hides: meshes and volumes on the device.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/box.h"
#include "core/grid.h"
#include "core/mesh.h"
#include "gpu/buffer.h"

namespace photohull::visibility {

/// Triangles, and for volumes the voxels too. Both sides of a triangle hide.
class Geometry {
 public:
  /// May be empty. Throws Error when the device cannot hold it.
  static Geometry of_mesh(const TriMesh& mesh);
  /// The voxels of negative distance: their exposed faces as triangles, and the bricks for
  /// marching.
  static Geometry of_volume(const SparseVolume& volume);

  std::size_t triangles() const { return triangle_count_; }
  bool is_volume() const { return grid_.voxel_size > 0; }
  /// Of the triangles, world coordinates; positions are relative to `origin`.
  const Box& bounds() const { return bounds_; }
  const glm::dvec3& origin() const { return origin_; }
  const gpu::Buffer& positions() const { return positions_; }  ///< three floats a vertex
  const gpu::Buffer& indices() const { return indices_; }      ///< three words a triangle
  const GridSpec& grid() const { return grid_; }
  /// Volumes: per brick of the grid a slot, kInside or kOutside; 16 words a slot, as
  /// carving::BitVolume.
  const gpu::Buffer& table() const { return table_; }
  const gpu::Buffer& words() const { return words_; }
  /// Volumes: the brick of each pair of triangles.
  const gpu::Buffer& face_bricks() const { return face_bricks_; }

 private:
  std::size_t triangle_count_ = 0;
  Box bounds_;
  glm::dvec3 origin_{0.0};
  GridSpec grid_;
  gpu::Buffer positions_, indices_, table_, words_, face_bricks_;
};

/// The exposed faces of the voxels of negative distance, two triangles each, counter-clockwise seen
/// from outside; `brick_of_face` takes the brick's index of each pair.
TriMesh voxel_faces(const SparseVolume& volume,
                    std::vector<std::uint32_t>* brick_of_face = nullptr);

}  // namespace photohull::visibility
