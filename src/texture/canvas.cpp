// The two bands of frequencies are after P. Burt, E. Adelson, "A multiresolution spline with
// application to image mosaics", ACM Transactions on Graphics 2, 1983 [BurtAdelson83].
#include "texture/canvas.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "texture/surface.h"

namespace photohull::texture {
namespace {

constexpr int kWindow = 7;            // texels along each side in which photographs are compared
constexpr float kLeastInWindow = 12;  // texels that both show
constexpr float kFullWeight = 0.25f;  // of all photographs, from which on nothing is filled
constexpr double kCoarse = 2;         // texels: standard deviation of what is the coarse part
constexpr float kShift = 0.5f;        // texels by which photographs that agree may be shifted
/// Of a photograph's weight, beside which 1 is the best at a triangle: what is seen from farther
/// away, or slanted, would soften fine detail.
constexpr float kLeastWeight = 0.8f;

/// How much of a colour is the photograph's.
float share_of(int clearance) {
  if (clearance < kLeastClearance) return 0;
  return float(clearance - kLeastClearance + 1) / float(kFullClearance - kLeastClearance + 1);
}

cv::Size size_of(const Chart& chart) { return {chart.size.x, chart.size.y}; }

/// Texels beside slivers may lie many of their widths away.
glm::dvec3 bounded(const glm::dvec3& weights) {
  constexpr double kBeyond = 1;
  const bool near = glm::all(glm::lessThan(glm::abs(weights - 0.5), glm::dvec3(0.5 + kBeyond)));
  if (near) return weights;
  const glm::dvec3 inside = glm::clamp(weights, 0.0, 1.0);
  const double sum = inside.x + inside.y + inside.z;
  return sum > 0 ? inside / sum : glm::dvec3(1.0 / 3);
}

/// Sums over windows of texels that both photographs show.
struct WindowSums {
  float count;
  glm::vec3 own, other;
  float squared;   // differences
  float gradient;  // squared, of the own one
};
static_assert(sizeof(WindowSums) == 9 * sizeof(float));

/// Sums of what is near, by how much of it is clear.
struct CoarseSums {
  glm::vec3 mean, fine;
  float share;
};
static_assert(sizeof(CoarseSums) == 7 * sizeof(float));

}  // namespace

Canvas::Canvas(const TriMesh& mesh, const Planes& planes, const Chart& chart,
               std::uint32_t chart_index, const PagePlan& plan)
    : mesh_(mesh), chart_(chart), chart_index_(chart_index), plan_(plan) {
  const std::size_t count = std::size_t(chart.size.x) * chart.size.y;
  places_.resize(count, glm::vec2(0));
  own_.resize(count, glm::vec4(0));
  all_.resize(count, glm::vec4(0));
  fine_.resize(count, glm::vec4(0));
  agreeing_.resize(count, glm::vec2(0));
  std::uint32_t last = kNoFace;
  FaceInImage seen;
  for (int y = 0; y < chart.size.y; ++y)
    for (int x = 0; x < chart.size.x; ++x) {
      const std::uint32_t f = face(x, y);
      if (f == kNoFace) continue;
      if (f != last) seen = on_chart(mesh, planes, chart, last = f);
      const glm::dvec3 w = bounded(surface_weights(seen, image_weights(seen, {x, y})));
      places_[index(x, y)] = {w.y, w.z};
    }
}

glm::vec3 Canvas::weights(std::size_t i) const {
  return {1 - places_[i].x - places_[i].y, places_[i].x, places_[i].y};
}

glm::vec3 Canvas::position(std::size_t i, std::uint32_t face) const {
  const glm::vec3 w = weights(i);
  const auto& [a, b, c] = mesh_.triangles[face];
  return w.x * mesh_.positions[a] + w.y * mesh_.positions[b] + w.z * mesh_.positions[c];
}

void Canvas::take_own(const ViewSource& source) {
  for (int y = 0; y < chart_.size.y; ++y)
    for (int x = 0; x < chart_.size.x; ++x) {
      const std::uint32_t f = face(x, y);
      if (f == kNoFace) continue;
      const std::size_t i = index(x, y);
      Projected p;
      if (!source.projector.project(position(i, f), p)) continue;
      const glm::ivec2 pixel = chart_.low + glm::ivec2(x, y);
      const float share = share_of(source.maps.clearance_of(pixel.x, pixel.y, p.z));
      if (share == 0) continue;
      own_[i] = glm::vec4(source.pixels.root(pixel.x, pixel.y), share);
      fine_[i] = glm::vec4(glm::vec3(own_[i]), 1);
    }
}

std::vector<glm::vec4> Canvas::resample(const CanvasView& view) const {
  std::vector<glm::vec4> out(own_.size(), glm::vec4(0));
  for (int y = 0; y < chart_.size.y; ++y)
    for (int x = 0; x < chart_.size.x; ++x) {
      const std::uint32_t f = face(x, y);
      if (f == kNoFace) continue;
      const std::size_t i = index(x, y);
      const auto& [a, b, c] = mesh_.triangles[f];
      const glm::vec3 w = weights(i);
      const float weight = w.x * view.weights[a] + w.y * view.weights[b] + w.z * view.weights[c];
      if (!(weight > 0)) continue;
      Projected p;
      if (!view.source.projector.project(position(i, f), p)) continue;
      const glm::dvec2 pixel = glm::round(glm::dvec2(p));
      if (!(std::abs(pixel.x) < 1e6 && std::abs(pixel.y) < 1e6)) continue;
      // The cubic reaches two pixels farther than the pixels themselves do.
      if (view.source.maps.clearance_of(int(pixel.x), int(pixel.y), p.z) < kFullClearance) continue;
      out[i] = glm::vec4(view.source.pixels.root_between(glm::dvec2(p)), weight);
    }
  return out;
}

void Canvas::add(const CanvasView& view, double noise) {
  const std::vector<glm::vec4> other = resample(view);
  bool any = false;
  for (std::size_t i = 0; i < other.size(); ++i) {
    const float w = other[i].w;
    all_[i] += glm::vec4(w * glm::vec3(other[i]), w);
    any |= w > 0 && own_[i].w > 0;
  }
  if (!any || chart_.plane == view.view) return;
  cv::Mat values(size_of(chart_), CV_32FC(9), cv::Scalar(0)), sums;
  values.setTo(0);
  const auto at = [&](int x, int y) { return glm::vec3(own_[index(x, y)]); };
  const auto shown = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < chart_.size.x && y < chart_.size.y && own_[index(x, y)].w > 0;
  };
  for (int y = 0; y < chart_.size.y; ++y)
    for (int x = 0; x < chart_.size.x; ++x) {
      const std::size_t i = index(x, y);
      if (!(other[i].w > 0 && own_[i].w > 0)) continue;
      const glm::vec3 own(own_[i]), seen(other[i]), apart = seen - own;
      glm::vec3 dx(0), dy(0);
      if (shown(x - 1, y) && shown(x + 1, y)) dx = 0.5f * (at(x + 1, y) - at(x - 1, y));
      if (shown(x, y - 1) && shown(x, y + 1)) dy = 0.5f * (at(x, y + 1) - at(x, y - 1));
      *reinterpret_cast<WindowSums*>(values.ptr<float>(y, x)) = {
          1, own, seen, glm::dot(apart, apart), glm::dot(dx, dx) + glm::dot(dy, dy)};
    }
  cv::boxFilter(values, sums, -1, {kWindow, kWindow}, {-1, -1}, false, cv::BORDER_CONSTANT);
  std::vector<float> least(own_.size(), 0.0f);
  for (const BandTexel& band : plan_.band_of_chart(chart_index_))
    if (band.plane == view.view)
      least[index(band.texel.x, band.texel.y)] = band.share / (1 - band.share);
  const float noise_part = float(2 * 3 * noise * noise);
  for (int y = 0; y < chart_.size.y; ++y)
    for (int x = 0; x < chart_.size.x; ++x) {
      const std::size_t i = index(x, y);
      if (!(other[i].w > 0 && own_[i].w > 0)) continue;
      const auto& s = *reinterpret_cast<const WindowSums*>(sums.ptr<float>(y, x));
      const glm::vec3 shift = (s.own - s.other) / s.count;
      float agree = 0;
      if (s.count >= kLeastInWindow) {
        const float rest =
            std::max(0.0f, s.squared / s.count - glm::dot(shift, shift));  // all channels
        const float allowed = 0.5f * kShift * kShift * s.gradient / s.count + noise_part;
        agree = allowed > 0 ? std::clamp(2 - rest / allowed, 0.0f, 1.0f) : rest == 0;
        agreeing_[i] += other[i].w * glm::vec2(agree, 1);
      }
      const float w = std::max(other[i].w >= kLeastWeight ? agree * other[i].w : 0, least[i]);
      if (w > 0) fine_[i] += glm::vec4(w * (glm::vec3(other[i]) + shift), w);
    }
}

