// MathWorks, "MAT-File Format", Level 5.
#include "io/matlab_file.h"

#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "core/error.h"
#include "io/text_file.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kHeader = 128;
constexpr std::size_t kMostInflated = std::size_t(256) << 20;
constexpr int kMaxDepth = 4;  // cells in cells

enum Type : std::uint32_t {
  kInt8 = 1,
  kUint8 = 2,
  kInt16 = 3,
  kUint16 = 4,
  kInt32 = 5,
  kUint32 = 6,
  kSingle = 7,
  kDouble = 9,
  kInt64 = 12,
  kUint64 = 13,
  kMatrix = 14,
  kCompressed = 15,
  kUtf8 = 16
};

enum Class : std::uint32_t { kCell = 1, kChar = 4, kNumbersFirst = 6, kNumbersLast = 15 };

struct Element {
  std::uint32_t type = 0;
  std::string_view data;
};

/// Walks over the elements of a part of the file.
class Elements {
 public:
  Elements(std::string_view bytes, std::string where) : bytes_(bytes), where_(std::move(where)) {}

  bool done() const { return position_ >= bytes_.size(); }

  Element next() {
    Element e;
    std::uint32_t first = 0, size = 0;
    read(position_, first);
    if (first >> 16 != 0) {  // type, size and data in eight bytes
      e.type = first & 0xffff;
      size = first >> 16;
      if (size > 4) fail("a small element of more than 4 bytes");
      e.data = take(position_ + 4, size);
      position_ += 8;
      return e;
    }
    e.type = first;
    read(position_ + 4, size);
    e.data = take(position_ + 8, size);
    position_ += 8 + (e.type == kCompressed ? size : (std::size_t(size) + 7) / 8 * 8);
    return e;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(
        concat(where_, " offset ", position_, ": ", what, "; save it anew with -v7 or -v6"));
  }

 private:
  std::string_view take(std::size_t begin, std::size_t size) const {
    if (begin > bytes_.size() || size > bytes_.size() - begin) fail("the file ends too early");
    return bytes_.substr(begin, size);
  }
  void read(std::size_t at, std::uint32_t& value) const {
    std::memcpy(&value, take(at, 4).data(), 4);
  }

  std::string_view bytes_;
  std::string where_;
  std::size_t position_ = 0;
};

std::string inflate(std::string_view data, const Elements& elements) {
  std::string out;
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) elements.fail("zlib cannot start");
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
  stream.avail_in = uInt(data.size());
  int state = Z_OK;
  while (state == Z_OK && out.size() < kMostInflated) {
    const std::size_t before = out.size();
    out.resize(before + std::max<std::size_t>(4096, before));
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + before);
    stream.avail_out = uInt(out.size() - before);
    state = ::inflate(&stream, Z_NO_FLUSH);
    out.resize(out.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  if (state != Z_STREAM_END) elements.fail("a compressed variable is damaged or too large");
  return out;
}

template <typename T>
void append(std::string_view data, std::vector<double>& values) {
  values.reserve(data.size() / sizeof(T));
  for (std::size_t i = 0; i + sizeof(T) <= data.size(); i += sizeof(T)) {
    T value;
    std::memcpy(&value, data.data() + i, sizeof value);
    values.push_back(double(value));
  }
}

std::vector<double> numbers_of(const Element& e, const Elements& elements) {
  std::vector<double> values;
  switch (e.type) {
    case kInt8:
      append<std::int8_t>(e.data, values);
      break;
    case kUint8:
    case kUtf8:
      append<std::uint8_t>(e.data, values);
      break;
    case kInt16:
      append<std::int16_t>(e.data, values);
      break;
    case kUint16:
      append<std::uint16_t>(e.data, values);
      break;
    case kInt32:
      append<std::int32_t>(e.data, values);
      break;
    case kUint32:
      append<std::uint32_t>(e.data, values);
      break;
    case kSingle:
      append<float>(e.data, values);
      break;
    case kDouble:
      append<double>(e.data, values);
      break;
    case kInt64:
      append<std::int64_t>(e.data, values);
      break;
    case kUint64:
      append<std::uint64_t>(e.data, values);
      break;
    default:
      elements.fail(concat("an array of the unknown type ", e.type));
  }
  return values;
}

