// OpenVDB files as this module writes and reads them; private to this module.
#pragma once

#include <openvdb/openvdb.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/grid.h"
#include "volume/write_vdb.h"

namespace photohull {

using MakeGrid = std::function<openvdb::GridBase::Ptr()>;

/// The metadata of a file of volumes on the grid, and of each of them.
openvdb::MetaMap meta_map(const GridSpec& grid, const VdbMetadata& metadata);

/// Names a grid, and says where its voxels are.
void describe(openvdb::GridBase& grid, const char* name, const GridSpec& spec,
              const openvdb::MetaMap& metadata);

/// Each grid is made when it is written and gone before the next. `tag`: 36 characters that stand
/// for the contents. Throws Error when the file cannot be written.
void write_grids(AtomicFile& file, const std::vector<MakeGrid>& grids,
                 const openvdb::MetaMap& metadata, const std::string& tag);

/// A tag of UUID's shape (version 8) of a hash of the contents. OpenVDB's own is random, so that no
/// two files would be alike.
std::string tag_of(std::uint64_t high, std::uint64_t low);

/// Runs a reader of an OpenVDB file; whatever it throws becomes an Error that names the file.
template <typename Read>
auto with_file(const std::filesystem::path& path, Read read) {
  try {
    openvdb::io::File file(path.string());
    file.open(/*delayLoad=*/false);
    return read(file);
  } catch (const Error& error) {
    throw Error(concat("cannot read ", path.string(), ": ", error.what(), "."));
  } catch (const std::exception& error) {
    throw Error(concat("cannot read ", path.string(), ": ", error.what(),
                       "; give a complete OpenVDB file."));
  }
}

}  // namespace photohull
