// Based on: C. Buehler, M. Bosse, L. McMillan, S. Gortler, M. Cohen, Unstructured lumigraph
// rendering, SIGGRAPH 2001.
#include "eval/predict_photo.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/option_word.h"

namespace photohull::eval {
namespace {

constexpr double kBiasPixels = 1;       // of the lending view, along its ray
constexpr double kLeastWeighed = 1e-3;  // radians; nearer views count as that near
constexpr float kKnown = 0.999f;        // alpha

double radians(double degrees) { return degrees * M_PI / 180; }

/// Linear RGBA of a pixel; the table makes what ColourImage::linear computes quick.
class Pixels {
 public:
  Pixels() {
    for (int i = 0; i < 256; ++i) table_[i] = float(linear_from_srgb(i / 255.0));
  }
  glm::vec4 at(const ColourImage& image, int x, int y) const {
    if (image.encoding != ColourImage::Encoding::kSrgb8) return image.linear(x, y);
    const std::uint8_t* p = &image.bytes[4 * (std::size_t(y) * image.width + x)];
    return {table_[p[0]], table_[p[1]], table_[p[2]], float(p[3]) / 255.0f};
  }

 private:
  std::array<float, 256> table_;
};

/// Catmull-Rom's weights of the pixels at -1, 0, 1, 2 for the position t in [0, 1].
std::array<float, 4> cubic(float t) {
  const float t2 = t * t, t3 = t2 * t;
  return {0.5f * (-t3 + 2 * t2 - t), 0.5f * (3 * t3 - 5 * t2 + 2), 0.5f * (-3 * t3 + 4 * t2 + t),
          0.5f * (t3 - t2)};
}

/// Colour at a pixel position; nothing outside the pixels' centres or where a pixel is unknown.
std::optional<glm::vec3> sample(const Pixels& pixels, const ColourImage& image,
                                const glm::dvec2& at) {
  if (!(at.x >= 0 && at.y >= 0 && at.x <= image.width - 1 && at.y <= image.height - 1)) return {};
  const int x0 = std::min(int(at.x), std::max(image.width - 2, 0));
  const int y0 = std::min(int(at.y), std::max(image.height - 2, 0));
  const std::array<float, 4> wx = cubic(float(at.x - x0)), wy = cubic(float(at.y - y0));
  glm::vec3 sum(0);
  for (int j = -1; j <= 2; ++j)
    for (int i = -1; i <= 2; ++i) {
      const glm::vec4 p = pixels.at(image, std::clamp(x0 + i, 0, image.width - 1),
                                    std::clamp(y0 + j, 0, image.height - 1));
      if (p.a < kKnown) return {};
      sum += wx[i + 1] * wy[j + 1] * glm::vec3(p);
    }
  return glm::max(sum, glm::vec3(0));
}

struct Lender {
  const PreparedView* view;
  glm::dvec3 centre;
};

struct Candidate {
  double angle;  ///< radians
  std::size_t lender;
  glm::dvec2 pixel;
  double near;  ///< share of the way to its camera where the shadow ray starts
};

/// What the rays of one prediction share.
class Predictor {
 public:
  Predictor(const TriMesh& mesh, const RayScene& rays, std::span<const PreparedView> views,
            std::span<const std::size_t> lenders, const PredictOptions& options)
      : mesh_(mesh),
        rays_(rays),
        blend_(std::size_t(options.blend)),
        least_(radians(options.least_angle)),
        most_(radians(options.most_angle)) {
    for (const std::size_t i : lenders) lenders_.push_back({&views[i], views[i].camera.center()});
  }

  /// The colour of the point that the ray (unit direction) meets.
  std::optional<glm::vec3> colour(const Ray& ray, const Hit& hit) const {
    const glm::dvec3 point = ray.origin + hit.t * ray.direction;
    std::vector<Candidate> near = candidates(point, -ray.direction, normal(hit.triangle));
    std::sort(near.begin(), near.end(), [](const Candidate& a, const Candidate& b) {
      return a.angle != b.angle ? a.angle < b.angle : a.lender < b.lender;
    });
    std::vector<std::pair<double, glm::vec3>> seen;  // angle and colour
    for (const Candidate& c : near) {
      const glm::dvec3 way = lenders_[c.lender].centre - point;
      if (rays_.occluded(point, way, c.near, 1)) continue;
      const auto colour = sample(pixels_, lenders_[c.lender].view->image, c.pixel);
      if (!colour) continue;
      seen.emplace_back(c.angle, *colour);
      if (seen.size() > blend_) break;
    }
    return blended(seen);
  }

