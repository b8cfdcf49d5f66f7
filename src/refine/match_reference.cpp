#include "refine/match_reference.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "refine/view_choice.h"
#include "visibility/kernels/depth_maps.h"

namespace photohull::refine::reference {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kTie = 1e-5;  // of cosines

double degrees_between(const dvec3& a, const dvec3& b) {
  return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

struct Candidate {
  int view;
  double cosine;
  double worth;
  dvec3 direction;  // unit, to the camera
};

bool in_frame(const MatchView& view, const dvec3& receiver) {
  const dvec3 p = view.camera.projection * glm::dvec4(receiver, 1);
  if (p.z <= 1) return false;
  const dvec2 pixel = dvec2(p) / p.z;
  return pixel.x >= -0.5 && pixel.y >= -0.5 && pixel.x <= view.camera.width - 0.5 &&
         pixel.y <= view.camera.height - 0.5;
}

bool unblocked(const MatchView& view, const dvec3& receiver, double depth_bias) {
  return visibility::reference::visible(view.camera, view.depth_info, receiver, depth_bias,
                                        view.depths);
}

/// Index of the candidate with the greatest worth above 0, or of the one that `tie` names when it
/// is as good; -1 where none is.
int best_of(const std::vector<Candidate>& candidates, int tie,
            const std::function<double(const Candidate&)>& worth) {
  int best = -1;
  double most = 0;
  for (std::size_t k = 0; k < candidates.size(); ++k)
    if (worth(candidates[k]) > most) most = worth(candidates[k]), best = int(k);
  for (std::size_t k = 0; k < candidates.size(); ++k)
    if (best >= 0 && candidates[k].view == tie && worth(candidates[k]) > most - kTie) return int(k);
  return best;
}

/// Colours of the taps about their mean.
std::vector<dvec3> taps(const MatchView& view, const Patch& patch, const dvec3& u, const dvec3& v) {
  const dvec3 p = view.camera.projection * glm::dvec4(patch.centre, 1);
  const dvec2 pixel = dvec2(p) / p.z;
  const dvec2 du = derivative(view.camera, patch.centre, u);
  const dvec2 dv = derivative(view.camera, patch.centre, v);
  const dvec2 dn = derivative(view.camera, patch.centre, patch.normal);
  const double square = glm::dot(u, u);  // voxels
  const double area = std::abs(du.x * dv.y - du.y * dv.x);
  const int level = area > 1 ? int(std::floor(std::log2(std::sqrt(area)) + 0.5)) : 0;
  std::vector<dvec3> out;
  dvec3 sum(0);
  for (int b = -patch.radius; b <= patch.radius; ++b)
    for (int a = -patch.radius; a <= patch.radius; ++a) {
      if (patch.radius > 1 && (a + b) % 2 != 0) continue;
      const double height =
          square * (0.5 * a * a * patch.bend.x + a * b * patch.bend.y + 0.5 * b * b * patch.bend.z);
      out.push_back(sample(view, pixel + double(a) * du + double(b) * dv + height * dn, level));
      sum += out.back();
    }
  const dvec3 mean = sum / double(out.size());
  for (dvec3& x : out) x -= mean;
  return out;
}

double product(const std::vector<dvec3>& a, const std::vector<dvec3>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += glm::dot(a[i], b[i]);
  return sum;
}

/// Steps between the taps of a patch.
struct Frame {
  dvec3 u, v;
};

Frame frame(const MatchView& reference, const Patch& patch, const MatchOptions& options) {
  const double pixel =
      glm::distance(reference.camera.centre, patch.centre) / reference.camera.focal;
  const double spacing = std::max(options.least_spacing, options.pixel_spacing * pixel);
  const dvec3 axis = std::abs(patch.normal.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  const dvec3 u = spacing * glm::normalize(glm::cross(axis, patch.normal));
  const dvec3 v = glm::cross(patch.normal, u);

  return {u, v};
}

}  // namespace

// Quotient rule on s / q, t / q.
dvec2 derivative(const projtex::GridCamera& camera, const dvec3& at, const dvec3& step) {
  const dvec3 p = camera.projection * glm::dvec4(at, 1);
  const dvec3 by = camera.projection * glm::dvec4(step, 0);
  return (dvec2(by) * p.z - dvec2(p) * by.z) / (p.z * p.z);
}

dvec3 sample(const MatchView& view, const dvec2& pixel, int level) {
  const auto& base = view.mips.front();
  const auto& image = view.mips[std::size_t(std::clamp(level, 0, int(view.mips.size()) - 1))];
  const dvec2 size(image.width, image.height);
  const dvec2 at =
      glm::clamp((pixel + 0.5) * size / dvec2(base.width, base.height) - 0.5, dvec2(-1), size);
  const dvec2 low = glm::floor(at), share = at - low;
  dvec3 sum(0);
  for (int corner = 0; corner < 4; ++corner) {
    const int dx = corner & 1, dy = corner >> 1;
    const int x = std::clamp(int(low.x) + dx, 0, image.width - 1);
    const int y = std::clamp(int(low.y) + dy, 0, image.height - 1);
    const double weight = (dx ? share.x : 1 - share.x) * (dy ? share.y : 1 - share.y);
    sum += weight * dvec3(image.pixels[std::size_t(y) * image.width + x]);
  }
  return glm::sqrt(glm::max(sum, 0.0));
}

Choice choose_views(std::span<const MatchView> views, const dvec3& position, const dvec3& normal,
                    const MatchOptions& options, std::span<const int> ties) {
  Choice out;
  std::vector<Candidate> candidates, hidden;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const dvec3 offset = views[v].camera.centre - position;
    const double cosine = glm::dot(offset, normal) / glm::length(offset);
    if (!(cosine > options.seen_cosine)) continue;
    const dvec3 receiver = position + options.shift * normal;
    if (!in_frame(views[v], receiver)) continue;
    const bool sees = unblocked(views[v], receiver, options.depth_bias);
    out.seen += sees;
    if (cosine > options.least_cosine)
      (sees ? candidates : hidden)
          .push_back(
              {int(v), cosine, cosine * std::pow(views[v].sharpness, 4), glm::normalize(offset)});
  }
  std::stable_sort(hidden.begin(), hidden.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cosine > b.cosine; });
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.worth > b.worth; });
  for (std::size_t k = 0; k < std::min<std::size_t>(hidden.size(), ViewChoice::kMostHidden); ++k)
    out.hidden.push_back(hidden[k].view);
  if (candidates.size() > ViewChoice::kCandidates) candidates.resize(ViewChoice::kCandidates);

  std::vector<dvec3> directions;
  const auto take = [&](int k) {
    out.views.push_back(candidates[std::size_t(k)].view);
    directions.push_back(candidates[std::size_t(k)].direction);
    candidates.erase(candidates.begin() + k);
  };
  const auto tie = [&](std::size_t slot) { return slot < ties.size() ? ties[slot] : -1; };
  if (candidates.empty()) return out;
  take(best_of(candidates, tie(0), [](const Candidate& c) { return c.worth; }));
  std::erase_if(candidates, [&](const Candidate& c) {
    const double angle = degrees_between(c.direction, directions[0]);
    return angle < options.nearest_angle || angle > options.farthest_angle;
  });
  while (out.views.size() < ViewChoice::kMostViews && !candidates.empty())
    take(best_of(candidates, tie(out.views.size()), [&](const Candidate& c) {
      const bool duplicate = std::any_of(directions.begin(), directions.end(), [&](const dvec3& d) {
        return degrees_between(c.direction, d) < options.duplicate_angle;
      });
      return duplicate ? 0.33 * c.worth : c.worth;
    }));
  return out;
}

