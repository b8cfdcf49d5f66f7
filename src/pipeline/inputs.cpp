#include "pipeline/inputs.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "assess/wrong_views.h"
#include "calib/crop.h"
#include "calib/diagnose.h"
#include "calib/mask_bias.h"
#include "calib/mask_lines.h"
#include "calib/noise.h"
#include "calib/prepare_views.h"
#include "calib/refine_cameras.h"
#include "calib/torn_masks.h"
#include "carving/fit_grid.h"
#include "carving/missing_parts.h"
#include "carving/object_box.h"
#include "core/error.h"
#include "io/image_file.h"
#include "pipeline/checks.h"
#include "pipeline/image_scale.h"
#include "pipeline/mask_policy.h"
#include "pipeline/memory.h"
#include "pipeline/plan.h"
#include "pipeline/self_check.h"
#include "pipeline/view_order.h"
#include "projtex/gpu_views.h"

namespace photohull::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr double kOversized = 1.8;     // times the object's box: the box is made smaller
constexpr int kCropMargin = 24;        // pixels around the box's projection: patches, mip levels
constexpr double kSuspicious = 0.25;   // pixels between outlines' tangents: cameras look wrong
constexpr int kFewestFeatures = 20;    // held-out ones that confirm a camera
constexpr double kAgrees = 0.5;        // pixels, of these
constexpr double kUnexplained = 0.02;  // of the foreground: more is told
constexpr double kFarOff = 0.005;      // of the image's longer side: this view is wrong

double rounded(double pixels) { return std::round(100 * pixels) / 100; }

std::string in_common(const CameraRefinement& found) {
  return concat(" (in all views focal lengths times ", std::round(1e4 * found.focal_factor) / 1e4,
                ", principal points by ", rounded(found.principal.x), ", ",
                rounded(found.principal.y), " px)");
}

double longest_side(const Box& box) {
  const glm::dvec3 size = box.size();
  return std::max({size.x, size.y, size.z});
}