std::vector<glm::vec3> Canvas::mean_of_all(const FillColour& fill) const {
  std::vector<glm::vec3> mean(own_.size(), glm::vec3(0));
  std::uint32_t hint = 0;
  for (int y = 0; y < chart_.size.y; ++y)
    for (int x = 0; x < chart_.size.x; ++x) {
      const std::uint32_t on = face(x, y);
      if (on == kNoFace) continue;
      const std::size_t i = index(x, y);
      const float known = std::min(1.0f, all_[i].w / kFullWeight);
      if (known > 0) mean[i] += known * glm::vec3(all_[i]) / all_[i].w;
      if (known < 1)
        mean[i] += (1 - known) * fill.root(mesh_.origin + glm::dvec3(position(i, on)), hint);
    }
  return mean;
}

std::vector<Canvas::Bands> Canvas::split(const std::vector<glm::vec3>& mean) const {
  cv::Mat values(size_of(chart_), CV_32FC(7)), smooth;
  for (std::size_t i = 0; i < own_.size(); ++i) {
    const float share = own_[i].w;
    values.ptr<CoarseSums>()[i] =
        share > 0 ? CoarseSums{share * mean[i], share * glm::vec3(fine_[i]) / fine_[i].w, share}
                  : CoarseSums{};
  }
  cv::GaussianBlur(values, smooth, {0, 0}, kCoarse, kCoarse, cv::BORDER_CONSTANT);
  std::vector<Bands> bands(own_.size());
  for (std::size_t i = 0; i < own_.size(); ++i) {
    if (own_[i].w == 0) continue;
    const auto& s = smooth.ptr<CoarseSums>()[i];
    bands[i] = {s.mean / s.share, glm::vec3(fine_[i]) / fine_[i].w - s.fine / s.share};
  }
  return bands;
}

void Canvas::finish(const FillColour& fill, double detail,
                    const std::function<void(const glm::ivec2&, const CanvasColour&)>& f) const {
  const std::vector<glm::vec3> mean = mean_of_all(fill);
  const std::vector<Bands> bands = split(mean);
  for (int y = 0; y < chart_.size.y; ++y)
    for (int x = 0; x < chart_.size.x; ++x) {
      if (face(x, y) == kNoFace) continue;
      const std::size_t i = index(x, y);
      CanvasColour colour{mean[i], all_[i].w == 0 && own_[i].w == 0};
      if (own_[i].w > 0) {
        const float agree = agreeing_[i].y > 0 ? agreeing_[i].x / agreeing_[i].y : 1;
        colour.root =
            glm::mix(mean[i], bands[i].coarse + float(detail) * bands[i].fine, agree * own_[i].w);
      }
      f({x, y}, colour);
    }
}

}  // namespace photohull::texture
