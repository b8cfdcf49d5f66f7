// Based on: M. Waechter, M. Beljan, S. Fuhrmann, N. Moehrle, J. Kopf, M. Goesele, "Virtual
// rephotography", ACM TOG 2017 [Waechter17]; R. Collins, "A space-sweep approach to true
// multi-image matching", CVPR 1996 [Collins96].
#include "assess/explained.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "core/clip_ray.h"
#include "core/error.h"
#include "photo/grey_image.h"

namespace photohull::assess {
namespace {

constexpr double kPlaces = 12000;         // over all views, about
constexpr double kFewerPlaces = 4000;     // the same for the surface alone
constexpr double kFewestPlaces = 100;     // a view
constexpr double kFewestOnSurface = 150;  // the same for the surface alone
constexpr int kReach = 2;                 // samples of a window to each side
constexpr int kSamples = (2 * kReach + 1) * (2 * kReach + 1);
constexpr double kWidestSpacing = 3;  // pixels between samples, which are smoothed by a pixel
constexpr double kLeastAngle = 5, kMostAngle = 60;  // degrees between the views at the point
constexpr std::size_t kLenders = 3;
constexpr double kTexture = 3;         // standard deviations of noise
constexpr double kRounding = 0.289;    // levels, standard deviation
constexpr double kNear = 1.0 / 3;      // of the distance to the box, where the search begins
constexpr double kNearInside = 0.05;   // of the distance to its far side, where that is nothing
constexpr int kMostSteps = 800;        // of a search
constexpr double kJustOutside = 0.25;  // of the box's diagonal
constexpr double kAgreement = 0.5;
constexpr double kSweptAgreement = 0.87;

using Window = std::array<double, kSamples>;

double degrees_between(const glm::dvec3& a, const glm::dvec3& b) {
  return std::acos(std::clamp(glm::dot(a, b) / glm::length(a) / glm::length(b), -1.0, 1.0)) * 180 /
         std::numbers::pi;
}

/// Zero-mean normalised cross-correlation over the first `n` samples.
double correlation(const Window& a, const Window& b, int n) {
  double sa = 0, sb = 0, aa = 0, bb = 0, ab = 0;
  for (int i = 0; i < n; ++i) {
    const double x = a[i] - a[0], y = b[i] - b[0];
    sa += x, sb += y, aa += x * x, bb += y * y, ab += x * y;
  }
  const double va = aa - sa * sa / n, vb = bb - sb * sb / n;
  return va > 0 && vb > 0 ? (ab - sa * sb / n) / std::sqrt(va * vb) : 0;
}

double deviation(const Window& a) {
  double sum = 0, squares = 0;
  for (const double v : a) sum += v - a[0], squares += (v - a[0]) * (v - a[0]);
  return std::sqrt(std::max(0.0, squares / kSamples - sum * sum / kSamples / kSamples));
}

/// A view's image and what does not change from place to place.
struct Eye {
  Camera camera;
  glm::dvec3 centre{0.0};
  GreyImage grey;
  std::vector<int> beside;  ///< the views nearest in angle at the box's middle
};

class Explainer {
 public:
  Explainer(const TriMesh& mesh, const RayScene& rays, const Box& box,
            std::span<const PreparedView> views, const ExplainOptions& options)
      : mesh_(mesh),
        rays_(rays),
        box_(box),
        views_(views),
        surface_alone_(options.surface_alone),
        spacing_(std::clamp(options.voxel_size / options.pixel_size, 1.0, kWidestSpacing)),
        least_deviation_(kTexture * std::max(options.noise, kRounding)),
        eyes_(views.size()) {
    tbb::parallel_for(std::size_t(0), views.size(), [&](std::size_t i) {
      eyes_[i].camera = views[i].camera;
      eyes_[i].centre = views[i].camera.center();
      eyes_[i].grey = smoothed(grey_image(views[i].image));
    });
    for (Eye& eye : eyes_) eye.beside = neighbours(eye);
  }