double median_noise(std::span<const View> views) {
  std::vector<double> values(views.size());
  tbb::parallel_for(std::size_t(0), views.size(),
                    [&](std::size_t i) { values[i] = estimate_image_noise(views[i].image); });
  std::nth_element(values.begin(), values.begin() + long(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Views whose outlines' tangents are far from all others', who agree; none where these are more
/// than a quarter.
std::vector<int> views_off_tangents(std::span<const View> views) {
  const std::vector<ViewFit> fits = fit_silhouettes(views);
  std::vector<int> off;
  std::size_t known = 0;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const Intrinsics& k = views[i].camera.intrinsics;
    known += fits[i].count > 0;
    if (fits[i].disagrees && fits[i].residual > kFarOff * std::max(k.width, k.height))
      off.push_back(int(i));
  }
  return 4 * off.size() > known ? std::vector<int>() : off;
}

bool was_given(const MaskJudgement& mask) {
  return mask.source == "mask files" || mask.source == "alpha channels";
}

}  // namespace

void Inputs::warn(const std::string& text) {
  report_.warnings.push_back(text);
  progress_.warn(text);
}

void Inputs::load() {
  scene = io::load_scene(options_.scene, options_.load);
  sort_views_by_name(scene);
  report_.scene = scene.path.string();
  report_.format = to_string(scene.format);
  report_.views = int(scene.views.size());
  for (const std::string& text : scene.warnings) warn(text);
  if (!scene.box)
    throw Error(concat(scene.path.string(),
                       ": nothing tells where the object is: give --box "
                       "\"x0 y0 z0 x1 y1 z1\" or a bbox.txt beside the scene"));
  report_.box = *scene.box;
  report_.box_source = scene.box_source;
  for (const std::string& text : check_box(*scene.box, scene.box_source, scene.views)) warn(text);
  full_ = scene;
  take_scales(choose_scales(*scene.box));
}

std::vector<double> Inputs::choose_scales(const Box& box) {
  // With masks, the voxels that pixels give are not known before these have been seen: the box
  // may become smaller.
  const bool known =
      options_.resolution || options_.voxel_size || options_.load.masks == io::MaskSource::kNone;
  const std::int64_t limit = memory_limit();
  Plan plan = plan_job(options_, full_, box, known, limit);
  check_memory(plan.cost.bytes, limit);
  if (plan.scales != plan.wanted)
    warn(concat("the photographs are read at ", smallest_scale_text(plan.scales),
                " of their size: at ", smallest_scale_text(plan.wanted),
                " the job would take more than ", memory_text(limit),
                " of memory (--max-memory; --image-scale forces a size)"));
  return plan.scales;
}

std::int64_t Inputs::memory_limit() const {
  return options_.max_memory ? *options_.max_memory : default_max_memory();
}

void Inputs::take_scales(std::vector<double> scales) {
  scales_ = std::move(scales);
  const auto [low, high] = std::minmax_element(scales_.begin(), scales_.end());
  report_.smallest_scale = *low;
  report_.largest_scale = *high;
  scene = full_;
  scale_scene(scales_, scene);
}

/// A box that is much larger than the object would waste the voxels, and far from the object few
/// views see what silhouettes do not reject.
void Inputs::tighten_box() {
  if (!carving::box_is_oversized(*scene.box, views)) return;
  const Box box = carving::object_box(*scene.box, views);
  const double factor = longest_side(*scene.box) / longest_side(box);
  if (factor < kOversized) return;
  warn(concat("the box from ", scene.box_source, " is ", std::round(10 * factor) / 10,
              " times larger than what the silhouettes leave: the object's own box is taken, "
              "and --resolution counts along that"));
  scene.box = report_.box = box;
  scene.box_source = report_.box_source += ", made smaller by the silhouettes";
}

GridSpec Inputs::lattice(std::span<const Camera> of) const {
  return carving::fit_grid(*scene.box, voxel_size_of(options_, *scene.box, of));
}

void Inputs::fit_grid() {
  check_cameras_outside(*scene.box, scene.box_source, scene.views);
  cameras = projtex::cameras_of(views);
  grid = lattice(cameras);
  const CostQuestion question{{},
                              cameras,
                              grid,
                              options_.effective_method(),
                              any_mask() ? Silhouettes::kGiven : Silhouettes::kNone};
  check_memory(estimate_cost(question).bytes, memory_limit());
  report_.grid = grid;
}

PreparedViews Inputs::decode() {
  std::map<fs::path, double> scale_of;
  for (std::size_t i = 0; i < scales_.size(); ++i)
    for (const fs::path* path :
         {&scene.views[i].image, &scene.views[i].mask, &scene.views[i].plate})
      scale_of[*path] = scales_[i];
  const auto scale = [&](const fs::path& path) {
    const auto found = scale_of.find(path);
    return found == scale_of.end() ? 1.0 : found->second;
  };
  const ViewLoader loader{[&](const fs::path& path) { return io::read_image(path, scale(path)); },
                          [&](const fs::path& path) { return io::read_mask(path, scale(path)); }};
  PrepareOptions prepare_options;
  prepare_options.masks = mask_policy(options_.load.masks);
  return prepare_views(scene, loader, prepare_options, progress_);
}

void Inputs::prepare() {
  PreparedViews prepared = decode();
  // --resolution will count along the object's own box, whose voxels need finer pixels.
  if (!options_.image_scale && options_.resolution && report_.smallest_scale < 1 &&
      carving::box_is_oversized(*scene.box, prepared.views)) {
    const Box box = carving::object_box(*scene.box, prepared.views);
    if (longest_side(*scene.box) >= kOversized * longest_side(box)) {
      std::vector<double> scales = choose_scales(box);
      if (scales != scales_) {
        prepared = {};
        take_scales(std::move(scales));
        prepared = decode();
      }
    }
  }
  full_ = {};
  views = std::move(prepared.views);
  report_.noise_sigma =
      std::max(options_.noise ? *options_.noise / 255 * report_.largest_scale : median_noise(views),
               kRoundingNoise);
  for (const std::string& text : prepared.warnings) warn(text);
  report_.mask_source = prepared.mask_source;
  report_.mask_confidence = prepared.mask_confidence;
  for (std::size_t i = 0; i < views.size(); ++i)
    report_.masks.push_back(
        {views[i].name, prepared.masks[i].source, prepared.masks[i].confidence});
  for (std::size_t i = 0; i < views.size(); ++i)
    if (!views[i].mask.empty() && !was_given(prepared.masks[i])) made_masks_.insert(views[i].name);
  if (!options_.keep_mask_holes) mend_given_masks(prepared.masks);
}

void Inputs::mend_given_masks(std::span<const MaskJudgement> masks) {
  std::vector<MendedMask> mended(views.size());
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    // Masks made from the photograph's colours have nothing to learn from them.
    if (was_given(masks[i]) && !views[i].mask.empty())
      mended[i] = mend_mask(views[i].image, views[i].mask);
  });
  const auto worst = std::max_element(
      mended.begin(), mended.end(), [](const auto& a, const auto& b) { return a.share < b.share; });
  const auto torn =
      std::count_if(mended.begin(), mended.end(), [](const auto& m) { return m.holes; });
  report_.masks_mended = int(torn);
  if (torn == 0) return;
  warn(concat(torn, torn == 1 ? " mask has" : " masks have",
              " holes or bites where the photographs show the object's colours (most in ",
              views[std::size_t(worst - mended.begin())].name, ", ",
              std::round(1000 * worst->share) / 10,
              " % of it): they were filled (--mask-holes keep takes the masks as they are)"));
}