double match_patch(std::span<const MatchView> views, std::span<const int> chosen,
                   const Patch& patch, double noise_sigma, const MatchOptions& options) {
  if (chosen.size() < 2) return kNoScore;
  const Frame f = frame(views[std::size_t(chosen[0])], patch, options);
  const std::vector<dvec3> own = taps(views[std::size_t(chosen[0])], patch, f.u, f.v);
  const double noise = 3 * double(own.size()) * variance_floor(noise_sigma);
  std::vector<double> scores;
  for (const int other : chosen.subspan(1)) {
    const std::vector<dvec3> theirs = taps(views[std::size_t(other)], patch, f.u, f.v);
    scores.push_back(product(own, theirs) /
                     std::sqrt((product(own, own) + noise) * (product(theirs, theirs) + noise)));
  }
  std::sort(scores.begin(), scores.end(), std::greater<>());
  const std::size_t best = std::size_t(std::ceil(options.best_pairs * double(scores.size())));
  double sum = 0;
  for (std::size_t i = 0; i < best; ++i) sum += scores[i];
  return sum / double(best);
}

double texture_of(std::span<const MatchView> views, std::span<const int> chosen, const Patch& patch,
                  double noise_sigma, const MatchOptions& options) {
  if (chosen.size() < 2) return 1;
  const Frame f = frame(views[std::size_t(chosen[0])], patch, options);
  const std::vector<dvec3> own = taps(views[std::size_t(chosen[0])], patch, f.u, f.v);
  const double variance = product(own, own);
  return variance / (variance + 3 * double(own.size()) * noise_sigma * noise_sigma);
}

}  // namespace photohull::refine::reference
