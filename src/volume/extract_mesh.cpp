// Mesh extraction by OpenVDB's dual contouring of signs (Museth, "VDB: High-resolution sparse
// volumes with dynamic topology", 2013; tools/VolumeToMesh.h).
#include "volume/extract_mesh.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "volume/fill_tree.h"
#include "volume/write_vdb.h"

#ifdef OPENVDB_USE_EXPLICIT_INSTANTIATION
// The library's own code of it serves: half of the time to compile this file went into another.
extern template void openvdb::tools::VolumeToMesh::operator()<openvdb::FloatGrid>(
    const openvdb::FloatGrid&);
#endif

namespace photohull {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
using Accessor = openvdb::tree::ValueAccessor<openvdb::FloatTree, false>;

/// Distances nearer to zero than this are moved away from it. A surface that passes through a
/// voxel's centre would otherwise give cells whose vertices coincide: triangles without area.
constexpr float kLeastDistance = 0.005f;  // voxels

/// 1 - cosine of the angle between normals of voxels that may share a vertex.
constexpr double kSameWay = 0.01;

float away_from_zero(float distance) {
  return distance < 0 ? std::min(distance, -kLeastDistance) : std::max(distance, kLeastDistance);
}

/// Is the brick outside the grid or known to lie outside the body?
bool is_outside(const SparseVolume& volume, const glm::ivec3& brick) {
  for (int axis = 0; axis < 3; ++axis)
    if (brick[axis] < 0 || brick[axis] >= volume.grid.bricks[axis]) return true;
  return volume.table[volume.grid.brick_index(brick)] == SparseVolume::kOutside;
}

/// The mesher looks for sign changes around leaves only: inside bricks that touch outside ones
/// must be leaves, or the surface between the two would be missing.
void store_exposed_inside_bricks(const SparseVolume& volume, Accessor& accessor) {
  const glm::ivec3 size = volume.grid.bricks;
  std::size_t index = 0;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        if (volume.table[index++] != SparseVolume::kInside) continue;
        const glm::ivec3 brick(x, y, z);
        bool exposed = false;
        for (int axis = 0; axis < 3; ++axis) {
          glm::ivec3 step(0);
          step[axis] = 1;
          exposed |= is_outside(volume, brick - step) || is_outside(volume, brick + step);
        }
        if (exposed) accessor.touchLeaf(openvdb::Coord(x, y, z) << 3)->setValuesOn();
      }
}

/// The volume as a level set in voxels, its coordinates in units of vdb_unit relative to the centre
/// of the grid.
openvdb::FloatGrid::Ptr distance_grid(const SparseVolume& volume, const glm::dvec3& center) {
  auto grid = openvdb::FloatGrid::create(SparseVolume::kBand);
  Accessor accessor(grid->tree());
  // The mesher looks at active voxels only; at a cut by the grid's border the sign can change
  // between voxels of which neither is in the band.
  fill_tree<Leaf>(volume, accessor, away_from_zero, [](float) { return true; });
  store_exposed_inside_bricks(volume, accessor);
  const glm::dvec3 shift = (volume.grid.origin - center) / vdb_unit(volume.grid.voxel_size);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);  // Says on which side the inside is.
  const double unit = vdb_unit(volume.grid.voxel_size);
  grid->setTransform(
      openvdb::math::Transform::createLinearTransform(volume.grid.voxel_size / unit));
  grid->transform().postTranslate(openvdb::Vec3d(shift.x, shift.y, shift.z));
  return grid;
}

/// 1 in the flagged bricks, by which the mesher multiplies its tolerance.
openvdb::FloatGrid::Ptr tolerance_grid(const SparseVolume& volume,
                                       std::span<const std::uint8_t> coarse,
                                       const openvdb::math::Transform& transform) {
  auto grid = openvdb::FloatGrid::create(0);
  Accessor accessor(grid->tree());
  for (const glm::ivec3& b : volume.bricks)
    if (coarse[volume.grid.brick_index(b)])
      accessor.addTile(1, openvdb::Coord(b.x, b.y, b.z) << 3, 1, true);
  grid->setTransform(transform.copy());
  return grid;
}

void add_triangle(TriMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
}

/// Splits along the shorter diagonal: rounder triangles, and none flat where three corners line up.
void add_quad(TriMesh& mesh, const std::array<std::uint32_t, 4>& q) {
  const auto span = [&](int a, int b) {
    const glm::vec3 d = mesh.positions[q[a]] - mesh.positions[q[b]];
    return glm::dot(d, d);
  };
  const int first = span(0, 2) <= span(1, 3) ? 0 : 1;
  add_triangle(mesh, q[first], q[first + 1], q[first + 2]);
  add_triangle(mesh, q[first], q[first + 2], q[(first + 3) % 4]);
}

/// OpenVDB winds polygons clockwise seen from outside; ours are the other way round.
void add_polygons(const openvdb::tools::VolumeToMesh& mesher, TriMesh& mesh) {
  std::size_t triangles = 0;
  for (std::size_t p = 0; p < mesher.polygonPoolListSize(); ++p) {
    const auto& pool = mesher.polygonPoolList()[p];
    triangles += 2 * pool.numQuads() + pool.numTriangles();
  }
  mesh.triangles.reserve(triangles);
  for (std::size_t p = 0; p < mesher.polygonPoolListSize(); ++p) {
    const auto& pool = mesher.polygonPoolList()[p];
    for (std::size_t i = 0; i < pool.numQuads(); ++i) {
      const openvdb::Vec4I& q = pool.quad(i);
      add_quad(mesh, {q[3], q[2], q[1], q[0]});
    }
    for (std::size_t i = 0; i < pool.numTriangles(); ++i) {
      const openvdb::Vec3I& t = pool.triangle(i);
      add_triangle(mesh, t[2], t[1], t[0]);
    }
  }
}

}  // namespace

TriMesh extract_mesh(const SparseVolume& volume, std::span<const std::uint8_t> coarse) {
  PHOTOHULL_CHECK(coarse.empty() || coarse.size() == volume.table.size());
  TriMesh mesh;
  mesh.origin = volume.grid.bounds().center();
  const auto grid = distance_grid(volume, mesh.origin);
  openvdb::tools::VolumeToMesh mesher(0.0, coarse.empty() ? 0 : kSameWay);
  if (!coarse.empty())
    mesher.setSpatialAdaptivity(tolerance_grid(volume, coarse, grid->transform()));
  mesher(*grid);

  static_assert(sizeof(openvdb::Vec3s) == sizeof(glm::vec3));
  mesh.positions.resize(mesher.pointListSize());
  if (!mesh.positions.empty())
    std::memcpy(mesh.positions.data(), mesher.pointList().get(),
                mesh.positions.size() * sizeof(glm::vec3));
  if (const double unit = vdb_unit(volume.grid.voxel_size); unit != 1)
    for (glm::vec3& p : mesh.positions) p *= float(unit);
  add_polygons(mesher, mesh);
  refine_vertices(volume, mesh);
  return mesh;
}

}  // namespace photohull
