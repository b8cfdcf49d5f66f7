// OpenVDB files out and in (Museth, "VDB: High-resolution sparse volumes with dynamic topology",
// 2013).
#include "volume/write_vdb.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/error.h"
#include "volume/fill_tree.h"
#include "volume/vdb_file.h"

namespace photohull {
namespace {

using openvdb::FloatGrid;
using openvdb::Vec3fGrid;

openvdb::Vec3f to_vdb(const glm::vec3& v) { return {v.x, v.y, v.z}; }

FloatGrid::Ptr surface_grid(const SparseVolume& volume) {
  const auto voxel_size = float(volume.grid.voxel_size / vdb_unit(volume.grid.voxel_size));
  auto grid = FloatGrid::create(SparseVolume::kBand * voxel_size);
  fill_tree<FloatGrid::TreeType::LeafNodeType>(
      volume, openvdb::tree::ValueAccessor<openvdb::FloatTree, false>(grid->tree()),
      [&](float distance) { return distance * voxel_size; },
      [](float distance) { return std::abs(distance) < SparseVolume::kBand; });
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  return grid;
}

/// A grid that holds value(i) at the stored voxels i near the surface for which known(i).
template <typename Grid, typename Known, typename Value>
typename Grid::Ptr attribute_grid(const SparseVolume& volume, Known known, Value value) {
  using Leaf = typename Grid::TreeType::LeafNodeType;
  auto grid = Grid::create();
  openvdb::tree::ValueAccessor<typename Grid::TreeType, false> accessor(grid->tree());
  for (std::size_t slot = 0; slot < volume.bricks.size(); ++slot) {
    const std::size_t first = slot * kBrickVoxels;
    openvdb::util::NodeMask<3> mask;
    for (int i = 0; i < kBrickVoxels; ++i)
      if (std::abs(volume.distance[first + i]) < VolumeAttributes::kReach && known(first + i))
        mask.setOn(i);
    if (mask.isOff()) continue;
    const glm::ivec3 corner = volume.bricks[slot] * kBrickEdge;
    auto* leaf = new Leaf(openvdb::Coord(corner.x, corner.y, corner.z));
    for (auto on = mask.beginOn(); on; ++on)
      leaf->buffer().setValue(on.pos(), value(first + on.pos()));
    leaf->setValueMask(mask);
    accessor.addLeaf(leaf);
  }
  return grid;
}

Vec3fGrid::Ptr colour_grid(const SparseVolume& volume, const MaskedValues<glm::vec3>& colour) {
  auto grid = attribute_grid<Vec3fGrid>(
      volume, [&](std::size_t i) { return colour[i].r >= 0; },
      [&](std::size_t i) { return to_vdb(colour[i]); });
  grid->setVectorType(openvdb::VEC_INVARIANT);
  grid->setSaveFloatAsHalf(true);
  return grid;
}

FloatGrid::Ptr confidence_grid(const SparseVolume& volume, const MaskedValues<float>& confidence) {
  auto grid = attribute_grid<FloatGrid>(
      volume, [&](std::size_t i) { return confidence[i] >= 0; },
      [&](std::size_t i) { return confidence[i]; });
  grid->setSaveFloatAsHalf(true);
  return grid;
}

/// A hash of everything that makes the file; eight bytes a step.
class ContentHash {
 public:
  template <typename T>
  void add(const std::vector<T>& values) {
    add_bytes(values.data(), values.size() * sizeof(T));
  }
  /// As of a vector of all of them.
  template <typename T>
  void add(const MaskedValues<T>& values) {
    static_assert(kBrickVoxels * sizeof(T) % 8 == 0);
    std::array<T, kBrickVoxels> brick;
    mix(values.size() * sizeof(T));
    for (std::size_t first = 0; first < values.size(); first += kBrickVoxels) {
      for (std::size_t i = 0; i < brick.size(); ++i) brick[i] = values[first + i];
      mix_bytes(brick.data(), sizeof brick);
    }
  }
  void add_bytes(const void* data, std::size_t size) {
    mix(size);
    mix_bytes(data, size);
  }
  void mix_bytes(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; i += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes + i, std::min<std::size_t>(8, size - i));
      mix(word);
    }
  }
  std::uint64_t mix(std::uint64_t word) {
    hash_ = (hash_ ^ word) * 0x9e3779b97f4a7c15u;
    return hash_ ^= hash_ >> 32;
  }

 private:
  std::uint64_t hash_ = 0;
};

std::string content_tag(const SparseVolume& volume, const VolumeAttributes& attributes,
                        const VdbMetadata& metadata) {
  ContentHash hash;
  hash.add_bytes(&volume.grid.origin, sizeof volume.grid.origin);
  hash.add_bytes(&volume.grid.voxel_size, sizeof volume.grid.voxel_size);
  hash.add(volume.table);
  hash.add(volume.distance);
  hash.add(attributes.colour);
  hash.add(attributes.confidence);
  for (const auto& [name, value] : metadata)
    for (const std::string& text : {name, value}) hash.add_bytes(text.data(), text.size());
  const std::uint64_t high = hash.mix(1), low = hash.mix(2);
  return tag_of(high, low);
}

/// The grid named surface, or else the first level set; null when there is none.
FloatGrid::Ptr find_level_set(openvdb::io::File& file) {
  const openvdb::GridPtrVecPtr all = file.readAllGridMetadata();
  std::string name;
  for (const openvdb::GridBase::Ptr& grid : *all) {
    if (!grid->isType<FloatGrid>() || grid->getGridClass() != openvdb::GRID_LEVEL_SET) continue;
    if (name.empty() || grid->getName() == "surface") name = grid->getName();
  }
  return name.empty() ? nullptr : openvdb::gridPtrCast<FloatGrid>(file.readGrid(name));
}

