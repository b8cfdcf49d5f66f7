// Format: glTF 2.0 Specification, Khronos Group 2021, chapters 3.6 (buffers, accessors) and 4
// (GLB); KHR_mesh_quantization and EXT_meshopt_compression.
#include "io/mesh/gltf_file.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <type_traits>

#include "core/error.h"
#include "core/json_levels.h"
#include "core/read_file.h"
#include "io/mesh/mesh_soup.h"

namespace photohull {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

static_assert(std::endian::native == std::endian::little, "numbers are read as they lie");

constexpr std::array kExtensions{std::string_view(kMeshoptCompression),
                                 std::string_view("KHR_mesh_quantization")};
/// Bytes of vertices that a byte of their code stands for at most, as codes of vertices have 2 bits
/// for each 16. More than that is a claim that only takes memory.
constexpr std::uint64_t kMostExpansion = 64;

/// A number as it is stored; whole numbers that are normalised lie from -1 or 0 to 1.
template <typename T>
float number_at(const char* at, bool normalised) {
  T value;
  std::memcpy(&value, at, sizeof value);
  if constexpr (std::is_integral_v<T>)
    if (normalised) return std::max(-1.0f, float(value) / float(std::numeric_limits<T>::max()));
  return float(value);
}

/// A type of numbers.
struct NumberType {
  std::uint64_t code, bytes;
  float (*read)(const char* at, bool normalised);
};
constexpr std::array<NumberType, 5> kNumberTypes{{{5120, 1, number_at<std::int8_t>},
                                                  {5121, 1, number_at<std::uint8_t>},
                                                  {5122, 2, number_at<std::int16_t>},
                                                  {5123, 2, number_at<std::uint16_t>},
                                                  {5126, 4, number_at<float>}}};

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
  check_extensions();
  const auto buffers = root_.find("buffers");
  buffers_.resize(buffers != root_.end() && buffers->is_array() ? buffers->size() : 0);
  loaded_.resize(buffers_.size());
}

void GltfFile::check_extensions() const {
  const auto needs = root_.find("extensionsRequired");
  if (needs == root_.end() || !needs->is_array()) return;
  for (const Json& name : *needs)
    if (!name.is_string() ||
        std::ranges::find(kExtensions, name.get_ref<const std::string&>()) == kExtensions.end())
      fail(concat("it needs the extension ",
                  name.dump(-1, ' ', true, Json::error_handler_t::replace),
                  ", which is not supported"));
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
  const std::uint64_t view = index(accessor, "bufferView");
  const std::string_view bytes = view_bytes(view);
  const std::uint64_t first = index(accessor, "byteOffset", 0);
  Span out;
  out.count = index(accessor, "count");
  out.stride = index(element("bufferViews", view), "byteStride", element_bytes);
  if (out.stride < element_bytes) fail("a byteStride is too small");
  if (out.count > 0 && first + (out.count - 1) * out.stride + element_bytes > bytes.size())
    fail("an accessor reaches beyond its buffer");
  out.first = bytes.data() + first;
  return out;
}

std::string_view GltfFile::view_bytes(std::uint64_t view) {
  const Json& object = element("bufferViews", view);
  if (const auto extensions = object.find("extensions");
      extensions != object.end() && extensions->is_object())
    if (const auto code = extensions->find(kMeshoptCompression); code != extensions->end()) {
      if (!code->is_object()) fail(concat(kMeshoptCompression, " of a buffer view is no object"));
      return decompressed(view, *code);
    }
  return part_of_buffer(object);
}

/// What an object's buffer, byteOffset and byteLength mean.
std::string_view GltfFile::part_of_buffer(const Json& object) {
  const std::string& all = buffer(index(object, "buffer"));
  const std::uint64_t begin = index(object, "byteOffset", 0), length = index(object, "byteLength");
  if (begin + length > all.size()) fail("a buffer ends early");
  return std::string_view(all).substr(begin, length);
}

const std::string& GltfFile::decompressed(std::uint64_t view, const Json& code) {
  if (const auto known = decompressed_.find(view); known != decompressed_.end())
    return known->second;
  const std::string_view from = part_of_buffer(code);
  const std::uint64_t count = index(code, "count"), stride = index(code, "byteStride");
  const Json mode = code.value("mode", Json()), filter = code.value("filter", Json("NONE"));
  if (filter != "NONE") fail("filters of EXT_meshopt_compression are not supported");
  const bool vertices = mode == "ATTRIBUTES", triangles = mode == "TRIANGLES";
  const bool indices = triangles || mode == "INDICES";
  if (vertices ? stride == 0 || stride > 256 || stride % 4 != 0
               : !indices || (stride != 2 && stride != 4) || (triangles && count % 3 != 0))
    fail("a compressed buffer view is none of EXT_meshopt_compression");
  if (count * (vertices ? stride : 1) > kMostExpansion * (from.size() + 1))
    fail("a compressed buffer view is shorter than its count needs");
  std::string plain(count * stride, '\0');
  const auto* bytes = reinterpret_cast<const unsigned char*>(from.data());
  const int failed =
      vertices    ? meshopt_decodeVertexBuffer(plain.data(), count, stride, bytes, from.size())
      : triangles ? meshopt_decodeIndexBuffer(plain.data(), count, stride, bytes, from.size())
                  : meshopt_decodeIndexSequence(plain.data(), count, stride, bytes, from.size());
  if (failed) fail("a compressed buffer view is damaged");
  return decompressed_[view] = std::move(plain);
}

template <typename Vector>
std::vector<Vector> GltfFile::floats(std::uint64_t accessor, const char* type) {
  const Json& object = element("accessors", accessor);
  const auto component =
      std::ranges::find(kNumberTypes, index(object, "componentType"), &NumberType::code);
  if (component == kNumberTypes.end() || object.value("type", Json()) != type)
    fail(concat(type[3] == '3' ? "positions must be vectors of three numbers"
                               : "places on textures must be vectors of two numbers"));
  const bool normalised = object.value("normalized", Json(false)) == Json(true);
  constexpr int kNumbers = Vector::length();
  const Span from = span(object, component->bytes * kNumbers);
  std::vector<Vector> values(from.count);
  for (std::uint64_t i = 0; i < from.count; ++i)
    for (int c = 0; c < kNumbers; ++c)
      values[i][c] =
          component->read(from.first + i * from.stride + component->bytes * c, normalised);
  return values;
}

std::vector<glm::vec3> GltfFile::vectors(std::uint64_t accessor) {
  return floats<glm::vec3>(accessor, "VEC3");
}

std::vector<glm::vec2> GltfFile::places(std::uint64_t accessor) {
  return floats<glm::vec2>(accessor, "VEC2");
}

std::span<const std::uint8_t> GltfFile::bytes(std::uint64_t buffer_view) {
  const std::string_view all = view_bytes(buffer_view);
  return {reinterpret_cast<const std::uint8_t*>(all.data()), all.size()};
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
