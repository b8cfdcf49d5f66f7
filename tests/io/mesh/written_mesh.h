// Mesh files in a folder of a test.
#pragma once

#include <filesystem>
#include <string>

#include "io/mesh/mesh_writers.h"
#include "support/scratch_folder.h"

namespace photohull {

/// Writes mesh.FORMAT into the folder, and what lies beside it; returns its path.
std::filesystem::path write(const ScratchFolder& folder, const std::string& format,
                            const MeshContents& contents);
std::string bytes_of(const std::filesystem::path& path);

}  // namespace photohull
