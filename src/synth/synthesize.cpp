#include "synth/synthesize.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "core/error.h"
#include "synth/degrade_cameras.h"
#include "synth/degrade_image.h"
#include "synth/degrade_mask.h"
#include "synth/light_maps.h"
#include "synth/motion.h"
#include "synth/place_cameras.h"
#include "synth/random.h"
#include "synth/scene_files.h"
#include "synth/truth.h"

namespace photohull::synth {
namespace {

constexpr double kBoxMargin = 0.02;  ///< of the diagonal, on every side

/// Progress may be told from several threads.
class SharedProgress {
 public:
  explicit SharedProgress(Progress& progress) : progress_(progress) {}
  void update(double fraction) {
    progress_.check_cancelled();
    const std::lock_guard lock(mutex_);
    progress_.update(fraction);
  }

 private:
  Progress& progress_;
  std::mutex mutex_;
};

/// What the frames of a sequence share.
struct Sequence {
  std::optional<Box> box;  ///< around the surface of all frames, where it moves
  std::unique_ptr<gpu::Context> context;
  std::string frame;  ///< the one that is made, for the names of stages; empty: no sequence

  std::string stage(const std::string& name) const {
    return frame.empty() ? name : "frame " + frame + ": " + name;
  }
};

/// One seed for all that degrades.
std::uint64_t degradation_seed(const Spec& spec) {
  return mix_bits(spec.seed) ^ mix_bits(spec.degradations.seed + 0xdea);
}

/// Indices of the views that are there.
std::vector<std::size_t> kept_views(const Spec& spec, std::size_t count) {
  const DegradationSpec& d = spec.degradations;
  std::vector<bool> gone(count);
  for (const int view : d.missing_views) gone[std::size_t(view)] = true;
  // A share of all views, at random among them.
  const std::vector<std::size_t> order =
      random_order(count, Random(degradation_seed(spec), 0x3155));
  for (std::size_t i = 0; i < std::size_t(std::floor(d.missing * double(count) + 1e-9)); ++i)
    gone[order[i]] = true;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < count; ++i)
    if (!gone[i]) kept.push_back(i);
  if (kept.empty())
    throw Error("degradations: all views are missing; lower missing or shorten missing_views");
  return kept;
}

std::string view_name(std::size_t index) {
  std::string digits = std::to_string(index);
  return std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits;
}

/// World size of the mean camera's pixel at the middle of the box.
double mean_pixel(const std::vector<LensCamera>& cameras, const glm::dvec3& middle) {
  double sum = 0;
  for (const LensCamera& lens : cameras)
    sum += lens.camera.to_camera(middle).z / lens.camera.intrinsics.fx;
  return sum / double(cameras.size());
}

/// Some thousand vertices spread over the mesh; where it moves, points spread over the box of
/// all frames, so that their cameras are off alike.
std::vector<glm::dvec3> control_points(const Surface& surface) {
  std::vector<glm::dvec3> points;
  const TriMesh& mesh = surface.mesh;
  constexpr int kSide = 12;
  if (surface.moves) {
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
      const glm::dvec3 place(i % kSide, i / kSide % kSide, i / (kSide * kSide));
      points.push_back(surface.box.min + surface.box.size() * (place / (kSide - 1.0)));
    }
    return points;
  }
  const std::size_t stride = mesh.positions.size() / 2000 + 1;
  for (std::size_t i = 0; i < mesh.positions.size(); i += stride) points.push_back(mesh.world(i));
  return points;
}

void check_orientation(const TriMesh& mesh, Progress& progress) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    volume += dot(glm::dvec3(mesh.positions[a]),
                  cross(glm::dvec3(mesh.positions[b]), glm::dvec3(mesh.positions[c])));
  if (volume < 0)
    progress.warn(
        "the mesh is inside out (its faces are clockwise seen from outside), so that no camera "
        "counts as seeing it; turn its faces around");
}

/// In the order in which they are written.
std::vector<std::size_t> ordered_views(const Spec& spec, std::vector<std::size_t> kept) {
  if (spec.degradations.shuffle == 0) return kept;
  std::vector<std::size_t> shuffled;
  for (const std::size_t i :
       random_order(kept.size(), Random(std::uint64_t(spec.degradations.shuffle), 0x5f1e)))
    shuffled.push_back(kept[i]);
  return shuffled;
}

Box written_box(const DegradationSpec& spec, const Surface& surface) {
  const glm::dvec3 half =
      spec.box_scale * (0.5 * (surface.box.max - surface.box.min) + kBoxMargin * surface.diagonal);
  const glm::dvec3 middle = surface.box.center() + surface.diagonal * spec.box_shift;
  return {middle - half, middle + half};
}