  ExplainedView look(std::size_t a) const {
    const GreyImage& grey = eyes_[a].grey;
    const double views = double(eyes_.size());
    const double wanted = surface_alone_ ? std::max(kFewerPlaces / views, kFewestOnSurface)
                                         : std::max(kPlaces / views, kFewestPlaces);
    ExplainedView out;
    out.step = std::max(1, int(std::sqrt(double(grey.width) * grey.height / wanted)));
    for (int y = out.step / 2; y < grey.height; y += out.step)
      for (int x = out.step / 2; x < grey.width; x += out.step) {
        if (const auto place = classify(a, {x, y})) out.places.push_back({x, y, *place});
        look_for_inside(a, {x, y}, out);
      }
    return out;
  }

 private:
  std::vector<int> neighbours(const Eye& eye) const {
    const glm::dvec3 middle = 0.5 * (box_.min + box_.max);
    std::vector<std::pair<double, int>> by_angle;
    for (std::size_t i = 0; i < eyes_.size(); ++i) {
      const double angle = degrees_between(eye.centre - middle, eyes_[i].centre - middle);
      if (&eyes_[i] != &eye && angle >= kLeastAngle && angle <= kMostAngle)
        by_angle.emplace_back(angle, int(i));
    }
    std::sort(by_angle.begin(), by_angle.end());
    std::vector<int> out;
    for (const auto& [angle, i] : by_angle)
      if (out.size() < kLenders) out.push_back(i);
    return out;
  }

  glm::dvec2 sample_at(const glm::dvec2& middle, int i) const {
    constexpr int kEdge = 2 * kReach + 1;
    return middle + spacing_ * glm::dvec2(i % kEdge - kReach, i / kEdge - kReach);
  }

  /// The photograph's window; nothing where it leaves the image or was not photographed.
  std::optional<Window> window_at(std::size_t view, const glm::dvec2& middle) const {
    const GreyImage& grey = eyes_[view].grey;
    const ColourImage& image = views_[view].image;
    Window window;
    for (int i = 0; i < kSamples; ++i) {
      const glm::dvec2 p = sample_at(middle, i);
      if (!grey.holds(p.x, p.y)) return {};
      if (image.has_alpha && image.linear(int(p.x), int(p.y)).a < 1) return {};
      window[i] = grey.at(p.x, p.y);
    }
    return window;
  }

  std::optional<Place> classify(std::size_t a, const glm::dvec2& pixel) const {
    const Eye& eye = eyes_[a];
    const glm::dvec3 ray = eye.camera.ray(pixel);
    const auto part = clip_ray(box_, eye.centre, ray);
    if (!part) return {};
    const auto window = window_at(a, pixel);
    if (!window) return {};
    if (deviation(*window) < least_deviation_) return Place::kPlain;
    const std::vector<Ray> through = rays_through(a, pixel);
    std::vector<Hit> hits(through.size());
    rays_.closest(through, hits);
    if (hits[kSamples / 2]) return compare(a, *window, through, hits);
    // What a window beside the surface's contour shows is the surface.
    if (surface_alone_ ||
        std::any_of(hits.begin(), hits.end(), [](const Hit& h) { return bool(h); }))
      return {};
    return search(a, pixel, *window, *part);
  }

  /// A solid hides its inside: who sees the surface from behind looks through where it is missing.
  void look_for_inside(std::size_t a, const glm::dvec2& pixel, ExplainedView& out) const {
    const glm::dvec3 ray = eyes_[a].camera.ray(pixel);
    const std::optional<Hit> hit = rays_.closest(eyes_[a].centre, ray);
    if (!hit) return;
    ++out.on_surface;
    out.behind += glm::dot(face_of(*hit), ray) > 0;
  }

  /// Of the triangle that was met: outward, of twice its area.
  glm::dvec3 face_of(const Hit& hit) const {
    const auto& [i, j, k] = mesh_.triangles[hit.triangle];
    return glm::cross(mesh_.world(j) - mesh_.world(i), mesh_.world(k) - mesh_.world(i));
  }

