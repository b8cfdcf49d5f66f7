// MVE's views/NAME.mve/meta.ini [Fuhrmann14]: world-to-camera rotation and translation, axes as
// ours, focal length as a share of the image's longer side (as pixels are seen), principal point
// as a share of width and height, so that pixel centres are at (0.5, 0.5). libs/mve/camera.cc.
#include <map>
#include <sstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/camera_checks.h"
#include "io/find_files.h"
#include "io/natural_less.h"
#include "io/pose_parts.h"
#include "io/scene_readers.h"
#include "io/text_file.h"
#include "io/usable_views.h"
#include "io/write_scene_parts.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

/// The views' folders, in natural order.
std::vector<fs::path> view_folders(const fs::path& views) {
  std::vector<fs::path> found;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(views, failure))
    if (is_file(entry.path() / "meta.ini")) found.push_back(entry.path());
  std::sort(found.begin(), found.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return found;
}

/// The [camera] section, with the line of each value.
class CameraSection {
 public:
  explicit CameraSection(const fs::path& file) : file_(file) {
    bool inside = false;
    for (Lines lines(file); lines.next_content();) {
      const std::string_view text = lines.text();
      if (text[0] == '[') {
        inside = text == "[camera]";
        continue;
      }
      const std::size_t equals = text.find('=');
      if (equals == std::string_view::npos)
        throw Error(lines.where() + ": a line must be [SECTION] or KEY = VALUE");
      if (inside)
        values_[std::string(trimmed(text.substr(0, equals)))] = {
            lines.where(), std::string(trimmed(text.substr(equals + 1)))};
    }
  }

  /// `absent` where the key is missing.
  std::vector<double> numbers(const char* key, std::vector<double> absent) const {
    const auto found = values_.find(key);
    if (found == values_.end()) return absent;
    const auto& [where, text] = found->second;
    std::vector<double> values;
    for (const std::string_view field : split_fields(text)) {
      const auto value = parse_double(field);
      if (!value || !std::isfinite(*value))
        throw Error(concat(where, ": ", key, " holds something that is no finite number"));
      values.push_back(*value);
    }
    if (values.size() != absent.size())
      throw Error(concat(where, ": ", key, " has ", values.size(), " numbers, but ", absent.size(),
                         " are needed"));
    return values;
  }

 private:
  fs::path file_;
  std::map<std::string, std::pair<std::string, std::string>> values_;
};

/// Focal lengths in pixels of a camera whose focal length is 1.
glm::dvec2 focal_unit(int width, int height, double pixel_aspect) {
  const bool portrait = double(width) / height * pixel_aspect < 1;
  return portrait ? glm::dvec2(height / pixel_aspect, height)
                  : glm::dvec2(width, width * pixel_aspect);
}

fs::path find_photograph(const fs::path& view) {
  for (const char* name : {"undistorted", "original"}) {
    const fs::path found = find_image(name, {view});
    if (!found.empty()) return found;
  }
  return {};
}

/// Nothing where the view has no camera.
std::optional<RawView> read_view(const fs::path& folder) {
  const CameraSection section(folder / "meta.ini");
  RawView view;
  view.where = (folder / "meta.ini").string();
  const double focal = section.numbers("focal_length", {0})[0];
  if (focal == 0) return std::nullopt;
  const double aspect = section.numbers("pixel_aspect", {1})[0];
  const std::vector<double> principal = section.numbers("principal_point", {0.5, 0.5});
  const std::vector<double> r = section.numbers("rotation", {1, 0, 0, 0, 1, 0, 0, 0, 1});
  const std::vector<double> t = section.numbers("translation", {0, 0, 0});
  const std::vector<double> radial = section.numbers("radial_distortion", {0, 0});
  if (!(focal > 0) || !(aspect > 0))
    throw Error(view.where + ": focal_length and pixel_aspect must be positive");
  const fs::path image = find_photograph(folder);
  // Where there is none, load_scene says so.
  const std::string name = image.empty() ? "undistorted" : image.filename().string();
  view.listed = (folder.filename() / name).string();
  const ImageSize size = image_size_or_none(image);
  const glm::dvec2 unit = focal_unit(size.width, size.height, aspect);
  view.camera.intrinsics = {size.width,
                            size.height,
                            focal * unit.x,
                            focal * unit.y,
                            0,
                            principal[0] * size.width,
                            principal[1] * size.height};
  view.camera.cam_from_world = {
      checked_rotation(from_rows(std::span<const double, 9>(r.data(), 9)), view.where, "rotation"),
      {t[0], t[1], t[2]}};
  if (image.stem() == "original" && (radial[0] != 0 || radial[1] != 0))
    view.distortion = {DistortionModel::kBrown, {radial[0], radial[1]}};
  return view;
}

}  // namespace

fs::path find_mve(const fs::path& folder) {
  for (const fs::path& candidate : {folder / "views", folder})
    if (!view_folders(candidate).empty()) return candidate;
  return {};
}

bool is_mve(const fs::path& file) { return file.filename() == "meta.ini"; }

RawScene read_mve(const fs::path& path) {
  // The path of one meta.ini means the scene that it is a part of.
  const fs::path views = is_file(path / "meta.ini") ? folder_of(path) : path;
  RawScene scene;
  scene.format = SceneFormat::kMve;
  scene.file = views.filename() == "views" ? views : views / "*.mve";
  scene.pixel_center = 0.5;
  scene.image_folders = {views};
  std::size_t left_out = 0;
  for (const fs::path& folder : view_folders(views)) {
    if (auto view = read_view(folder))
      scene.views.push_back(std::move(*view));
    else
      ++left_out;
  }
  if (left_out > 0)
    scene.warnings.push_back(
        concat(views.string(), ": ", left_out, " views have no camera and are left out"));
  return scene;
}

void write_mve(const Scene& scene, const fs::path& folder) {
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    const SourceView& view = scene.views[i];
    require_no_skew(view, "MVE");
    require_pinhole(view, "MVE");
    const fs::path target = folder / "views" / ("view_" + numbered_name(i) + ".mve");
    make_folder(target);
    place_image(view, target, "undistorted");
    const Intrinsics& k = view.camera.intrinsics;
    const double aspect = k.fy / k.fx;
    const double focal = k.fx / focal_unit(k.width, k.height, aspect).x;
    std::ostringstream out;
    out << "# MVE view meta data\n\n[camera]\nfocal_length = " << number_text(focal)
        << "\npixel_aspect = " << number_text(aspect)
        << "\nprincipal_point = " << number_text((k.cx + 0.5) / k.width) << " "
        << number_text((k.cy + 0.5) / k.height) << "\nradial_distortion = 0 0\nrotation = "
        << matrix_text(view.camera.cam_from_world.rotation)
        << "\ntranslation = " << vector_text(view.camera.cam_from_world.translation)
        << "\n\n[view]\nid = " << i << "\nname = " << view.name << "\n";
    write_atomically(target / "meta.ini", out.str());
  }
  write_bbox_file(scene, folder);
}

}  // namespace photohull::io