/// A mask can only be wrong where its view and another one are there.
void check_wrong_masks(const Spec& spec, const std::vector<std::size_t>& kept, Progress& progress) {
  for (const int view : spec.degradations.mask_wrong)
    if (kept.size() < 2 || !std::binary_search(kept.begin(), kept.end(), std::size_t(view)))
      progress.warn(concat("degradations.mask_wrong: view ", view,
                           " gets no wrong mask, since it or every other view is missing"));
}

/// The sheet would hide the object.
void check_above(const PrintedSheet& sheet, const std::vector<LensCamera>& cameras,
                 const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < cameras.size(); ++i)
    if (!(cameras[i].camera.center().z > sheet.origin().z))
      throw Error(concat("cameras: view ", names[i],
                         " is below the sheet; raise the elevations, or leave out sheet"));
}

/// By which object and sheet have turned before a camera that stands at azimuth 0, radians.
double turn_of(const Spec& spec, const Surface& surface, const LensCamera& lens) {
  if (!spec.cameras.turntable) return 0;
  const glm::dvec3 out = lens.camera.center() - surface.box.center();
  return -std::atan2(out.x, -out.y);
}

/// Renders and writes all views; returns the largest share of a frame that is covered.
double write_views(const Spec& spec, const Surface& surface, const std::vector<LensCamera>& cameras,
                   const std::vector<std::size_t>& indices, const std::vector<std::string>& names,
                   const SceneFiles& files, SharedProgress& progress, gpu::Context* context,
                   const PrintedSheet* sheet) {
  const double pixel = mean_pixel(cameras, surface.box.center());
  std::optional<LightMaps> maps;
  const Shading still(spec, surface, pixel, sheet);
  if (context) maps.emplace(*context, spec.light, surface, still.lights());
  const std::uint64_t seed = degradation_seed(spec);
  const auto frame = std::uint64_t(spec.moment.frame);  // each has noise of its own
  const double rows = double(cameras.size()) * spec.image.height;
  std::atomic<long> rows_done = 0;
  std::vector<double> fill(cameras.size());
  std::vector<Mask> masks(cameras.size());
  const auto write_view = [&](std::size_t i) {
    const Shading shading(spec, surface, pixel, sheet, turn_of(spec, surface, cameras[i]));
    const Picture picture = render(
        surface, shading, cameras[i], indices[i], spec.image.samples, spec.seed,
        [&] { progress.update(double(++rows_done) / rows); }, maps ? &*maps : nullptr);
    masks[i] = undegraded_mask(picture, spec.degradations);
    const auto& coverage = picture.coverage;
    fill[i] = std::accumulate(coverage.begin(), coverage.end(), 0.0) / double(coverage.size());
    if (fill[i] == 0)
      throw Error(concat("view ", names[i],
                         " sees nothing of the object; change cameras.distance, fill or "
                         "principal_offset"));
    const int w = picture.width, h = picture.height;
    if (spec.image.bits == 16)
      files.write_picture(names[i], w, h,
                          expose_16_bits(picture, spec.degradations, seed, indices[i], 2 * frame));
    else
      files.write_picture(names[i], w, h,
                          expose(picture, spec.degradations, seed, indices[i], 2 * frame));
    if (spec.image.maps) files.write_maps(names[i], picture);
    if (!spec.background.plates) return;
    // Taken with the camera as it stands, with noise of its own.
    const Picture empty = render_background(shading, cameras[i], indices[i]);
    files.write_plate(names[i], empty.width, empty.height,
                      expose(empty, spec.degradations, seed, indices[i], 2 * frame + 1));
  };
  if (maps)
    for (std::size_t i = 0; i < cameras.size(); ++i) write_view(i);
  else
    tbb::parallel_for(std::size_t(0), cameras.size(), write_view);
  if (!spec.image.masks) return *std::max_element(fill.begin(), fill.end());
  const auto& wrong = spec.degradations.mask_wrong;
  const std::uint64_t mask_seed = frame == 0 ? seed : mix_bits(seed + frame);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const bool other = std::find(wrong.begin(), wrong.end(), int(indices[i])) != wrong.end();
    const Mask& source = masks[other ? (i + 1) % masks.size() : i];
    files.write_mask(names[i], degrade_mask(source, spec.degradations, mask_seed, indices[i]));
  }
  return *std::max_element(fill.begin(), fill.end());
}

std::string result_text(const SynthesizedScene& scene, const std::vector<std::string>& names,
                        const Surface& surface, const PrintedSheet* sheet) {
  const auto list = [](const glm::dvec3& p) { return nlohmann::json{p.x, p.y, p.z}; };
  const Box box = surface.moves ? tight_box(surface.mesh) : surface.box;
  nlohmann::json gains = nlohmann::json::array();
  for (const glm::dvec3& gain : scene.gains) gains.push_back(list(gain));
  nlohmann::json result = {{"writer", "photohull synthesize"},
                           {"views", names},
                           {"triangles", scene.triangles},
                           {"diagonal", scene.diagonal},
                           {"tight_box", {list(box.min), list(box.max)}},
                           {"gains", gains},
                           {"seen_share", scene.seen},
                           {"largest_fill", scene.largest_fill}};
  if (sheet)
    result["sheet"] = {{"origin", list(sheet->origin())},
                       {"unit", sheet->unit()},
                       {"turned_about", list(surface.own.middle)}};
  return result.dump();
}

