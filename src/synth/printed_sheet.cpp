#include "synth/printed_sheet.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "sheet/meet_sheet.h"
#include "synth/degrade_cameras.h"
#include "synth/random.h"

namespace photohull::synth {
namespace {

constexpr double kTexelsPerMm = 10;
constexpr float kPaper = 0.8f, kInk = 0.03f, kHider = 0.3f;  // reflectances

}  // namespace

PrintedSheet::PrintedSheet(const Spec& spec, const Surface& surface) {
  const Sheet sheet = read_sheet(spec.sheet.board);
  if (!sheet.is_flat())
    throw Error(concat(spec.sheet.board,
                       ": diameter: it is a strip around a cylinder; give a flat sheet's file"));
  picture_ = sheet_picture(sheet, kTexelsPerMm);
  const glm::dvec2 object(surface.own.size);
  const glm::dvec2 room = sheet.free_max - sheet.free_min;
  scale_ = std::max(object.x / room.x, object.y / room.y) / spec.sheet.fill;
  unit_ = scale_ / spec.sheet.print;
  origin_ = {glm::dvec2(surface.box.center()), surface.box.min.z};
  reach_ = 0.5 * glm::length(sheet.page);
  bend_ = spec.sheet.bend;
  hide_tags(sheet, spec);
}

void PrintedSheet::hide_tags(const Sheet& sheet, const Spec& spec) {
  if (!(spec.sheet.hidden > 0)) return;
  const auto count = std::size_t(std::lround(spec.sheet.hidden * double(sheet.tags.size())));
  hidden_.resize(std::size_t(view_count(spec.cameras)));
  for (std::size_t view = 0; view < hidden_.size(); ++view) {
    Random random(spec.seed, 0x41de, view);
    const auto order = random_order(sheet.tags.size(), Random(spec.seed, 0x41df, view));
    for (std::size_t i = 0; i < count; ++i) {
      const auto& c = sheet.tags[order[i]].corners;
      const double side = glm::length(c[1] - c[0]);
      const double up = random.uniform() - 0.5, right = random.uniform() - 0.5;
      const glm::dvec2 off(right, up);
      hidden_[view].push_back(
          {0.5 * (c[0] + c[2]) + 0.7 * side * off, side * (0.4 + 0.3 * random.uniform())});
    }
  }
}

float PrintedSheet::albedo(const glm::dvec2& place, std::size_t view) const {
  const float light = picture_.at(place);
  if (light < 0) return light;
  if (view < hidden_.size())
    for (const Disc& disc : hidden_[view])
      if (glm::dot(place - disc.middle, place - disc.middle) < disc.radius * disc.radius)
        return kHider;
  return kInk + (kPaper - kInk) * light;
}

std::optional<PrintedSheet::Seen> PrintedSheet::see(const Ray& ray, std::size_t view) const {
  const auto hit =
      meet_sheet((ray.origin - origin_) / scale_, ray.direction / scale_, bend_, reach_);
  if (!hit) return std::nullopt;
  Seen seen;
  seen.albedo = albedo(hit->place, view);
  if (seen.albedo < 0) return std::nullopt;
  seen.t = hit->t;
  seen.position = ray.origin + hit->t * ray.direction;
  seen.normal = glm::dot(hit->normal, ray.direction) > 0 ? -hit->normal : hit->normal;
  return seen;
}

}  // namespace photohull::synth
