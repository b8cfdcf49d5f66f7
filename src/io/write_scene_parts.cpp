#include "io/write_scene_parts.h"

#include <charconv>
#include <cmath>

#include "core/atomic_file.h"
#include "core/error.h"

namespace photohull::io {
namespace fs = std::filesystem;

std::string number_text(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string relative_path(const fs::path& path, const fs::path& folder) {
  std::error_code failure;
  const fs::path relative = fs::proximate(path, folder, failure);
  return (failure ? path : relative).generic_string();
}

std::string listed_name(const SourceView& view, const fs::path& folder,
                        std::initializer_list<const char*> image_folders) {
  std::error_code ignored;
  for (const char* image_folder : image_folders)
    if (fs::equivalent(folder / image_folder / view.name, view.image, ignored))
      return fs::path(view.name).generic_string();
  return relative_path(view.image, folder);
}

void make_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (!fs::is_directory(folder, failure))
    throw Error(concat(folder.string(), ": the folder cannot be made (", failure.message(),
                       "); choose a place that is writable"));
}

void require_no_skew(const SourceView& view, const char* format) {
  const Intrinsics& k = view.camera.intrinsics;
  // Over the image's whole height such a skew moves nothing by more than a millionth of a pixel.
  const double shift = std::abs(k.skew / k.fy) * k.height;
  if (shift > 1e-6)
    throw Error(concat(view.name, ": its camera has a skew of ", k.skew, " pixels, which ", format,
                       " cannot express; write the Middlebury format"));
}

void write_bbox_file(const Scene& scene, const fs::path& folder) {
  if (!scene.box) return;
  std::string text;
  for (const glm::dvec3& corner : {scene.box->min, scene.box->max})
    text +=
        concat(number_text(corner.x), " ", number_text(corner.y), " ", number_text(corner.z), "\n");
  write_atomically(folder / "bbox.txt", text);
}

}  // namespace photohull::io