  std::vector<Ray> rays_through(std::size_t a, const glm::dvec2& pixel) const {
    std::vector<Ray> through;
    for (int i = 0; i < kSamples; ++i)
      through.push_back({eyes_[a].centre, eyes_[a].camera.ray(sample_at(pixel, i))});
    return through;
  }

  /// `hits` of the window's rays, of which the middle one is there.
  Place compare(std::size_t a, const Window& window, const std::vector<Ray>& through,
                const std::vector<Hit>& hits) const {
    const Hit& hit = hits[kSamples / 2];
    const glm::dvec3& ray = through[kSamples / 2].direction;
    const std::vector<std::size_t> lenders = lenders_of(a, eyes_[a].centre + hit.t * ray, ray, hit);
    if (lenders.empty()) return Place::kAlone;
    for (const std::size_t b : lenders) {
      Window mine, other;
      int n = 0;
      for (int i = 0; i < kSamples; ++i) {
        if (!hits[i]) continue;
        const auto p = eyes_[b].camera.project(eyes_[a].centre + hits[i].t * through[i].direction);
        if (!p || !eyes_[b].grey.holds(p->x, p->y)) continue;
        mine[n] = window[i];
        other[n++] = eyes_[b].grey.at(p->x, p->y);
      }
      if (2 * n > kSamples && correlation(mine, other, n) >= kAgreement) return Place::kExplained;
    }
    return Place::kDisagreeing;
  }

  /// Views that see the point where the ray meets the surface, the nearest in angle first.
  std::vector<std::size_t> lenders_of(std::size_t a, const glm::dvec3& point, const glm::dvec3& ray,
                                      const Hit& hit) const {
    const glm::dvec3 face = face_of(hit);
    std::vector<std::pair<double, std::size_t>> by_angle;
    for (std::size_t b = 0; b < eyes_.size(); ++b) {
      const glm::dvec3 way = eyes_[b].centre - point;
      const double angle = degrees_between(way, -ray);
      if (b == a || angle < kLeastAngle || angle > kMostAngle) continue;
      if (glm::dot(face, way) * glm::dot(face, -ray) <= 0) continue;
      const auto pixel = eyes_[b].camera.project(point);
      if (pixel && eyes_[b].grey.holds(pixel->x, pixel->y)) by_angle.emplace_back(angle, b);
    }
    std::sort(by_angle.begin(), by_angle.end());
    std::vector<std::size_t> out;
    for (const auto& [angle, b] : by_angle) {
      const glm::dvec3 way = eyes_[b].centre - point;
      // Facets of the size of voxels would shadow themselves.
      const double lift = spacing_ * eyes_[b].camera.to_camera(point).z /
                          eyes_[b].camera.intrinsics.fx / glm::length(way);
      if (rays_.occluded(point, way, lift, 1)) continue;
      out.push_back(b);
      if (out.size() == kLenders) break;
    }
    return out;
  }

  /// A sample's ray in another view, at the inverse depth s: pixel of (s * eye + ray).
  struct Line {
    glm::dvec3 eye, ray;
    std::optional<glm::dvec2> at(double s) const {
      const glm::dvec3 h = s * eye + ray;
      return h.z > 0 ? std::optional(glm::dvec2(h) / h.z) : std::nullopt;
    }
  };

