#include "refine/checkpoint.h"

#include <cstring>
#include <fstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/lists.h"

namespace photohull::refine {
namespace {

constexpr char kMagic[] = "photohull checkpoint 1\n";

bool same(const GridSpec& a, const GridSpec& b) {
  return a.origin == b.origin && a.voxel_size == b.voxel_size && a.bricks == b.bricks;
}

}  // namespace

void write_checkpoint(const CheckpointFile& file, const Checkpoint& checkpoint) {
  AtomicFile out(file.path);
  out.write(kMagic, sizeof kMagic);
  ListWriter writer([&](const void* data, std::size_t size) { out.write(data, size); });
  writer.text(file.job);
  writer.list(checkpoint.levels);
  write_volume(checkpoint.volume, writer);
  writer.one(checkpoint.settled.grid());
  writer.list(checkpoint.settled.kinds());
  out.commit();
}

std::optional<Checkpoint> read_checkpoint(const CheckpointFile& file,
                                          std::span<const GridSpec> grids, Progress& progress) {
  std::error_code error;
  const std::uint64_t bytes = std::filesystem::file_size(file.path, error);
  if (error) return std::nullopt;
  std::ifstream stream(file.path, std::ios::binary);
  try {
    char magic[sizeof kMagic] = {};
    stream.read(magic, sizeof magic);
    if (!stream || std::memcmp(magic, kMagic, sizeof magic) != 0)
      throw Error("it is no checkpoint of this version");
    ListReader reader(
        [&](void* target, std::size_t size) {
          return bool(stream.read(static_cast<char*>(target), std::streamsize(size)));
        },
        bytes - sizeof magic);
    if (reader.text() != file.job) return std::nullopt;
    Checkpoint out;
    out.levels = reader.list<LevelReport>();
    out.volume = read_volume(reader);
    if (out.levels.empty() || out.levels.size() >= grids.size() ||
        !same(out.volume.grid, grids[out.levels.size() - 1]))
      throw Error("it belongs to other voxels");
    const GridSpec settled_grid = reader.one<GridSpec>();
    out.settled = SettledBricks(settled_grid, reader.list<std::uint8_t>());
    if (!same(settled_grid, out.volume.grid) ||
        out.settled.kinds().size() != settled_grid.brick_count() || !reader.at_end())
      throw Error("a part of it has another size");
    return out;
  } catch (const Error& problem) {
    progress.warn(concat(file.path.string(), ": cannot go on from here, for ", problem.what(),
                         "; starting afresh"));
    return std::nullopt;
  }
}

}  // namespace photohull::refine
