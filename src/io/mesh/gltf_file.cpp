// Format: glTF 2.0 Specification, Khronos Group 2021, chapters 3.6 (buffers, accessors) and 4
// (GLB).
#include "io/mesh/gltf_file.h"

#include <bit>
#include <cstring>

#include "core/error.h"
#include "core/json_levels.h"
#include "core/read_file.h"
#include "io/mesh/mesh_soup.h"

namespace photohull {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

static_assert(std::endian::native == std::endian::little, "numbers are read as they lie");

/// 0 to 63; -1 for what is no digit.
int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

}  // namespace

void GltfFile::fail(const std::string& what) const {
  fail_to_read(path_, what, "repair or export the mesh again");
}

GltfFile::GltfFile(fs::path path) : path_(std::move(path)) {
  const std::string bytes = read_whole_file(path_);
  const std::string text = bytes.starts_with("glTF") ? split_binary(bytes) : bytes;
  try {
    root_ = Json::parse(text, json_level_guard(path_.string()));
  } catch (const Json::exception&) {
    fail("it is not valid JSON");
  }
  if (!root_.is_object()) fail("it is no glTF");
  const auto asset = root_.find("asset");
  if (asset == root_.end() || !asset->is_object() || !asset->contains("version") ||
      !(*asset)["version"].is_string() ||
      !(*asset)["version"].get_ref<const std::string&>().starts_with("2."))
    fail("it is not glTF of version 2");
  if (const auto needs = root_.find("extensionsRequired");
      needs != root_.end() && needs->is_array() && !needs->empty())
    fail(concat("it needs the extension ",
                (*needs)[0].dump(-1, ' ', true, Json::error_handler_t::replace),
                ", which is not supported"));
  const auto buffers = root_.find("buffers");
  buffers_.resize(buffers != root_.end() && buffers->is_array() ? buffers->size() : 0);
  loaded_.resize(buffers_.size());
}

/// Keeps the binary chunk and returns the JSON.
std::string GltfFile::split_binary(const std::string& bytes) {
  const auto word = [&](std::uint64_t at) {
    std::uint32_t value = 0;
    if (at + sizeof value > bytes.size()) fail("it ends early");
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  };
  constexpr std::uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;
  const std::uint64_t length = word(8);
  if (word(4) != 2) fail("it is not glTF of version 2");
  if (length > bytes.size()) fail(concat("it has ", bytes.size(), " bytes and claims ", length));
  std::string json;
  for (std::uint64_t at = 12; at < length;) {
    const std::uint64_t size = word(at);
    const std::uint32_t type = word(at + 4);
    at += 8;
    if (at + size > length) fail("a chunk of it is longer than the file");
    if (type == kJson) json = bytes.substr(at, size);
    if (type == kBinary) binary_ = bytes.substr(at, size);
    at += size;
  }
  return json;
}

const Json& GltfFile::element(const char* list, std::uint64_t index) const {
  const auto found = root_.find(list);
  if (found == root_.end() || !found->is_array() || index >= found->size() ||
      !(*found)[index].is_object())
    fail(concat("there is no ", list, "[", index, "]"));
  return (*found)[index];
}

std::uint64_t GltfFile::index(const Json& object, const char* key, std::uint64_t fallback) const {
  const auto found = object.find(key);
  if (found == object.end()) return fallback;
  if (!found->is_number_unsigned() || found->get<std::uint64_t>() > 0xffffffffu)
    fail(concat(key, " is no whole number below 2^32"));
  return found->get<std::uint64_t>();
}

std::uint64_t GltfFile::index(const Json& object, const char* key) const {
  if (!object.contains(key)) fail(concat(key, " is missing"));
  return index(object, key, 0);
}

std::vector<double> GltfFile::numbers(const Json& object, const char* key,
                                      std::size_t count) const {
  const auto found = object.find(key);
  if (found == object.end()) return {};
  std::vector<double> values;
  if (found->is_array() && found->size() == count)
    for (const Json& value : *found)
      if (value.is_number()) values.push_back(value.get<double>());
  if (values.size() != count) fail(concat(key, " is no list of ", count, " numbers"));
  return values;
}

std::vector<std::uint64_t> GltfFile::indices(const Json& object, const char* key) const {
  const auto found = object.find(key);
  if (found == object.end()) return {};
  if (!found->is_array()) fail(concat(key, " is no list"));
  std::vector<std::uint64_t> values;
  for (const Json& value : *found) {
    if (!value.is_number_unsigned()) fail(concat(key, " is no list of whole numbers"));
    values.push_back(value.get<std::uint64_t>());
  }
  return values;
}

