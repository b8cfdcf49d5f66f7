#include "visibility/geometry.h"

#include <unordered_map>

#include "core/error.h"

namespace photohull::visibility {
namespace {

Box bounds_of(const TriMesh& mesh) {
  Box box{glm::dvec3(1e300), glm::dvec3(-1e300)};
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) {
      box.min = glm::min(box.min, mesh.world(vertex));
      box.max = glm::max(box.max, mesh.world(vertex));
    }
  return mesh.triangles.empty() ? Box{mesh.origin, mesh.origin} : box;
}

template <typename T>
gpu::Buffer buffer_of(const std::vector<T>& values) {
  return values.empty() ? gpu::Buffer(16) : gpu::Buffer::of(values);
}

}  // namespace

Geometry Geometry::of_mesh(const TriMesh& mesh) {
  Geometry g;
  g.triangle_count_ = mesh.triangles.size();
  g.bounds_ = bounds_of(mesh);
  g.origin_ = mesh.origin;
  g.positions_ = buffer_of(mesh.positions);
  g.indices_ = buffer_of(mesh.triangles);
  return g;
}

Geometry Geometry::of_volume(const SparseVolume& volume) {
  std::vector<std::uint32_t> bricks;
  Geometry g = of_mesh(voxel_faces(volume, &bricks));
  g.face_bricks_ = buffer_of(bricks);
  g.grid_ = volume.grid;
  g.table_ = buffer_of(volume.table);
  std::vector<std::uint32_t> words(volume.bricks.size() * (kBrickVoxels / 32));
  for (std::size_t i = 0; i < volume.distance.size(); ++i)
    if (volume.distance[i] < 0) words[i / 32] |= 1u << (i % 32);
  g.words_ = buffer_of(words);
  return g;
}

TriMesh voxel_faces(const SparseVolume& volume, std::vector<std::uint32_t>* brick_of_face) {
  TriMesh mesh;
  mesh.origin = volume.grid.origin;
  const float size = float(volume.grid.voxel_size);
  const glm::ivec3 corners = volume.grid.voxels() + 1;
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_at;
  const auto vertex = [&](const glm::ivec3& c) {
    const std::uint64_t key = (std::uint64_t(c.z) * std::uint64_t(corners.y) + std::uint64_t(c.y)) *
                                  std::uint64_t(corners.x) +
                              std::uint64_t(c.x);
    const auto [it, fresh] = vertex_at.try_emplace(key, std::uint32_t(mesh.positions.size()));
    if (fresh) mesh.positions.push_back((glm::vec3(c) - 0.5f) * size);
    return it->second;
  };
  const auto add_face = [&](const glm::ivec3& voxel, int axis, int side) {
    glm::ivec3 u(0), v(0), low = voxel;
    u[(axis + 1) % 3] = 1, v[(axis + 2) % 3] = 1;
    low[axis] += side > 0;
    const std::uint32_t a = vertex(low), b = vertex(low + u), c = vertex(low + u + v),
                        d = vertex(low + v);
    if (side > 0) {
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    } else {
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({a, d, c});
    }
    if (brick_of_face)
      brick_of_face->push_back(std::uint32_t(volume.grid.brick_index(voxel / kBrickEdge)));
  };
  const glm::ivec3 n = volume.grid.voxels();
  for (std::size_t index = 0; index < volume.table.size(); ++index) {
    if (volume.table[index] == SparseVolume::kOutside) continue;
    const glm::ivec3 b(int(index % volume.grid.bricks.x),
                       int(index / volume.grid.bricks.x % volume.grid.bricks.y),
                       int(index / volume.grid.bricks.x / volume.grid.bricks.y));
    for (int i = 0; i < kBrickVoxels; ++i) {
      const glm::ivec3 voxel = b * kBrickEdge + glm::ivec3(i >> 6, i >> 3 & 7, i & 7);
      if (volume.at(voxel) >= 0) continue;
      for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) {
          glm::ivec3 beside = voxel;
          beside[axis] += side;
          const bool on_grid = beside[axis] >= 0 && beside[axis] < n[axis];
          if (!on_grid || volume.at(beside) >= 0) add_face(voxel, axis, side);
        }
    }
  }
  return mesh;
}

}  // namespace photohull::visibility
