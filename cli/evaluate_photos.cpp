#include "evaluate_photos.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "core/error.h"
#include "core/parse_name.h"
#include "eval/agreement_picture.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "io/select_views.h"
#include "mesh/simplify_mesh.h"
#include "option_flags.h"
#include "photo/noise.h"
#include "pipeline/mask_policy.h"
#include "pipeline/photometric.h"
#include "views/prepare_views.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

/// Indices of the scene's views, by those of all views that its file lists; views without a usable
/// photograph, which the scene's warnings name, drop out.
std::vector<std::size_t> usable(const std::vector<std::size_t>& listed, const Scene& scene) {
  std::vector<std::size_t> out;
  for (const std::size_t i : listed) {
    const auto found =
        std::find_if(scene.views.begin(), scene.views.end(),
                     [&](const SourceView& view) { return view.name == scene.listed[i]; });
    if (found != scene.views.end()) out.push_back(std::size_t(found - scene.views.begin()));
  }
  return out;
}

struct Lists {
  std::vector<std::size_t> held_out, lenders;
};

Lists lists_of(const PhotoArguments& a, const Scene& scene) {
  const std::vector<std::string>& names = scene.listed;
  Lists lists;
  lists.held_out = io::select_views(*a.views, names);
  const std::vector<std::size_t> all = io::select_views(a.lenders.value_or(""), names, "--lenders");
  for (const std::size_t i : all) {
    const bool held_out = std::binary_search(lists.held_out.begin(), lists.held_out.end(), i);
    if (!held_out)
      lists.lenders.push_back(i);
    else if (a.lenders)
      throw UsageError(concat("--lenders: view ", i, " (", names[i],
                              ") is held out by --views and cannot lend colour"));
  }
  if (lists.lenders.empty())
    throw UsageError(concat("--views: all ", names.size(),
                            " views are held out, none is left to lend colour; hold out fewer"));
  const auto refuse = [&](const char* which, std::size_t first) {
    const auto why =
        std::find_if(scene.left_out.begin(), scene.left_out.end(),
                     [&](const LeftOutView& view) { return view.name == names[first]; });
    throw Error(concat(scene.path.string(), ": no photograph of ", which, " can be used (",
                       names[first], why == scene.left_out.end() ? "" : ": " + why->detail,
                       "); choose others"));
  };
  const Lists found = {usable(lists.held_out, scene), usable(lists.lenders, scene)};
  if (found.held_out.empty()) refuse("--views", lists.held_out.front());
  if (found.lenders.empty()) refuse("the views that lend colour", lists.lenders.front());
  return found;
}

pipeline::Photometric parse_photometric(const std::string& text) {
  using pipeline::Photometric;
  return parse_name("--photometric", text,
                    std::array{Photometric::kOff, Photometric::kAuto, Photometric::kOn});
}

/// The line that says what was done.
std::string make_alike(pipeline::Photometric photometric, const TriMesh& mesh,
                       PreparedViews& prepared, const Progress& progress) {
  std::vector<double> noise;
  for (const PreparedView& view : prepared.views) noise.push_back(estimate_image_noise(view.image));
  std::nth_element(noise.begin(), noise.begin() + long(noise.size() / 2), noise.end());
  const pipeline::PhotometricOutcome found = pipeline::measure_photometric(
      photometric, mesh, mean_edge(mesh), noise[noise.size() / 2], prepared.views, progress);
  if (found.used)
    prepared.views = pipeline::divide_by_gains(std::move(prepared.views), found.calibration);
  if (!found.warning.empty()) prepared.warnings.push_back(found.warning);
  return found.line;
}

void write_picture(AtomicFile& file, const std::string& mesh_name, const PreparedView& view,
                   const eval::PhotoMaps& maps, const eval::PhotoScore& score) {
  char figures[64];
  std::snprintf(figures, sizeof figures, "ZNCC %.3f", score.zncc().value_or(0));
  const std::string title =
      concat(fs::path(mesh_name).filename().string(), " in ", view.name, ": ", figures);
  const RgbImage image = eval::draw_agreement(view, maps, title);
  io::write_png(file, image);
}

std::string shown(const std::optional<double>& value, double scale, const char* format) {
  if (!value) return "-";
  char text[32];
  std::snprintf(text, sizeof text, format, scale * *value);
  return text;
}

void print_row(const char* name, const eval::PhotoScore& s) {
  const auto percent = [](const std::optional<double>& share) { return shown(share, 100, "%.2f"); };
  std::printf("%-24s %8s %10s %8s %9s %10s %8s %8s\n", name, shown(s.zncc(), 1, "%.4f").c_str(),
              shown(s.zncc_predicted(), 1, "%.4f").c_str(), shown(s.psnr(), 1, "%.2f").c_str(),
              percent(s.coverage()).c_str(), percent(s.predicted_share()).c_str(),
              percent(s.excess()).c_str(), percent(s.silhouette_iou()).c_str());
}

}  // namespace

