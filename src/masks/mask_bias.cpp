#include "masks/mask_bias.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "photo/grey_image.h"

namespace photohull {
namespace {

constexpr double kReach = 16, kReachShare = 0.02;  // pixels, and of the image's longer side
constexpr int kFewestPixels = 50;                  // at a distance, for its mean to count
constexpr double kLeastBias = 0.75;                // pixels; less does not matter
constexpr double kLeastContrast = 1.5;             // of the edge to the strongest slope aside
constexpr double kLeastAgreement = 0.6;            // of the views
constexpr double kSame = 1.5;                      // pixels between edges that agree
constexpr int kAside = 3;                          // pixels from an edge to what lies around it

/// Mean absolute slope of brightness along the contour's normal, levels a pixel, by distance.
struct Profile {
  explicit Profile(int farthest)
      : reach(farthest), slope(std::size_t(2 * farthest + 1)), count(slope.size()) {}
  int reach;  ///< pixels
  std::vector<double> slope, count;
};

Profile profile_of(const View& view, const SilhouetteDistance& silhouette, int reach) {
  Profile p(reach);
  const GreyImage grey = smoothed(grey_image(view.image));
  const int w = silhouette.width, h = silhouette.height;
  const auto d = [&](int x, int y) { return double(silhouette.pixels[std::size_t(y) * w + x]); };
  const auto g = [&](int x, int y) { return double(grey.values[std::size_t(y) * w + x]); };
  for (int y = 1; y + 1 < h; ++y)
    for (int x = 1; x + 1 < w; ++x) {
      const double distance = d(x, y);
      if (!(std::abs(distance) <= reach)) continue;
      const glm::dvec2 normal(d(x + 1, y) - d(x - 1, y), d(x, y + 1) - d(x, y - 1));
      const double length = glm::length(normal);
      if (!(length > 1)) continue;  // where several parts of the contour are equally near
      const glm::dvec2 slope(g(x + 1, y) - g(x - 1, y), g(x, y + 1) - g(x, y - 1));
      const auto bin = std::size_t(std::lround(distance) + reach);
      p.slope[bin] += 0.5 * std::abs(glm::dot(slope, normal)) / length;
      p.count[bin] += 1;
    }
  for (std::size_t i = 0; i < p.slope.size(); ++i)
    p.slope[i] = p.count[i] >= kFewestPixels ? p.slope[i] / p.count[i] : 0;
  return p;
}

std::size_t peak_of(const Profile& p) {
  return std::size_t(std::max_element(p.slope.begin(), p.slope.end()) - p.slope.begin());
}

/// The peak's place to fractions of a pixel, by the parabola through its neighbours.
double place_of(const Profile& p, std::size_t peak) {
  if (peak == 0 || peak + 1 == p.slope.size()) return double(peak) - p.reach;
  const double a = p.slope[peak - 1], b = p.slope[peak], c = p.slope[peak + 1];
  const double bend = a - 2 * b + c;
  return double(peak) - p.reach + (bend < 0 ? 0.5 * (a - c) / bend : 0);
}

/// The slope at the peak against the strongest beyond its flanks.
double contrast_of(const Profile& p, std::size_t peak) {
  double aside = 0;
  for (std::size_t i = 0; i < p.slope.size(); ++i)
    if (i + kAside < peak || i > peak + kAside) aside = std::max(aside, p.slope[i]);
  return aside > 0 ? p.slope[peak] / aside : 0;
}

}  // namespace

bool MaskBias::counts() const {
  return std::abs(pixels) >= kLeastBias && contrast >= kLeastContrast &&
         agreement >= kLeastAgreement;
}

MaskBias measure_mask_bias(std::span<const View> views,
                           std::span<const SilhouetteDistance> silhouettes) {
  int longest = 0;
  for (const SilhouetteDistance& s : silhouettes) longest = std::max({longest, s.width, s.height});
  const int reach = int(std::lround(std::max(kReach, kReachShare * longest)));
  std::vector<Profile> profiles(views.size(), Profile(reach));
  tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
    if (!silhouettes[i].pixels.empty()) profiles[i] = profile_of(views[i], silhouettes[i], reach);
  });
  Profile all(reach);
  double measured = 0;
  for (const Profile& p : profiles) {
    const double sum = std::accumulate(p.slope.begin(), p.slope.end(), 0.0);
    if (!(sum > 0)) continue;
    measured += 1;
    for (std::size_t i = 0; i < all.slope.size(); ++i) all.slope[i] += p.slope[i] / sum;
  }
  MaskBias bias;
  if (measured == 0) return bias;
  const std::size_t peak = peak_of(all);
  bias.pixels = place_of(all, peak);
  bias.contrast = contrast_of(all, peak);
  for (const Profile& p : profiles)
    if (p.slope[peak_of(p)] > 0)
      bias.agreement += (std::abs(place_of(p, peak_of(p)) - bias.pixels) <= kSame) / measured;
  return bias;
}

void move_outline(double pixels, Mask& mask, SilhouetteDistance& silhouette) {
  for (std::size_t i = 0; i < silhouette.pixels.size(); ++i) {
    float& d = silhouette.pixels[i];
    if (std::abs(d) < SilhouetteDistance::kNoContour) d -= float(pixels);
    mask.coverage[i] = std::uint8_t(std::lround(255 * std::clamp(0.5 - double(d), 0.0, 1.0)));
  }
}

}  // namespace photohull
