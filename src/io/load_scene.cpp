#include "io/load_scene.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "core/error.h"
#include "io/camera_checks.h"
#include "io/find_files.h"
#include "io/find_scene.h"
#include "io/formats.h"
#include "io/image_file.h"
#include "io/raw_scene.h"
#include "io/scene_box.h"
#include "io/scene_masks.h"
#include "io/scene_readers.h"
#include "io/select_views.h"
#include "io/text_file.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kFewestViews = 2;

/// Throws Error when two views share an image.
void reject_duplicates(const RawScene& raw, const std::vector<fs::path>& images) {
  std::map<fs::path, std::size_t> seen;
  for (std::size_t i = 0; i < raw.views.size(); ++i) {
    const fs::path& key =
        images[i].empty() ? fs::path(raw.views[i].listed).lexically_normal() : images[i];
    const auto [earlier, fresh] = seen.emplace(key, i);
    if (!fresh)
      throw Error(concat(raw.views[i].where, ": the image ", raw.views[i].listed,
                         " is listed twice (first in ", raw.views[earlier->second].where,
                         "); remove one"));
  }
}

/// File names where they tell the views apart, else the paths as listed.
std::vector<std::string> view_names(const RawScene& raw, const std::vector<fs::path>& images) {
  std::vector<std::string> names, paths;
  for (std::size_t i = 0; i < raw.views.size(); ++i) {
    const fs::path listed = fs::path(raw.views[i].listed).lexically_normal();
    const fs::path& named = images[i].empty() ? listed : images[i];
    names.push_back(named.filename().string());
    paths.push_back((listed.parent_path() / named.filename()).generic_string());
  }
  std::vector<std::string> sorted = names;
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end() ? names : paths;
}

[[noreturn]] void report_missing_image(const RawScene& raw, const RawView& view) {
  std::string folders;
  for (const fs::path& folder : raw.image_folders)
    folders += (folders.empty() ? "" : ", ") + (folder / "").lexically_normal().string();
  throw Error(concat(view.where, ": the image ", view.listed, " was not found (looked in ", folders,
                     "); put it there or leave the view out with --views"));
}

/// Focal lengths from fields of view, where the file states those; needs the image's size.
void complete_focal_lengths(const RawView& raw, Intrinsics& k) {
  if (k.fx == 0 && raw.angle_x > 0) k.fx = 0.5 * k.width / std::tan(0.5 * raw.angle_x);
  if (k.fy == 0 && raw.angle_y > 0) k.fy = 0.5 * k.height / std::tan(0.5 * raw.angle_y);
  if (k.fx == 0) k.fx = k.fy;
  if (k.fy == 0) k.fy = k.fx;
}

Camera complete_camera(const RawView& raw, const fs::path& image, double pixel_center) {
  Camera camera = raw.camera;
  Intrinsics& k = camera.intrinsics;
  const ImageSize size = read_image_size(image);
  if ((k.width != 0 && k.width != size.width) || (k.height != 0 && k.height != size.height))
    throw Error(concat(raw.where, ": the image size is stated as ", k.width, " x ", k.height,
                       ", but ", image.string(), " is ", size.width, " x ", size.height,
                       "; use the images that the cameras were calibrated with"));
  k.width = size.width;
  k.height = size.height;
  complete_focal_lengths(raw, k);
  // An unstated principal point is the image's centre, whatever the file's pixel convention.
  k.cx = std::isnan(k.cx) ? 0.5 * (k.width - 1) : k.cx - pixel_center;
  k.cy = std::isnan(k.cy) ? 0.5 * (k.height - 1) : k.cy - pixel_center;
  check_camera(camera, raw.distortion, raw.where);
  return camera;
}

void choose_box(const LoadSceneOptions& options, const fs::path& given, const RawScene& raw,
                Scene& scene) {
  const auto set = [&scene](const std::optional<Box>& box, const std::string& source) {
    scene.box = box;
    scene.box_source = box ? source : "";
    return box.has_value();
  };
  const fs::path folder = raw.file.parent_path();
  std::error_code ignored;
  if (set(options.box, "--box") || set(read_bbox_file(folder), "bbox.txt")) return;
  if (fs::is_directory(given, ignored) && set(read_bbox_file(given), "bbox.txt")) return;
  if (raw.box) {
    check_box(*raw.box, raw.box_source);
    set(raw.box, raw.box_source);
  } else if (raw.format == SceneFormat::kMiddlebury) {
    set(read_readme_box(folder), "README.txt");
  } else {
    set(box_of_points(raw.points), "sparse points");
  }
}

/// Indices of the views to keep.
std::vector<std::size_t> kept_views(const LoadSceneOptions& options,
                                    const std::vector<std::string>& names) {
  std::vector<std::size_t> kept = select_views(options.views, names), left_out, rest;
  if (options.hold_out.empty()) return kept;
  left_out = select_views(options.hold_out, names, "--hold-out");
  std::set_difference(kept.begin(), kept.end(), left_out.begin(), left_out.end(),
                      std::back_inserter(rest));
  return rest;
}

