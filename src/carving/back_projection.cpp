#include "carving/back_projection.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"

namespace photohull::carving {
namespace {

constexpr int kBlock = 8;               // voxels along an edge
constexpr double kRoundingRoom = 0.01;  // pixels by which a block's bounds are grown
constexpr int kWidestLookup = 4;        // cells of a level that a look-up takes along a side

// States of blocks.
constexpr std::uint8_t kCarved = 1;  // all labels are -1
constexpr std::uint8_t kMarked = 2;  // no label is 0

int blocks_along(int voxels) { return (voxels + kBlock - 1) / kBlock; }

/// Pixels from `low` to `high`, both included.
struct PixelRange {
  glm::ivec2 low, high;
};

/// Least and greatest values of squares of pixels, coarser by two from level to level.
template <typename Pixel>
class Extremes {
 public:
  explicit Extremes(const PixelView<Pixel>& image) : image_(image) {
    const auto at = [&](int x, int y) {
      const Pixel v = image.pixels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
      return Bounds{v, v};
    };
    add_level(image.width, image.height, at);
    while (levels_.back().width > 1 || levels_.back().height > 1) {
      const std::size_t finer = levels_.size() - 1;
      add_level(levels_[finer].width, levels_[finer].height,
                [this, finer](int x, int y) { return levels_[finer].at(x, y); });
    }
  }

  struct Bounds {
    Pixel low, high;
  };
  /// At least as wide as those of the range's pixels.
  Bounds of(const PixelRange& range) const {
    const glm::ivec2 size = range.high - range.low + 1;
    std::size_t level = 0;  // of squares of 2 pixels
    while ((std::max(size.x, size.y) >> (level + 1)) >= kWidestLookup && level + 1 < levels_.size())
      ++level;
    const int shift = int(level) + 1;
    const Level& cells = levels_[level];
    Bounds all = cells.at(range.low.x >> shift, range.low.y >> shift);
    for (int y = range.low.y >> shift; y <= range.high.y >> shift; ++y)
      for (int x = range.low.x >> shift; x <= range.high.x >> shift; ++x) {
        const Bounds cell = cells.at(x, y);
        all = {std::min(all.low, cell.low), std::max(all.high, cell.high)};
      }
    return all;
  }

 private:
  struct Level {
    int width = 0, height = 0;
    std::vector<Bounds> cells;
    const Bounds& at(int x, int y) const {
      return cells[std::size_t(y) * std::size_t(width) + std::size_t(x)];
    }
  };

  /// Of 2 x 2 of what `at` gives.
  template <typename At>
  void add_level(int width, int height, const At& at) {
    Level level{(width + 1) / 2, (height + 1) / 2, {}};
    level.cells.resize(std::size_t(level.width) * std::size_t(level.height));
    tbb::parallel_for(0, level.height, [&](int y) {
      for (int x = 0; x < level.width; ++x) {
        Bounds all = at(2 * x, 2 * y);
        for (int dy = 0; dy < 2; ++dy)
          for (int dx = 0; dx < 2; ++dx) {
            const Bounds one =
                at(std::min(2 * x + dx, width - 1), std::min(2 * y + dy, height - 1));
            all = {std::min(all.low, one.low), std::max(all.high, one.high)};
          }
        level.cells[std::size_t(y) * std::size_t(level.width) + std::size_t(x)] = all;
      }
    });
    levels_.push_back(std::move(level));
  }

  PixelView<Pixel> image_;
  std::vector<Level> levels_;
};

/// Where voxels of a lattice are on a camera's image.
class Projector {
 public:
  Projector(const DenseLattice& lattice, const TruncatingCamera& camera, int width, int height)
      : lattice_(lattice), camera_(camera), width_(width), height_(height) {
    const glm::dmat3& r = camera.rotation;
    for (int row = 0; row < 3; ++row) rows_[row] = {r[0][row], r[1][row], r[2][row]};
  }

