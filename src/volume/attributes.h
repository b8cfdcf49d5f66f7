// Colour and confidence of the surface, kept on the voxels near it.
#pragma once

#include <glm/glm.hpp>

#include "core/grid.h"
#include "core/mesh.h"
#include "core/voxel_mask.h"

namespace photohull {

/// What is known about the surface near each stored voxel: kBrickVoxels entries per slot, in the
/// order of SparseVolume::distance; or empty. Only what may be known takes memory.
struct VolumeAttributes {
  static constexpr float kUnknown = -1.0f;
  static constexpr float kReach = 1.5f;  ///< voxels from the surface that can know anything

  MaskedValues<glm::vec3> colour;  ///< linear RGB; its red is kUnknown where nothing is known
  MaskedValues<float> confidence;  ///< [0, 1]; kUnknown where nothing is known
};

/// Spreads the colours and confidences of a mesh of this volume's surface to the stored voxels
/// within kReach of it: each point of the mesh to the 8 voxels around it with trilinear weights,
/// then to neighbours that got nothing. An attribute that the mesh does not have stays empty.
VolumeAttributes attributes_from_mesh(const SparseVolume& volume, const TriMesh& mesh);

}  // namespace photohull
