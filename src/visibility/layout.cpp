#include "visibility/layout.h"

#include <algorithm>
#include <cmath>

#include "visibility/convex.h"
#include "visibility/warp.h"

namespace photohull::visibility {
namespace {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

constexpr double kNearestShare = 1e-4;  // nearest depth that is drawn, of the farthest
constexpr double kNearSlack = 0.99;
constexpr double kDepthSlack = 1e-3;
constexpr double kMargin = 2;  // texels around a region, for kernels
constexpr int kSplitTries = 11;

dvec4 row_of(const glm::dmat4x3& p, int i) { return {p[0][i], p[1][i], p[2][i], p[3][i]}; }

/// A functional of world points as one of points relative to `origin`.
dvec4 relative_to(const dvec4& row, const dvec3& origin) {
  return {dvec3(row), row.w + glm::dot(dvec3(row), origin)};
}

/// The plain map's homogeneous rows (X z, Y z, z) for world points.
struct PlainRows {
  dvec4 x, y, z;
  dvec3 operator()(const dvec3& p) const {
    const dvec4 h(p, 1);
    return {glm::dot(x, h), glm::dot(y, h), glm::dot(z, h)};
  }
};

class Layouter {
 public:
  Layouter(const Camera& viewpoint, const Box& bounds, const dvec3& origin,
           const Technique& technique, const std::optional<Camera>& eye)
      : viewpoint_(viewpoint), bounds_(bounds), origin_(origin), technique_(technique), eye_(eye) {
    const Intrinsics& in = viewpoint.intrinsics;
    const double scale = double(technique.resolution) / std::max(in.width, in.height);
    const glm::dmat4x3 p = viewpoint.projection();
    const dvec4 q = row_of(p, 2);
    plain_ = {scale * (row_of(p, 0) + 0.5 * q), scale * (row_of(p, 1) + 0.5 * q), q};
    // Partitions share the texels of a whole map.
    out_.size = texels(scale / std::sqrt(double(technique.partitions)));
    out_.view_x = relative_to((row_of(p, 0) + 0.5 * q) / double(in.width), origin);
    out_.view_y = relative_to((row_of(p, 1) + 0.5 * q) / double(in.height), origin);
    out_.texel_width = 1 / (scale * std::sqrt(in.fx * in.fy));
  }

  MapLayout run() {
    fit_depths();
    if (technique_.warp == Warp::kNone || !eye_ || !lay_out_parts()) {
      out_.parts.clear();
      out_.size = texels(
          1 / (out_.texel_width * std::sqrt(viewpoint_.intrinsics.fx * viewpoint_.intrinsics.fy)));
      add_part(dmat3(1.0), 1e300);
    }
    return std::move(out_);
  }

 private:
  glm::ivec2 texels(double a_pixel) const {
    const auto count = [&](int pixels) { return std::max(1, int(std::lround(pixels * a_pixel))); };
    return {count(viewpoint_.intrinsics.width), count(viewpoint_.intrinsics.height)};
  }

  void fit_depths() {
    out_.near = 1e300, out_.far = -1e300;
    for (const dvec3& corner : Convex(bounds_).corners()) {
      out_.near = std::min(out_.near, plain_(corner).z);
      out_.far = std::max(out_.far, plain_(corner).z);
    }
    // A little more, for geometry of one depth has a range too.
    if (out_.far > 0) out_.far *= 1 + kDepthSlack;
    out_.near = std::max((1 - kDepthSlack) * out_.near, kNearestShare * out_.far);
  }

  void add_part(const dmat3& warp, double end) {
    PartLayout part;
    const auto combine = [&](int i) {
      return relative_to(warp[0][i] * plain_.x + warp[1][i] * plain_.y + warp[2][i] * plain_.z,
                         origin_);
    };
    part.row_x = combine(0), part.row_y = combine(1), part.row_w = combine(2);
    part.row_z = relative_to(plain_.z, origin_);
    const dmat3 back = glm::inverse(warp);
    part.depth_of_w = {back[0][2], back[1][2], back[2][2]};
    // w is depth times a factor that is linear on the map, so least at a corner.
    double factor = 1e300;
    for (const int x : {0, out_.size.x})
      for (const int y : {0, out_.size.y})
        factor = std::min(factor, 1 / glm::dot(part.depth_of_w, dvec3(x, y, 1)));
    part.nearest_w = kNearSlack * out_.near * factor;
    part.end = end;
    out_.parts.push_back(part);
  }

  /// What the eye sees between two depths and the viewpoint has on its image.
  WarpRegion region(double low, double high) const {
    WarpRegion r;
    Convex solid(bounds_);
    solid.cut(*eye_, low);
    const dvec3 axis = eye_->forward();
    solid.cut(-axis, -(glm::dot(axis, eye_->center()) + high));
    solid.cut(viewpoint_, out_.near);
    for (const dvec3& p : solid.corners()) {
      const dvec3 h = plain_(p);
      r.texels.emplace_back(h.x / h.z, h.y / h.z);
      r.depths.push_back(std::max(eye_->to_camera(p).z, 1e-9 * high));
    }
    if (r.texels.empty()) return r;
    const auto [first, last] = std::minmax_element(r.depths.begin(), r.depths.end());
    const dvec3 near_end = eye_->center() + *first * axis, far_end = eye_->center() + *last * axis;
    const dvec3 a = plain_(near_end), b = plain_(far_end);
    if (a.z <= 0 || b.z <= 0) return r;
    r.near_end = dvec2(a) / a.z, r.far_end = dvec2(b) / b.z;
    const dvec3 ray = glm::normalize(0.5 * (near_end + far_end) - viewpoint_.center());
    r.sine = glm::length(glm::cross(ray, axis));
    const Intrinsics& in = eye_->intrinsics;
    const double corner = std::hypot(0.5 * in.width / in.fx, 0.5 * in.height / in.fy);
    r.limit_sine = corner / std::hypot(1.0, corner);
    return r;
  }

