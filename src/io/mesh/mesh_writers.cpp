#include "io/mesh/mesh_writers.h"

#include <algorithm>

#include "core/error.h"
#include "io/mesh/write_mesh.h"

namespace photohull {

std::span<const MeshWriter> mesh_writers() {
  static constexpr MeshWriter kWriters[] = {
      {"ply", "colours, normals and confidence", false, false, false,
       [](AtomicFile& file, const MeshContents& contents, const OpenBeside&) {
         write_ply(file, contents.mesh);
       }},
      {"stl", "triangles alone, for printers", false, true, false, write_stl},
      {"glb", "glTF with a texture, for the web and viewers", true, true, true, write_glb},
      {"obj", "with a texture, for modelling programs", true, false, false, write_obj},
      {"usdz", "with a texture, for phones and tablets", true, true, false, write_usdz},
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
