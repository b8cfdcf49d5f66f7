#include "io/mesh/mesh_writers.h"

#include <algorithm>

#include "core/error.h"
#include "io/mesh/write_mesh.h"

namespace photohull {

std::span<const MeshWriter> mesh_writers() {
  static constexpr MeshWriter kWriters[] = {
      {"ply", "colours, normals and confidence", write_ply},
      {"stl", "triangles alone, for printers", write_stl},
  };
  return kWriters;
}

const MeshWriter& find_mesh_writer(const std::string& option, const std::string& name) {
  const auto found =
      std::ranges::find_if(mesh_writers(), [&](const MeshWriter& w) { return w.name == name; });
  if (found != mesh_writers().end()) return *found;
  std::string all;
  for (const MeshWriter& w : mesh_writers()) all += (all.empty() ? "" : ", ") + std::string(w.name);
  throw UsageError(concat(option, ": there is no format '", name, "'; it is one of ", all));
}

}  // namespace photohull