  dmat3 warp_of(const WarpRegion& r, bool& warped) const {
    const double margin = kMargin + 0.5 * technique_.filter_size;
    warped = false;
    return technique_.warp == Warp::kFit
               ? fit_region(r, out_.size, margin)
               : warp_region(r, out_.size, margin, technique_.warp, warped);
  }

  /// Greatest width of a texel over that of an eye's pixel, squared, at the region's corners.
  double worst_error(const WarpRegion& r, const dmat3& warp) const {
    double worst = 0;
    for (std::size_t i = 0; i < r.texels.size(); ++i) {
      const double step = 1e-3;
      const auto at = [&](double dx, double dy) {
        const dvec3 h = warp * dvec3(r.texels[i] + dvec2(dx, dy), 1);
        return dvec2(h) / h.z;
      };
      const dvec2 dx = (at(step, 0) - at(0, 0)) / step, dy = (at(0, step) - at(0, 0)) / step;
      const double texels = std::abs(dx.x * dy.y - dx.y * dy.x);
      worst = std::max(worst, 1 / std::max(texels * r.depths[i] * r.depths[i], 1e-300));
    }
    return worst;
  }

  /// Ends of the partitions, between a logarithmic and an even split [Zhang06], such that the
  /// partition that suits its receivers least does so best.
  std::vector<double> choose_ends(double low, double high) const {
    const int n = technique_.partitions;
    std::vector<double> best;
    double least = 1e300;
    for (int k = 0; k < kSplitTries && n > 1; ++k) {
      const double share = double(k) / (kSplitTries - 1);
      std::vector<double> ends;
      double worst = 0, start = low;
      for (int i = 1; i <= n; ++i) {
        const double even = low + (high - low) * i / n;
        ends.push_back(share * even + (1 - share) * low * std::pow(high / low, double(i) / n));
        const WarpRegion r = region(start, ends.back());
        bool warped;
        if (!r.texels.empty()) worst = std::max(worst, worst_error(r, warp_of(r, warped)));
        start = ends.back();
      }
      if (worst < least) least = worst, best = ends;
    }
    return n > 1 ? best : std::vector{high};
  }

  bool lay_out_parts() {
    if (out_.far <= out_.near) return false;
    const double reach = glm::length(eye_->center() - bounds_.center()) + bounds_.diagonal();
    const WarpRegion all = region(kNearestShare * reach, reach);
    if (all.texels.empty()) return false;
    const auto [low, high] = std::minmax_element(all.depths.begin(), all.depths.end());
    double start = *low;
    const std::vector<double> ends = choose_ends(*low, *high);
    for (const double end : ends) {
      WarpRegion r = region(start, end);
      if (r.texels.empty()) r = all;
      bool warped = false;
      const dmat3 matrix = warp_of(r, warped);
      out_.warped = out_.warped || warped;
      add_part(matrix, end);
      start = end;
    }
    const dvec3 axis = eye_->forward();
    out_.eye_row = relative_to(dvec4(axis, -glm::dot(axis, eye_->center())), origin_);
    return true;
  }

  const Camera& viewpoint_;
  const Box& bounds_;
  dvec3 origin_;
  const Technique& technique_;
  const std::optional<Camera>& eye_;
  PlainRows plain_;
  MapLayout out_;
};

}  // namespace

MapLayout lay_out(const Camera& viewpoint, const Box& bounds, const dvec3& origin,
                  const Technique& technique, const std::optional<Camera>& eye) {
  return Layouter(viewpoint, bounds, origin, technique, eye).run();
}

shaders::MapInfo to_info(const MapLayout& layout, const Technique& technique,
                         std::size_t triangles) {
  shaders::MapInfo info{};
  info.part_ends = glm::vec4(1e30f);
  for (std::size_t i = 0; i < layout.parts.size(); ++i) {
    const PartLayout& part = layout.parts[i];
    info.parts[i] = {glm::vec4(part.row_x), glm::vec4(part.row_y), glm::vec4(part.row_w),
                     glm::vec4(part.row_z),
                     glm::vec4(glm::vec3(part.depth_of_w), float(part.nearest_w))};
    if (i + 1 < layout.parts.size()) info.part_ends[int(i)] = float(part.end);
  }
  info.eye_row = glm::vec4(layout.eye_row);
  info.size = glm::ivec4(layout.size, int(layout.parts.size()), int(triangles));
  const double texel = layout.texel_width * std::max(layout.middle(), 0.0);
  info.bias = {float(technique.bias_texels * texel), float(technique.slope_factor),
               float(technique.z_max_texels * texel), float(layout.texel_width)};
  info.range = {float(layout.near), float(layout.far), float(technique.bleeding_cut), 0};
  info.view_x = glm::vec4(layout.view_x);
  info.view_y = glm::vec4(layout.view_y);
  info.lists.x = technique.list_block;
  return info;
}

}  // namespace photohull::visibility
