// Volumes of parts of a lattice put together in one OpenVDB file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "core/atomic_file.h"
#include "core/grid.h"
#include "volume/write_vdb.h"

namespace photohull {

/// A grid that holds the lattices of files as write_vdb makes them: voxels of one size, whole
/// bricks apart. Its number of bricks may be larger than that of a volume in memory. Throws Error
/// where a file cannot be read, or is of other voxels than the first.
GridSpec joined_grid(std::span<const std::filesystem::path> files);

/// Writes the grids of the files as those of one file on the joined grid, for the caller to commit:
/// `surface`, and `Cd` and `confidence` where a file has them. Of a brick that more than
/// one file stores, the first one's is taken. Specks of a few voxels that end where the bricks of
/// their file do are left out: the file beside it tells of none. One grid of all files is in memory
/// at a time. Equal files give equal bytes. Throws as joined_grid does, and Error when the file
/// cannot be written.
void join_vdb(AtomicFile& file, std::span<const std::filesystem::path> files,
              const VdbMetadata& metadata);

/// Bytes of memory that join_vdb takes, at least.
std::size_t joined_bytes(std::span<const std::filesystem::path> files);

}  // namespace photohull
