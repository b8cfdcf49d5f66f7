#include "carving/bounding.h"

#include <algorithm>

namespace photohull::carving {
namespace {

constexpr double kMostAtBox = 0.5;

struct Faces {
  std::size_t all = 0, at_box = 0;
};

void count_faces(const SparseVolume& volume, const Box& box, const glm::ivec3& voxel,
                 Faces& faces) {
  if (volume.at(voxel) >= 0) return;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      glm::ivec3 beside = voxel;
      beside[axis] += side;
      if (volume.at(beside) < 0) continue;
      const double place = volume.grid.world(glm::dvec3(beside))[axis];
      const double near = 0.5 * volume.grid.voxel_size;
      ++faces.all;
      faces.at_box += place < box.min[axis] + near || place > box.max[axis] - near;
    }
}

}  // namespace

double share_at_box(const SparseVolume& volume, const Box& box) {
  Faces faces;
  const glm::ivec3 n = volume.grid.voxels();
  for (int x = 0; x < n.x; ++x)
    for (int y = 0; y < n.y; ++y)
      for (int z = 0; z < n.z; ++z) count_faces(volume, box, {x, y, z}, faces);
  return faces.all == 0 ? 1 : double(faces.at_box) / double(faces.all);
}

bool silhouettes_bound(const SparseVolume& hull, const Box& box,
                       std::span<const Silhouette> silhouettes) {
  const auto masked = std::count_if(silhouettes.begin(), silhouettes.end(),
                                    [](const Silhouette& s) { return s.distance; });
  return 2 * std::size_t(masked) >= silhouettes.size() && share_at_box(hull, box) < kMostAtBox;
}

}  // namespace photohull::carving
