#include "volume/join_vdb.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "volume/vdb_file.h"

namespace photohull {
namespace {

namespace fs = std::filesystem;
using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Vec3fGrid;

constexpr double kSameSize = 1e-9;         // relative
constexpr double kWholeVoxels = 1e-3;      // of a voxel: what origins may be off whole bricks
constexpr std::size_t kLargestSpeck = 64;  // voxels

/// What a file says of its lattice, without the voxels.
struct Head {
  GridSpec grid;
  std::string tag;
  bool colour = false, confidence = false;
};

Head read_head(const fs::path& path) {
  return with_file(path, [](openvdb::io::File& file) {
    if (!file.hasGrid("surface")) throw Error("it has no grid named surface");
    const openvdb::GridBase::ConstPtr grid = file.readGridMetadata("surface");
    const auto size = grid->getMetadata<openvdb::DoubleMetadata>("voxel_size");
    const auto unit = grid->getMetadata<openvdb::DoubleMetadata>("scene_unit");
    const auto bricks = grid->getMetadata<openvdb::Vec3IMetadata>("grid_bricks");
    if (!size || !unit || !bricks || !(size->value() > 0) || !(unit->value() > 0))
      throw Error("it was not written by photohull");
    const openvdb::Vec3d origin = grid->transform().indexToWorld(Coord(0, 0, 0));
    const openvdb::Vec3i n = bricks->value();
    Head out;
    out.grid.voxel_size = size->value();
    out.grid.origin = unit->value() * glm::dvec3(origin.x(), origin.y(), origin.z());
    out.grid.bricks = {n.x(), n.y(), n.z()};
    out.tag = file.getUniqueTag();
    out.colour = file.hasGrid("Cd");
    out.confidence = file.hasGrid("confidence");
    return out;
  });
}

/// The brick of `all` that is the first one of `part`.
glm::ivec3 first_brick(const GridSpec& all, const GridSpec& part) {
  const glm::dvec3 bricks = (part.origin - all.origin) / (all.voxel_size * kBrickEdge);
  const glm::dvec3 whole = glm::round(bricks);
  const bool fits = std::abs(part.voxel_size / all.voxel_size - 1) < kSameSize &&
                    glm::all(glm::lessThan(glm::abs(bricks - whole), glm::dvec3(kWholeVoxels)));
  if (!fits)
    throw Error("its voxels are not those of the other parts; make all parts of one whole");
  return glm::ivec3(whole);
}

template <typename Function>
auto naming(const fs::path& path, const Function& function) {
  try {
    return function();
  } catch (const Error& error) {
    throw Error(concat("cannot join ", path.string(), ": ", error.what()));
  }
}

std::vector<Head> read_heads(std::span<const fs::path> files) {
  std::vector<Head> heads;
  for (const fs::path& file : files) heads.push_back(read_head(file));
  return heads;
}

GridSpec grid_around(std::span<const fs::path> files, std::span<const Head> heads) {
  GridSpec out = heads.front().grid;
  glm::ivec3 low(0), high = out.bricks;
  for (std::size_t i = 0; i < heads.size(); ++i) {
    const glm::ivec3 first =
        naming(files[i], [&] { return first_brick(heads.front().grid, heads[i].grid); });
    low = glm::min(low, first);
    high = glm::max(high, first + heads[i].grid.bricks);
  }
  out.origin += out.voxel_size * glm::dvec3(low * kBrickEdge);
  out.bricks = high - low;
  return out;
}

/// Which file each brick of the joined grid is of, by its first voxel.
using BrickFiles = std::map<Coord, std::size_t>;

/// What is stored of `part`, moved by `shift`, where nothing is stored yet; visit(first voxel) of
/// each brick.
template <typename Grid, typename Visit>
void add(const Grid& part, const Coord& shift, Grid& all, const Visit& visit) {
  using Leaf = typename Grid::TreeType::LeafNodeType;
  typename Grid::Accessor accessor = all.getAccessor();
  // Tiles first: leaves lie beside them.
  auto tile = part.tree().cbeginValueOff();
  for (tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1); tile; ++tile) {
    if (tile.getValue() == part.background()) continue;
    openvdb::CoordBBox box;
    tile.getBoundingBox(box);
    for (auto at = box.min(); at.x() <= box.max().x(); at.x() += kBrickEdge)
      for (at.y() = box.min().y(); at.y() <= box.max().y(); at.y() += kBrickEdge)
        for (at.z() = box.min().z(); at.z() <= box.max().z(); at.z() += kBrickEdge)
          if (!accessor.probeConstLeaf(at + shift))
            accessor.addTile(1, at + shift, tile.getValue(), false);
  }
  for (auto leaf = part.tree().cbeginLeaf(); leaf; ++leaf) {
    const Coord at = leaf->origin() + shift;
    if (accessor.probeConstLeaf(at)) continue;
    auto* copy = new Leaf(*leaf);
    copy->setOrigin(at);
    accessor.addLeaf(copy);  // the tree owns it now
    visit(at);
  }
}

/// The voxels of the body that hold together with one of it, by faces, edges and corners; none
/// where they are more than a speck has. `large`: voxels of which that is known.
std::vector<Coord> speck_at(const Coord& voxel, FloatGrid::ConstAccessor& surface,
                            std::set<Coord>& large) {
  std::set<Coord> seen{voxel};
  std::vector<Coord> out{voxel};
  bool is_speck = !large.contains(voxel);
  for (std::size_t i = 0; i < out.size() && is_speck; ++i)
    for (int k = 0; k < 27; ++k) {
      const Coord next = out[i] + Coord(k / 9, k / 3 % 3, k % 3) - Coord(1);
      if (surface.getValue(next) >= 0 || !seen.insert(next).second) continue;
      out.push_back(next);
      is_speck &= out.size() <= kLargestSpeck && !large.contains(next);
    }
  if (is_speck) return out;
  large.insert(out.begin(), out.end());
  return {};
}

/// Takes specks from the body that end at a border between files: what one part has and the one
/// beside it has nothing of.
void remove_specks(const BrickFiles& files, const GridSpec& grid, FloatGrid& surface) {
  FloatGrid::ConstAccessor at = surface.getConstAccessor();
  FloatGrid::Accessor change = surface.getAccessor();
  std::set<Coord> large;
  for (const auto& [brick, file] : files)
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2, step = face % 2 ? 1 : -1;
      Coord next = brick;
      next[axis] += step * kBrickEdge;
      if (next[axis] < 0 || next[axis] >= grid.voxels()[axis]) continue;  // the box cuts it
      const auto beside = files.find(next);
      if (beside != files.end() && beside->second == file) continue;
      for (int i = 0; i < kBrickEdge * kBrickEdge; ++i) {
        Coord voxel = brick;
        voxel[axis] += face % 2 ? kBrickEdge - 1 : 0;
        voxel[(axis + 1) % 3] += i / kBrickEdge, voxel[(axis + 2) % 3] += i % kBrickEdge;
        next = voxel;
        next[axis] += step;
        if (at.getValue(voxel) >= 0 || at.getValue(next) < 0) continue;
        for (const Coord& gone : speck_at(voxel, at, large))
          change.setValueOff(gone, surface.background());
      }
    }
}

