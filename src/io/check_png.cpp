#include "io/check_png.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <string_view>

#include "core/error.h"

namespace photohull::io {
namespace {

constexpr std::streamoff kSignature = 8, kChecksum = 4;

}  // namespace

void check_png(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  in.seekg(kSignature);
  // Length of the data, most significant byte first, and the chunk's type.
  for (std::array<char, 8> head; in.read(head.data(), head.size());) {
    if (std::string_view(head.data() + 4, 4) == "IEND") return;
    std::uint32_t length = 0;
    for (int i = 0; i < 4; ++i) length = length << 8 | std::uint8_t(head[std::size_t(i)]);
    in.seekg(std::streamoff(length) + kChecksum, std::ios::cur);
  }
  throw Error(concat(path.string(),
                     ": the image is damaged or cut short (the file ends before its end is "
                     "marked); export it again"));
}

}  // namespace photohull::io
