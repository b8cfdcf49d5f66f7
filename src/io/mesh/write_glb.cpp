// glTF 2.0 in its binary form (Khronos Group, 2021).
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"
#include "io/image_file.h"
#include "io/mesh/mesh_writers.h"
#include "io/mesh/split_mesh.h"

namespace photohull {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of the format.
enum Component { kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126 };
enum Target { kNoTarget = 0, kVertices = 34962, kIndices = 34963 };
enum Sampling { kLinear = 9729, kLinearMipmapLinear = 9987, kClampToEdge = 33071 };
constexpr std::uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

class GlbWriter {
 public:
  explicit GlbWriter(const MeshContents& contents)
      : contents_(contents), mesh_(contents.mesh), turn_(y_up_from_world(contents.up)) {
    root_["asset"] = {{"version", "2.0"}, {"generator", "photohull " PHOTOHULL_VERSION}};
    root_["scene"] = 0;
    root_["scenes"] = {{{"nodes", {0}}}};
    const glm::dvec3 origin = turn_ * mesh_.origin;
    root_["nodes"] = {{{"mesh", 0}, {"translation", {origin.x, origin.y, origin.z}}}};
    root_["meshes"] = {{{"primitives", Json::array()}}};
    root_["materials"] = Json::array();
    root_["accessors"] = Json::array();
    root_["bufferViews"] = Json::array();
  }

  void add_all() {
    const std::vector<MeshPart> parts = split_by_pages(contents_);
    for (std::size_t p = 0; p < parts.size(); ++p)
      if (!parts[p].triangles.empty()) add_part(parts[p], add_material(p));
    root_["buffers"] = {{{"byteLength", bytes_.size()}}};
  }

  void write(AtomicFile& file) {
    std::string json = root_.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    bytes_.resize((bytes_.size() + 3) / 4 * 4, 0);
    const std::uint64_t size = 12 + 8 + json.size() + 8 + bytes_.size();
    if (size > std::numeric_limits<std::uint32_t>::max())
      throw Error(concat(file.target().string(),
                         ": a GLB file holds 4 GiB at most; export another format, or a smaller "
                         "mesh or texture"));
    put(file, {kMagic, 2, std::uint32_t(size)});
    put(file, {std::uint32_t(json.size()), kJsonChunk});
    file.write(json.data(), json.size());
    put(file, {std::uint32_t(bytes_.size()), kBinaryChunk});
    file.write(bytes_.data(), bytes_.size());
  }

 private:
  static void put(AtomicFile& file, std::initializer_list<std::uint32_t> words) {
    file.write(std::data(words), words.size() * sizeof(std::uint32_t));
  }

  std::size_t add_view(const void* data, std::size_t size, Target target) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4, 0);
    Json view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}};
    if (target != kNoTarget) view["target"] = int(target);
    root_["bufferViews"].push_back(view);
    const auto* first = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
    return root_["bufferViews"].size() - 1;
  }

  template <typename T>
  std::size_t add_accessor(const std::vector<T>& values, Component component, const char* type,
                           std::size_t count, Target target = kVertices, const Json& more = {}) {
    Json accessor = {{"bufferView", add_view(values.data(), values.size() * sizeof(T), target)},
                     {"componentType", int(component)},
                     {"count", count},
                     {"type", type}};
    if (!more.is_null()) accessor.update(more);
    root_["accessors"].push_back(accessor);
    return root_["accessors"].size() - 1;
  }

  std::size_t add_material(std::size_t page) {
    Json material = {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}};
    if (const MeshTexture* texture = contents_.texture) {
      const TexturePage& p = texture->pages[page];
      const std::vector<std::uint8_t> png = io::encode_png(p.width, p.height, 3, p.rgb);
      root_["samplers"] = {{{"magFilter", int(kLinear)},
                            {"minFilter", int(kLinearMipmapLinear)},
                            {"wrapS", int(kClampToEdge)},
                            {"wrapT", int(kClampToEdge)}}};
      root_["images"].push_back(
          {{"bufferView", add_view(png.data(), png.size(), kNoTarget)}, {"mimeType", "image/png"}});
      root_["textures"].push_back({{"sampler", 0}, {"source", root_["images"].size() - 1}});
      material["pbrMetallicRoughness"]["baseColorTexture"] = {
          {"index", root_["textures"].size() - 1}};
    }
    root_["materials"].push_back(material);
    return root_["materials"].size() - 1;
  }

  void add_part(const MeshPart& part, std::size_t material) {
    Json attributes;
    const std::size_t count = part.vertices.size();
    attributes["POSITION"] = add_positions(part);
    if (!mesh_.normals.empty()) {
      std::vector<glm::vec3> normals;
      for (const std::uint32_t v : part.vertices)
        normals.push_back(glm::mat3(turn_) * unit_normal(mesh_, v));
      attributes["NORMAL"] = add_accessor(normals, kFloat, "VEC3", count);
    }
    if (!part.places.empty())
      attributes["TEXCOORD_0"] = add_accessor(part.places, kFloat, "VEC2", count);
    else if (!mesh_.colours.empty())
      attributes["COLOR_0"] = add_colours(part);
    if (!mesh_.confidence.empty()) {
      std::vector<float> confidence;
      for (const std::uint32_t v : part.vertices) confidence.push_back(mesh_.confidence[v]);
      attributes["_CONFIDENCE"] = add_accessor(confidence, kFloat, "SCALAR", count);
    }
    const std::size_t indices =
        add_accessor(part.triangles, kUnsignedInt, "SCALAR", 3 * part.triangles.size(), kIndices);
    root_["meshes"][0]["primitives"].push_back(
        {{"attributes", attributes}, {"indices", indices}, {"material", material}});
  }

  std::size_t add_positions(const MeshPart& part) {
    std::vector<glm::vec3> positions;
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (const std::uint32_t v : part.vertices) {
      const glm::vec3 p = glm::mat3(turn_) * mesh_.positions[v];
      low = glm::min(low, p);
      high = glm::max(high, p);
      positions.push_back(p);
    }
    return add_accessor(positions, kFloat, "VEC3", positions.size(), kVertices,
                        {{"min", {low.x, low.y, low.z}}, {"max", {high.x, high.y, high.z}}});
  }

  /// Linear, as the format has it.
  std::size_t add_colours(const MeshPart& part) {
    std::vector<std::array<std::uint16_t, 4>> colours;
    const auto code = [](float linear) {
      return std::uint16_t(65535 * std::clamp(linear, 0.0f, 1.0f) + 0.5f);
    };
    for (const std::uint32_t v : part.vertices) {
      const glm::vec3& c = mesh_.colours[v];
      colours.push_back({code(c.r), code(c.g), code(c.b), 65535});
    }
    return add_accessor(colours, kUnsignedShort, "VEC4", colours.size(), kVertices,
                        {{"normalized", true}});
  }

  const MeshContents& contents_;
  const TriMesh& mesh_;
  const glm::dmat3 turn_;  // to +Y up
  Json root_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace

void write_glb(AtomicFile& file, const MeshContents& contents, const OpenBeside&) {
  GlbWriter writer(contents);
  writer.add_all();
  writer.write(file);
}

}  // namespace photohull