template <typename Grid>
typename Grid::Ptr join(const char* name, std::span<const fs::path> files,
                        std::span<const Head> heads, const GridSpec& spec,
                        BrickFiles* bricks = nullptr) {
  typename Grid::Ptr all;
  for (std::size_t i = 0; i < files.size(); ++i)
    with_file(files[i], [&](openvdb::io::File& file) {
      if (!file.hasGrid(name)) return;  // a part without any surface
      const auto part = openvdb::gridPtrCast<Grid>(file.readGrid(name));
      if (!part) throw Error(concat("its grid ", name, " is of another type"));
      if (!all) {
        all = Grid::create(part->background());
        all->setGridClass(part->getGridClass());
        all->setVectorType(part->getVectorType());
        all->setSaveFloatAsHalf(part->saveFloatAsHalf());
      }
      const glm::ivec3 shift = kBrickEdge * first_brick(spec, heads[i].grid);
      add(*part, Coord(shift.x, shift.y, shift.z), *all, [&](const Coord& first) {
        if (bricks) bricks->emplace(first, i);
      });
    });
  return all;
}

FloatGrid::Ptr join_surface(std::span<const fs::path> files, std::span<const Head> heads,
                            const GridSpec& spec) {
  BrickFiles bricks;
  const FloatGrid::Ptr all = join<FloatGrid>("surface", files, heads, spec, &bricks);
  remove_specks(bricks, spec, *all);
  return all;
}

}  // namespace

GridSpec joined_grid(std::span<const fs::path> files) {
  openvdb::initialize();
  PHOTOHULL_CHECK(!files.empty());
  return grid_around(files, read_heads(files));
}

void join_vdb(AtomicFile& file, std::span<const fs::path> files, const VdbMetadata& metadata) {
  openvdb::initialize();
  PHOTOHULL_CHECK(!files.empty());
  const std::vector<Head> heads = read_heads(files);
  const GridSpec spec = grid_around(files, heads);
  const openvdb::MetaMap map = meta_map(spec, metadata);
  const auto named = [&](openvdb::GridBase::Ptr grid, const char* name) {
    describe(*grid, name, spec, map);
    return grid;
  };
  std::vector<MakeGrid> grids = {
      [&] { return named(join_surface(files, heads, spec), "surface"); }};
  if (std::ranges::any_of(heads, &Head::colour))
    grids.push_back([&] { return named(join<Vec3fGrid>("Cd", files, heads, spec), "Cd"); });
  if (std::ranges::any_of(heads, &Head::confidence))
    grids.push_back(
        [&] { return named(join<FloatGrid>("confidence", files, heads, spec), "confidence"); });
  std::string tags;
  for (const Head& head : heads) tags += head.tag;
  for (const auto& [name, value] : metadata) tags += name + value;
  write_grids(file, grids, map,
              tag_of(std::hash<std::string>()(tags), std::hash<std::string>()("2" + tags)));
}

std::size_t joined_bytes(std::span<const fs::path> files) {
  openvdb::initialize();
  std::size_t bytes = 0;
  for (const fs::path& path : files)
    with_file(path, [&](openvdb::io::File& file) {
      const openvdb::GridBase::ConstPtr grid = file.readGridMetadata("surface");
      const auto stored = grid->getMetadata<openvdb::Int64Metadata>("file_mem_bytes");
      bytes += stored ? std::size_t(stored->value()) : 0;
    });
  return bytes;
}

}  // namespace photohull
