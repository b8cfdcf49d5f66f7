#include "io/load_scene.h"

#include <algorithm>
#include <iterator>

#include "core/error.h"
#include "core/left_out.h"
#include "core/option_word.h"
#include "io/find_scene.h"
#include "io/formats.h"
#include "io/raw_scene.h"
#include "io/scene_box.h"
#include "io/scene_masks.h"
#include "io/scene_readers.h"
#include "io/select_views.h"
#include "io/spread_views.h"
#include "io/text_file.h"
#include "io/usable_views.h"
#include "io/write_scene.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kFewestViews = 2;
constexpr const char* kAllViews = "all";

void choose_box(const LoadSceneOptions& options, const fs::path& given, const RawScene& raw,
                Scene& scene) {
  const auto set = [&scene](const std::optional<Box>& box, const std::string& source) {
    scene.box = box;
    scene.box_source = box ? source : "";
    return box.has_value();
  };
  const fs::path folder = raw.file.parent_path();
  std::error_code ignored;
  if (set(options.box, option_word("box"))) {
    const std::string axes = sort_corners(*scene.box);
    if (!axes.empty())
      scene.warnings.push_back(concat("the corners of ", option_word("box"), " are swapped along ",
                                      axes, ": they were sorted"));
    return;
  }
  if (set(read_bbox_file(folder), "bbox.txt")) return;
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

/// Indices of the views that were chosen, hold-outs and all that --views leaves out gone.
std::vector<std::size_t> chosen_views(const LoadSceneOptions& options,
                                      const std::vector<std::string>& names) {
  const bool named_all = std::find(names.begin(), names.end(), kAllViews) != names.end();
  const bool all = (options.views == kAllViews && !named_all) || parse_spread(options.views);
  std::vector<std::size_t> kept = select_views(all ? "" : options.views, names), left_out, rest;
  if (options.hold_out.empty()) return kept;
  const bool held_name = std::find(names.begin(), names.end(), options.hold_out) != names.end();
  if (!held_name && (options.hold_out == kAllViews || parse_spread(options.hold_out)))
    throw UsageError(concat(option_word("hold_out", options.hold_out),
                            ": name the views to leave out, e.g. 0,8,16, for at least ",
                            kFewestViews, " must be left"));
  left_out = select_views(options.hold_out, names, option_word("hold_out"));
  std::set_difference(kept.begin(), kept.end(), left_out.begin(), left_out.end(),
                      std::back_inserter(rest));
  return rest;
}

/// Where a feature is in the photograph, which may be a scaled copy of the one that the file means.
glm::dvec2 track_pixel(const RawScene& raw, const RawView& stated, const SourceView& view,
                       double pixel_center, const glm::dvec2& pixel) {
  const Intrinsics &from = stated.camera.intrinsics, &k = view.camera.intrinsics;
  const glm::dvec2 factor(from.width > 0 ? double(k.width) / from.width : 1,
                          from.height > 0 ? double(k.height) / from.height : 1);
  return raw.track_origin == TrackOrigin::kPrincipal ? factor * pixel + glm::dvec2(k.cx, k.cy)
                                                     : factor * (pixel - pixel_center + 0.5) - 0.5;
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
      found.observations.push_back(
          {view, track_pixel(raw, raw.views[o.view], scene.views[std::size_t(view)], pixel_center,
                             o.pixel)});
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

void note_scaled(const RawView& stated, const SourceView& view, Scene& scene) {
  const Intrinsics &from = stated.camera.intrinsics, &k = view.camera.intrinsics;
  scene.warnings.push_back(
      concat(scene.scaled, " of ", scene.views.size(),
             " photographs are scaled copies of those that the cameras are for (", view.name,
             " is ", k.width, " x ", k.height, ", its camera is for ", from.width, " x ",
             from.height, "): the cameras were scaled with them"));
}

/// Fills the scene with those of the chosen views whose photographs can be used; raw indices.
std::vector<std::size_t> fill_usable(const LoadSceneOptions& options, const RawScene& raw,
                                     double pixel_center, Scene& scene) {
  const Photographs photographs = find_photographs(raw);
  scene.listed = photographs.names;
  const std::vector<std::size_t> chosen = chosen_views(options, photographs.names);
  if (chosen.size() < kFewestViews)
    throw Error(concat(raw.file.string(), ": ", chosen.size(),
                       chosen.size() == 1 ? " view is" : " views are",
                       !options.hold_out.empty() ? concat(" left by ", option_word("hold_out"))
                       : options.views.empty()   ? " listed"
                                                 : " selected",
                       ", but at least ", kFewestViews, " are needed"));
  std::vector<std::size_t> usable;
  std::vector<LeftOutView> left_out;
  std::optional<std::size_t> first_scaled;
  for (const std::size_t i : chosen) {
    CheckedView checked = check_view(raw, i, photographs, pixel_center);
    if (!checked.view) {
      left_out.push_back(std::move(checked.left_out));
      continue;
    }
    if (checked.scaled && scene.scaled++ == 0) first_scaled = usable.size();
    scene.views.push_back(std::move(*checked.view));
    usable.push_back(i);
  }
  const auto warnings = note_left_out(scene, left_out, options.strict);
  scene.warnings.insert(scene.warnings.end(), warnings.begin(), warnings.end());
  if (first_scaled)
    note_scaled(raw.views[usable[*first_scaled]], scene.views[*first_scaled], scene);
  return usable;
}

/// Keeps as many of the views as were asked for; where nothing was said, not more than are worth
/// their time.
void thin_out(const LoadSceneOptions& options, std::vector<std::size_t>& usable, Scene& scene) {
  const std::size_t all = usable.size();
  const bool unasked = options.views.empty() && options.most_views > 0 && all > options.most_views;
  const std::size_t count =
      unasked ? options.most_views : parse_spread(options.views).value_or(all);
  if (count >= all) return;
  std::vector<SourceView> views;
  std::vector<std::size_t> kept;
  for (const std::size_t i : spread_views(scene.views, scene.box, count)) {
    views.push_back(std::move(scene.views[i]));
    kept.push_back(usable[i]);
  }
  scene.passed_over = int(all - count);
  scene.views = std::move(views);
  usable = std::move(kept);
  if (unasked)
    scene.warnings.push_back(concat(
        count, " of ", all,
        " photographs are used, spread over all directions: more would add little but time (",
        option_word("views", "all"), " takes all, ", option_word("views", "spread:N"),
        " another number)"));
}

/// Views chosen by the options, with their photographs, cameras and tracks.
std::vector<RawView> fill_views(const LoadSceneOptions& options, const RawScene& raw,
                                Scene& scene) {
  const double center = options.pixel_center.value_or(raw.pixel_center);
  std::vector<std::size_t> usable = fill_usable(options, raw, center, scene);
  thin_out(options, usable, scene);
  fill_tracks(raw, usable, center, scene);
  std::vector<RawView> selected;
  for (const std::size_t i : usable) selected.push_back(raw.views[i]);
  return selected;
}

RawScene read_calibrated(const fs::path& path, const CalibratedImages& images) {
  if (!is_file(path) || !is_calibration(path))
    throw Error(concat(path.string(), ": is no file of photohull calibrate, which is what ",
                       option_word("step"), ", ", option_word("angles"), " and ",
                       option_word("moment"), " are for"));
  return read_calibration(path, images);
}

constexpr const char* kPixelCenters = "0, 0.5 or 1";

/// Where masks come from, by a word, or their folder.
Words mask_words(LoadSceneOptions& o) {
  static constexpr std::pair<MaskSource, const char*> kSources[] = {
      {MaskSource::kAuto, "auto"},
      {MaskSource::kBackground, "background"},
      {MaskSource::kNone, "none"}};
  return {[&o] {
            for (const auto& [source, word] : kSources)
              if (o.masks == source) return std::string(word);
            return o.mask_directory.string();
          },
          [&o](const std::string& text) {
            o.masks = MaskSource::kDirectory;
            for (const auto& [source, word] : kSources)
              if (text == word) o.masks = source;
            o.mask_directory = o.masks == MaskSource::kDirectory ? text : "";
            return true;
          }};
}

}  // namespace

void LoadSceneOptions::validate() const {
  parse_spread(views);
  const std::string given = option_word("masks"), plates = option_word("background");
  if (pixel_center && *pixel_center != 0.0 && *pixel_center != 0.5 && *pixel_center != 1.0)
    throw UsageError(
        concat(option_word("pixel_center", *pixel_center), ": expected ", kPixelCenters));
  if (masks == MaskSource::kDirectory && mask_directory.empty())
    throw UsageError(concat(
        given, " is empty: expected auto, background, none or the folder that holds the masks"));
  if (!background.empty() && masks == MaskSource::kNone)
    throw UsageError(
        concat(plates, " and ", option_word("masks", "none"), " exclude each other: give one"));
  if (!background.empty() && masks == MaskSource::kDirectory)
    throw UsageError(concat(plates, " and a folder of ", given, " exclude each other: give one"));
  if (!images.empty() && calibrated)
    throw UsageError("the photographs of a calibration are given once");
  if (!box) return;
  try {
    Box sorted = *box;
    sort_corners(sorted);
    check_box(sorted, option_word("box"));
  } catch (const Error& failure) {
    throw UsageError(failure.what());
  }
}

void describe_views(Described& to, LoadSceneOptions& o) {
  to.text("views", &o.views,
          concat("views to use, e.g. \"0-10,15,img_*.png\"; spread:N (N that show the object from "
                 "all sides) or all (default: all; to reconstruct, spread:",
                 kEnoughViews, " where there are more)"))
      .if_empty = "write e.g. 0-10,15";
  to.text("hold_out", &o.hold_out,
          concat("views to leave out of these, a list of the same kind; '",
                 command_word("evaluate", "photos"), "' judges by them"))
      .if_empty = "write e.g. 0,8,16";
}

void describe_reading(Described& to, LoadSceneOptions& o) {
  to.choice("format", &o.format, scene_formats(), "how the scene is read (default: detected)");
  to.text("masks", mask_words(o),
          "auto (files, alpha, else a background model), background (always that), none, or a "
          "folder of masks")
      .always = true;
  to.text("background", &o.background,
          "masks from photographs without the object: a file for a camera that stands still, or a "
          "folder with one for every view")
      .if_empty = "give a photograph without the object, or a folder";
  to.text("images", &o.images,
          "folder of the photographs, where they are not where the scene has them")
      .if_empty = "give a folder of photographs";
  to.number("pixel_center", &o.pixel_center, from_to(0, 1), "pixels",
            "coordinate of the top-left pixel's centre in the scene file (default: the format's)")
      .expects = kPixelCenters;
  to.flag("strict", &o.strict,
          "refuse scenes whose photographs are not all there, readable and of their cameras' "
          "shape, and folders of masks that lack some (default: such photographs are left out "
          "while two of three remain, such masks done without)");
}

Scene load_scene(const fs::path& path, const LoadSceneOptions& options) {
  options.validate();
  std::error_code ignored;
  if (!options.images.empty() && !fs::is_directory(options.images, ignored))
    throw Error(concat(options.images.string(), ": is no folder of photographs (",
                       option_word("images"), ")"));
  std::optional<CalibratedImages> calibrated = options.calibrated;
  if (!options.images.empty() && is_file(path) && is_calibration(path))
    calibrated = CalibratedImages{options.images, {}, {}, {}};
  SceneLocation location;
  if (!calibrated) location = find_scene(path, options.format);
  RawScene raw = calibrated ? read_calibrated(path, *calibrated)
                            : read_raw_scene(location.format, location.file, options.images);
  Scene scene;
  scene.path = path;
  scene.file = location.file.empty() ? raw.file : location.file;
  scene.format = raw.format;
  scene.warnings = location.warnings;
  scene.warnings.insert(scene.warnings.end(), raw.warnings.begin(), raw.warnings.end());
  choose_box(options, path, raw, scene);
  const std::vector<RawView> selected = fill_views(options, raw, scene);
  attach_masks(options, raw.file.parent_path(), selected, scene);
  attach_plates(options, selected, scene);
  scene.points = std::move(raw.points);
  return scene;
}

}  // namespace photohull::io