std::optional<MatArray> parse_array(std::string_view data, const std::string& where, int depth) {
  Elements parts(data, where);
  if (depth > kMaxDepth) parts.fail("cells are nested too deeply");
  const std::vector<double> flags = numbers_of(parts.next(), parts);
  if (flags.empty() || !(flags[0] >= 0 && flags[0] < 4294967296.0))
    parts.fail("array flags are missing");
  const auto bits = std::uint32_t(flags[0]);
  const std::uint32_t kind = bits & 0xff;
  MatArray array;
  double count = 1;
  for (const double n : numbers_of(parts.next(), parts)) {
    if (!(n >= 0 && n <= 1e9)) parts.fail("an impossible dimension");
    array.dimensions.push_back(std::size_t(n));
    count *= n;
  }
  array.name = std::string(parts.next().data);
  constexpr std::uint32_t kComplex = 0x800;
  if (bits & kComplex) return std::nullopt;
  if (kind == kCell) {
    // Each cell takes eight bytes at least.
    if (count > double(data.size()) / 8) parts.fail("more cells than the file can hold");
    for (double i = 0; i < count; ++i) {
      const Element cell = parts.next();
      if (cell.type != kMatrix) parts.fail("a cell that is no array");
      auto parsed = cell.data.empty() ? MatArray() : parse_array(cell.data, where, depth + 1);
      array.cells.push_back(parsed.value_or(MatArray()));
    }
    return array;
  }
  if (kind != kChar && (kind < kNumbersFirst || kind > kNumbersLast)) return std::nullopt;
  array.values = numbers_of(parts.next(), parts);
  if (double(array.values.size()) != count) parts.fail("sizes and data of an array differ");
  if (kind == kChar) {
    for (const double c : array.values) array.text += char(c >= 32 && c < 256 ? int(c) : '?');
    array.values.clear();
  }
  return array;
}

void put(std::string& bytes, const void* data, std::size_t size) {
  bytes.append(static_cast<const char*>(data), size);
}

void put_element(std::string& bytes, std::uint32_t type, std::string_view data) {
  const auto size = std::uint32_t(data.size());
  put(bytes, &type, 4);
  put(bytes, &size, 4);
  bytes += data;
  bytes.append((8 - data.size() % 8) % 8, '\0');
}

std::string array_bytes(const MatArray& array) {
  const bool is_text = !array.text.empty(), is_cell = !array.cells.empty();
  std::string bytes, part;
  const std::uint32_t flags[2] = {is_cell ? kCell : is_text ? kChar : kNumbersFirst, 0};
  put(part, flags, sizeof flags);
  put_element(bytes, kUint32, part);
  part.clear();
  for (const std::size_t n : array.dimensions) {
    const auto value = std::int32_t(n);
    put(part, &value, 4);
  }
  put_element(bytes, kInt32, part);
  put_element(bytes, kInt8, array.name);
  part.clear();
  for (const MatArray& cell : array.cells) put_element(bytes, kMatrix, array_bytes(cell));
  if (is_cell) return bytes;
  for (const double value : array.values) put(part, &value, 8);
  put_element(bytes, is_text ? kUtf8 : kDouble, is_text ? std::string_view(array.text) : part);
  return bytes;
}

}  // namespace

std::vector<MatArray> read_mat_file(const fs::path& file) {
  const std::string bytes = read_text_file(file);
  if (bytes.size() < kHeader || bytes.compare(126, 2, "IM") != 0)
    throw Error(concat(file.string(),
                       ": not a MAT-file of level 5 (little-endian); save it with "
                       "-v7 or -v6, not -v7.3"));
  std::vector<MatArray> variables;
  Elements elements(std::string_view(bytes).substr(kHeader), file.string());
  while (!elements.done()) {
    Element e = elements.next();
    std::string inflated;
    if (e.type == kCompressed) {
      inflated = inflate(e.data, elements);
      e = Elements(inflated, file.string()).next();
    }
    if (e.type != kMatrix) continue;
    if (auto array = parse_array(e.data, file.string(), 0)) variables.push_back(std::move(*array));
  }
  return variables;
}

std::string mat_file_bytes(std::span<const MatArray> variables) {
  std::string bytes = "MATLAB 5.0 MAT-file, projection matrices by photohull";
  bytes.resize(116, ' ');
  bytes.append(8, '\0');
  bytes += std::string("\x00\x01", 2) + "IM";
  for (const MatArray& variable : variables) put_element(bytes, kMatrix, array_bytes(variable));
  return bytes;
}

}  // namespace photohull::io
