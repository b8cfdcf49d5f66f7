#include "io/write_scene_parts.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/option_word.h"

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
                       " cannot express; write the Middlebury format, or with ",
                       option_word("undistort")));
}

namespace {

/// Larger differences, in pixels, are not rounding.
constexpr double kSlack = 1e-6;

[[noreturn]] void refuse(const SourceView& view, const char* format, const std::string& what) {
  throw Error(concat(view.name, ": its camera has ", what, ", which ", format,
                     " cannot express; write it with ", option_word("undistort")));
}

}  // namespace

void refuse_distortion(const SourceView& view, const char* format) {
  refuse(view, format, "a lens distortion");
}

void require_pinhole(const SourceView& view, const char* format) {
  if (view.distortion.model != DistortionModel::kNone) refuse_distortion(view, format);
}

void require_square_pixels(const SourceView& view, const char* format) {
  const Intrinsics& k = view.camera.intrinsics;
  if (std::abs(k.fx / k.fy - 1) * std::max(k.width, k.height) > kSlack)
    refuse(view, format, concat("focal lengths of ", k.fx, " and ", k.fy, " pixels"));
}

void require_centred(const SourceView& view, const char* format) {
  const Intrinsics& k = view.camera.intrinsics;
  const double x = 0.5 * (k.width - 1), y = 0.5 * (k.height - 1);
  if (std::abs(k.cx - x) > kSlack || std::abs(k.cy - y) > kSlack)
    refuse(view, format,
           concat("its principal point ", k.cx - x, ", ", k.cy - y, " pixels off the centre"));
}

std::string matrix_text(const glm::dmat3& matrix) {
  const glm::dmat3 rows = glm::transpose(matrix);
  return vector_text(rows[0]) + " " + vector_text(rows[1]) + " " + vector_text(rows[2]);
}

std::string matrix_lines(const glm::dmat3& matrix) {
  const glm::dmat3 rows = glm::transpose(matrix);
  return vector_text(rows[0]) + "\n" + vector_text(rows[1]) + "\n" + vector_text(rows[2]) + "\n";
}

std::string vector_text(const glm::dvec3& v) {
  return concat(number_text(v.x), " ", number_text(v.y), " ", number_text(v.z));
}

std::string numbered_name(std::size_t index) {
  std::ostringstream text;
  text << std::setw(8) << std::setfill('0') << index;
  return text.str();
}

std::string place_image(const SourceView& view, const fs::path& folder, const std::string& stem) {
  const fs::path target = folder / (stem + view.image.extension().string());
  std::error_code failure;
  if (!fs::equivalent(view.image, target, failure)) {
    AtomicFile file(target);
    fs::copy_file(view.image, file.temporary(), fs::copy_options::overwrite_existing, failure);
    if (failure) file.fail(failure.value());
    file.commit();
  }
  return target.filename().string();
}

std::string json_text(const nlohmann::ordered_json& root) {
  return root.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
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