void Inputs::refine_cameras() {
  const bool asked = options_.refine_cameras.has_value();
  if (!asked) {
    report_.mask_disagreement = tangent_disagreement(views);
    if (!(report_.mask_disagreement > kSuspicious)) return;
  }
  RefineCamerasOptions o;
  if (options_.refine_cameras == RefineCameras::kPosesAndIntrinsics)
    o.intrinsics = SharedIntrinsics::kAll;
  else if (options_.refine_cameras != RefineCameras::kPoses)
    o.intrinsics = SharedIntrinsics::kWhereAlike;
  o.given = undistorted_tracks(scene, views);
  o.box = scene.box;
  const CameraRefinement found = photohull::refine_cameras(views, o, progress_);
  const bool always = asked && options_.refine_cameras != RefineCameras::kAuto;
  const bool use = found.changed && (always || pays(found));
  report_.camera_refinement = to_json(found, scene, use);
  remember_right_cameras(found, use);
  if (!use) return;
  if (!asked)
    warn(concat("the masks' outlines disagree by ", rounded(report_.mask_disagreement),
                " px: the cameras were refined",
                shares_intrinsics(found) ? in_common(found) : std::string(),
                ", and what they see agrees to ",
                rounded(found.all.observations ? found.all.after : found.tangents_after),
                " px instead of ",
                rounded(found.all.observations ? found.all.before : found.tangents_before),
                " (--refine-cameras off takes them as they are)"));
  cameras_moved = found.moved;
  cameras_moved_alike = found.moved_alike;
  apply(found, scene);
  for (std::size_t i = 0; i < views.size(); ++i) views[i].camera = found.cameras[i];
}

void Inputs::crop() {
  for (View& view : views) crop_to_box(scene.box.value(), kCropMargin, view);
  cameras = projtex::cameras_of(views);
}

bool Inputs::any_mask() const {
  return std::any_of(views.begin(), views.end(), [](const View& v) { return !v.mask.empty(); });
}

void Inputs::measure_silhouettes() {
  silhouettes.resize(views.size());
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (!views[i].mask.empty()) silhouettes[i] = silhouette_distance(views[i].mask);
  });
}

/// Masks that are all too small carve the object itself away.
void Inputs::correct_masks() {
  // The user counts in the files' pixels.
  double offset = options_.mask_offset.value_or(0) * report_.largest_scale;
  if (!options_.mask_offset) {
    const MaskBias bias = measure_mask_bias(views, silhouettes);
    if (bias.counts()) offset = bias.pixels;
  }
  const double in_files = offset / report_.largest_scale;
  report_.mask_offset = in_files;
  if (offset == 0) return;
  if (!options_.mask_offset)
    warn(concat("the masks are about ", std::round(10 * std::abs(in_files)) / 10, " px too ",
                offset > 0 ? "small" : "large",
                ": outlines are taken from where the photographs' edges are (--mask-offset 0 "
                "takes the masks as they are)"));
  for (std::size_t i = 0; i < views.size(); ++i)
    if (!views[i].mask.empty()) move_outline(offset, views[i].mask, silhouettes[i]);
}

