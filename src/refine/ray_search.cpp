// Depth along rays by comparing patches across them [Collins96], then by passing planes from ray to
// ray [Bleyer11].
#include "refine/ray_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace photohull::refine {
namespace {

constexpr int kLengths[] = {8, 16, 32, 64};                 // samples along a ray
constexpr std::size_t kMostThreads = std::size_t(1) << 21;  // samples at a time
constexpr double kHopeful = 0.2;               // below the least score, of what is worth spreading
constexpr double kElsewhere = 2.5;             // voxels between places that are not the same
constexpr int kGuesses = 8;                    // planes that a ray tries in a round
constexpr double kLeastCosine = 0.2;           // between a plane's normal and the ray
constexpr double kTilt = 0.7;                  // of the first round's guesses: tangent of the angle
constexpr double kGolden = 2.399963229728653;  // radians; turns by it never repeat

/// Of patches that face the camera: their normals point at it.
OffsetRange away_from_camera(int count) { return {0, -1, count}; }

double step_of(const Ray& ray, int count) { return std::max(1.0, ray.length / count); }

glm::dvec3 place(const Ray& ray, const RayPlane& found) {
  return ray.from + found.along * ray.direction;
}

struct Guess {
  double along;
  glm::dvec3 normal;
};

/// The planes that one ray tries.
class Guesses {
 public:
  Guesses(const Ray& ray) : ray_(ray) {}

  bool full() const { return count_ == kGuesses; }
  const Guess& operator[](std::size_t k) const { return guesses_[k]; }

  /// Where the ray meets a plane, if it does and not at too small an angle.
  void add_plane(const glm::dvec3& point, const glm::dvec3& normal) {
    const double facing = -glm::dot(normal, ray_.direction);
    if (full() || !(facing >= kLeastCosine)) return;
    const double along = glm::dot(ray_.from - point, normal) / facing;
    if (along >= 0 && along <= ray_.length) guesses_[count_++] = {along, normal};
  }

  /// Planes about `found` in turning directions, until there are enough.
  void fill(const RayPlane& found, double scale, std::size_t seed) {
    const glm::dvec3 helper =
        std::abs(ray_.direction.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(ray_.direction, helper));
    const glm::dvec3 w = glm::cross(ray_.direction, u);
    for (std::size_t turn = seed * kGuesses; !full(); ++turn) {
      const double angle = kGolden * double(turn);
      glm::dvec3 normal = glm::normalize(
          found.normal + kTilt * scale * (std::cos(angle) * u + std::sin(angle) * w));
      if (-glm::dot(normal, ray_.direction) < kLeastCosine) normal = found.normal;
      const double shift = scale * std::cos(2 * angle + 1);
      guesses_[count_++] = {std::clamp(found.along + shift, 0.0, ray_.length), normal};
    }
  }

 private:
  const Ray& ray_;
  std::array<Guess, kGuesses> guesses_;
  std::size_t count_ = 0;
};

/// The rays of a lattice, and what its places found.
class RayLattice {
 public:
  RayLattice(std::span<const Ray> rays, int width, int height)
      : rays_(rays), width_(width), height_(height), at_(std::size_t(width) * height, -1) {
    for (std::size_t i = 0; i < rays.size(); ++i)
      at_[std::size_t(rays[i].y) * width + rays[i].x] = int(i);
  }

  Guesses guesses(std::size_t i, std::span<const RayPlane> findings, int round) const {
    const Ray& ray = rays_[i];
    Guesses out(ray);
    std::array<int, 6> found;
    for (std::size_t k = 0; const glm::ivec2& d : neighbours(ray, round))
      found[k++] = neighbour(ray, d.x, d.y, findings);
    const auto [l, r, a, b] = std::array{found[0], found[1], found[2], found[3]};
    if (l >= 0 && r >= 0 && a >= 0 && b >= 0 && findings[i].along >= 0) {
      const glm::dvec3 across =
          glm::cross(at(r, findings) - at(l, findings), at(b, findings) - at(a, findings));
      if (glm::length(across) > 0) {
        const glm::dvec3 normal = glm::normalize(across);
        out.add_plane(at(int(i), findings), glm::dot(normal, ray.direction) > 0 ? -normal : normal);
      }
    }
    for (const int k : found) add(k, findings, out);
    RayPlane self = findings[i];
    if (self.along < 0) self.along = 0.5 * ray.length, self.normal = -ray.direction;
    const std::size_t seed = ray.seed < 0 ? i : std::size_t(ray.seed);
    out.fill(self, std::ldexp(1.0, -round), seed + std::size_t(round));
    return out;
  }

