#include "synth/degrade_mask.h"

#include <algorithm>
#include <cmath>

#include "calib/silhouette.h"
#include "synth/random.h"

namespace photohull::synth {
namespace {

void grow(Mask& mask, double pixels) {
  const SilhouetteDistance distance = silhouette_distance(mask);
  for (std::size_t i = 0; i < mask.coverage.size(); ++i) {
    const double share = std::clamp(0.5 - (distance.pixels[i] - pixels), 0.0, 1.0);
    mask.coverage[i] = std::uint8_t(std::lround(255 * share));
  }
}

void tear(Mask& mask, const DegradationSpec& spec, std::uint64_t seed, std::size_t view) {
  std::vector<std::size_t> foreground;
  for (std::size_t i = 0; i < mask.coverage.size(); ++i)
    if (mask.coverage[i] >= 128) foreground.push_back(i);
  if (foreground.empty()) return;
  Random random(seed, 0x401e5, view);
  const double radius = spec.mask_hole_radius;
  const int reach = int(std::ceil(radius + 1));
  for (int hole = 0; hole < spec.mask_holes; ++hole) {
    const std::size_t at = foreground[std::size_t(random.uniform() * double(foreground.size()))];
    const int x0 = int(at % std::size_t(mask.width)), y0 = int(at / std::size_t(mask.width));
    for (int y = std::max(0, y0 - reach); y <= std::min(mask.height - 1, y0 + reach); ++y)
      for (int x = std::max(0, x0 - reach); x <= std::min(mask.width - 1, x0 + reach); ++x) {
        std::uint8_t& value = mask.coverage[std::size_t(y) * mask.width + x];
        const double kept = std::clamp(std::hypot(x - x0, y - y0) - radius + 0.5, 0.0, 1.0);
        value = std::min(value, std::uint8_t(std::lround(255 * kept)));
      }
  }
}

}  // namespace

Mask exact_mask(const Picture& picture) {
  Mask mask{picture.width, picture.height, {}};
  mask.coverage.reserve(picture.coverage.size());
  for (const float share : picture.coverage)
    mask.coverage.push_back(std::uint8_t(std::lround(255 * share)));
  return mask;
}

Mask degrade_mask(const Mask& mask, const DegradationSpec& spec, std::uint64_t seed,
                  std::size_t view) {
  Mask result = mask;
  if (spec.mask_grow != 0) grow(result, spec.mask_grow);
  if (spec.mask_holes > 0) tear(result, spec, seed, view);
  return result;
}

}  // namespace photohull::synth
