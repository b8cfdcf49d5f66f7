// The formats that meshes are written in: a table with an entry each.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/atomic_file.h"
#include "core/mesh.h"

namespace photohull {

struct MeshWriter {
  const char* name;  ///< of the format, and extension of its files
  const char* what;  ///< they hold, for people
  /// In world coordinates. Throws Error when it cannot be written.
  void (*write)(AtomicFile& file, const TriMesh& mesh);
};

/// In the order in which they are named; the first is the one that reconstructions always write.
std::span<const MeshWriter> mesh_writers();

/// Throws UsageError that names `option` and those that there are.
const MeshWriter& find_mesh_writer(const std::string& option, const std::string& name);

// The entries but PLY's (write_mesh.h), each in a file of its name.
void write_stl(AtomicFile& file, const TriMesh& mesh);

}  // namespace photohull
