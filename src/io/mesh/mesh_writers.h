// The formats that meshes are written in: a table with an entry each.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <string>

#include "core/atomic_file.h"
#include "core/mesh.h"
#include "core/mesh_texture.h"
#include "io/mesh/mesh_file_options.h"

namespace photohull {

/// What there is to be written; a format takes of it what it can hold.
struct MeshContents {
  const TriMesh& mesh;
  const MeshTexture* texture = nullptr;  ///< of that mesh; null: there is none
  /// A world axis, or the opposite of one: for formats that say which way is up.
  glm::dvec3 up{0, 0, 1};
  MeshFileOptions options{};
};

/// Opens a further file in the folder of the mesh's own, by its name.
using OpenBeside = std::function<AtomicFile&(const std::string& name)>;

struct MeshWriter {
  const char* name;     ///< of the format, and extension of its files
  const char* what;     ///< they hold, for people
  bool holds_textures;  ///< else it takes the vertices' colours, or none
  bool has_unit;        ///< is its unit a length?
  bool compresses;
  /// In world coordinates, but for formats that have an axis of their own for up. Throws Error when
  /// it cannot be written.
  void (*write)(AtomicFile& file, const MeshContents& contents, const OpenBeside& beside);
};

/// In the order in which they are named; the first is the one that reconstructions always write.
std::span<const MeshWriter> mesh_writers();

/// Throws UsageError that names `option` and those that there are.
const MeshWriter& find_mesh_writer(const std::string& option, const std::string& name);

// The entries but PLY's (write_mesh.h), each in a file of its name.
/// In millimetres where the scene's unit is known.
void write_stl(AtomicFile& file, const MeshContents& contents, const OpenBeside& beside);
/// glTF 2.0 in one file, in metres with +Y up; the texture's pages are base colours of a rough
/// material; without a texture the vertices' colours. Confidence is the attribute _CONFIDENCE.
void write_glb(AtomicFile& file, const MeshContents& contents, const OpenBeside& beside);
/// Wavefront OBJ in the scene's unit. With a texture an .mtl and an image for each page lie beside
/// it.
void write_obj(AtomicFile& file, const MeshContents& contents, const OpenBeside& beside);
/// Universal Scene Description as text with the pages, in a zip archive; in the scene's unit, which
/// it states, with +Y up.
void write_usdz(AtomicFile& file, const MeshContents& contents, const OpenBeside& beside);

}  // namespace photohull
