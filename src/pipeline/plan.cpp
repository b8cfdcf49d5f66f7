#include "pipeline/plan.h"

#include <algorithm>
#include <limits>

#include "carving/fit_grid.h"
#include "core/error.h"
#include "core/image_scale.h"
#include "core/option_word.h"
#include "pipeline/image_scale.h"
#include "pipeline/larger_photographs.h"
#include "pipeline/methods/method.h"
#include "pipeline/read_scene.h"
#include "pipeline/subject.h"
#include "pipeline/texture_stage.h"
#include "views/crop.h"

namespace photohull::pipeline {
namespace {

constexpr double kPartsPhotographs = 0.85;  // of memory that those of a part may take as they are
constexpr double kCoarsestHeld = 4;  // voxels that a pixel may be wide where some are held larger

/// Alpha channels are not known before decoding: they count as masks that must be made.
Silhouettes silhouettes_of(io::MaskSource masks, const Scene& scene) {
  if (masks == io::MaskSource::kNone) return Silhouettes::kNone;
  const bool given = masks != io::MaskSource::kBackground &&
                     std::any_of(scene.views.begin(), scene.views.end(),
                                 [](const SourceView& view) { return !view.mask.empty(); });
  return given ? Silhouettes::kGiven : Silhouettes::kMade;
}

std::vector<Camera> cameras_at(std::span<const double> scales, const Scene& scene) {
  std::vector<Camera> out;
  for (std::size_t i = 0; i < scales.size(); ++i) {
    out.push_back(scene.views[i].camera);
    out.back().intrinsics = scaled_intrinsics(out.back().intrinsics, scales[i]);
  }
  return out;
}

/// `matched`: the scales of the photographs whose pixels the voxels follow, where they do.
void count_cost(const Request& request, const Scene& scene, const Box& box, bool with_grid,
                std::span<const double> matched, Plan& plan) {
  CostQuestion question;
  for (const SourceView& view : scene.views) question.files.push_back(view.camera.intrinsics);
  question.cameras = cameras_at(plan.scales, scene);
  question.method = request.options.effective_method();
  question.masks = silhouettes_of(request.masks, scene);
  if (request.options.part) {
    question.part = {0, request.options.part_bricks};
    for (Camera& camera : question.cameras) {
      Intrinsics& k = camera.intrinsics;
      question.part->pixels += double(k.width) * k.height;
      k = cropped_intrinsics(*request.options.carved_box, kCropMargin, camera);
    }
  }
  plan.silhouettes = question.masks != Silhouettes::kNone;
  if (with_grid)
    plan.grid =
        *(question.grid = lattice_of(request.options, request.options.carved_box.value_or(box),
                                     cameras_at(matched, scene), plan.silhouettes));
  if (makes_texture(request.options)) {
    question.texture_bytes = texture_bytes(memory_limit(request.options));
    question.pixel = carving::pixel_footprint(box, question.cameras);
  }
  plan.cost = estimate_cost(question);
  question.grid.reset();
  plan.fixed_bytes = estimate_cost(question).bytes;
}

/// The plan with photographs as much smaller as leaves room for some of the wanted size besides.
std::optional<Plan> plan_to_hold_some(const Request& request, const Scene& scene, const Box& box,
                                      bool with_grid, std::int64_t limit, Plan plan) {
  if (!method_of(request.options).matches_larger) return std::nullopt;
  const std::vector<Camera> wanted = cameras_at(plan.wanted, scene);
  double pixels = 0;
  for (const Camera& camera : wanted)
    pixels = std::max(pixels, double(camera.intrinsics.width) * camera.intrinsics.height);
  const std::size_t views = scene.views.size();
  if (!can_be_held(views, pixels)) return std::nullopt;
  const std::int64_t least = held_bytes(fewest_held(views), pixels, pixels);
  const double coarsest =
      kCoarsestHeld * voxel_size_of(request.options, box, wanted, plan.silhouettes);
  while (halve_image_scales(box, scene.views, coarsest, plan.scales)) {
    const std::vector<double> halved = plan.scales;
    keep_unexpected_sizes(request.reader, scene.views, plan.scales);
    if (plan.scales != halved) return std::nullopt;
    count_cost(request, scene, box, with_grid, plan.wanted, plan);
    if (plan.cost.bytes + least > limit) continue;
    plan.held_bytes = limit - plan.cost.bytes;
    plan.cost.bytes += std::min(plan.held_bytes, held_bytes(int(views), pixels, pixels));
    return plan;
  }
  return std::nullopt;
}

}  // namespace

double voxel_size_of(const ReconstructOptions& options, const Box& box,
                     std::span<const Camera> cameras, bool silhouettes) {
  if (options.resolution) return carving::voxel_size_for(box, *options.resolution);
  const double largest = carving::voxel_size_for(box, 2);
  if (options.voxel_size) {
    if (*options.voxel_size > largest)
      throw UsageError(concat(option_word("voxel_size", *options.voxel_size), ": at most ", largest,
                              ", half of the box's longest side"));
    return *options.voxel_size;
  }
  const double footprint = carving::pixel_footprint(box, cameras);
  if (!(footprint > 0)) throw Error("no camera has the box's centre in front of it");
  const double size = footprint * footprint_factor(options.quality, silhouettes);
  if (size > largest)
    throw Error(concat("a pixel is ", footprint,
                       " world units large at the box's centre, too much for a box whose longest "
                       "side is ",
                       2 * largest, "; check the box's units, or give ",
                       option_word("voxel_size")));
  return size;
}

GridSpec lattice_of(const ReconstructOptions& options, const Box& box,
                    std::span<const Camera> cameras, bool silhouettes) {
  const double size = voxel_size_of(options, box, cameras, silhouettes);
  return options.lattice == Lattice::kFixed ? carving::fixed_grid(box, size)
                                            : carving::fit_grid(box, size);
}

Plan plan_job(const Request& request, const Scene& scene, const Box& box, bool with_grid,
              std::int64_t limit) {
  const ReconstructOptions& options = request.options;
  Plan plan;
  plan.wanted.assign(scene.views.size(), options.image_scale.value_or(1));
  // Voxels that follow the pixels need these as they are.
  const bool given = options.resolution || options.voxel_size;
  const double voxel =
      given ? voxel_size_of(options, box, {}, true) : std::numeric_limits<double>::infinity();
  if (given && !options.image_scale) {
    plan.wanted = image_scales(box, scene.views, voxel);
    keep_unexpected_sizes(request.reader, scene.views, plan.wanted);
  }
  plan.scales = plan.wanted;
  count_cost(request, scene, box, with_grid, plan.scales, plan);
  if (options.image_scale || plan.cost.bytes <= limit) return plan;
  // Smaller parts are better than smaller photographs.
  if (options.part && double(plan.fixed_bytes) <= kPartsPhotographs * double(limit)) return plan;
  if (auto some = plan_to_hold_some(request, scene, box, with_grid, limit, plan)) return *some;
  while (plan.cost.bytes > limit) {
    std::vector<double> smaller = plan.scales;
    if (!halve_image_scales(box, scene.views, voxel, smaller)) break;
    keep_unexpected_sizes(request.reader, scene.views, smaller);
    if (smaller == plan.scales) break;
    plan.scales = std::move(smaller);
    count_cost(request, scene, box, with_grid, plan.scales, plan);
  }
  return plan;
}

Plan plan_reading(const Request& request, const Scene& scene, const Box& box, bool box_known,
                  std::int64_t limit) {
  if (box_known) return plan_job(request, scene, box, true, limit);
  try {
    Plan plan = plan_job(request, scene, box, true, limit);
    if (plan.cost.bytes > limit) count_cost(request, scene, box, false, plan.scales, plan);
    return plan;
  } catch (const UsageError&) {
    throw;
  } catch (const Error&) {  // the lattice; whether it is right is seen when the box is known
    return plan_job(request, scene, box, false, limit);
  }
}

std::string smallest_scale_text(std::span<const double> scales) {
  return image_scale_text(*std::min_element(scales.begin(), scales.end()));
}

}  // namespace photohull::pipeline