  /// The best score of a ray and of those whose planes it tries; -1: none found anything.
  float best_about(std::size_t i, std::span<const RayPlane> findings, int round) const {
    float best = findings[i].score;
    for (const glm::ivec2& d : neighbours(rays_[i], round))
      if (const int k = neighbour(rays_[i], d.x, d.y, findings); k >= 0)
        best = std::max(best, findings[std::size_t(k)].score);
    return best;
  }

 private:
  /// Where the rays are whose planes a ray tries in a round: beside it, and farther off.
  static std::array<glm::ivec2, 6> neighbours(const Ray& ray, int round) {
    const int far = round + 2, sign = (ray.x + ray.y + round) % 2 == 0 ? 1 : -1;
    return {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {far, sign * far}, {-far, -sign * far}}};
  }

  /// That many rays away, with a finding; -1: none.
  int neighbour(const Ray& ray, int dx, int dy, std::span<const RayPlane> findings) const {
    const int x = ray.x + dx, y = ray.y + dy;
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return -1;
    const int k = at_[std::size_t(y) * width_ + x];
    return k >= 0 && findings[std::size_t(k)].along >= 0 ? k : -1;
  }

  glm::dvec3 at(int k, std::span<const RayPlane> findings) const {
    return place(rays_[std::size_t(k)], findings[std::size_t(k)]);
  }

  void add(int k, std::span<const RayPlane> findings, Guesses& out) const {
    if (k >= 0) out.add_plane(at(k, findings), findings[std::size_t(k)].normal);
  }

  std::span<const Ray> rays_;
  int width_, height_;
  std::vector<int> at_;
};

/// The best place of the sweep, between samples.
void take_best(const Ray& ray, Finding& found) {
  const std::vector<float>& s = found.swept;
  const auto best = std::size_t(std::max_element(s.begin(), s.end()) - s.begin());
  double shift = 0;
  if (best > 0 && best + 1 < s.size()) {
    const double curvature = s[best - 1] - 2.0 * s[best] + s[best + 1];
    if (curvature < 0) shift = std::clamp(0.5 * (s[best - 1] - s[best + 1]) / curvature, -0.5, 0.5);
  }
  found.along = (double(best) + shift) * found.step;
  found.score = s[best];
  found.normal = -ray.direction;
}

}  // namespace

double Finding::lead() const {
  float other = -1;
  for (std::size_t j = 0; j < swept.size(); ++j) {
    if (std::abs(double(j) * step - along) <= kElsewhere * step) continue;
    const bool peak =
        (j == 0 || swept[j] >= swept[j - 1]) && (j + 1 == swept.size() || swept[j] > swept[j + 1]);
    if (peak || !moved) other = std::max(other, swept[j]);
  }
  return double(score) - double(other);
}

RaySearch::RaySearch(gpu::Context& context, const projtex::ImageSet& images,
                     std::span<const projtex::GridCamera> cameras, double noise_sigma,
                     const VoteOptions& options)
    : matcher_(context, images, cameras,
               {1, options.tap_spacing, 1, options.best_pairs, noise_sigma}, "refine_vote"),
      options_(options) {}

void RaySearch::scores_along(std::span<const Ray> rays, const ViewPartners& partners, int count,
                             const Decide& decide) const {
  const std::size_t batch = kMostThreads / std::size_t(count);
  for (std::size_t first = 0; first < rays.size(); first += batch) {
    std::vector<PatchSurfel> surfels;
    std::vector<std::uint32_t> tiles;
    for (const Ray& ray : rays.subspan(first, std::min(batch, rays.size() - first))) {
      surfels.push_back(
          {glm::vec3(ray.from), glm::vec3(-ray.direction), float(step_of(ray, count))});
      tiles.push_back(std::uint32_t(ray.tile));
    }
    const Matches s = matcher_.match_alike(surfels, partners.tiles, tiles, away_from_camera(count));
    for (std::size_t i = 0; i < surfels.size(); ++i)
      decide(first + i, s.scores.data() + i * std::size_t(count));
  }
}