/// The bricks to store: those that the file's grid had, where it says so, or else the box of the
/// leaves. `first` is the brick that becomes (0, 0, 0).
glm::ivec3 grid_bricks(const FloatGrid& grid, glm::ivec3& first) {
  openvdb::CoordBBox box;
  if (!grid.tree().evalLeafBoundingBox(box)) box = openvdb::CoordBBox({0, 0, 0}, {7, 7, 7});
  const openvdb::Coord low = box.min() >> 3, high = box.max() >> 3;
  if (const auto said = grid.getMetadata<openvdb::Vec3IMetadata>("grid_bricks")) {
    const openvdb::Vec3i size = said->value();
    if (low.x() >= 0 && low.y() >= 0 && low.z() >= 0 && high.x() < size.x() &&
        high.y() < size.y() && high.z() < size.z()) {
      first = glm::ivec3(0);
      return {size.x(), size.y(), size.z()};
    }
  }
  first = {low.x(), low.y(), low.z()};
  return glm::ivec3(high.x(), high.y(), high.z()) - first + 1;
}

SparseVolume to_volume(const FloatGrid& source) {
  const openvdb::math::Transform& transform = source.transform();
  const openvdb::math::Mat4d matrix = transform.baseMap()->getAffineMap()->getMat4();
  SparseVolume volume;
  GridSpec& grid = volume.grid;
  grid.voxel_size = matrix(0, 0);
  const auto is_cube = openvdb::math::Mat3d::identity() * grid.voxel_size;
  if (!transform.isLinear() || !(grid.voxel_size > 0) || !is_cube.eq(matrix.getMat3(), 1e-9))
    throw Error("its voxels are not axis-aligned cubes; resample the grid");

  glm::ivec3 first;
  grid.bricks = grid_bricks(source, first);
  constexpr double kMostBricks = 1 << 27;  // 4096^3 voxels; a table of half a gigabyte
  if (double(grid.bricks.x) * grid.bricks.y * grid.bricks.z > kMostBricks)
    throw Error("its leaves are spread over more than 4096^3 voxels; clip the grid");
  const glm::ivec3 corner = first * kBrickEdge;
  const openvdb::Vec3d origin =
      transform.indexToWorld(openvdb::Coord(corner.x, corner.y, corner.z));
  grid.origin = {origin.x(), origin.y(), origin.z()};

  auto accessor = source.getConstAccessor();
  for (int z = 0; z < grid.bricks.z; ++z)
    for (int y = 0; y < grid.bricks.y; ++y)
      for (int x = 0; x < grid.bricks.x; ++x) {
        const glm::ivec3 at = corner + glm::ivec3(x, y, z) * kBrickEdge;
        const openvdb::Coord coord(at.x, at.y, at.z);
        const auto* leaf = accessor.probeConstLeaf(coord);
        if (!leaf) {
          const bool inside = accessor.getValue(coord) < 0;
          volume.table.push_back(inside ? SparseVolume::kInside : SparseVolume::kOutside);
          continue;
        }
        volume.table.push_back(std::uint32_t(volume.bricks.size()));
        volume.bricks.emplace_back(x, y, z);
        for (int i = 0; i < kBrickVoxels; ++i)
          volume.distance.push_back(std::clamp(float(leaf->getValue(i) / grid.voxel_size),
                                               -SparseVolume::kBand, SparseVolume::kBand));
      }
  if (const auto unit = source.getMetadata<openvdb::DoubleMetadata>("scene_unit")) {
    if (!(unit->value() > 0)) throw Error("its scene_unit is not positive");
    grid.voxel_size *= unit->value();
    grid.origin *= unit->value();
  }
  return volume;
}

}  // namespace

double vdb_unit(double voxel_size) {
  constexpr double kSmallest = 2e-5;  // OpenVDB takes a voxel's volume below 3e-15 for zero
  double unit = 1;
  while (voxel_size / unit < kSmallest) unit /= 1000;
  return unit;
}

void write_vdb(AtomicFile& file, const SparseVolume& volume, const VolumeAttributes& attributes,
               const VdbMetadata& metadata) {
  PHOTOHULL_CHECK(volume.grid.voxel_size > 0);
  const std::size_t voxels = volume.distance.size();
  PHOTOHULL_CHECK(attributes.colour.empty() || attributes.colour.size() == voxels);
  PHOTOHULL_CHECK(attributes.confidence.empty() || attributes.confidence.size() == voxels);
  openvdb::initialize();

  const openvdb::MetaMap map = meta_map(volume.grid, metadata);
  const auto named = [&](openvdb::GridBase::Ptr grid, const char* name) {
    describe(*grid, name, volume.grid, map);
    return grid;
  };
  std::vector<MakeGrid> grids = {[&] { return named(surface_grid(volume), "surface"); }};
  if (!attributes.colour.empty())
    grids.push_back([&] { return named(colour_grid(volume, attributes.colour), "Cd"); });
  if (!attributes.confidence.empty())
    grids.push_back(
        [&] { return named(confidence_grid(volume, attributes.confidence), "confidence"); });
  write_grids(file, grids, map, content_tag(volume, attributes, metadata));
}

void write_vdb(const std::filesystem::path& path, const SparseVolume& volume,
               const VolumeAttributes& attributes, const VdbMetadata& metadata) {
  AtomicFile file(path);
  write_vdb(file, volume, attributes, metadata);
  file.commit();
}

SparseVolume read_vdb_surface(const std::filesystem::path& path) {
  openvdb::initialize();
  return with_file(path, [&](openvdb::io::File& file) {
    const FloatGrid::Ptr grid = find_level_set(file);
    if (!grid) throw Error("it has no level set; give a file with a grid named surface");
    return to_volume(*grid);
  });
}

}  // namespace photohull
