// glTF 2.0 and its binary form: the JSON, and numbers out of its buffers. Internal to io/mesh.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace photohull {

inline constexpr const char* kMeshoptCompression = "EXT_meshopt_compression";
/// Name in a node's extras, of files whose positions are quantised.
inline constexpr const char* kSceneUnit = "sceneUnitInMetres";

/// Reads trust nothing: every length and index is checked, and throws the Error of fail_to_read.
class GltfFile {
 public:
  explicit GltfFile(std::filesystem::path path);

  [[noreturn]] void fail(const std::string& what) const;
  const nlohmann::json& root() const { return root_; }
  /// An element of one of the file's lists of objects ("meshes", "nodes").
  const nlohmann::json& element(const char* list, std::uint64_t index) const;
  /// A whole number of an object; `fallback` where it is absent.
  std::uint64_t index(const nlohmann::json& object, const char* key, std::uint64_t fallback) const;
  /// The same for one that must be there.
  std::uint64_t index(const nlohmann::json& object, const char* key) const;
  /// A list of exactly `count` numbers; empty where it is absent.
  std::vector<double> numbers(const nlohmann::json& object, const char* key,
                              std::size_t count) const;
  /// The elements of a list of whole numbers; empty where it is absent.
  std::vector<std::uint64_t> indices(const nlohmann::json& object, const char* key) const;

  /// The values of an accessor: VEC3 and VEC2 of floats or of what KHR_mesh_quantization allows in
  /// their place, and SCALAR of unsigned integers.
  std::vector<glm::vec3> vectors(std::uint64_t accessor);
  std::vector<glm::vec2> places(std::uint64_t accessor);
  std::vector<std::uint32_t> integers(std::uint64_t accessor);
  /// All of a buffer view, as long as this file is.
  std::span<const std::uint8_t> bytes(std::uint64_t buffer_view);

 private:
  struct Span {
    const char* first = nullptr;
    std::uint64_t count = 0, stride = 0;
  };
  template <typename Vector>
  std::vector<Vector> floats(std::uint64_t accessor, const char* type);
  void check_extensions() const;
  std::string split_binary(const std::string& bytes);
  std::string decode(const std::string& uri) const;
  const std::string& buffer(std::uint64_t index);
  /// The bytes of a view, decompressed if need be (EXT_meshopt_compression).
  std::string_view view_bytes(std::uint64_t view);
  std::string_view part_of_buffer(const nlohmann::json& object);
  const std::string& decompressed(std::uint64_t view, const nlohmann::json& code);
  Span span(const nlohmann::json& accessor, std::uint64_t element_bytes);

  std::filesystem::path path_;
  nlohmann::json root_;
  std::string binary_;                // of a .glb
  std::vector<std::string> buffers_;  // as far as they were needed
  std::vector<bool> loaded_;
  std::map<std::uint64_t, std::string> decompressed_;  // of views, as far as they were needed
};

}  // namespace photohull
