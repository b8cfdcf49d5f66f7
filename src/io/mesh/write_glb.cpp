// glTF 2.0 in its binary form (Khronos Group, 2021), with KHR_mesh_quantization and
// EXT_meshopt_compression at choice.
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "core/error.h"
#include "io/mesh/glb_buffers.h"
#include "io/mesh/gltf_file.h"
#include "io/mesh/mesh_writers.h"
#include "io/mesh/split_mesh.h"

namespace photohull {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of the format.
enum Component { kByte = 5120, kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126 };
enum Sampling { kLinear = 9729, kLinearMipmapLinear = 9987, kClampToEdge = 33071 };
constexpr std::uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr double kShortSteps = 65535, kByteSteps = 127;

std::uint16_t short_code(double share) {
  return std::uint16_t(std::lround(kShortSteps * std::clamp(share, 0.0, 1.0)));
}

/// Vertices of triangles that follow each other lie together, as codecs and viewers like it.
MeshPart in_order(MeshPart part) {
  const std::size_t corners = 3 * part.triangles.size(), count = part.vertices.size();
  if (corners == 0) return part;
  std::uint32_t* indices = part.triangles.front().data();
  meshopt_optimizeVertexCache(indices, indices, corners, count);
  std::vector<std::uint32_t> remap(count);
  const std::size_t used = meshopt_optimizeVertexFetchRemap(remap.data(), indices, corners, count);
  PHOTOHULL_CHECK_OP(used, ==, count);
  meshopt_remapIndexBuffer(indices, indices, corners, remap.data());
  MeshPart out{std::vector<std::uint32_t>(count), std::vector<glm::vec2>(part.places.size()),
               std::move(part.triangles)};
  for (std::size_t i = 0; i < count; ++i) {
    out.vertices[remap[i]] = part.vertices[i];
    if (!part.places.empty()) out.places[remap[i]] = part.places[i];
  }
  return out;
}

class GlbWriter {
 public:
  explicit GlbWriter(const MeshContents& contents)
      : contents_(contents),
        mesh_(contents.mesh),
        compress_(contents.options.compress),
        turn_(y_up_from_world(contents.up)),
        buffers_(compress_) {
    root_["asset"] = {{"version", "2.0"}, {"generator", "photohull " PHOTOHULL_VERSION}};
    root_["scene"] = 0;
    root_["scenes"] = {{{"nodes", {0}}}};
    root_["meshes"] = {{{"primitives", Json::array()}}};
    root_["materials"] = Json::array();
    root_["accessors"] = Json::array();
    set_node();
  }

  void add_all() {
    std::vector<MeshPart> parts = split_by_pages(contents_);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (parts[p].triangles.empty()) continue;
      const std::size_t material = add_material(p);
      add_part(compress_ ? in_order(std::move(parts[p])) : parts[p], material);
    }
    buffers_.finish(root_);
  }

  void write(AtomicFile& file) {
    std::string json = root_.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::vector<std::uint8_t>& bytes = buffers_.bytes();
    const std::uint64_t size = 12 + 8 + json.size() + 8 + bytes.size();
    if (size > std::numeric_limits<std::uint32_t>::max())
      throw Error(concat(file.target().string(),
                         ": a GLB file holds 4 GiB at most; export another format, or a smaller "
                         "mesh or texture"));
    put(file, {kMagic, 2, std::uint32_t(size)});
    put(file, {std::uint32_t(json.size()), kJsonChunk});
    file.write(json.data(), json.size());
    put(file, {std::uint32_t(bytes.size()), kBinaryChunk});
    file.write(bytes.data(), bytes.size());
  }

 private:
  static void put(AtomicFile& file, std::initializer_list<std::uint32_t> words) {
    file.write(std::data(words), words.size() * sizeof(std::uint32_t));
  }

  /// From the numbers of the buffers to metres. Quantised positions are whole steps from the lower
  /// corner of the mesh's bounds.
  void set_node() {
    low_ = glm::vec3(std::numeric_limits<float>::max());
    glm::vec3 high(-low_);
    for (const glm::vec3& p : mesh_.positions) {
      low_ = glm::min(low_, turned(p));
      high = glm::max(high, turned(p));
    }
    if (mesh_.positions.empty()) low_ = high = glm::vec3(0);
    const glm::vec3 size = high - low_;
    const double longest = std::max({size.x, size.y, size.z});
    step_ = compress_ && longest > 0 ? longest / kShortSteps : 1;
    const double unit = contents_.options.metres(), scale = unit * step_;
    const glm::dvec3 at =
        unit * (turn_ * mesh_.origin + (compress_ ? glm::dvec3(low_) : glm::dvec3(0)));
    root_["nodes"] = {{{"mesh", 0}, {"translation", {at.x, at.y, at.z}}}};
    if (scale != 1) root_["nodes"][0]["scale"] = {scale, scale, scale};
    if (compress_) root_["nodes"][0]["extras"] = {{kSceneUnit, unit}};
  }

  glm::vec3 turned(const glm::vec3& v) const { return glm::mat3(turn_) * v; }

  std::size_t add_accessor(std::size_t view, Component component, const char* type,
                           std::size_t count, const Json& more = {}) {
    Json accessor = {
        {"bufferView", view}, {"componentType", int(component)}, {"count", count}, {"type", type}};
    if (!more.is_null()) accessor.update(more);
    root_["accessors"].push_back(accessor);
    return root_["accessors"].size() - 1;
  }

