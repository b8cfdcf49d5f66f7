#include "pipeline/part.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "carving/fit_grid.h"
#include "core/error.h"
#include "core/option_word.h"
#include "mesh/simplify_mesh.h"
#include "pipeline/place_lattice.h"
#include "projtex/photographs.h"
#include "views/crop.h"
#include "visibility/kernels/depth_maps.h"
#include "volume/skin.h"
#include "volume/write_vdb.h"

namespace photohull::pipeline {
namespace {

using glm::ivec3;

constexpr double kBoxSlack = 0.5;  // voxels that the surface may stand out of the whole's box
constexpr int kFinerSteps = 8;     // more parts by an eighth are tried next
constexpr int kAbout = 2;          // bricks of the whole about a part that its surface starts from

struct Cut {
  int axis = 0, at = 0;
};

/// The layer before which about `share` of the bricks lie, across the longest side that has two.
std::optional<Cut> cut_of(std::span<ivec3> bricks, double share) {
  ivec3 low = bricks.front(), high = low;
  for (const ivec3& b : bricks) low = glm::min(low, b), high = glm::max(high, b);
  const ivec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  if (size[axis] == 0) return std::nullopt;
  const auto middle = bricks.begin() + std::ptrdiff_t(share * double(bricks.size()));
  std::nth_element(bricks.begin(), middle, bricks.end(),
                   [axis](const ivec3& a, const ivec3& b) { return a[axis] < b[axis]; });
  return Cut{axis, std::clamp((*middle)[axis], low[axis] + 1, high[axis])};
}

/// Without what lies outside the range: that is outside.
SparseVolume within(const SparseVolume& volume, const BrickRange& range) {
  SparseVolume out;
  out.grid = volume.grid;
  out.table.assign(volume.table.size(), SparseVolume::kOutside);
  for (int z = range.first.z; z < range.end.z; ++z)
    for (int y = range.first.y; y < range.end.y; ++y)
      for (int x = range.first.x; x < range.end.x; ++x) {
        const std::size_t index = volume.grid.brick_index({x, y, z});
        const std::uint32_t slot = volume.table[index];
        out.table[index] = slot;
        if (slot >= SparseVolume::kInside) continue;
        out.table[index] = std::uint32_t(out.bricks.size());
        out.bricks.emplace_back(x, y, z);
        const auto from = volume.distance.begin() + std::ptrdiff_t(slot) * kBrickVoxels;
        out.distance.insert(out.distance.end(), from, from + kBrickVoxels);
      }
  return out;
}

BrickRange grown(const BrickRange& range, int bricks, const GridSpec& grid) {
  return {glm::max(range.first - bricks, 0), glm::min(range.end + bricks, grid.bricks)};
}

/// The grid of the range of `whole`, its voxels halved so many times.
GridSpec finer(const GridSpec& whole, const BrickRange& range, int levels) {
  GridSpec out = whole;
  out.origin += whole.voxel_size * glm::dvec3(range.first * kBrickEdge);
  out.bricks = range.end - range.first;
  const int scale = kBrickEdge << levels;
  out.before = scale * range.first;
  out.after = scale * (whole.bricks - range.end);
  for (int level = 0; level < levels; ++level) {
    out.voxel_size /= 2;
    out.origin -= 0.5 * out.voxel_size;
    out.bricks *= 2;
  }
  return out;
}

/// Might the camera show something of the box?
bool may_show(const Camera& camera, const Box& box) {
  const glm::dvec2 size(camera.intrinsics.width, camera.intrinsics.height);
  glm::dvec2 least(std::numeric_limits<double>::max()), greatest(-least);
  int before = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const auto pixel =
        camera.project({(corner & 1 ? box.max : box.min).x, (corner & 2 ? box.max : box.min).y,
                        (corner & 4 ? box.max : box.min).z});
    if (!pixel) continue;
    ++before;
    least = glm::min(least, *pixel);
    greatest = glm::max(greatest, *pixel);
  }
  if (before < 8) return before > 0;  // some corners are behind it: it stands beside or within
  return glm::all(glm::lessThan(least, size)) &&
         glm::all(glm::greaterThan(greatest, glm::dvec2(-1)));
}

/// Goes on with a range that has `some` of the surface's bricks, which is to become so many parts.
/// False: it has too few layers of bricks.
bool cut_range(std::span<ivec3> some, const BrickRange& range, int count,
               std::vector<BrickRange>& out) {
  if (count == 1) {
    out.push_back(range);
    return true;
  }
  if (some.empty()) return false;
  const int before = count / 2;
  const auto cut = cut_of(some, double(before) / count);
  if (!cut) return false;
  const auto middle = std::partition(
      some.begin(), some.end(), [&](const ivec3& brick) { return brick[cut->axis] < cut->at; });
  const std::size_t size = std::size_t(middle - some.begin());
  BrickRange low = range, high = range;
  low.end[cut->axis] = high.first[cut->axis] = cut->at;
  return cut_range(some.first(size), low, before, out) &&
         cut_range(some.subspan(size), high, count - before, out);
}

/// In their order; none where there are too few layers of bricks.
std::vector<BrickRange> ranges_of_parts(const SparseVolume& whole, int count) {
  std::vector<ivec3> bricks = whole.bricks;
  std::vector<BrickRange> out;
  if (!cut_range(bricks, {ivec3(0), whole.grid.bricks}, count, out)) out.clear();
  return out;
}

/// Of the whole's bricks, around a part's own.
int halo_bricks(int levels) {
  return (kHaloVoxels + (kBrickEdge << levels) - 1) / (kBrickEdge << levels);
}

/// Of the whole's bricks, those in the range.
double share_of(const SparseVolume& whole, const BrickRange& range) {
  const auto in = std::ranges::count_if(whole.bricks,
                                        [&](const ivec3& brick) { return range.contains(brick); });
  return double(in) / double(whole.bricks.size());
}

}  // namespace

