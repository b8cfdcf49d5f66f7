#include "pipeline/place_lattice.h"

#include <algorithm>
#include <cmath>

#include "carving/object_box.h"
#include "core/error.h"
#include "core/option_word.h"
#include "pipeline/check_room.h"
#include "pipeline/checks.h"
#include "pipeline/larger_photographs.h"
#include "pipeline/methods/method.h"
#include "pipeline/plan.h"
#include "pipeline/subject.h"
#include "projtex/gpu_views.h"
#include "views/crop.h"

namespace photohull::pipeline {
namespace {

constexpr double kOversized = 1.8;  // times the object's box: the box is made smaller

double longest_side(const Box& box) {
  const glm::dvec3 size = box.size();
  return std::max({size.x, size.y, size.z});
}

}  // namespace

std::optional<Box> smaller_box(const ReconstructOptions& options, const Box& box,
                               const std::vector<PreparedView>& views) {
  if (options.box_stands() || !carving::box_is_oversized(box, views)) return std::nullopt;
  const Box object = carving::object_box(box, views);
  if (longest_side(box) / longest_side(object) < kOversized) return std::nullopt;
  return object;
}

SourcedBox tighten_box(const ReconstructOptions& options, const SourcedBox& given,
                       const std::vector<PreparedView>& views, Progress& progress) {
  const std::optional<Box> object = smaller_box(options, given.box, views);
  if (!object) return given;
  const double factor = longest_side(given.box) / longest_side(*object);
  progress.warn(concat("the box from ", given.source, " is ", std::round(10 * factor) / 10,
                       " times larger than what the silhouettes leave: the object's own box is "
                       "taken, and ",
                       option_word("resolution"), " counts along that"));
  return {*object, given.source + ", made smaller by the silhouettes"};
}

GridSpec place_lattice(const ReconstructOptions& options, const SourcedBox& box,
                       const std::vector<PreparedView>& views) {
  const bool masks = any_mask(views);
  if (masks || !method_of(options).needs_no_silhouettes)
    check_cameras_outside(box.box, box.source, sources_of(views));
  const GridSpec grid = lattice_of(options, box.box, matched_cameras(views), masks);
  if (!masks) check_room(options, box.box, grid, projtex::cameras_of(views));
  return grid;
}

bool has_surroundings(const ReconstructOptions& options, bool box_found,
                      const std::vector<PreparedView>& views) {
  if (!method_of(options).carve_around) return false;
  if (options.surroundings != Surroundings::kAuto) return options.surroundings == Surroundings::kOn;
  const auto masked = std::count_if(views.begin(), views.end(),
                                    [](const PreparedView& view) { return !view.mask.empty(); });
  return box_found && 2 * std::size_t(masked) < views.size();
}

std::vector<PreparedView> crop_views(std::vector<PreparedView> views, const Box& box) {
  for (PreparedView& view : views) crop_to_box(box, kCropMargin, view);
  return views;
}

}  // namespace photohull::pipeline
