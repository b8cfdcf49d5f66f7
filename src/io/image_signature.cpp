#include "io/image_signature.h"

#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "core/error.h"
#include "io/check_openexr.h"
#include "io/find_files.h"

namespace photohull::io {
namespace {

using namespace std::string_view_literals;

/// Why not a byte of a file could be read.
std::string why_nothing(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return concat("it cannot be opened: ", std::strerror(errno));
  ::close(file);
  return "the file is empty";
}

}  // namespace

std::string known_images() {
  const auto reads = [](const char* name) { return bool(OIIO::ImageInput::create(name)); };
  std::string names = "PNG, JPEG, TIFF, OpenEXR, BMP and PNM";
  if (reads("webp")) names += ", WebP";
  if (reads("heif")) names += ", AVIF and HEIC";
  return names + " can be read";
}

const char* image_format(const std::filesystem::path& path) {
  const std::string head = file_head(path, 12);
  if (head.empty())
    throw Error(concat(path.string(), ": cannot be read as an image (", why_nothing(path),
                       "); copy or export it again"));
  if (head.starts_with("\x89PNG\r\n\x1a\n"sv)) return "png";
  if (head.starts_with("\xff\xd8\xff"sv)) return "jpeg";
  for (const auto magic : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv})
    if (head.starts_with(magic)) return "tiff";
  if (head.starts_with("\x76\x2f\x31\x01"sv)) {
    check_openexr(path);
    return "openexr";
  }
  if (head.starts_with("RIFF") && head.substr(8) == "WEBP") return "webp";
  if (head.substr(std::min<std::size_t>(4, head.size())).starts_with("ftyp")) return "heif";
  if (head.starts_with("BM")) return "bmp";
  if (head.size() > 2 && head[0] == 'P' &&
      std::string_view("123456fF").find(head[1]) != std::string_view::npos)
    return "pnm";
  throw Error(concat(path.string(),
                     ": cannot be read as an image (its beginning is none that is known); ",
                     known_images()));
}

}  // namespace photohull::io
