#include "pipeline/camera_cache.h"

#include <cmath>
#include <fstream>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <sstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json_levels.h"
#include "core/option_word.h"
#include "pipeline/identity_text.h"
#include "pipeline/input_hashes.h"
#include "pipeline/recording_progress.h"

namespace photohull::pipeline {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// What a run leaves to the next one.
struct Kept {
  std::vector<Camera> cameras, sources;  ///< of the views, and of their photographs as listed
  std::set<std::string> right;
  CameraFindings findings;
  std::vector<std::string> warnings;
};

void add_bytes(std::span<const std::uint8_t> bytes, std::ostream& out) {
  out << bytes.size() << ' ' << digest_of(bytes) << '\n';
}

/// Of all that agree_cameras goes by.
std::string identity_of(const ReconstructOptions& options, const Scene& scene,
                        std::span<const PreparedView> views) {
  std::ostringstream text;
  text << std::setprecision(kIdentityDigits);
  add_program(text);
  text << (options.refine_cameras ? int(*options.refine_cameras) : -1) << '\n';
  add_box(*scene.box, text);
  for (const SceneTrack& track : scene.tracks)
    for (const SceneTrack::Observation& o : track.observations)
      text << o.view << ' ' << o.pixel.x << ' ' << o.pixel.y
           << (&o == &track.observations.back() ? '\n' : ' ');
  for (const std::string& name : scene.listed) text << std::quoted(name) << '\n';
  for (const PreparedView& view : views) {
    text << std::quoted(view.name) << ' ' << int(view.image.encoding) << ' '
         << view.silhouette.likelihood << ' ' << view.sharpness << '\n';
    add_camera(view.camera, text);
    add_camera(view.source.camera, text);
    add_distortion(view.source.distortion, text);
    add_bytes(view.image.bytes, text);
    add_bytes(view.mask.coverage, text);
  }
  const std::string all = text.str();
  return digest_of({reinterpret_cast<const std::uint8_t*>(all.data()), all.size()});
}

json to_json(const Camera& camera) {
  const Intrinsics& k = camera.intrinsics;
  std::vector<double> numbers = {k.fx, k.fy, k.skew, k.cx, k.cy};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) numbers.push_back(camera.cam_from_world.rotation[i][j]);
  for (int i = 0; i < 3; ++i) numbers.push_back(camera.cam_from_world.translation[i]);
  return numbers;
}

/// A camera of the same size; throws json::exception where these are not its numbers.
Camera camera_from(const json& numbers, Camera camera) {
  Intrinsics& k = camera.intrinsics;
  std::size_t at = 0;
  for (double* value : {&k.fx, &k.fy, &k.skew, &k.cx, &k.cy}) *value = numbers.at(at++);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) camera.cam_from_world.rotation[i][j] = numbers.at(at++);
  for (int i = 0; i < 3; ++i) camera.cam_from_world.translation[i] = numbers.at(at++);
  return camera;
}

/// Numbers that may be none; JSON has no word for them.
json number(double value) { return std::isnan(value) ? json() : json(value); }
double number(const json& value) { return value.is_null() ? NAN : value.get<double>(); }

void write(const fs::path& file, const std::string& identity, const Kept& kept) {
  const CameraFindings& f = kept.findings;
  json cameras = json::array(), sources = json::array();
  for (const Camera& camera : kept.cameras) cameras.push_back(to_json(camera));
  for (const Camera& camera : kept.sources) sources.push_back(to_json(camera));
  const json all = {{"identity", identity},
                    {"cameras", cameras},
                    {"sources", sources},
                    {"right", kept.right},
                    {"warnings", kept.warnings},
                    {"mask_disagreement", number(f.mask_disagreement)},
                    {"features", number(f.features.pixels)},
                    {"feature_pairs", f.features.pairs},
                    {"feature_matches", f.features.matches},
                    {"refinement", f.refinement},
                    {"moved", number(f.moved)},
                    {"moved_alike", number(f.moved_alike)}};
  write_atomically(file, all.dump());
}

/// What the file keeps of the same job, if there is one.
std::optional<Kept> read(const fs::path& file, const std::string& identity,
                         std::span<const PreparedView> views, Progress& progress) {
  std::ifstream stream(file);
  if (!stream) return std::nullopt;
  try {
    const json all = json::parse(stream, json_level_guard(file.string()));
    if (all.at("identity") != identity) return std::nullopt;
    Kept kept;
    for (std::size_t i = 0; i < views.size(); ++i) {
      kept.cameras.push_back(camera_from(all.at("cameras").at(i), views[i].camera));
      kept.sources.push_back(camera_from(all.at("sources").at(i), views[i].source.camera));
    }
    all.at("right").get_to(kept.right);
    all.at("warnings").get_to(kept.warnings);
    all.at("refinement").get_to(kept.findings.refinement);
    kept.findings.mask_disagreement = number(all.at("mask_disagreement"));
    kept.findings.features = {number(all.at("features")), all.at("feature_pairs"),
                              all.at("feature_matches")};
    kept.findings.moved = number(all.at("moved"));
    kept.findings.moved_alike = number(all.at("moved_alike"));
    return kept;
  } catch (const json::exception&) {
  } catch (const Error&) {
  }
  progress.warn(concat(file.string(), ": damaged, so that cameras are refined anew"));
  return std::nullopt;
}

}  // namespace

AgreeingCameras agree_cameras_once(const fs::path& folder, const ReconstructOptions& options,
                                   const Scene& scene, std::vector<PreparedView> views,
                                   Progress& progress) {
  const fs::path file = folder / ".photohull-cameras";
  const std::string identity = identity_of(options, scene, views);
  if (!options.fresh)
    if (std::optional<Kept> kept = read(file, identity, views, progress)) {
      for (const std::string& warning : kept->warnings) progress.warn(warning);
      progress.note(concat("the cameras are those that the run before made agree (",
                           option_word("fresh"), " refines them anew)"));
      for (std::size_t i = 0; i < views.size(); ++i) {
        views[i].camera = kept->cameras[i];
        views[i].source.camera = kept->sources[i];
      }
      return {std::move(views), std::move(kept->right), std::move(kept->findings)};
    }
  RecordingProgress recording(progress);
  AgreeingCameras out = agree_cameras(options, scene, std::move(views), recording);
  if (out.findings.refinement.empty()) return out;
  Kept kept{{}, {}, out.right, out.findings, recording.warnings()};
  for (const PreparedView& view : out.views) {
    kept.cameras.push_back(view.camera);
    kept.sources.push_back(view.source.camera);
  }
  write(file, identity, kept);
  return out;
}

}  // namespace photohull::pipeline