std::vector<float> RaySearch::textures(std::span<const Ray> rays,
                                       const ViewPartners& partners) const {
  std::vector<float> out;
  for (std::size_t first = 0; first < rays.size(); first += kMostThreads) {
    std::vector<PatchSurfel> surfels;
    std::vector<std::uint32_t> tiles;
    for (const Ray& ray : rays.subspan(first, std::min(kMostThreads, rays.size() - first))) {
      surfels.push_back(
          {glm::vec3(ray.from + 0.5 * ray.length * ray.direction), glm::vec3(-ray.direction)});
      tiles.push_back(std::uint32_t(ray.tile));
    }
    const Matches s = matcher_.textures_alike(surfels, partners.tiles, tiles);
    out.insert(out.end(), s.texture.begin(), s.texture.end());
  }
  return out;
}

void RaySearch::sweep(std::span<const Ray> rays, const ViewPartners& partners,
                      std::span<Finding> findings) const {
  std::vector<std::size_t> by_length[std::size(kLengths)];
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (findings[i].known) continue;
    std::size_t k = 0;
    while (k + 1 < std::size(kLengths) && rays[i].length > kLengths[k]) ++k;
    by_length[k].push_back(i);
  }
  for (std::size_t k = 0; k < std::size(kLengths); ++k) {
    std::vector<Ray> part;
    for (const std::size_t i : by_length[k]) part.push_back(rays[i]);
    scores_along(part, partners, kLengths[k], [&](std::size_t i, const float* s) {
      Finding& found = findings[by_length[k][i]];
      found.step = step_of(part[i], kLengths[k]);
      found.swept.assign(
          s, s + std::min(kLengths[k], int(std::ceil(part[i].length / found.step)) + 1));
      take_best(part[i], found);
    });
  }
}

void RaySearch::spread(std::span<const Ray> rays, int width, int height,
                       const ViewPartners& partners, std::span<Finding> findings) const {
  const RayLattice lattice(rays, width, height);
  std::vector<std::size_t> unknown;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (!findings[i].known) unknown.push_back(i);
  constexpr std::size_t batch = kMostThreads / kGuesses;
  for (int round = 0; round < options_.rounds; ++round) {
    const std::vector<RayPlane> before(findings.begin(), findings.end());
    std::vector<std::size_t> trying;
    for (const std::size_t i : unknown)
      if (lattice.best_about(i, before, round) >= options_.least_score - kHopeful)
        trying.push_back(i);
    for (std::size_t first = 0; first < trying.size(); first += batch) {
      const auto part = std::span<const std::size_t>(trying).subspan(
          first, std::min(batch, trying.size() - first));
      std::vector<PatchSurfel> surfels(part.size() * kGuesses);
      std::vector<std::uint32_t> tiles(surfels.size());
      tbb::parallel_for(std::size_t(0), part.size(), [&](std::size_t i) {
        const Guesses guesses = lattice.guesses(part[i], before, round);
        const Ray& ray = rays[part[i]];
        for (std::size_t k = 0; k < kGuesses; ++k) {
          surfels[i * kGuesses + k] = {glm::vec3(ray.from + guesses[k].along * ray.direction),
                                       glm::vec3(guesses[k].normal)};
          tiles[i * kGuesses + k] = std::uint32_t(ray.tile);
        }
      });
      const Matches s = matcher_.match_alike(surfels, partners.tiles, tiles, away_from_camera(1));
      tbb::parallel_for(std::size_t(0), part.size(), [&](std::size_t i) {
        Finding& found = findings[part[i]];
        const Ray& ray = rays[part[i]];
        for (std::size_t k = i * kGuesses; k < (i + 1) * kGuesses; ++k) {
          if (s.scores[k] <= found.score) continue;
          found.moved = true;
          found.score = s.scores[k];
          found.along = glm::dot(glm::dvec3(surfels[k].position) - ray.from, ray.direction);
          found.normal = glm::dvec3(surfels[k].normal);
        }
      });
    }
  }
}

}  // namespace photohull::refine