  std::size_t add_material(std::size_t page) {
    Json material = {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}};
    if (const MeshTexture* texture = contents_.texture) {
      const PageImage image = encode_page(texture->pages[page], contents_.options.texture_format);
      root_["samplers"] = {{{"magFilter", int(kLinear)},
                            {"minFilter", int(kLinearMipmapLinear)},
                            {"wrapS", int(kClampToEdge)},
                            {"wrapT", int(kClampToEdge)}}};
      root_["images"].push_back(
          {{"bufferView", buffers_.add_bytes(image.bytes.data(), image.bytes.size())},
           {"mimeType", image.type}});
      root_["textures"].push_back({{"sampler", 0}, {"source", root_["images"].size() - 1}});
      material["pbrMetallicRoughness"]["baseColorTexture"] = {
          {"index", root_["textures"].size() - 1}};
    }
    root_["materials"].push_back(material);
    return root_["materials"].size() - 1;
  }

  void add_part(const MeshPart& part, std::size_t material) {
    Json attributes;
    attributes["POSITION"] = add_positions(part);
    if (!mesh_.normals.empty()) attributes["NORMAL"] = add_normals(part);
    if (!part.places.empty())
      attributes["TEXCOORD_0"] = add_places(part);
    else if (!mesh_.colours.empty())
      attributes["COLOR_0"] = add_colours(part);
    if (!mesh_.confidence.empty()) attributes["_CONFIDENCE"] = add_confidence(part);
    std::vector<std::uint32_t> corners;
    for (const auto& triangle : part.triangles)
      corners.insert(corners.end(), triangle.begin(), triangle.end());
    const std::size_t indices =
        add_accessor(buffers_.add_indices(corners), kUnsignedInt, "SCALAR", corners.size());
    root_["meshes"][0]["primitives"].push_back(
        {{"attributes", attributes}, {"indices", indices}, {"material", material}});
  }

  /// `value(vertex)` is what is stored of a mesh's vertex, in a multiple of 4 bytes.
  template <typename Value>
  std::size_t add_values(const MeshPart& part, const Value& value, Component component,
                         const char* type, const Json& more = {}) {
    std::vector<decltype(value(0u))> values;
    values.reserve(part.vertices.size());
    for (const std::uint32_t v : part.vertices) values.push_back(value(v));
    return add_accessor(buffers_.add_vertices(values), component, type, values.size(), more);
  }

  std::size_t add_positions(const MeshPart& part) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    const auto stored = [&](std::uint32_t v) {
      glm::vec3 p = turned(mesh_.positions[v]);
      if (compress_) p = glm::vec3(glm::round(glm::dvec3(p - low_) / step_));
      low = glm::min(low, p);
      high = glm::max(high, p);
      return p;
    };
    for (const std::uint32_t v : part.vertices) stored(v);
    const Json bounds = {{"min", {low.x, low.y, low.z}}, {"max", {high.x, high.y, high.z}}};
    if (!compress_) return add_values(part, stored, kFloat, "VEC3", bounds);
    return add_values(
        part,
        [&](std::uint32_t v) {
          const glm::vec3 p = stored(v);
          return std::array{std::uint16_t(p.x), std::uint16_t(p.y), std::uint16_t(p.z),
                            std::uint16_t(0)};
        },
        kUnsignedShort, "VEC3", bounds);
  }

  std::size_t add_normals(const MeshPart& part) {
    const auto normal = [&](std::uint32_t v) { return turned(unit_normal(mesh_, v)); };
    if (!compress_) return add_values(part, normal, kFloat, "VEC3");
    const auto code = [](float value) { return std::int8_t(std::lround(kByteSteps * value)); };
    return add_values(part,
                      [&](std::uint32_t v) {
                        const glm::vec3 n = normal(v);
                        return std::array{code(n.x), code(n.y), code(n.z), std::int8_t(0)};
                      },
                      kByte, "VEC3", {{"normalized", true}});
  }

  std::size_t add_places(const MeshPart& part) {
    const std::size_t count = part.places.size();
    if (!compress_) return add_accessor(buffers_.add_vertices(part.places), kFloat, "VEC2", count);
    std::vector<std::array<std::uint16_t, 2>> codes;
    for (const glm::vec2& place : part.places)
      codes.push_back({short_code(place.x), short_code(place.y)});
    return add_accessor(buffers_.add_vertices(codes), kUnsignedShort, "VEC2", count,
                        {{"normalized", true}});
  }

  /// Linear, as the format has it.
  std::size_t add_colours(const MeshPart& part) {
    return add_values(part,
                      [&](std::uint32_t v) {
                        const glm::vec3& c = mesh_.colours[v];
                        return std::array{short_code(c.r), short_code(c.g), short_code(c.b),
                                          std::uint16_t(kShortSteps)};
                      },
                      kUnsignedShort, "VEC4", {{"normalized", true}});
  }

  std::size_t add_confidence(const MeshPart& part) {
    if (!compress_)
      return add_values(
          part, [&](std::uint32_t v) { return mesh_.confidence[v]; }, kFloat, "SCALAR");
    return add_values(part,
                      [&](std::uint32_t v) {
                        return std::array{short_code(mesh_.confidence[v]), std::uint16_t(0)};
                      },
                      kUnsignedShort, "SCALAR", {{"normalized", true}});
  }

  const MeshContents& contents_;
  const TriMesh& mesh_;
  const bool compress_;
  const glm::dmat3 turn_;  // to +Y up
  glm::vec3 low_{0};       // corner of the turned mesh
  double step_ = 1;        // of stored positions, scene units
  Json root_;
  GlbBuffers buffers_;
};

}  // namespace

void write_glb(AtomicFile& file, const MeshContents& contents, const OpenBeside&) {
  GlbWriter writer(contents);
  writer.add_all();
  writer.write(file);
}

}  // namespace photohull
