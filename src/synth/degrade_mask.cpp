#include "synth/degrade_mask.h"

#include <algorithm>
#include <cmath>

#include "masks/silhouette.h"
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

void cut(Mask& mask, double level) {
  for (std::uint8_t& value : mask.coverage) value = value >= 255 * level - 1e-9 ? 255 : 0;
}

/// Takes the outermost pixels of a mask of 0 and 255. What lies beyond the frame is unknown and
/// eats nothing.
void erode(Mask& mask) {
  const Mask before = mask;
  const auto is_empty = [&](int x, int y) {
    return x >= 0 && x < mask.width && y >= 0 && y < mask.height &&
           before.coverage[std::size_t(y) * mask.width + x] == 0;
  };
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (is_empty(x - 1, y) || is_empty(x + 1, y) || is_empty(x, y - 1) || is_empty(x, y + 1))
        mask.coverage[std::size_t(y) * mask.width + x] = 0;
}

void tear(Mask& mask, const DegradationSpec& spec, std::uint64_t seed, std::size_t view) {
  std::vector<std::size_t> foreground;
  for (std::size_t i = 0; i < mask.coverage.size(); ++i)
    if (mask.coverage[i] >= 128) foreground.push_back(i);
  if (foreground.empty()) return;
  Random random(seed, 0x401e5, view);
  const double radius = spec.mask_hole_radius;
  const bool soft = spec.mask_style == kCoverage;
  const int reach = int(std::ceil(radius + 1));
  for (int hole = 0; hole < spec.mask_holes; ++hole) {
    const std::size_t at = foreground[std::size_t(random.uniform() * double(foreground.size()))];
    const int x0 = int(at % std::size_t(mask.width)), y0 = int(at / std::size_t(mask.width));
    for (int y = std::max(0, y0 - reach); y <= std::min(mask.height - 1, y0 + reach); ++y)
      for (int x = std::max(0, x0 - reach); x <= std::min(mask.width - 1, x0 + reach); ++x) {
        std::uint8_t& value = mask.coverage[std::size_t(y) * mask.width + x];
        const double outside = std::hypot(x - x0, y - y0) - radius;
        const double kept = soft ? std::clamp(outside + 0.5, 0.0, 1.0) : outside >= 0;
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

Mask centre_mask(const Picture& picture) {
  Mask mask{picture.width, picture.height, {}};
  mask.coverage.reserve(picture.depth.size());
  for (const float depth : picture.depth) mask.coverage.push_back(depth > 0 ? 255 : 0);
  return mask;
}

Mask undegraded_mask(const Picture& picture, const DegradationSpec& spec) {
  return spec.mask_style == kAliased ? centre_mask(picture) : exact_mask(picture);
}

Mask degrade_mask(const Mask& mask, const DegradationSpec& spec, std::uint64_t seed,
                  std::size_t view) {
  Mask result = mask;
  if (spec.mask_grow != 0) grow(result, spec.mask_grow);
  if (spec.mask_style == kCut || spec.mask_style == kEroded) cut(result, spec.mask_cut);
  if (spec.mask_style == kEroded) erode(result);
  if (spec.mask_holes > 0) tear(result, spec, seed, view);
  return result;
}

}  // namespace photohull::synth