/// The bytes that a URI means: base64 in itself, or a file below the folder of this one.
std::string GltfFile::decode(const std::string& uri) const {
  if (!uri.starts_with("data:")) {
    const fs::path file = path_.parent_path() / uri;
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored)) fail("its buffer " + file.string() + " is missing");
    return read_whole_file(file);
  }
  constexpr std::string_view kMark = ";base64,";
  const std::size_t mark = uri.find(kMark);
  if (mark == std::string::npos) fail("a buffer's data is not base64");
  std::string bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (std::size_t i = mark + kMark.size(); i < uri.size() && uri[i] != '='; ++i) {
    const int digit = base64_digit(uri[i]);
    if (digit < 0) fail("a buffer's data is not base64");
    bits = bits << 6 | std::uint32_t(digit);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += char(bits >> held & 0xff);
  }
  return bytes;
}

const std::string& GltfFile::buffer(std::uint64_t index) {
  const Json& object = element("buffers", index);
  const auto uri = object.find("uri");
  if (uri == object.end()) {
    if (index != 0) fail("a buffer has no data");
    return binary_;
  }
  if (!uri->is_string()) fail("a buffer's uri is no text");
  if (!loaded_[index]) buffers_[index] = decode(uri->get<std::string>());
  loaded_[index] = true;
  return buffers_[index];
}

GltfFile::Span GltfFile::span(const Json& accessor, std::uint64_t element_bytes) {
  if (accessor.contains("sparse")) fail("sparse accessors are not supported");
  const Json& view = element("bufferViews", index(accessor, "bufferView"));
  const std::string& bytes = buffer(index(view, "buffer"));
  const std::uint64_t begin = index(view, "byteOffset", 0), length = index(view, "byteLength");
  if (begin + length > bytes.size()) fail("a buffer ends early");
  const std::uint64_t first = index(accessor, "byteOffset", 0);
  Span out;
  out.count = index(accessor, "count");
  out.stride = index(view, "byteStride", element_bytes);
  if (out.stride < element_bytes) fail("a byteStride is too small");
  if (out.count > 0 && first + (out.count - 1) * out.stride + element_bytes > length)
    fail("an accessor reaches beyond its buffer");
  out.first = bytes.data() + begin + first;
  return out;
}

template <typename Vector>
std::vector<Vector> GltfFile::floats(std::uint64_t accessor, const char* type) {
  constexpr std::uint64_t kFloat = 5126;
  const Json& object = element("accessors", accessor);
  if (index(object, "componentType") != kFloat || object.value("type", Json()) != type)
    fail(concat(type[3] == '3' ? "positions must be vectors of three floats"
                               : "places on textures must be vectors of two floats"));
  const Span from = span(object, sizeof(Vector));
  std::vector<Vector> values(from.count);
  for (std::uint64_t i = 0; i < from.count; ++i)
    std::memcpy(&values[i], from.first + i * from.stride, sizeof(Vector));
  return values;
}

std::vector<glm::vec3> GltfFile::vectors(std::uint64_t accessor) {
  return floats<glm::vec3>(accessor, "VEC3");
}

std::vector<glm::vec2> GltfFile::places(std::uint64_t accessor) {
  return floats<glm::vec2>(accessor, "VEC2");
}

std::span<const std::uint8_t> GltfFile::bytes(std::uint64_t buffer_view) {
  const Json& view = element("bufferViews", buffer_view);
  const std::string& all = buffer(index(view, "buffer"));
  const std::uint64_t begin = index(view, "byteOffset", 0), length = index(view, "byteLength");
  if (begin + length > all.size()) fail("a buffer ends early");
  return {reinterpret_cast<const std::uint8_t*>(all.data()) + begin, length};
}

std::vector<std::uint32_t> GltfFile::integers(std::uint64_t accessor) {
  const Json& object = element("accessors", accessor);
  const std::uint64_t type = index(object, "componentType");
  const std::uint64_t bytes = type == 5121 ? 1 : type == 5123 ? 2 : type == 5125 ? 4 : 0;
  if (bytes == 0 || object.value("type", Json()) != "SCALAR")
    fail("indices must be unsigned whole numbers");
  const Span from = span(object, bytes);
  std::vector<std::uint32_t> values(from.count);
  for (std::uint64_t i = 0; i < from.count; ++i)
    std::memcpy(&values[i], from.first + i * from.stride, bytes);
  return values;
}

}  // namespace photohull
