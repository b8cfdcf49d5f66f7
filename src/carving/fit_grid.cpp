#include "carving/fit_grid.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/option_word.h"
#include "core/too_many_voxels.h"
#include "core/viewing_depth.h"

namespace photohull::carving {
namespace {

constexpr double kMargin = 3.0;  // voxels around the box: room for the narrow band
constexpr double kRounding = 1e-12;
constexpr double kMaxBricks = 520.0 * 520 * 520;  // tables of 536 MiB; 4096^3 voxels fit

/// Along each axis, for so many voxels. Throws as fit_grid does.
glm::ivec3 bricks_for(const glm::dvec3& voxels, double voxel_size) {
  const glm::dvec3 bricks = glm::ceil((voxels + 2.0 * kMargin) / double(kBrickEdge));
  if (!is_lattice(bricks))
    throw TooManyVoxels(concat("voxel size ", voxel_size, " makes a lattice of ",
                               bricks.x * kBrickEdge, " x ", bricks.y * kBrickEdge, " x ",
                               bricks.z * kBrickEdge, " voxels, whose index alone takes ",
                               std::ceil(bricks.x * bricks.y * bricks.z * 4 / 1048576), " MiB"),
                        concat("choose a lower ", option_word("resolution"), ", a larger ",
                               option_word("voxel_size"), " or a smaller ", option_word("box")),
                        voxel_size, 1);
  return glm::ivec3(bricks);
}

void check_voxel_size(double voxel_size) {
  if (!(std::isfinite(voxel_size) && voxel_size > 0))
    throw UsageError(concat("voxel size ", voxel_size, ": must be finite and positive"));
}

}  // namespace

bool is_lattice(const glm::dvec3& bricks) { return bricks.x * bricks.y * bricks.z <= kMaxBricks; }

double pixel_footprint(const Box& box, std::span<const Camera> cameras) {
  std::vector<double> sizes;
  for (const Camera& camera : cameras) {
    const Intrinsics& k = camera.intrinsics;
    const double depth =
        box.contains(camera.center())
            ? viewing_depth(camera.projection(), camera.center(), k.width, k.height, box)
            : camera.to_camera(box.center()).z;
    const double focal = std::sqrt(std::abs(camera.intrinsics.fx * camera.intrinsics.fy));
    if (depth > 0 && focal > 0) sizes.push_back(depth / focal);
  }
  if (sizes.empty()) return 0;
  std::nth_element(sizes.begin(), sizes.begin() + long(sizes.size() / 2), sizes.end());
  return sizes[sizes.size() / 2];
}

double voxel_size_for(const Box& box, int resolution) {
  if (resolution < 2)
    throw UsageError(concat(option_word("resolution", resolution), ": at least 2"));
  const glm::dvec3 size = box.size();
  return std::max({size.x, size.y, size.z}) / resolution;
}

GridSpec fit_grid(const Box& box, double voxel_size) {
  check_voxel_size(voxel_size);
  GridSpec grid;
  grid.voxel_size = voxel_size;
  grid.bricks = bricks_for(box.size() / voxel_size, voxel_size);
  // Centre the voxels on the box, so that the margin is even.
  grid.origin = box.center() - 0.5 * voxel_size * glm::dvec3(grid.voxels() - 1);
  return grid;
}

GridSpec fixed_grid(const Box& box, double voxel_size) {
  check_voxel_size(voxel_size);
  GridSpec grid;
  grid.voxel_size = voxel_size;
  // A side of N voxels has N, whichever way its division was rounded.
  grid.bricks = bricks_for(glm::ceil(box.size() / voxel_size * (1 - kRounding)), voxel_size);
  grid.origin = box.min + voxel_size * (0.5 - kMargin);
  return grid;
}

GridSpec coarser(const GridSpec& grid) {
  GridSpec out;
  out.voxel_size = 2 * grid.voxel_size;
  out.bricks = (grid.bricks + 1) / 2;
  out.before = 0.5 * grid.before;
  out.after = 0.5 * grid.after;
  out.origin = grid.origin + 0.5 * grid.voxel_size;
  return out;
}

}  // namespace photohull::carving