/// One view that is far off carves away what all others have.
void Inputs::leave_out_wrong_views() {
  if (!options_.keep_views)
    leave_out(
        views_off_tangents(views),
        "its outline is not where the other views' outlines say (check its camera and its mask)");
  const assess::SilhouetteConsistency found =
      assess::find_wrong_views(*scene.box, cameras, pointers(silhouettes));
  contradiction = options_.keep_views ? found.uncovered : found.uncovered_left;
  if (!options_.keep_views)
    leave_out(found.wrong,
              "without it the other views' silhouettes agree (check its camera and its mask)");
}

void Inputs::widen_lines() {
  lines.assign(views.size(), {});
  widened.assign(views.size(), {});
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (views[i].mask.empty()) return;
    lines[i] = find_lines(views[i].mask);
    if (lines[i].empty()) return;
    widened[i] = views[i].mask;
    photohull::widen_lines(lines[i], widened[i]);
    silhouettes[i] = silhouette_distance(widened[i]);
  });
  for (const auto& list : lines) report_.thin.line_pixels += std::int64_t(list.size());
}

void Inputs::forget_masks() {
  for (std::size_t i = 0; i < views.size(); ++i)
    if (!lines[i].empty() || !widened[i].empty()) return;
  for (View& view : views) std::vector<std::uint8_t>().swap(view.mask.coverage);
}

std::vector<carving::Silhouette> Inputs::silhouettes_of_views() const {
  std::vector<carving::Silhouette> out;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Mask& mask = views[i].mask;
    if (mask.empty())
      out.push_back({&mask});
    else
      out.push_back({widened[i].empty() ? &mask : &widened[i], &silhouettes[i], &lines[i],
                     made_masks_.contains(views[i].name)});
  }
  return out;
}

void Inputs::explain_foreground() {
  if (options_.views_may_miss || !any_mask()) return;
  const carving::MissingParts found =
      carving::find_missing_parts(*scene.box, cameras, silhouettes_of_views(), {}, &progress_);
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (views[i].mask.empty()) return;
    Mask mask = widened[i].empty() ? views[i].mask : widened[i];
    if (!carving::mend_silhouette(found.parts, cameras[i], silhouettes[i], mask)) return;
    silhouettes[i] = silhouette_distance(mask);
    widened[i] = std::move(mask);
  });
  ThinReport& counts = report_.thin;
  double worst = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const carving::ExplainedView& v = found.views[i];
    counts.looked_at += v.looked_at, counts.unexplained += v.unexplained, counts.placed += v.placed;
    const double share = double(v.unexplained - v.placed) / std::max(v.looked_at, 1);
    if (share > worst) worst = share, counts.worst_view = views[i].name;
  }
  // Masks that were made show likelihoods, too, and other views are free to tell otherwise.
  if (report_.mask_confidence < 1) return;
  const auto left = double(counts.unexplained - counts.placed);
  if (left > kUnexplained * double(counts.looked_at))
    warn(concat("the masks show parts (", std::round(1000 * left / double(counts.looked_at)) / 10,
                " % of their foreground, most in ", counts.worst_view,
                ") that too many other masks leave out: these are not in the model"));
}

/// Features of a view whose camera is right lie where those of other views say, whatever its mask.
void Inputs::remember_right_cameras(const CameraRefinement& found, bool used) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewAgreement& v = found.views[i];
    if (v.observations >= kFewestFeatures && (used ? v.after : v.before) <= kAgrees)
      right_cameras_.insert(views[i].name);
  }
}

/// The views whose outlines contradict the others', in ascending order; where the camera is known
/// to be right, the mask alone.
void Inputs::leave_out(std::span<const int> wrong, const std::string& why) {
  for (auto i = wrong.rbegin(); i != wrong.rend(); ++i) {
    const std::string name = views[*i].name;
    if (right_cameras_.contains(name)) {
      warn(concat("the mask of ", name, " is left out: ", why,
                  "; the view stays, for features say that its camera is right"));
      report_.masks_left_out.push_back(name);
      views[*i].mask = {};
      silhouettes[*i] = {};
      continue;
    }
    warn(concat("view ", name, " is left out: ", why));
    report_.left_out.push_back(name);
    views.erase(views.begin() + *i);
    scene.views.erase(scene.views.begin() + *i);
    cameras.erase(cameras.begin() + *i);
    silhouettes.erase(silhouettes.begin() + *i);
  }
}

}  // namespace photohull::pipeline
