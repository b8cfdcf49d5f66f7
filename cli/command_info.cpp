#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>

#include "calib/diagnose.h"
#include "calib/prepare_views.h"
#include "commands.h"
#include "core/parse_name.h"
#include "io/image_file.h"
#include "pipeline/image_scale.h"
#include "pipeline/inspect.h"
#include "pipeline/mask_policy.h"
#include "pipeline/memory.h"
#include "pipeline/plan.h"
#include "scene_arguments.h"
#include "terminal_progress.h"

namespace photohull::cli {
namespace {

struct Arguments {
  SceneArguments scene;
  std::optional<int> resolution;
  std::optional<double> voxel_size;
  std::string quality = "normal", image_scale = "auto", max_memory = "auto";
  std::optional<std::string> method;
  bool json = false, cameras = false, masks = false;
};

struct Range {
  double low = 1e300, high = -1e300;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

void print_views(const Scene& scene) {
  Range focal, width, height;
  int distorted = 0, masked = 0;
  for (const SourceView& view : scene.views) {
    focal.add(view.camera.intrinsics.fx);
    width.add(view.camera.intrinsics.width);
    height.add(view.camera.intrinsics.height);
    distorted += view.distortion.model != DistortionModel::kNone;
    masked += !view.mask.empty();
  }
  std::printf("views          %zu (%s format)\n", scene.views.size(), to_string(scene.format));
  std::printf("image size     %.0f x %.0f", width.low, height.low);
  if (width.low != width.high || height.low != height.high)
    std::printf(" to %.0f x %.0f", width.high, height.high);
  std::printf(" pixels\nfocal length   %.1f", focal.low);
  if (focal.low != focal.high) std::printf(" to %.1f", focal.high);
  std::printf(" pixels\ndistortion     %d of %zu views\nmask files     %d of %zu views\n",
              distorted, scene.views.size(), masked, scene.views.size());
}

void print_text(const pipeline::Inspection& info) {
  print_views(info.scene);
  if (info.scene.box) {
    const Box& b = *info.scene.box;
    const glm::ivec3 n = info.grid.voxels();
    std::printf("box            (%g %g %g) to (%g %g %g), from %s\n", b.min.x, b.min.y, b.min.z,
                b.max.x, b.max.y, b.max.z, info.scene.box_source.c_str());
    std::printf("view angles    %.1f degrees to the nearest (median), %.1f at most\n",
                info.nearest_angle, info.farthest_angle);
    std::printf("pixel          %g world units at the box's centre\n", info.voxel_size);
    std::printf("voxels         %d x %d x %d of %g\n", n.x, n.y, n.z, info.grid.voxel_size);
    std::printf("image scale    %s\n", pipeline::smallest_scale_text(info.scales).c_str());
    std::printf("estimate       %lld MiB, %.0f CPU seconds (software rasterizer)\n",
                static_cast<long long>(info.memory_bytes >> 20), info.cpu_seconds);
  }
  for (const std::string& text : info.warnings) std::printf("warning: %s\n", text.c_str());
}

void print_readings(const CameraDiagnosis& d) {
  if (d.readings.empty()) return;
  const auto print = [](const char* name, const PoseReading& r) {
    std::printf("%-14s %s: explains %.0f %% of the matches", name, to_string(r).c_str(),
                100 * r.explained);
    if (std::isfinite(r.residual))
      std::printf(", median %.2f px from the epipolar lines", r.residual);
    std::printf("\n");
  };
  std::printf("matches        %d features in %d pairs of views\n", d.matches, d.pairs);
  print("poses", d.given);
  print(d.misread ? "better" : "next best", d.readings[d.readings[0].as_given() ? 1 : 0]);
}

void print_diagnosis(const CameraDiagnosis& d, const Scene& scene) {
  print_readings(d);
  if (!d.views.empty()) {
    std::size_t worst = 0;
    for (std::size_t i = 0; i < d.views.size(); ++i)
      if (d.views[i].residual > d.views[worst].residual) worst = i;
    std::printf("agreement     ");
    if (d.usual_residual > 0)
      std::printf(" matches %.2f px from the epipolar lines (median view);", d.usual_residual);
    std::printf(" at worst %s, %.2f px\n", scene.views[worst].name.c_str(),
                d.views[worst].residual);
  }
  if (d.pixel_centre) {
    const PixelCentreFit& f = *d.pixel_centre;
    std::printf("pixel centre   ");
    if (f.tells)
      std::printf("%s fits", f.best == 0 ? "as given" : f.best > 0 ? "+0.5 px" : "-0.5 px");
    else
      std::printf("none clearly fits");
    if (std::isfinite(f.sigma)) std::printf(": best shift %+.3f +- %.3f px", f.shift, f.sigma);
    std::printf("\n");
    const auto print = [](const char* name, const std::array<double, 3>& rms, int count) {
      if (count > 0)
        std::printf("  %-12s %.3f, %.3f, %.3f px rms for -0.5, 0, +0.5 px (%d)\n", name, rms[0],
                    rms[1], rms[2], count);
    };
    print("tracks", f.tracks, f.track_count);
    print("silhouettes", f.tangents, f.tangent_count);
  }
  if (d.box && d.box->points > 0)
    std::printf("box holds      %.0f %% of %d matched points; diagonal %.3g, theirs %.3g\n",
                100 * d.box->points_inside, d.box->points, d.box->diagonal, d.box->points_diagonal);
  for (const std::string& text : d.notes) std::printf("note: %s\n", text.c_str());
  for (const std::string& text : d.faults) std::printf("fault: %s\n", text.c_str());
  if (d.faults.empty()) std::printf("cameras        no fault found\n");
}

const char* to_string(ViewFit::By by) {
  switch (by) {
    case ViewFit::By::kMatches:
      return "matches";
    case ViewFit::By::kSilhouettes:
      return "silhouettes";
    case ViewFit::By::kTracks:
      return "tracks";
  }
  return "unknown";
}

/// Infinite and undefined numbers become null.
nlohmann::ordered_json diagnosis_json(const CameraDiagnosis& d, const Scene& scene) {
  nlohmann::ordered_json j = {{"pairs", d.pairs}, {"matches", d.matches}, {"misread", d.misread}};
  for (const PoseReading& r : d.readings)
    j["readings"].push_back({{"reading", to_string(r)},
                             {"inverted", r.inverted},
                             {"flipped", r.flipped},
                             {"explained", r.explained},
                             {"residual", r.residual}});
  for (std::size_t i = 0; i < d.views.size(); ++i)
    j["views"].push_back({{"name", scene.views[i].name},
                          {"residual", d.views[i].residual},
                          {"others", d.views[i].others},
                          {"count", d.views[i].count},
                          {"by", to_string(d.views[i].by)},
                          {"disagrees", d.views[i].disagrees}});
  if (d.pixel_centre) {
    const PixelCentreFit& f = *d.pixel_centre;
    j["pixel_centre"] = {{"tells", f.tells},
                         {"best", f.best},
                         {"shift", f.shift},
                         {"sigma", f.sigma},
                         {"shifts", PixelCentreFit::kShifts},
                         {"tracks_rms", f.tracks},
                         {"tracks", f.track_count},
                         {"tangents_rms", f.tangents},
                         {"tangents", f.tangent_count}};
  }
  if (d.box)
    j["box"] = {{"seen_by", d.box->seen_by},
                {"cameras_inside", d.box->cameras_inside},
                {"diagonal", d.box->diagonal},
                {"distance", d.box->distance},
                {"points", d.box->points},
                {"points_inside", d.box->points_inside},
                {"points_diagonal", d.box->points_diagonal},
                {"points_distance", d.box->points_distance}};
  j["faults"] = d.faults;
  j["notes"] = d.notes;
  return j;
}

PreparedViews prepare(const Scene& scene, const SceneArguments& arguments, Progress& progress) {
  const ViewLoader loader{[](const std::filesystem::path& path) { return io::read_image(path); },
                          [](const std::filesystem::path& path) { return io::read_mask(path); }};
  PrepareOptions options;
  options.masks = pipeline::mask_policy(arguments.options().masks);
  progress.stage("views", 1);
  return prepare_views(scene, loader, options, progress);
}

CameraDiagnosis diagnose(const Scene& scene, const PreparedViews& prepared,
                         TerminalProgress& progress) {
  progress.stage("cameras", 3);
  return diagnose_cameras(prepared.views, scene.box, progress);
}

void print_masks(const PreparedViews& prepared) {
  std::printf("masks          %s", prepared.mask_source.c_str());
  double least = 2, sum = 0;
  std::size_t worst = 0, count = 0;
  for (std::size_t i = 0; i < prepared.masks.size(); ++i) {
    if (prepared.views[i].mask.empty()) continue;
    const double c = prepared.masks[i].confidence;
    sum += c, ++count;
    if (c < least) least = c, worst = i;
  }
  if (count > 0)
    std::printf(": confidence %.2f in the mean, %.2f at least (%s)", sum / double(count), least,
                prepared.views[worst].name.c_str());
  std::printf("\n");
  for (const std::string& text : prepared.warnings) std::printf("warning: %s\n", text.c_str());
}

nlohmann::ordered_json masks_json(const PreparedViews& prepared) {
  nlohmann::ordered_json j = {{"source", prepared.mask_source},
                              {"confidence", prepared.mask_confidence},
                              {"views", nlohmann::ordered_json::array()},
                              {"warnings", prepared.warnings}};
  for (std::size_t i = 0; i < prepared.masks.size(); ++i)
    j["views"].push_back({{"name", prepared.views[i].name},
                          {"source", prepared.masks[i].source},
                          {"confidence", prepared.masks[i].confidence}});
  return j;
}

void print_json(const pipeline::Inspection& info, const CameraDiagnosis* diagnosis,
                const PreparedViews* masks) {
  nlohmann::ordered_json j;
  j["format"] = to_string(info.scene.format);
  for (const SourceView& v : info.scene.views) {
    const Intrinsics& k = v.camera.intrinsics;
    const glm::dvec3 c = v.camera.center();
    j["views"].push_back({{"name", v.name},
                          {"width", k.width},
                          {"height", k.height},
                          {"fx", k.fx},
                          {"fy", k.fy},
                          {"skew", k.skew},
                          {"cx", k.cx},
                          {"cy", k.cy},
                          {"centre", {c.x, c.y, c.z}},
                          {"mask", v.mask.string()}});
  }
  if (info.scene.box) {
    const Box& b = *info.scene.box;
    j["box"] = {{"min", {b.min.x, b.min.y, b.min.z}},
                {"max", {b.max.x, b.max.y, b.max.z}},
                {"source", info.scene.box_source}};
    j["nearest_angle_degrees"] = info.nearest_angle;
    j["farthest_angle_degrees"] = info.farthest_angle;
    j["pixel_footprint"] = info.voxel_size;
    j["normal_voxel_size"] =
        info.voxel_size * pipeline::footprint_factor(pipeline::Quality::kNormal);
    j["voxel_size"] = info.grid.voxel_size;
    j["image_scale"] = *std::min_element(info.scales.begin(), info.scales.end());
    j["memory_limit_bytes"] = info.memory_limit;
    j["memory_bytes"] = info.memory_bytes;
    j["cpu_seconds"] = info.cpu_seconds;
  }
  if (diagnosis) j["cameras"] = diagnosis_json(*diagnosis, info.scene);
  if (masks) j["masks"] = masks_json(*masks);
  j["warnings"] = info.warnings;
  std::printf("%s\n",
              j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
}

/// Those that decide on voxels, and on how photographs are read.
pipeline::ReconstructOptions job_options(const Arguments& a) {
  using pipeline::Method;
  using pipeline::Quality;
  pipeline::ReconstructOptions o;
  o.output = "none";  // nothing is written
  o.load = a.scene.options();
  o.resolution = a.resolution;
  o.voxel_size = a.voxel_size;
  o.quality = parse_name("--quality", a.quality,
                         std::array{Quality::kDraft, Quality::kNormal, Quality::kHigh});
  if (a.method)
    o.method = parse_name(
        "--method", *a.method,
        std::array{Method::kHull, Method::kVoxelColoring, Method::kSpaceCarving, Method::kRefine});
  o.image_scale = pipeline::parse_image_scale(a.image_scale);
  o.max_memory = pipeline::parse_max_memory(a.max_memory);
  o.validate();
  return o;
}

void run(const Arguments& a) {
  const pipeline::ReconstructOptions job = job_options(a);
  const Scene scene = io::load_scene(a.scene.scene, a.scene.options());
  std::optional<CameraDiagnosis> diagnosis;
  std::optional<PreparedViews> prepared;
  if (a.cameras || a.masks) {
    TerminalProgress progress(a.cameras ? 4 : 1);
    prepared = prepare(scene, a.scene, progress);
    if (a.cameras) diagnosis = diagnose(scene, *prepared, progress);
    progress.finish();
  }
  pipeline::Inspection info;
  std::exception_ptr failure;
  try {
    info = pipeline::inspect(scene, job);
  } catch (...) {
    // What is wrong with the cameras may be why: it is said first.
    if (!diagnosis) throw;
    failure = std::current_exception();
    info.scene = scene;
    info.scene.box.reset();
  }
  if (a.json) {
    print_json(info, diagnosis ? &*diagnosis : nullptr, a.masks ? &*prepared : nullptr);
  } else {
    print_text(info);
    if (a.masks) print_masks(*prepared);
    if (diagnosis) print_diagnosis(*diagnosis, scene);
  }
  std::fflush(stdout);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

void add_info(CLI::App& app) {
  auto a = std::make_shared<Arguments>();
  CLI::App* c = app.add_subcommand("info", "tell what was understood of a scene");
  a->scene.add_to(*c);
  c->add_option("--resolution", a->resolution, "voxels along the box's longest side, to estimate");
  c->add_option("--voxel-size", a->voxel_size, "voxel size in world units, to estimate");
  c->add_option("--quality", a->quality, "draft, normal or high, to estimate")
      ->capture_default_str();
  c->add_option("--method", a->method,
                "hull, voxel-coloring, space-carving or refine, to estimate (default: hull for "
                "draft, else refine)");
  c->add_option("--image-scale", a->image_scale,
                "at which photographs would be read, to estimate (default: as reconstruct does)");
  c->add_option("--max-memory", a->max_memory, "that the job may take, such as 512M or 2G, or auto")
      ->capture_default_str();
  c->add_flag("--json", a->json, "print JSON");
  c->add_flag("--cameras", a->cameras,
              "look for faults of the cameras in the photographs, too; takes about half a second "
              "a view");
  c->add_flag("--check-masks", a->masks,
              "find the masks, too, and tell how sure they are ('photohull masks' tells of each)");
  c->footer(
      "With --cameras, features are matched without the poses and tell how these must be read "
      "(inverse, axes flipped), which views disagree with the rest, whether the principal points "
      "are half a pixel off, and whether the box is where the cameras look. Faults are named and "
      "do not change the exit code.\n\n"
      "Examples:\n"
      "  photohull info datasets/templeSparseRing\n"
      "  photohull info datasets/templeSparseRing --cameras\n"
      "  photohull info scan --resolution 512 --masks none\n"
      "  photohull info colmap/sparse/0 --box \"-1 -1 0 1 1 2\" --json");
  c->callback([a] { run(*a); });
}

}  // namespace photohull::cli
