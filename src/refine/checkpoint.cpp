#include "refine/checkpoint.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <type_traits>

#include "core/atomic_file.h"
#include "core/error.h"

namespace photohull::refine {
namespace {

constexpr char kMagic[] = "photohull checkpoint 1\n";

class Writer {
 public:
  explicit Writer(AtomicFile& file) : file_(file) {}
  template <typename T>
  void list(std::span<const T> items) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::uint64_t count = items.size();
    file_.write(&count, sizeof count);
    file_.write(items.data(), items.size_bytes());
  }

 private:
  AtomicFile& file_;
};

class Reader {
 public:
  Reader(std::ifstream& stream, std::uint64_t bytes) : stream_(stream), left_(bytes) {}
  template <typename T>
  std::vector<T> list() {
    std::uint64_t count = 0;
    take(&count, sizeof count);
    if (count > left_ / sizeof(T)) throw Error("it ends too early");
    std::vector<T> items(count);
    take(items.data(), count * sizeof(T));
    return items;
  }
  template <typename T>
  T one() {
    const std::vector<T> items = list<T>();
    if (items.size() != 1) throw Error("a part of it has another size");
    return items.front();
  }
  bool at_end() const { return left_ == 0; }

 private:
  void take(void* target, std::uint64_t bytes) {
    if (bytes > left_ || !stream_.read(static_cast<char*>(target), std::streamsize(bytes)))
      throw Error("it ends too early");
    left_ -= bytes;
  }

  std::ifstream& stream_;
  std::uint64_t left_;
};

bool same(const GridSpec& a, const GridSpec& b) {
  return a.origin == b.origin && a.voxel_size == b.voxel_size && a.bricks == b.bricks;
}

void check(const SparseVolume& volume) {
  bool ok = volume.table.size() == volume.grid.brick_count() &&
            volume.distance.size() == volume.bricks.size() * kBrickVoxels;
  for (std::size_t slot = 0; ok && slot < volume.bricks.size(); ++slot) {
    const glm::ivec3& b = volume.bricks[slot];
    ok = glm::all(glm::greaterThanEqual(b, glm::ivec3(0))) &&
         glm::all(glm::lessThan(b, volume.grid.bricks)) &&
         volume.table[volume.grid.brick_index(b)] == slot;
  }
  for (std::size_t i = 0; ok && i < volume.table.size(); ++i)
    ok = volume.table[i] >= SparseVolume::kInside || volume.table[i] < volume.bricks.size();
  for (std::size_t i = 0; ok && i < volume.distance.size(); ++i)
    ok = std::abs(volume.distance[i]) <= SparseVolume::kBand;
  if (!ok) throw Error("its volume contradicts itself");
}

}  // namespace

void write_checkpoint(const CheckpointFile& file, const Checkpoint& checkpoint) {
  AtomicFile out(file.path);
  out.write(kMagic, sizeof kMagic);
  Writer writer(out);
  writer.list(std::span<const char>(file.job));
  writer.list(std::span<const LevelReport>(checkpoint.levels));
  writer.list(std::span<const GridSpec>(&checkpoint.volume.grid, 1));
  writer.list(std::span<const std::uint32_t>(checkpoint.volume.table));
  writer.list(std::span<const glm::ivec3>(checkpoint.volume.bricks));
  writer.list(std::span<const float>(checkpoint.volume.distance));
  writer.list(std::span<const GridSpec>(&checkpoint.settled.grid(), 1));
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
    Reader reader(stream, bytes - sizeof magic);
    const std::vector<char> job = reader.list<char>();
    if (std::string(job.begin(), job.end()) != file.job) return std::nullopt;
    Checkpoint out;
    out.levels = reader.list<LevelReport>();
    out.volume.grid = reader.one<GridSpec>();
    if (out.levels.empty() || out.levels.size() >= grids.size() ||
        !same(out.volume.grid, grids[out.levels.size() - 1]))
      throw Error("it belongs to other voxels");
    out.volume.table = reader.list<std::uint32_t>();
    out.volume.bricks = reader.list<glm::ivec3>();
    out.volume.distance = reader.list<float>();
    check(out.volume);
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
