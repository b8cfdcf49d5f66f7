// Wavefront OBJ: text, with materials in a file beside it.
#include <array>
#include <cstdio>
#include <string>

#include "core/error.h"
#include "core/image.h"
#include "io/mesh/mesh_writers.h"
#include "io/mesh/split_mesh.h"

namespace photohull {
namespace {

/// Collects lines into blocks for the file.
class Lines {
 public:
  explicit Lines(AtomicFile& file) : file_(file) {}
  template <typename... Numbers>
  void add(const char* format, Numbers... numbers) {
    std::array<char, 256> line;
    const int length = std::snprintf(line.data(), line.size(), format, numbers...);
    PHOTOHULL_CHECK(length > 0 && length < int(line.size()));
    text_.append(line.data(), std::size_t(length));
    if (text_.size() > kBlock) flush();
  }
  void flush() {
    file_.write(text_.data(), text_.size());
    text_.clear();
  }

 private:
  static constexpr std::size_t kBlock = std::size_t(1) << 20;
  AtomicFile& file_;
  std::string text_;
};

void add_vertices(const MeshContents& contents, Lines& lines) {
  const TriMesh& mesh = contents.mesh;
  const bool coloured = !contents.texture && !mesh.colours.empty();
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::dvec3 p = mesh.world(v);
    if (coloured) {
      const glm::vec3 c = glm::clamp(mesh.colours[v], 0.0f, 1.0f);
      lines.add("v %.9g %.9g %.9g %.4f %.4f %.4f\n", p.x, p.y, p.z, srgb_from_linear(c.r),
                srgb_from_linear(c.g), srgb_from_linear(c.b));
    } else {
      lines.add("v %.9g %.9g %.9g\n", p.x, p.y, p.z);
    }
  }
  if (mesh.normals.empty()) return;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::vec3 n = unit_normal(mesh, v);
    lines.add("vn %.6g %.6g %.6g\n", double(n.x), double(n.y), double(n.z));
  }
}

/// `first`: the number of the part's first place.
void add_faces(const MeshContents& contents, const MeshPart& part, std::size_t first,
               Lines& lines) {
  const bool places = !part.places.empty(), normals = !contents.mesh.normals.empty();
  for (const auto& triangle : part.triangles) {
    lines.add("%s", "f");
    for (const std::uint32_t corner : triangle) {
      const std::size_t vertex = part.vertices[corner] + std::size_t(1), place = first + corner;
      if (places && normals)
        lines.add(" %zu/%zu/%zu", vertex, place, vertex);
      else if (places)
        lines.add(" %zu/%zu", vertex, place);
      else if (normals)
        lines.add(" %zu//%zu", vertex, vertex);
      else
        lines.add(" %zu", vertex);
    }
    lines.add("%c", '\n');
  }
}

void write_materials(const AtomicFile& file, const MeshContents& contents,
                     const OpenBeside& beside) {
  std::string text;
  const TextureFormat format = contents.options.texture_format;
  for (std::size_t p = 0; p < contents.texture->pages.size(); ++p) {
    const std::string name = page_name(file, p, format);
    const PageImage image = encode_page(contents.texture->pages[p], format);
    beside(name).write(image.bytes.data(), image.bytes.size());
    text +=
        concat("newmtl page_", p, "\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd ", name, "\n");
  }
  beside(file.target().stem().string() + ".mtl").write(text.data(), text.size());
}

}  // namespace

void write_obj(AtomicFile& file, const MeshContents& contents, const OpenBeside& beside) {
  const std::vector<MeshPart> parts = split_by_pages(contents);
  Lines lines(file);
  lines.add("# photohull %s\n", PHOTOHULL_VERSION);
  if (contents.texture) lines.add("mtllib %s.mtl\n", file.target().stem().c_str());
  add_vertices(contents, lines);
  for (const MeshPart& part : parts)
    for (const glm::vec2& place : part.places)
      lines.add("vt %.7g %.7g\n", double(place.x), 1 - double(place.y));
  std::size_t first = 1;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (contents.texture) lines.add("usemtl page_%zu\n", p);
    add_faces(contents, parts[p], first, lines);
    first += parts[p].places.size();
  }
  lines.flush();
  if (contents.texture) write_materials(file, contents, beside);
}

}  // namespace photohull
