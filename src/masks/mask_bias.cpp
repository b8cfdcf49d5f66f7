#include "masks/mask_bias.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
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
constexpr int kMostSteps = 6;                      // to where the masks' own slopes say
constexpr double kConverged = 0.05;                // pixels
constexpr double kLeastRise = 0.1;                 // of a place with its outline's move

/// Coverage, [0, 255], of a pixel that held `before` and lies `distance` outside the outline, when
/// that moves outward by `moved`. Moved outward, it takes nothing from parts that are too thin to
/// have an outline.
double coverage_at(double distance, double moved, double before) {
  const double coverage = 255 * std::clamp(0.5 - (distance - moved), 0.0, 1.0);
  return moved > 0 ? std::max(coverage, before) : coverage;
}

/// The mask as a picture of brightness, with its outline moved outward by `pixels`.
GreyImage picture_of(const Mask& mask, const SilhouetteDistance& silhouette, double pixels) {
  GreyImage picture{mask.width, mask.height, {mask.coverage.begin(), mask.coverage.end()}};
  if (pixels != 0)
    for (std::size_t i = 0; i < picture.values.size(); ++i)
      picture.values[i] = float(coverage_at(silhouette.pixels[i], pixels, picture.values[i]));
  return picture;
}

/// Mean absolute slope of brightness along the contour's normal, levels a pixel, by distance.
struct Profile {
  explicit Profile(int farthest)
      : reach(farthest), slope(std::size_t(2 * farthest + 1)), count(slope.size()) {}
  int reach;  ///< pixels
  std::vector<double> slope, count;
  int views = 0;  ///< that a mean is of
};

Profile profile_of(const GreyImage& grey, const SilhouetteDistance& silhouette, int reach) {
  Profile p(reach);
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

/// The views' mean profile, each view with the same weight.
Profile mean_of(std::span<const Profile> profiles, int reach) {
  Profile mean(reach);
  for (const Profile& p : profiles) {
    const double sum = std::accumulate(p.slope.begin(), p.slope.end(), 0.0);
    if (!(sum > 0)) continue;
    mean.views += 1;
    for (std::size_t i = 0; i < mean.slope.size(); ++i) mean.slope[i] += p.slope[i] / sum;
  }
  return mean;
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

MaskBias measure_mask_bias(std::span<const PreparedView> views,
                           std::span<const SilhouetteDistance* const> silhouettes) {
  int longest = 0;
  for (const SilhouetteDistance* s : silhouettes)
    if (s) longest = std::max({longest, s->width, s->height});
  const int reach = int(std::lround(std::max(kReach, kReachShare * longest)));
  const auto profiles_of = [&](const auto& brightness) {
    std::vector<Profile> profiles(views.size(), Profile(reach));
    tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
      if (silhouettes[i]) profiles[i] = profile_of(smoothed(brightness(i)), *silhouettes[i], reach);
    });
    return profiles;
  };
  const std::vector<Profile> profiles =
      profiles_of([&](std::size_t i) { return grey_image(views[i].image); });
  const Profile all = mean_of(profiles, reach);
  const double measured = all.views;
  MaskBias bias;
  if (measured == 0) return bias;
  const std::size_t peak = peak_of(all);
  const double place = place_of(all, peak);
  bias.contrast = contrast_of(all, peak);
  for (const Profile& p : profiles)
    if (p.slope[peak_of(p)] > 0)
      bias.agreement += (std::abs(place_of(p, peak_of(p)) - place) <= kSame) / measured;
  bias.pixels = place;
  if (std::abs(place) < kLeastBias) return bias;
  // Parts below two pixels have their strongest slopes beside their outlines, in right masks too:
  // the outline is to be moved so that the masks have theirs where the photographs have it.
  const auto beside = [&](double moved) {  // pixels, from the photographs' place
    const Profile own = mean_of(profiles_of([&](std::size_t k) {
                                  return picture_of(views[k].mask, *silhouettes[k], moved);
                                }),
                                reach);
    return place_of(own, peak_of(own)) - place;
  };
  double last = place, last_beside = beside(last), moved = 0, moved_beside = beside(moved);
  for (int i = 0; i < kMostSteps && std::abs(moved_beside) > kConverged; ++i) {  // secant method
    const double rise = (moved_beside - last_beside) / (moved - last);
    if (!(rise > kLeastRise)) break;
    last = std::exchange(moved, moved - moved_beside / rise);
    last_beside = std::exchange(moved_beside, beside(moved));
  }
  bias.pixels = moved;
  return bias;
}

void move_outline(double pixels, Mask& mask, SilhouetteDistance& silhouette) {
  for (std::size_t i = 0; i < silhouette.pixels.size(); ++i) {
    float& d = silhouette.pixels[i];
    mask.coverage[i] = std::uint8_t(std::lround(coverage_at(d, pixels, mask.coverage[i])));
    if (std::abs(d) < SilhouetteDistance::kNoContour) d -= float(pixels);
  }
}

}  // namespace photohull