 private:
  /// Of the face, not of unit length.
  glm::dvec3 normal(std::uint32_t triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return glm::cross(glm::dvec3(mesh_.positions[b]) - glm::dvec3(mesh_.positions[a]),
                      glm::dvec3(mesh_.positions[c]) - glm::dvec3(mesh_.positions[a]));
  }

  /// Views that may see the point if nothing is in the way; `back` points to the eye.
  std::vector<Candidate> candidates(const glm::dvec3& point, const glm::dvec3& back,
                                    const glm::dvec3& normal) const {
    std::vector<Candidate> out;
    for (std::size_t i = 0; i < lenders_.size(); ++i) {
      const glm::dvec3 way = lenders_[i].centre - point;
      const double distance = glm::length(way);
      if (!(distance > 0) || glm::dot(normal, way) * glm::dot(normal, back) < 0) continue;
      const double angle = std::acos(std::clamp(glm::dot(way, back) / distance, -1.0, 1.0));
      if (angle < least_ || angle > most_) continue;
      const Camera& camera = lenders_[i].view->camera;
      const auto pixel = camera.project(point);
      if (!pixel) continue;
      const double footprint = camera.to_camera(point).z / camera.intrinsics.fx;
      out.push_back({angle, i, *pixel, kBiasPixels * footprint / distance});
    }
    return out;
  }

  /// `seen` by angle, one more than are blended where there are so many.
  std::optional<glm::vec3> blended(const std::vector<std::pair<double, glm::vec3>>& seen) const {
    if (seen.empty()) return {};
    const double limit = seen.size() > blend_ ? seen[blend_].first : most_;
    double weights = 0;
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < std::min(blend_, seen.size()); ++i) {
      const auto& [angle, colour] = seen[i];
      if (!(angle < limit)) break;
      const double weight = (1 - angle / limit) / std::max(angle, kLeastWeighed);
      sum += weight * glm::dvec3(colour);
      weights += weight;
    }
    return weights > 0 ? glm::vec3(sum / weights) : seen[0].second;
  }

  const TriMesh& mesh_;
  const RayScene& rays_;
  std::size_t blend_;
  double least_, most_;  ///< radians
  std::vector<Lender> lenders_;
  Pixels pixels_;
};

}  // namespace

void describe(Described& to, PredictOptions& o) {
  to.number("blend", &o.blend, from_to(1, 16), "", "photographs blended at a point");
  to.number("least_angle", &o.least_angle, below(0, 90), "degrees",
            "degrees between a ray that is predicted and one that lends colour");
  to.number("most_angle", &o.most_angle, above(0, 90), "degrees",
            "the greatest such angle at which colour is lent");
}

void PredictOptions::validate() const {
  check_options(*this);
  if (least_angle >= most_angle)
    throw UsageError(concat(option_word("least_angle"), " must be from 0 to below ", most_angle,
                            ", not ", least_angle));
}

Prediction predict_photo(const TriMesh& mesh, const RayScene& rays, const Camera& camera,
                         std::span<const PreparedView> views, std::span<const std::size_t> lenders,
                         const PredictOptions& options, const std::function<void()>& row_done) {
  options.validate();
  const Predictor predictor(mesh, rays, views, lenders, options);
  const int width = camera.intrinsics.width, height = camera.intrinsics.height;
  Prediction out{width, height, {}, {}};
  out.state.resize(std::size_t(width) * std::size_t(height), PixelState::kMiss);
  out.colour.resize(out.state.size(), glm::vec3(0));
  const glm::dvec3 eye = camera.center();
  tbb::parallel_for(0, height, [&](int y) {
    std::vector<Ray> row;
    for (int x = 0; x < width; ++x) row.push_back({eye, camera.ray({x, y}), 0, INFINITY});
    std::vector<Hit> hits(row.size());
    rays.closest(row, hits);
    for (int x = 0; x < width; ++x) {
      if (!hits[x]) continue;
      const std::size_t i = std::size_t(y) * std::size_t(width) + std::size_t(x);
      const auto colour = predictor.colour(row[x], hits[x]);
      out.state[i] = colour ? PixelState::kLit : PixelState::kUnlit;
      if (colour) out.colour[i] = *colour;
    }
    row_done();
  });
  return out;
}

}  // namespace photohull::eval