SparseVolume bricks_of_whole(const std::filesystem::path& folder) {
  SparseVolume surface = read_vdb_surface(folder / "volume.vdb");
  surface.distance = {};
  return surface;
}

std::optional<int> fewest_parts(const SparseVolume& whole, int levels, double room) {
  for (int count = 2; count <= PartNumber::kMost; count += 1 + count / kFinerSteps) {
    const std::vector<BrickRange> ranges = ranges_of_parts(whole, count);
    if (ranges.empty()) return std::nullopt;
    const bool fit = std::ranges::all_of(ranges, [&](const BrickRange& range) {
      const BrickRange all = grown(range, halo_bricks(levels), whole.grid);
      return share_of(whole, all) <= room &&
             carving::is_lattice(glm::dvec3((all.end - all.first) << levels));
    });
    if (fit) return count;
  }
  return std::nullopt;
}

double share_of_part(const SparseVolume& whole, const PartNumber& part, int levels) {
  return share_of(whole, grown(range_of_part(whole, part), halo_bricks(levels), whole.grid));
}

BrickRange range_of_part(const SparseVolume& whole, const PartNumber& part) {
  const std::vector<BrickRange> ranges = ranges_of_parts(whole, part.count);
  if (ranges.empty())
    throw Error(concat(option_word("part", to_string(part)), ": the whole has a surface of ",
                       whole.bricks.size(), " bricks, too few for so many parts; make fewer"));
  return ranges[std::size_t(part.number - 1)];
}

Part cut_part(const SparseVolume& whole, const Box& box, const PartNumber& part, int levels) {
  const BrickRange range = range_of_part(whole, part);
  const BrickRange all = grown(range, halo_bricks(levels), whole.grid);
  Part out;
  out.whole_box = box;
  out.near = within(whole, grown(all, kAbout, whole.grid));
  out.grid = finer(whole.grid, all, levels);
  const int scale = 1 << levels;
  out.bricks = share_of(whole, all) * double(whole.bricks.size()) * scale * scale;
  out.first_voxel = scale * kBrickEdge * all.first;
  out.own = {scale * (range.first - all.first), scale * (range.end - all.first)};
  const Box filled = out.grid.bounds();
  out.beside = skin(whole);
  std::erase_if(out.beside, [&](const ivec3& voxel) { return all.contains(voxel / kBrickEdge); });
  const double slack = kBoxSlack * out.grid.voxel_size;
  out.box = {glm::max(filled.min, box.min - slack), glm::min(filled.max, box.max + slack)};
  return out;
}

std::vector<DepthMap> depths_beside(gpu::Context& context, const Part& part,
                                    std::span<const Camera> cameras) {
  const GridSpec& grid = part.near.grid;
  const std::vector<projtex::GridCamera> on_grid = projtex::to_grid(cameras, grid);
  visibility::DepthMaps maps(on_grid, grid, projtex::kCutPixels);
  maps.draw(context, on_grid, part.beside);
  std::vector<DepthMap> out;
  for (std::size_t view = 0; view < cameras.size(); ++view) {
    out.push_back(maps.map(view));
    for (float& depth : out.back().depths) depth = float(depth * grid.voxel_size);
  }
  return out;
}

SparseVolume own_of(const Part& part, const SparseVolume& volume) {
  return within(volume, part.own);
}

TriMesh own_of(const Part& part, TriMesh mesh) {
  const GridSpec& grid = part.grid;
  std::erase_if(mesh.triangles, [&](const auto& t) {
    const glm::dvec3 middle = (mesh.world(t[0]) + mesh.world(t[1]) + mesh.world(t[2])) / 3.0;
    const glm::dvec3 voxel = glm::floor((middle - grid.origin) / grid.voxel_size + 0.5);
    return !part.own.contains(ivec3(glm::floor(voxel / double(kBrickEdge))));
  });
  keep_used_vertices(mesh);
  return mesh;
}

std::vector<PreparedView> views_of(const Part& part, std::vector<PreparedView> views) {
  std::erase_if(views, [&](const PreparedView& view) { return !may_show(view.camera, part.box); });
  if (views.size() < 2)
    throw Error(concat("the part is shown by ", views.size(),
                       views.size() == 1 ? " photograph" : " photographs",
                       ", and nothing can be told of it; make fewer parts"));
  for (PreparedView& view : views) crop_to_box(part.box, kCropMargin, view, projtex::kCutPixels);
  return views;
}

}  // namespace photohull::pipeline