  /// At which depth do other views agree with the window, where no surface is?
  Place search(std::size_t a, const glm::dvec2& pixel, const Window& window,
               const std::pair<double, double>& part) const {
    const Eye& eye = eyes_[a];
    const glm::dvec3 forward = eye.camera.forward();
    const double slant = glm::dot(eye.camera.ray(pixel), forward);  // depth of a step along the ray
    const double near = slant * std::max(kNear * part.first, kNearInside * part.second);
    if (eye.beside.size() < 2) return Place::kBare;
    std::vector<std::array<Line, kSamples>> lines(eye.beside.size());
    double length = 0;
    for (std::size_t l = 0; l < lines.size(); ++l) {
      const glm::dmat4x3 p = eyes_[eye.beside[l]].camera.projection();
      for (int i = 0; i < kSamples; ++i) {
        const glm::dvec3 ray = eye.camera.ray(sample_at(pixel, i));
        lines[l][i] = {p * glm::dvec4(eye.centre, 1),
                       p * glm::dvec4(ray / glm::dot(ray, forward), 0)};
      }
      const Line& middle = lines[l][kSamples / 2];
      const auto first = middle.at(0), last = middle.at(1 / near);
      length = std::max(length, first && last ? glm::distance(*first, *last) : kMostSteps);
    }
    const int steps = std::clamp(int(length / spacing_), 8, kMostSteps);
    double best = kSweptAgreement, depth = 0;
    for (int step = 0; step <= steps; ++step) {
      const double s = step / near / steps;
      double first = -1, second = -1;  // the best two
      for (std::size_t l = 0; l < lines.size(); ++l) {
        const double score = score_at(eyes_[eye.beside[l]].grey, lines[l], s, window);
        second = std::max(second, std::min(first, score));
        first = std::max(first, score);
      }
      if ((first + second) / 2 > best)
        best = (first + second) / 2, depth = s > 0 ? 1 / s : INFINITY;
    }
    if (depth == 0) return Place::kBare;
    const double t = depth / slant;
    const double outside = std::max(part.first - t, t - part.second);
    if (outside <= 0) return Place::kMissed;
    return outside < kJustOutside * glm::length(box_.max - box_.min) ? Place::kCut : Place::kBeyond;
  }

  double score_at(const GreyImage& grey, const std::array<Line, kSamples>& lines, double s,
                  const Window& window) const {
    Window other;
    for (int i = 0; i < kSamples; ++i) {
      const auto p = lines[i].at(s);
      if (!p || !grey.holds(p->x, p->y)) return -1;
      other[i] = grey.at(p->x, p->y);
    }
    return correlation(window, other, kSamples);
  }

  const TriMesh& mesh_;
  const RayScene& rays_;
  const Box& box_;
  std::span<const PreparedView> views_;
  bool surface_alone_;
  double spacing_;  ///< pixels
  double least_deviation_;
  std::vector<Eye> eyes_;
};

}  // namespace

namespace {

int told_of(const auto& counted) {
  return counted.count(Place::kExplained) + counted.count(Place::kDisagreeing) +
         counted.count(Place::kAlone) + counted.count(Place::kMissed);
}

}  // namespace

int ExplainedView::count(Place place) const {
  return int(std::count_if(places.begin(), places.end(),
                           [&](const PlaceAt& p) { return p.place == place; }));
}

int ExplainedView::told() const { return told_of(*this); }

double ExplainedView::explained() const {
  return double(count(Place::kExplained)) / std::max(1, told());
}

int Explained::looked_at() const { return std::accumulate(counts.begin(), counts.end(), 0); }

int Explained::told() const { return told_of(*this); }

double Explained::explained() const { return share_told(Place::kExplained); }

double Explained::share_behind() const { return double(behind) / std::max(1, on_surface); }

double Explained::share_told(Place place) const {
  return double(count(place)) / std::max(1, told());
}

double Explained::share_textured(Place place) const {
  return double(count(place)) / std::max(1, looked_at() - count(Place::kPlain));
}

Explained explain_photographs(const TriMesh& mesh, const RayScene& rays, const Box& box,
                              std::span<const PreparedView> views, const ExplainOptions& options) {
  PHOTOHULL_CHECK(options.voxel_size > 0 && options.pixel_size > 0);
  const Explainer explainer(mesh, rays, box, views, options);
  Explained out;
  out.views.resize(views.size());
  tbb::parallel_for(std::size_t(0), views.size(),
                    [&](std::size_t i) { out.views[i] = explainer.look(i); });
  for (const ExplainedView& view : out.views) {
    for (const PlaceAt& p : view.places) ++out.counts[std::size_t(p.place)];
    out.on_surface += view.on_surface, out.behind += view.behind;
  }
  return out;
}

}  // namespace photohull::assess