/// Tracks of the views that are kept: kept[i] is the raw index of the scene's view i.
void fill_tracks(const RawScene& raw, const std::vector<std::size_t>& kept, double pixel_center,
                 Scene& scene) {
  std::vector<int> index(raw.views.size(), -1);
  for (std::size_t i = 0; i < kept.size(); ++i) index[kept[i]] = int(i);
  for (const RawTrack& track : raw.tracks) {
    SceneTrack found;
    for (const RawTrack::Observation& o : track.observations) {
      const int view = index[o.view];
      if (view < 0) continue;
      const Intrinsics& k = scene.views[std::size_t(view)].camera.intrinsics;
      const glm::dvec2 origin = raw.track_origin == TrackOrigin::kPrincipal
                                    ? glm::dvec2(k.cx, k.cy)
                                    : glm::dvec2(-pixel_center);
      found.observations.push_back({view, o.pixel + origin});
    }
    auto& o = found.observations;
    std::stable_sort(o.begin(), o.end(),
                     [](const auto& a, const auto& b) { return a.view < b.view; });
    const auto twice = std::unique(o.begin(), o.end(),
                                   [](const auto& a, const auto& b) { return a.view == b.view; });
    o.erase(twice, o.end());
    if (o.size() >= 2) scene.tracks.push_back(std::move(found));
  }
}

/// Views selected by the options, their images found and their cameras completed.
std::vector<RawView> fill_views(const LoadSceneOptions& options, const RawScene& raw,
                                Scene& scene) {
  std::vector<fs::path> images;
  for (const RawView& view : raw.views)
    images.push_back(find_image(view.listed, raw.image_folders));
  reject_duplicates(raw, images);
  const std::vector<std::string> names = view_names(raw, images);
  std::vector<RawView> selected;
  const std::vector<std::size_t> kept = kept_views(options, names);
  const double center = options.pixel_center.value_or(raw.pixel_center);
  for (const std::size_t i : kept) {
    const RawView& view = raw.views[i];
    if (images[i].empty()) report_missing_image(raw, view);
    scene.views.push_back({names[i],
                           images[i],
                           {},
                           complete_camera(view, images[i], center),
                           view.distortion,
                           view.silhouette});
    selected.push_back(view);
  }
  if (scene.views.size() < kFewestViews)
    throw Error(concat(raw.file.string(), ": ", scene.views.size(),
                       !options.hold_out.empty() ? " views are left by --hold-out"
                       : options.views.empty()   ? " views are listed"
                                                 : " views are selected",
                       ", but at least ", kFewestViews, " are needed"));
  fill_tracks(raw, kept, center, scene);
  return selected;
}

RawScene read_calibrated(const fs::path& path, const CalibratedImages& images) {
  if (!is_file(path) || !is_calibration(path))
    throw Error(concat(path.string(),
                       ": is no file of photohull calibrate, which is what --images is for"));
  return read_calibration(path, images);
}

}  // namespace

void LoadSceneOptions::validate() const {
  if (pixel_center && *pixel_center != 0.0 && *pixel_center != 0.5 && *pixel_center != 1.0)
    throw UsageError(concat("--pixel-center ", *pixel_center, ": expected 0, 0.5 or 1"));
  if (masks == MaskSource::kDirectory && mask_directory.empty())
    throw UsageError(
        "--masks is empty: expected auto, background, none or the folder that holds the masks");
  if (!background.empty() && masks == MaskSource::kNone)
    throw UsageError("--background and --masks none exclude each other: give one");
  if (!background.empty() && masks == MaskSource::kDirectory)
    throw UsageError("--background and a folder of --masks exclude each other: give one");
  if (!box) return;
  try {
    check_box(*box, "--box");
  } catch (const Error& failure) {
    throw UsageError(failure.what());
  }
}

Scene load_scene(const fs::path& path, const LoadSceneOptions& options) {
  options.validate();
  SceneLocation location;
  if (!options.calibrated) location = find_scene(path, options.format);
  RawScene raw = options.calibrated ? read_calibrated(path, *options.calibrated)
                                    : format_entry(location.format).read(location.file);
  Scene scene;
  scene.path = path;
  scene.format = raw.format;
  scene.warnings = location.warnings;
  scene.warnings.insert(scene.warnings.end(), raw.warnings.begin(), raw.warnings.end());
  const std::vector<RawView> selected = fill_views(options, raw, scene);
  attach_masks(options, raw.file.parent_path(), selected, scene);
  attach_plates(options, selected, scene);
  choose_box(options, path, raw, scene);
  scene.points = std::move(raw.points);
  return scene;
}

}  // namespace photohull::io
