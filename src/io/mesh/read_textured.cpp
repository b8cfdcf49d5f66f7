#include "io/mesh/read_textured.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "io/decode_picture.h"
#include "io/mesh/gltf_file.h"
#include "io/mesh/split_mesh.h"

namespace photohull {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostVertices = 1u << 28;
constexpr float kFarthest = 1e30f;

const Json& object_in(const GltfFile& file, const Json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_object())
    file.fail(concat("a primitive has no ", key, ": it has no texture of photohull"));
  return *found;
}

/// The page of a primitive's material: an index of the file's images.
std::uint64_t image_of(const GltfFile& file, const Json& primitive) {
  const Json& material = file.element("materials", file.index(primitive, "material"));
  const Json& surface = object_in(file, material, "pbrMetallicRoughness");
  const Json& colour = object_in(file, surface, "baseColorTexture");
  return file.index(file.element("textures", file.index(colour, "index")), "source");
}

void add_primitive(GltfFile& file, const Json& primitive, std::uint32_t page, TexturedMesh& out) {
  TriMesh& mesh = out.mesh;
  const Json& attributes = object_in(file, primitive, "attributes");
  const std::size_t first = mesh.positions.size();
  const auto positions = file.vectors(file.index(attributes, "POSITION"));
  const auto normals = file.vectors(file.index(attributes, "NORMAL"));
  const auto places = file.places(file.index(attributes, "TEXCOORD_0"));
  if (normals.size() != positions.size() || places.size() != positions.size())
    file.fail("its lists of vertices differ in length");
  if (first + positions.size() > kMostVertices) file.fail("it has more than 268 million vertices");
  for (const glm::vec3& p : positions)
    if (!glm::all(glm::lessThan(glm::abs(p), glm::vec3(kFarthest))))
      file.fail("a position is no usable number");
  mesh.positions.insert(mesh.positions.end(), positions.begin(), positions.end());
  mesh.normals.insert(mesh.normals.end(), normals.begin(), normals.end());
  const std::vector<std::uint32_t> corners = file.integers(file.index(primitive, "indices"));
  for (const std::uint32_t corner : corners)
    if (corner >= positions.size())
      file.fail(
          concat("an index is out of range: ", corner, " of ", positions.size(), " vertices"));
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    const std::array<std::uint32_t, 3> t{corners[i], corners[i + 1], corners[i + 2]};
    const auto base = std::uint32_t(first);
    mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
    out.texture.page.push_back(page);
    out.texture.corners.push_back({places[t[0]], places[t[1]], places[t[2]]});
  }
}

void add_page(GltfFile& file, std::uint64_t image, MeshTexture& texture) {
  const auto bytes = file.bytes(file.index(file.element("images", image), "bufferView"));
  RgbImage page;
  try {
    page = io::decode_picture(bytes, concat("its texture ", image));
  } catch (const Error& error) {
    file.fail(error.what());
  }
  if (!texture.pages.empty() &&
      (page.width != texture.pages.front().width || page.height != texture.pages.front().height))
    file.fail("its textures differ in size");
  texture.pages.push_back({page.width, page.height, std::move(page.rgb)});
}

/// In metres.
struct Lengths {
  double unit = 1;  // of the scene
  double step = 1;  // 1 as positions are stored
};

Lengths lengths_of(const GltfFile& file) {
  const Json& node = file.element("nodes", 0);
  Lengths out;
  if (const auto s = file.numbers(node, "scale", 3); !s.empty()) out.unit = out.step = s[0];
  if (const auto extras = node.find("extras"); extras != node.end() && extras->is_object())
    if (const auto unit = extras->find(kSceneUnit); unit != extras->end() && unit->is_number())
      out.unit = unit->get<double>();
  if (!(out.step > 0 && out.unit > 0)) file.fail("a node's scale is none");
  return out;
}

}  // namespace

TexturedMesh read_textured_glb(const std::filesystem::path& path, const glm::dvec3& up) {
  GltfFile file(path);
  TexturedMesh out;
  const Json& mesh = file.element("meshes", 0);
  const auto primitives = mesh.find("primitives");
  if (primitives == mesh.end() || !primitives->is_array()) file.fail("a mesh has no primitives");
  std::vector<std::uint64_t> images;
  for (const Json& primitive : *primitives) {
    if (!primitive.is_object()) file.fail("a primitive is no object");
    const std::uint64_t image = image_of(file, primitive);
    auto known = std::ranges::find(images, image);
    if (known == images.end()) {
      add_page(file, image, out.texture);
      known = images.insert(images.end(), image);
    }
    add_primitive(file, primitive, std::uint32_t(known - images.begin()), out);
  }
  if (out.mesh.triangles.empty()) file.fail("it has no triangles");
  const glm::dmat3 turn = glm::transpose(y_up_from_world(up));
  const Lengths lengths = lengths_of(file);
  if (const auto t = file.numbers(file.element("nodes", 0), "translation", 3); !t.empty())
    out.mesh.origin = turn * glm::dvec3(t[0], t[1], t[2]) / lengths.unit;
  const float step = float(lengths.step / lengths.unit);
  for (glm::vec3& p : out.mesh.positions) p = glm::mat3(turn) * (step * p);
  for (glm::vec3& n : out.mesh.normals) n = glm::mat3(turn) * n;
  return out;
}

}  // namespace photohull
