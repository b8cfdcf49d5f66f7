// Plain 3x4 projection matrices from the world to pixels: projections.txt with "NAME p11 ... p34"
// a line, a file IMAGE.P for each image, or PMVS's txt/00000000.txt under the word CONTOUR
// [Furukawa10]. Skew and unlike focal lengths are kept.
#include <algorithm>
#include <sstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/find_files.h"
#include "io/pose_parts.h"
#include "io/scene_readers.h"
#include "io/text_file.h"
#include "io/write_scene_parts.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kNumbers = 12;
constexpr const char* kList = "projections.txt";

RawView view_of(std::string listed, const std::vector<double>& rows, const std::string& where) {
  RawView view;
  view.listed = std::move(listed);
  view.where = where;
  view.camera = camera_of_projection(std::span<const double, 12>(rows.data(), 12), where);
  return view;
}

RawScene read_list(const fs::path& file) {
  RawScene scene;
  scene.file = file;
  for (Lines lines(file); lines.next_content();) {
    const std::vector<std::string_view> fields = split_fields(lines.text());
    if (fields.size() < kNumbers + 1)
      throw Error(concat(lines.where(), ": ", fields.size(),
                         " fields found, but an image name and 12 numbers are needed"));
    const std::size_t first = fields.size() - kNumbers;
    std::vector<double> rows;
    for (std::size_t i = first; i < fields.size(); ++i)
      rows.push_back(lines.number(fields[i], "a number of P"));
    std::string name(fields[0].data(), fields[first - 1].data() + fields[first - 1].size());
    scene.views.push_back(view_of(std::move(name), rows, lines.where()));
  }
  return scene;
}

RawScene read_folder(const fs::path& folder) {
  RawScene scene;
  scene.file = folder / "*.P";
  for (const fs::path& file : files_ending(folder, ".P"))
    scene.views.push_back(
        view_of(file.stem().string(), read_numbers(file, kNumbers), file.string()));
  return scene;
}

std::string text_of(const Camera& camera, const char* between_rows) {
  const std::array<double, 12> p = projection_rows(camera, 0);
  std::string text;
  for (int i = 0; i < 12; ++i)
    text += number_text(p[i]) + (i == 11 ? "\n" : i % 4 == 3 ? between_rows : " ");
  return text;
}

}  // namespace

fs::path find_projection(const fs::path& folder) {
  if (is_file(folder / kList)) return folder / kList;
  return files_ending(folder, ".P").empty() ? fs::path() : folder;
}

bool is_projection(const fs::path& file) {
  return file.filename() == kList || file.extension() == ".P";
}

RawScene read_projection(const fs::path& path) {
  std::error_code ignored;
  const bool list = path.extension() != ".P" && !fs::is_directory(path, ignored);
  const fs::path folder = fs::is_directory(path, ignored) ? path : folder_of(path);
  RawScene scene = list ? read_list(path) : read_folder(folder);
  scene.format = SceneFormat::kProjection;
  scene.image_folders = {folder, folder / "images", folder / "..", folder / ".." / "images"};
  return scene;
}

void write_projection(const Scene& scene, const fs::path& folder) {
  make_folder(folder);
  std::string text;
  for (const SourceView& view : scene.views) {
    require_pinhole(view, "a projection matrix");
    text += listed_name(view, folder, {".", "images"}) + " " + text_of(view.camera, " ");
  }
  write_atomically(folder / kList, text);
  write_bbox_file(scene, folder);
}

fs::path find_pmvs(const fs::path& folder) {
  for (const fs::path& candidate : {folder, folder / "pmvs"})
    if (is_file(candidate / "txt" / "00000000.txt")) return candidate;
  return {};
}

bool is_pmvs(const fs::path& file) { return file_head(file, 7) == "CONTOUR"; }

RawScene read_pmvs(const fs::path& given) {
  // The path of one of the matrices means all.
  const fs::path folder = given.filename() == "txt" ? folder_of(given) : given;
  RawScene scene;
  scene.format = SceneFormat::kPmvs;
  scene.file = folder / "txt";
  scene.image_folders = {folder / "visualize", folder, folder / "images"};
  for (const fs::path& file : files_ending(folder / "txt", ".txt")) {
    Lines lines(file);
    if (!lines.next_content() || lines.text() != "CONTOUR")
      throw Error(concat(lines.where(),
                         ": the first line must be CONTOUR (CONTOUR2 and other "
                         "kinds are not read)"));
    std::vector<double> rows;
    while (lines.next_content())
      for (const std::string_view field : split_fields(lines.text(), kNumbers + 1))
        rows.push_back(lines.number(field, "a number of P"));
    if (rows.size() != kNumbers)
      throw Error(concat(file.string(), ": ", rows.size(),
                         " numbers follow CONTOUR, but a 3x4 matrix has 12"));
    scene.views.push_back(view_of(file.stem().string(), rows, file.string()));
    const fs::path mask = folder / "masks" / (file.stem().string() + ".pgm");
    if (is_file(mask)) scene.views.back().mask = (fs::path("masks") / mask.filename()).string();
  }
  return scene;
}

void write_pmvs(const Scene& scene, const fs::path& folder) {
  make_folder(folder / "txt");
  make_folder(folder / "visualize");
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    const SourceView& view = scene.views[i];
    require_pinhole(view, "PMVS's format");
    place_image(view, folder / "visualize", numbered_name(i));
    write_atomically(folder / "txt" / (numbered_name(i) + ".txt"),
                     "CONTOUR\n" + text_of(view.camera, "\n"));
  }
  write_bbox_file(scene, folder);
}

}  // namespace photohull::io
