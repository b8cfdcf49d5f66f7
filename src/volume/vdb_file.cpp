#include "volume/vdb_file.h"

#include <cerrno>
#include <cstdio>
#include <fstream>

namespace photohull {
namespace {

/// An archive that writes to any seekable stream. io::File ignores the stream's state when it
/// closes, so that a full disk would go unnoticed.
class CheckedArchive : public openvdb::io::Archive {
 public:
  /// Grids of different names. Each is made when it is written and gone before the next, since
  /// they take several times the memory of the volume.
  void write_to(std::ostream& out, const std::vector<MakeGrid>& grids,
                const openvdb::MetaMap& metadata) const {
    constexpr bool kSeekable = true;
    openvdb::io::setWriteGridStatsMetadata(out, isGridStatsMetadataEnabled());
    writeHeader(out, kSeekable);
    metadata.writeMeta(out);
    const auto count = std::int32_t(grids.size());
    out.write(reinterpret_cast<const char*>(&count), sizeof count);
    for (const MakeGrid& make : grids) {
      const openvdb::GridBase::Ptr grid = make();
      openvdb::io::GridDescriptor descriptor(grid->getName(), grid->type(),
                                             grid->saveFloatAsHalf());
      writeGrid(descriptor, grid, out, kSeekable);
    }
  }
};

}  // namespace

openvdb::MetaMap meta_map(const GridSpec& grid, const VdbMetadata& metadata) {
  openvdb::MetaMap map;
  for (const auto& [name, value] : metadata) map.insertMeta(name, openvdb::StringMetadata(value));
  const glm::ivec3 bricks = grid.bricks;
  for (const char* name : {"voxel_size", "scene_unit", "grid_bricks", "photohull_version"})
    map.removeMeta(name);  // These are facts, and keep their types.
  map.insertMeta("voxel_size", openvdb::DoubleMetadata(grid.voxel_size));
  map.insertMeta("scene_unit", openvdb::DoubleMetadata(vdb_unit(grid.voxel_size)));
  map.insertMeta("grid_bricks", openvdb::Vec3IMetadata({bricks.x, bricks.y, bricks.z}));
  map.insertMeta("photohull_version", openvdb::StringMetadata(PHOTOHULL_VERSION));
  return map;
}

void describe(openvdb::GridBase& grid, const char* name, const GridSpec& spec,
              const openvdb::MetaMap& metadata) {
  const double unit = vdb_unit(spec.voxel_size);
  const glm::dvec3 origin = spec.origin / unit;
  auto transform = openvdb::math::Transform::createLinearTransform(spec.voxel_size / unit);
  transform->postTranslate({origin.x, origin.y, origin.z});
  grid.setTransform(transform);
  for (auto it = metadata.beginMeta(); it != metadata.endMeta(); ++it)
    grid.insertMeta(it->first, *it->second);
  grid.setName(name);
  grid.setCreator("created by photohull " PHOTOHULL_VERSION);
}

void write_grids(AtomicFile& file, const std::vector<MakeGrid>& grids,
                 const openvdb::MetaMap& metadata, const std::string& tag) {
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
    // After the magic number, the file's and the library's version and the flag for offsets.
    constexpr std::streamoff kTag = 8 + 4 + 2 * 4 + 1;
    out.seekp(kTag);
    out.write(tag.data(), std::streamsize(tag.size()));
    out.close();
  } catch (const std::ios::failure&) {
    file.fail(errno);
  }
}

std::string tag_of(std::uint64_t high, std::uint64_t low) {
  char text[37];
  std::snprintf(text, sizeof text, "%08x-%04x-8%03x-8%03x-%012llx", unsigned(high >> 32),
                unsigned(high >> 16 & 0xffff), unsigned(high & 0xfff), unsigned(low >> 52),
                static_cast<unsigned long long>(low & 0xffffffffffff));
  return text;
}

}  // namespace photohull