void PhotoArguments::add_to(CLI::App& command) {
  CLI::Option* scene_option = command.add_option(
      "--photos", photos, "a scene: judge by its photographs that --views lists");
  const auto with_photos = [&](CLI::Option* option) { option->needs(scene_option); };
  with_photos(command.add_option(
      "--views", views,
      "photographs that were not used to make the mesh, e.g. \"0,8,16\" (reconstruct --hold-out)"));
  with_photos(command.add_option("--lenders", lenders,
                                 "photographs that lend colour (default: all others)"));
  for (CLI::Option* option : add_flags_of(command, options, {"least_angle", "window"}))
    with_photos(option);
  with_photos(command.add_option(
      "--picture", picture,
      "write a PNG of the worst view: photograph, prediction, difference, agreement"));
  with_photos(command
                  .add_option("--photometric", photometric,
                              "off, auto or on: photographs made alike in exposure, white balance "
                              "and vignetting first, by gains measured on the mesh")
                  ->capture_default_str());
  for (CLI::Option* option : scene.add_reading_options(command)) with_photos(option);
}

void PhotoArguments::check() const {
  if (!given()) return;
  if (photos->empty()) throw UsageError("--photos is empty: give the folder or file of the scene");
  if (!views || views->empty())
    throw UsageError("--photos needs --views: the views that were held out, e.g. 0,8,16");
  if (lenders && lenders->empty()) throw UsageError("--lenders is empty: write e.g. 1-7,9-15");
  options.validate();
  parse_photometric(photometric);
}

eval::PhotoAgreement judge_photos(const PhotoArguments& a, const TriMesh& mesh,
                                  const std::string& mesh_name, AtomicFile* picture,
                                  Progress& progress) {
  if (mesh.triangles.empty()) throw Error(concat(mesh_name, " has no faces; --photos needs some"));
  progress.stage("photographs", 0.2 * kPhotoWeight);
  SceneArguments reading = a.scene;
  reading.scene = *a.photos;
  reading.check();
  const io::LoadSceneOptions& load = reading.load;
  Scene scene = io::load_scene(reading.scene, load);
  const ViewLoader loader{[](const fs::path& path) { return io::read_image(path); },
                          [](const fs::path& path) { return io::read_mask(path); }};
  PrepareOptions prepare;
  prepare.masks = pipeline::mask_policy(load.masks);
  prepare.strict = load.strict;
  lists_of(a, scene);  // what is wrong with them is said before the photographs are decoded
  PreparedViews prepared = prepare_views(scene, loader, prepare, progress);
  const Lists lists = lists_of(a, scene);

  const pipeline::Photometric photometric = parse_photometric(a.photometric);
  std::string correction;
  if (photometric != pipeline::Photometric::kOff)
    correction = make_alike(photometric, mesh, prepared, progress);

  progress.stage("predictions", 0.8 * kPhotoWeight);
  eval::PhotoMaps worst;
  eval::PhotoAgreement result =
      eval::judge_by_photographs(mesh, prepared.views, lists.held_out, lists.lenders, a.options,
                                 &progress, picture ? &worst : nullptr);
  result.result_name = mesh_name;
  result.scene = *a.photos;
  result.mask_source = prepared.mask_source;
  result.photometric = correction;
  result.warnings.insert(result.warnings.begin(), prepared.warnings.begin(),
                         prepared.warnings.end());
  result.warnings.insert(result.warnings.begin(), scene.warnings.begin(), scene.warnings.end());
  if (!picture) return result;
  if (!result.worst)
    throw Error("--picture: no held-out photograph holds texture, so none is the worst");
  write_picture(*picture, mesh_name, prepared.views[worst.view], worst,
                result.views[*result.worst]);
  return result;
}

void print_agreement(const eval::PhotoAgreement& a) {
  std::printf("photographs %s: %zu held out, %zu lend colour, masks from %s\n", a.scene.c_str(),
              a.views.size(), a.lenders, a.mask_source.c_str());
  if (!a.photometric.empty()) std::printf("%s\n", a.photometric.c_str());
  std::printf("judged      %.2f %% of the foreground, by windows of %d x %d pixels\n\n",
              a.all.foreground ? 100 * double(a.all.judged) / double(a.all.foreground) : 0.0,
              a.options.window, a.options.window);
  std::printf("%-24s %8s %10s %8s %9s %10s %8s %8s\n", "", "ZNCC", "predicted", "PSNR", "covered",
              "predicted", "excess", "IoU");
  std::printf("%-24s %8s %10s %8s %9s %10s %8s %8s\n", "view", "", "only", "dB", "%", "%", "%",
              "%");
  for (const eval::PhotoScore& score : a.views) print_row(score.view.c_str(), score);
  print_row("all", a.all);
  for (const std::string& text : a.warnings) std::printf("warning: %s\n", text.c_str());
}

}  // namespace photohull::cli
