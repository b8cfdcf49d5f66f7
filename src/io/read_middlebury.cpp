// Middlebury multi-view "*_par.txt": a count, then a line "name K R t" for each image, both
// matrices row by row, P = K [R | t]. Format: Seitz et al., CVPR 2006 (README of the data sets).
#include <algorithm>
#include <array>

#include "core/error.h"
#include "io/camera_checks.h"
#include "io/pose_parts.h"
#include "io/raw_scene.h"
#include "io/text_file.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr int kNumbers = 21;
constexpr std::array<const char*, kNumbers> kFieldNames = {
    "k11", "k12", "k13", "k21", "k22", "k23", "k31", "k32", "k33", "r11", "r12",
    "r13", "r21", "r22", "r23", "r31", "r32", "r33", "t1",  "t2",  "t3"};

using Numbers = std::array<double, kNumbers>;

RawView parse_view(const Lines& lines) {
  const std::vector<std::string_view> fields = split_fields(lines.text());
  // A name may hold blanks, so the numbers are counted from the end of the line.
  const bool surplus_number = fields.size() > kNumbers + 1 && parse_double(fields[1]).has_value();
  if (fields.size() < kNumbers + 1 || surplus_number)
    throw Error(concat(lines.where(), ": ", fields.size(),
                       " fields found, but an image name and 21 numbers (K, R, t) are needed"));
  const std::size_t first = fields.size() - kNumbers;
  Numbers v;
  for (int i = 0; i < kNumbers; ++i) v[i] = lines.number(fields[first + i], kFieldNames[i]);

  RawView view;
  view.where = lines.where();
  const char* name_end = fields[first - 1].data() + fields[first - 1].size();
  view.listed = std::string(fields[0].data(), name_end);
  view.camera.intrinsics = intrinsics_of(std::span<const double, 9>(v.data(), 9), view.where);
  const glm::dmat3 rows(v[9], v[10], v[11], v[12], v[13], v[14], v[15], v[16], v[17]);
  view.camera.cam_from_world.rotation =
      checked_rotation(glm::transpose(rows), view.where, "R (r11 ... r33)");
  view.camera.cam_from_world.translation = {v[18], v[19], v[20]};
  return view;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// dinoRing lists the images whose silhouettes can be trusted in a file of its own.
void mark_bad_silhouettes(const fs::path& folder, RawScene& scene) {
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder, failure)) {
    if (!entry.path().filename().string().ends_with("_good_silhouette_images.txt")) continue;
    std::vector<std::string> good, bad;
    for (Lines lines(entry.path()); lines.next_content();) good.emplace_back(lines.text());
    for (RawView& view : scene.views) {
      view.silhouette = std::find(good.begin(), good.end(), view.listed) != good.end();
      if (!view.silhouette) bad.push_back(view.listed);
    }
    if (!bad.empty())
      scene.warnings.push_back(concat(entry.path().filename().string(), " leaves out ", joined(bad),
                                      ": no silhouette is cut from them"));
  }
}

}  // namespace

RawScene read_middlebury(const fs::path& par_file) {
  RawScene scene;
  scene.format = SceneFormat::kMiddlebury;
  scene.file = par_file;
  scene.pixel_center = 0.0;
  const fs::path folder = par_file.parent_path();
  scene.image_folders = {folder, folder / "images"};

  Lines lines(par_file);
  if (!lines.next_content())
    throw Error(concat(par_file.string(),
                       ": the file is empty; its first line must be the number "
                       "of images"));
  const std::int64_t count = lines.integer(lines.text(), "the number of images");
  while (lines.next_content()) {
    if (std::int64_t(scene.views.size()) == count)
      throw Error(concat(lines.where(), ": the file states ", count,
                         " images but lists more; correct its first line"));
    scene.views.push_back(parse_view(lines));
  }
  if (std::int64_t(scene.views.size()) != count)
    throw Error(concat(par_file.string(), ": the file states ", count, " images but lists ",
                       scene.views.size(), "; complete it or correct its first line"));
  mark_bad_silhouettes(folder, scene);
  return scene;
}

}  // namespace photohull::io