  /// Calls what(index of the voxel, index of its pixel) for the voxels of a block that are seen.
  template <typename What>
  void for_seen(const glm::ivec3& low, const glm::ivec3& high, const What& what) const {
    for (int i = low.x; i < high.x; ++i)
      for (int j = low.y; j < high.y; ++j) {
        const std::size_t row = (std::size_t(i) * std::size_t(lattice_.shape.y) + std::size_t(j)) *
                                std::size_t(lattice_.shape.z);
        for (int k = low.z; k < high.z; ++k)
          if (const std::int64_t pixel = pixel_of(camera_point({i, j, k})); pixel >= 0)
            what(row + std::size_t(k), std::size_t(pixel));
      }
  }

  /// The pixels of a block all of whose voxels are seen.
  std::optional<PixelRange> seen_whole(const glm::ivec3& low, const glm::ivec3& high) const {
    const std::optional<Rectangle> r = rectangle(low, high);
    if (!r || !(r->low.x > -1 && r->low.y > -1 && r->high.x < width_ && r->high.y < height_))
      return std::nullopt;
    return PixelRange{glm::ivec2(r->low), glm::ivec2(r->high)};
  }

  /// Is it certain that none of the block's voxels is seen?
  bool unseen(const glm::ivec3& low, const glm::ivec3& high) const {
    const std::optional<Rectangle> r = rectangle(low, high);
    return r && (r->high.x <= -1 || r->high.y <= -1 || r->low.x >= width_ || r->low.y >= height_);
  }

 private:
  struct Rectangle {
    glm::dvec2 low{1e300}, high{-1e300};
  };

  glm::dvec3 camera_point(const glm::ivec3& voxel) const {
    const glm::dvec3 p = lattice_.origin + glm::dvec3(voxel) * lattice_.voxel_size;
    glm::dvec3 out;
    for (int row = 0; row < 3; ++row)
      out[row] =
          rows_[row].x * p.x + rows_[row].y * p.y + rows_[row].z * p.z + camera_.translation[row];
    return out;
  }
  glm::dvec2 projected(const glm::dvec3& p) const {
    return {p.x / p.z * camera_.fx + camera_.cx, p.y / p.z * camera_.fy + camera_.cy};
  }
  std::int64_t pixel_of(const glm::dvec3& p) const {
    if (!(p.z > 0)) return -1;
    const glm::dvec2 at = projected(p);
    if (!(at.x > -1 && at.x < width_ && at.y > -1 && at.y < height_)) return -1;
    return std::int64_t(at.y) * width_ + std::int64_t(at.x);
  }
  /// Around the projections of a block's voxels, which lie within those of its corners; nothing
  /// where one is not before the camera.
  std::optional<Rectangle> rectangle(const glm::ivec3& low, const glm::ivec3& high) const {
    Rectangle out;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::ivec3 at(corner & 1 ? high.x - 1 : low.x, corner & 2 ? high.y - 1 : low.y,
                          corner & 4 ? high.z - 1 : low.z);
      const glm::dvec3 p = camera_point(at);
      if (!(p.z > 0)) return std::nullopt;
      out.low = glm::min(out.low, projected(p));
      out.high = glm::max(out.high, projected(p));
    }
    out.low -= kRoundingRoom;
    out.high += kRoundingRoom;
    return out;
  }

