// Volumes in OpenVDB files.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/atomic_file.h"
#include "core/grid.h"
#include "volume/attributes.h"

namespace photohull {

using VdbMetadata = std::map<std::string, std::string>;

/// The length, in the scene's units, that is 1 in a file of voxels of that size: 1, or for voxels
/// below 2e-5, which OpenVDB takes for nothing, a power of a thousandth. Files say it in the
/// metadata `scene_unit`.
double vdb_unit(double voxel_size);

/// Writes an OpenVDB file with the grids
///   surface     float level set in units of vdb_unit, inside negative; active within 3 voxels
///   Cd          linear RGB (half), active where nearer than 1.5 voxels and known
///   confidence  [0, 1] (half), active where Cd is: the mean of the vertices nearby
/// the last two only where `attributes` has them. Index (i, j, k) of every grid is the voxel of
/// that index, whose centre is at grid.world({i, j, k}). `metadata` becomes string metadata of the
/// file and of every grid, beside voxel_size, scene_unit and photohull_version. Equal contents give
/// equal bytes. The file appears whole or not at all; throws Error when it cannot be written.
void write_vdb(const std::filesystem::path& path, const SparseVolume& volume,
               const VolumeAttributes& attributes, const VdbMetadata& metadata);
/// The same, for the caller to commit.
void write_vdb(AtomicFile& file, const SparseVolume& volume, const VolumeAttributes& attributes,
               const VdbMetadata& metadata);

/// Reads the grid `surface`, or else the first level set, as a volume in voxels. Indices are
/// shifted by whole bricks so that none is negative; grid.origin follows. Distances are clamped to
/// the band; tiles count by their sign. Throws Error when the file cannot be read, has no such
/// grid, or its voxels are no axis-aligned cubes.
SparseVolume read_vdb_surface(const std::filesystem::path& path);

}  // namespace photohull
