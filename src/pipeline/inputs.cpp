#include "pipeline/inputs.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "carving/object_box.h"
#include "core/error.h"
#include "masks/torn_masks.h"
#include "photo/noise.h"
#include "pipeline/checks.h"
#include "pipeline/complete_box.h"
#include "pipeline/image_scale.h"
#include "pipeline/mask_policy.h"
#include "pipeline/memory.h"
#include "pipeline/plan.h"
#include "pipeline/view_order.h"
#include "projtex/gpu_views.h"
#include "views/crop.h"
#include "views/prepare_views.h"

namespace photohull::pipeline {
namespace {

constexpr double kOversized = 1.8;  // times the object's box: the box is made smaller
constexpr int kCropMargin = 24;     // pixels around the box's projection: patches, mip levels

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
  report_.photographs_listed = int(scene.listed.size());
  report_.photographs_scaled = scene.scaled;
  report_.photographs_passed_over = scene.passed_over;
  if (options_.lattice == Lattice::kFixed && looks_for_box(options_.box, scene))
    throw Error(
        concat(scene.path.string(),
               ": --lattice fixed needs a box that does not follow the photographs, and the "
               "scene gives none; give --box"));
  const BoxFindings findings =
      complete_box(options_.box, mask_policy(options_.load.masks), scene, progress_);
  box_found_ = findings.found;
  seen = findings.seen;
  for (const std::string& text : scene.warnings) warn(text);
  report_.box = *scene.box;
  report_.box_source = scene.box_source;
  for (const std::string& text : check_box(*scene.box, scene.box_source, scene.views)) warn(text);
  if (const auto why = hopeless_setup(*scene.box, scene.box_source, scene.views)) throw Error(*why);
  full_ = scene;
  take_scales(choose_scales(*scene.box));
}

std::vector<double> Inputs::choose_scales(const Box& box) {
  // With masks, the voxels that pixels give are not known for sure before these have been seen: the
  // box may become smaller.
  const bool known =
      options_.resolution || options_.voxel_size || options_.load.masks == io::MaskSource::kNone;
  const std::int64_t limit = memory_limit();
  const Plan plan = plan_reading(options_, full_, box, known, limit);
  check_memory(plan.cost.bytes, limit);
  short_of_memory_ = plan.scales != plan.wanted;
  if (short_of_memory_)
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
  if (options_.box_stands() || !carving::box_is_oversized(*scene.box, views)) return;
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
  return lattice_of(options_, *scene.box, of, any_mask());
}

void Inputs::fit_grid() {
  if (any_mask() || options_.effective_method() != Method::kRefine)
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
  PrepareOptions prepare_options;
  prepare_options.masks = mask_policy(options_.load.masks);
  prepare_options.strict = options_.load.strict;
  return prepare_views(scene, reduced_loader(full_, scales_), prepare_options, progress_);
}

void Inputs::prepare() {
  PreparedViews prepared = decode();
  // --resolution will count along the object's own box, whose voxels need finer pixels; and there
  // is more memory for those than in all of the box.
  if (!options_.image_scale && (options_.resolution || short_of_memory_) &&
      report_.smallest_scale < 1 && !options_.box_stands() &&
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
  report_.views = int(views.size());
  report_.photographs_left_out = scene.left_out;
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
  forget_masks_made_within();
  if (!options_.keep_mask_holes) mend_given_masks(prepared.masks);
}

/// The background of a photograph taken from within the box is what is looked for.
void Inputs::forget_masks_made_within() {
  const std::size_t within = cameras_within(*scene.box, scene.views);
  if (within == 0 || made_masks_.empty()) return;
  for (View& view : views)
    if (made_masks_.contains(view.name)) view.mask = {};
  made_masks_.clear();
  warn(concat(within, within == 1 ? " camera stands" : " cameras stand",
              " inside the box: masks made from the background are not used"));
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

bool Inputs::has_surroundings() const {
  if (options_.effective_method() != Method::kRefine) return false;
  if (options_.surroundings != Surroundings::kAuto)
    return options_.surroundings == Surroundings::kOn;
  const auto masked = std::count_if(views.begin(), views.end(),
                                    [](const View& view) { return !view.mask.empty(); });
  return box_found_ && 2 * std::size_t(masked) < views.size();
}

void Inputs::crop() {
  if (has_surroundings()) return;
  for (View& view : views) crop_to_box(scene.box.value(), kCropMargin, view);
  cameras = projtex::cameras_of(views);
}

}  // namespace photohull::pipeline