  DenseLattice lattice_;
  TruncatingCamera camera_;
  int width_, height_;
  glm::dvec3 rows_[3];
};

/// Calls what(block's index, its first voxel, one behind its last voxel), in parallel.
template <typename What>
void for_blocks(const DenseLattice& lattice, const What& what) {
  const glm::ivec3 n(blocks_along(lattice.shape.x), blocks_along(lattice.shape.y),
                     blocks_along(lattice.shape.z));
  tbb::parallel_for(0, n.x * n.y, [&](int column) {
    for (int z = 0; z < n.z; ++z) {
      const glm::ivec3 low = kBlock * glm::ivec3(column / n.y, column % n.y, z);
      what(std::size_t(column) * std::size_t(n.z) + std::size_t(z), low,
           glm::min(low + kBlock, lattice.shape));
    }
  });
}

/// Changes each element of a block.
template <typename Element, typename Change>
void change_block(const DenseLattice& lattice, const glm::ivec3& low, const glm::ivec3& high,
                  std::span<Element> values, const Change& change) {
  for (int i = low.x; i < high.x; ++i)
    for (int j = low.y; j < high.y; ++j) {
      Element* row =
          values.data() + (std::size_t(i) * std::size_t(lattice.shape.y) + std::size_t(j)) *
                              std::size_t(lattice.shape.z);
      for (int k = low.z; k < high.z; ++k) change(row[k]);
    }
}

template <typename Pixel>
void check_sizes(const DenseLattice& lattice, const PixelView<Pixel>& image, std::size_t voxels) {
  PHOTOHULL_CHECK_OP(voxels, ==, lattice.voxels());
  PHOTOHULL_CHECK_OP(image.pixels.size(), ==, std::size_t(image.width) * std::size_t(image.height));
}

}  // namespace

std::vector<std::uint8_t> carving_blocks(const DenseLattice& lattice) {
  return std::vector<std::uint8_t>(std::size_t(blocks_along(lattice.shape.x)) *
                                   std::size_t(blocks_along(lattice.shape.y)) *
                                   std::size_t(blocks_along(lattice.shape.z)));
}

void carve_dense(const DenseLattice& lattice, const TruncatingCamera& camera,
                 const PixelView<std::uint8_t>& mask, std::span<std::int32_t> labels,
                 std::span<std::uint8_t> blocks) {
  check_sizes(lattice, mask, labels.size());
  const Extremes<std::uint8_t> extremes(mask);
  const Projector projector(lattice, camera, mask.width, mask.height);
  for_blocks(lattice, [&](std::size_t block, const glm::ivec3& low, const glm::ivec3& high) {
    if (blocks[block] == kCarved || projector.unseen(low, high)) return;
    if (const auto range = projector.seen_whole(low, high)) {
      const auto [least, greatest] = extremes.of(*range);
      if (greatest == 0) {
        change_block(lattice, low, high, labels, [](std::int32_t& label) { label = -1; });
        blocks[block] = kCarved;
        return;
      }
      if (least > 0) {
        if (blocks[block] != kMarked)
          change_block(lattice, low, high, labels,
                       [](std::int32_t& label) { label = label == 0 ? 1 : label; });
        blocks[block] = kMarked;
        return;
      }
    }
    projector.for_seen(low, high, [&](std::size_t voxel, std::size_t pixel) {
      std::int32_t& label = labels[voxel];
      if (label == -1) return;
      if (mask.pixels[pixel] == 0)
        label = -1;
      else if (label == 0)
        label = 1;
    });
  });
}

void add_dense(const DenseLattice& lattice, const TruncatingCamera& camera,
               const PixelView<float>& image, std::span<float> sums) {
  check_sizes(lattice, image, sums.size());
  const Extremes<float> extremes(image);
  const Projector projector(lattice, camera, image.width, image.height);
  for_blocks(lattice, [&](std::size_t, const glm::ivec3& low, const glm::ivec3& high) {
    if (projector.unseen(low, high)) return;
    if (const auto range = projector.seen_whole(low, high)) {
      const auto [least, greatest] = extremes.of(*range);
      if (least == greatest) {
        const float value = least;
        if (value != 0)
          change_block(lattice, low, high, sums, [value](float& sum) { sum += value; });
        return;
      }
    }
    projector.for_seen(low, high, [&](std::size_t voxel, std::size_t pixel) {
      sums[voxel] += image.pixels[pixel];
    });
  });
}

}  // namespace photohull::carving
