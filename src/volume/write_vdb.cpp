// OpenVDB files out and in (Museth, "VDB: High-resolution sparse volumes with dynamic topology",
// 2013).
#include "volume/write_vdb.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <vector>

#include "core/error.h"
#include "volume/atomic_file.h"
#include "volume/fill_tree.h"

namespace photohull {
namespace {

using openvdb::FloatGrid;
using openvdb::Vec3fGrid;

openvdb::Vec3f to_vdb(const glm::vec3& v) { return {v.x, v.y, v.z}; }

/// An archive that writes to any seekable stream. io::File ignores the stream's state when it
/// closes, so that a full disk would go unnoticed.
class CheckedArchive : public openvdb::io::Archive {
 public:
  void write_to(std::ostream& out, const openvdb::GridCPtrVec& grids,
                const openvdb::MetaMap& metadata) const {
    constexpr bool kSeekable = true;
    Archive::write(out, grids, kSeekable, metadata);
  }
};

openvdb::MetaMap meta_map(const SparseVolume& volume, const Metadata& metadata) {
  openvdb::MetaMap map;
  for (const auto& [name, value] : metadata) map.insertMeta(name, openvdb::StringMetadata(value));
  const glm::ivec3 bricks = volume.grid.bricks;
  map.insertMeta("voxel_size", openvdb::DoubleMetadata(volume.grid.voxel_size));
  map.insertMeta("grid_bricks", openvdb::Vec3IMetadata({bricks.x, bricks.y, bricks.z}));
  map.insertMeta("photohull_version", openvdb::StringMetadata(PHOTOHULL_VERSION));
  return map;
}

void describe(openvdb::GridBase& grid, const char* name, const SparseVolume& volume,
              const openvdb::MetaMap& metadata) {
  const glm::dvec3& origin = volume.grid.origin;
  auto transform = openvdb::math::Transform::createLinearTransform(volume.grid.voxel_size);
  transform->postTranslate({origin.x, origin.y, origin.z});
  grid.setTransform(transform);
  for (auto it = metadata.beginMeta(); it != metadata.endMeta(); ++it)
    grid.insertMeta(it->first, *it->second);
  grid.setName(name);
  grid.setCreator("created by photohull " PHOTOHULL_VERSION);
}

FloatGrid::Ptr surface_grid(const SparseVolume& volume) {
  const float voxel_size = float(volume.grid.voxel_size);
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

Vec3fGrid::Ptr colour_grid(const SparseVolume& volume, const std::vector<glm::vec3>& colour) {
  auto grid = attribute_grid<Vec3fGrid>(
      volume, [&](std::size_t i) { return colour[i].r >= 0; },
      [&](std::size_t i) { return to_vdb(colour[i]); });
  grid->setVectorType(openvdb::VEC_INVARIANT);
  grid->setSaveFloatAsHalf(true);
  return grid;
}

FloatGrid::Ptr confidence_grid(const SparseVolume& volume, const std::vector<float>& confidence) {
  auto grid = attribute_grid<FloatGrid>(
      volume, [&](std::size_t i) { return confidence[i] >= 0; },
      [&](std::size_t i) { return confidence[i]; });
  grid->setSaveFloatAsHalf(true);
  return grid;
}

void write_grids(const std::filesystem::path& path, const openvdb::GridCPtrVec& grids,
                 const openvdb::MetaMap& metadata) {
  AtomicFile file(path);
  std::vector<char> buffer(std::size_t(1) << 20);
  std::ofstream out;
  out.rdbuf()->pubsetbuf(buffer.data(), std::streamsize(buffer.size()));
  errno = 0;
  try {
    out.exceptions(std::ios::badbit | std::ios::failbit);
    out.open(file.temporary(), std::ios::binary | std::ios::trunc);
    CheckedArchive archive;
    archive.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK);
    archive.write_to(out, grids, metadata);
    out.close();
  } catch (const std::ios::failure&) {
    file.fail(errno);
  }
  file.commit();
}

}  // namespace

void write_vdb(const std::filesystem::path& path, const SparseVolume& volume,
               const VolumeAttributes& attributes, const Metadata& metadata) {
  PHOTOHULL_CHECK(volume.grid.voxel_size > 0);
  const std::size_t voxels = volume.distance.size();
  PHOTOHULL_CHECK(attributes.colour.empty() || attributes.colour.size() == voxels);
  PHOTOHULL_CHECK(attributes.confidence.empty() || attributes.confidence.size() == voxels);
  openvdb::initialize();

  const openvdb::MetaMap map = meta_map(volume, metadata);
  openvdb::GridCPtrVec grids;
  const auto add = [&](const openvdb::GridBase::Ptr& grid, const char* name) {
    describe(*grid, name, volume, map);
    grids.push_back(grid);
  };
  add(surface_grid(volume), "surface");
  if (!attributes.colour.empty()) add(colour_grid(volume, attributes.colour), "Cd");
  if (!attributes.confidence.empty())
    add(confidence_grid(volume, attributes.confidence), "confidence");
  write_grids(path, grids, map);
}

}  // namespace photohull
