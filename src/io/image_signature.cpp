#include "io/image_signature.h"

#include <string>
#include <string_view>

#include "core/error.h"
#include "io/check_openexr.h"
#include "io/find_files.h"

namespace photohull::io {
namespace {

using namespace std::string_view_literals;

}  // namespace

const char* image_format(const std::filesystem::path& path) {
  const std::string head = file_head(path, 8);
  if (head.starts_with("\x89PNG\r\n\x1a\n"sv)) return "png";
  if (head.starts_with("\xff\xd8\xff"sv)) return "jpeg";
  for (const auto magic : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv})
    if (head.starts_with(magic)) return "tiff";
  if (head.starts_with("\x76\x2f\x31\x01"sv)) {
    check_openexr(path);
    return "openexr";
  }
  if (head.starts_with("BM")) return "bmp";
  if (head.size() > 2 && head[0] == 'P' &&
      std::string_view("123456fF").find(head[1]) != std::string_view::npos)
    return "pnm";
  throw Error(
      concat(path.string(),
             ": cannot be read as an image (its beginning is none that is known); PNG, JPEG, "
             "TIFF and OpenEXR are known"));
}

}  // namespace photohull::io