double truth_weight(const Spec& spec) {
  return double(spec.truth_samples) * view_count(spec.cameras) / 2e6;
}

double render_weight(const Spec& spec) {
  return double(spec.image.width) * spec.image.height * spec.image.samples * spec.image.samples *
         view_count(spec.cameras) / 2e7;
}

double scene_weight(const Spec& spec) { return 1 + render_weight(spec) + truth_weight(spec); }

Sequence begin_sequence(const Spec& spec, Progress& progress, const std::string& device,
                        int threads) {
  Sequence sequence;
  if (spec.light.shadows && spec.light.shadow_test != kShadowRays)
    sequence.context = gpu::Context::create(device, threads);
  sequence.box = box_of_frames(spec, progress);
  return sequence;
}

/// The scene of the spec's moment.
SynthesizedScene make_scene(const Spec& spec, const std::filesystem::path& folder,
                            const Sequence& sequence, Progress& progress) {
  progress.stage(sequence.stage("surface"), 1);
  const Surface surface = surface_at_moment(spec, sequence.box);
  const bool first = sequence.frame.empty() || spec.moment.frame == 0;  // warnings are said once
  if (first) check_orientation(surface.mesh, progress);
  progress.check_cancelled();
  const std::vector<LensCamera> all = place_cameras(spec, surface);
  const std::vector<std::size_t> kept = kept_views(spec, all.size());
  if (first) check_wrong_masks(spec, kept, progress);
  const std::vector<std::size_t> indices = ordered_views(spec, kept);
  std::vector<LensCamera> cameras;
  std::vector<std::string> names;
  for (const std::size_t i : indices) {
    cameras.push_back(all[i]);
    names.push_back(view_name(i));
  }
  const std::vector<LensCamera> written =
      degrade_cameras(cameras, spec.degradations, degradation_seed(spec), control_points(surface));

  std::optional<PrintedSheet> sheet;
  if (!spec.sheet.board.empty()) sheet.emplace(spec, surface);
  if (sheet) check_above(*sheet, cameras, names);

  const SceneFiles files(folder, names, spec.image);
  SharedProgress shared(progress);
  progress.stage(sequence.stage("photographs"), render_weight(spec));
  SynthesizedScene result;
  result.largest_fill = write_views(spec, surface, cameras, indices, names, files, shared,
                                    sequence.context.get(), sheet ? &*sheet : nullptr);

  progress.stage(sequence.stage("truth"), truth_weight(spec));
  std::vector<TruthSample> samples = sample_surface(surface, spec.truth_samples, spec.seed);
  count_views(surface, cameras, samples, [&](double share) { shared.update(share); });
  files.write_truth(surface.mesh, samples);

  files.write_cameras(names, written, cameras, cameras_are_off(spec.degradations),
                      written_box(spec.degradations, surface));
  for (const std::size_t i : indices)
    result.gains.emplace_back(view_gain(spec.degradations, degradation_seed(spec), i));
  result.views = int(cameras.size());
  result.triangles = surface.mesh.triangles.size();
  result.diagonal = surface.diagonal;
  result.middlebury = cameras.front().distortion.model == DistortionModel::kNone;
  const auto seen = std::count_if(samples.begin(), samples.end(),
                                  [](const TruthSample& s) { return s.views > 0; });
  result.seen = double(seen) / double(samples.size());
  files.finish(spec_text(spec, result_text(result, names, surface, sheet ? &*sheet : nullptr)));
  return result;
}

}  // namespace

double total_weight(const Spec& spec) { return box_weight(spec) + scene_weight(spec); }

double sequence_weight(Spec spec, int frames) {
  spec.moment = {0, frames};
  return box_weight(spec) + frames * scene_weight(spec);
}

SynthesizedScene synthesize(const Spec& spec, const std::filesystem::path& folder,
                            Progress& progress, const std::string& device, int threads) {
  return make_scene(spec, folder, begin_sequence(spec, progress, device, threads), progress);
}

std::vector<SynthesizedScene> synthesize_frames(Spec spec,
                                                const std::vector<std::filesystem::path>& folders,
                                                Progress& progress, const std::string& device,
                                                int threads) {
  spec.moment = {0, int(folders.size())};
  Sequence sequence = begin_sequence(spec, progress, device, threads);
  std::vector<SynthesizedScene> made;
  for (const std::filesystem::path& folder : folders) {
    sequence.frame = folder.filename().string();
    made.push_back(make_scene(spec, folder, sequence, progress));
    ++spec.moment.frame;
  }
  return made;
}

}  // namespace photohull::synth
