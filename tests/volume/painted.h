// Attributes of all stored voxels of a volume.
#pragma once

#include <memory>

#include "volume/attributes.h"

namespace photohull {

/// `colour` and `confidence` tell those of a stored voxel by its index.
template <typename Colour, typename Confidence>
VolumeAttributes painted(const SparseVolume& volume, const Colour& colour,
                         const Confidence& confidence) {
  const auto all = std::make_shared<VoxelMask>(volume.bricks.size());
  for (std::size_t i = 0; i < volume.distance.size(); ++i) all->mark(i);
  all->count();
  VolumeAttributes out;
  out.colour = {all, glm::vec3(0), glm::vec3(VolumeAttributes::kUnknown)};
  out.confidence = {all, 0.0f, VolumeAttributes::kUnknown};
  for (std::size_t i = 0; i < volume.distance.size(); ++i) {
    out.colour.ranked(i) = colour(i);
    out.confidence.ranked(i) = confidence(i);
  }
  return out;
}

}  // namespace photohull
