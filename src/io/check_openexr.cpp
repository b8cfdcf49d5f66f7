#include "io/check_openexr.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "core/error.h"
#include "io/find_files.h"

namespace photohull::io {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as they lie");

constexpr std::size_t kLongestHeader = 1 << 20;  // bytes

/// Types whose values all have one size.
struct FixedSize {
  std::string_view type;
  std::size_t bytes;
};
constexpr FixedSize kFixedSizes[] = {{"box2i", 16},      {"box2f", 16},    {"chromaticities", 32},
                                     {"compression", 1}, {"double", 8},    {"envmap", 1},
                                     {"float", 4},       {"int", 4},       {"m33f", 36},
                                     {"m33d", 72},       {"m44f", 64},     {"m44d", 128},
                                     {"v2i", 8},         {"v2f", 8},       {"v2d", 16},
                                     {"v3i", 12},        {"v3f", 12},      {"v3d", 24},
                                     {"keycode", 28},    {"lineOrder", 1}, {"rational", 8},
                                     {"timecode", 8},    {"tiledesc", 9},  {"deepImageState", 1}};

class Header {
 public:
  Header(std::string_view bytes, const std::filesystem::path& path) : rest_(bytes), path_(path) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(concat(path_.string(), ": the image is damaged or cut short (", what,
                       "); export it again"));
  }
  std::string_view bytes(std::size_t count) {
    if (count > rest_.size()) fail("its header has no end");
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }
  std::int32_t integer() {
    std::int32_t value = 0;
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  std::string_view name() {
    constexpr std::size_t kLongestName = 255;
    const std::size_t end = rest_.find('\0');
    if (end == std::string_view::npos || end > kLongestName)
      fail("a name of its header has no end");
    return bytes(end + 1).substr(0, end);
  }
  bool done() const { return rest_.empty(); }

 private:
  std::string_view rest_;
  const std::filesystem::path& path_;
};

void check_value(std::string_view type, Header value) {
  if (type == "chlist") {
    while (!value.name().empty()) value.bytes(16);
    if (!value.done()) value.fail("its list of channels has another length");
  } else if (type == "stringvector") {
    while (!value.done()) {
      const std::int32_t length = value.integer();
      value.bytes(length < 0 ? SIZE_MAX : std::size_t(length));
    }
  } else if (type == "preview") {
    const std::int64_t width = value.integer(), height = value.integer();
    if (width < 0 || height < 0 || width > 65536 || height > 65536)
      value.fail("its preview has an impossible size");
    value.bytes(std::size_t(4 * width * height));
    if (!value.done()) value.fail("its preview has another length");
  } else if (type == "idmanifest") {
    value.fail("lists of object names are not supported");
  }
}

void check_attribute(std::string_view type, std::string_view value, Header& header,
                     const std::filesystem::path& path) {
  for (const FixedSize& fixed : kFixedSizes)
    if (type == fixed.type && value.size() != fixed.bytes)
      header.fail(concat("a value of type ", type, " has another length"));
  check_value(type, Header(value, path));
}

}  // namespace

void check_openexr(const std::filesystem::path& path) {
  constexpr std::int32_t kMultipart = 0x1000;
  const std::string bytes = file_head(path, kLongestHeader);
  Header header(bytes, path);
  header.integer();  // the signature
  const bool multipart = header.integer() & kMultipart;
  for (bool first = true;; first = false) {
    std::string_view name = header.name();
    if (name.empty() && !first) return;  // an empty part ends the list of parts
    for (; !name.empty(); name = header.name()) {
      const std::string_view type = header.name();
      const std::int32_t size = header.integer();
      if (size < 0) header.fail("an attribute has a negative length");
      check_attribute(type, header.bytes(std::size_t(size)), header, path);
    }
    if (!multipart) return;
  }
}

}  // namespace photohull::io
