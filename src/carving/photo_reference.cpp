#include "carving/photo_reference.h"

#include <algorithm>
#include <cmath>

namespace photohull::carving::reference {
namespace {

constexpr double kOutlierShare = 0.5;
constexpr double kOutlierSlack = 0.1;
constexpr int kPeakLayers = 2;

glm::dvec3 mean_of(PatchColours patch) {
  glm::dvec3 sum(0);
  for (const glm::dvec3& colour : patch) sum += colour;
  return sum / double(patch.size());
}

/// Over the taps and summed over the channels; of a patch with itself it is the variance.
double covariance(PatchColours a, PatchColours b) {
  const glm::dvec3 mean_a = mean_of(a), mean_b = mean_of(b);
  double sum = 0;
  for (std::size_t tap = 0; tap < a.size(); ++tap)
    sum += glm::dot(a[tap] - mean_a, b[tap] - mean_b);
  return sum / double(a.size());
}

double correlation(PatchColours a, PatchColours b, double noise_variance) {
  const double floor = 3 * noise_variance;  // three channels
  return covariance(a, b) / std::sqrt((covariance(a, a) + floor) * (covariance(b, b) + floor));
}

}  // namespace

Consistency photo_consistency(std::span<const Patch> patches, double noise_variance) {
  const std::vector<PatchColours> colours(patches.begin(), patches.end());
  return photo_consistency(colours, noise_variance);
}

Consistency photo_consistency(std::span<const PatchColours> patches, double noise_variance) {
  const std::size_t n = patches.size();
  Consistency out;
  out.seen = int(n);
  if (n == 0) return out;
  for (const PatchColours& patch : patches) out.texture += covariance(patch, patch) / 3 / double(n);

  std::vector<double> agreement(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      if (i != j) agreement[i] += correlation(patches[i], patches[j], noise_variance);
  const double best = *std::max_element(agreement.begin(), agreement.end());
  const double least = best - std::max((1 - kOutlierShare) * best, kOutlierSlack);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < n; ++i) {
    if (agreement[i] >= least) kept.push_back(i);
    out.outlier_margin = std::min(out.outlier_margin, std::abs(agreement[i] - least));
  }
  out.used = int(kept.size());
  if (kept.size() < 2) return out;

  double sum = 0;
  int pairs = 0;
  for (std::size_t i = 0; i < kept.size(); ++i)
    for (std::size_t j = i + 1; j < kept.size(); ++j, ++pairs)
      sum += correlation(patches[kept[i]], patches[kept[j]], noise_variance);
  out.score = sum / pairs;
  return out;
}

namespace {

/// The patch without its mean, at unit norm but for the noise; empty when it does not count.
std::vector<glm::dvec3> normalised(const ShownPatch& patch, double noise_variance, bool coverage) {
  std::vector<glm::dvec3> shown;
  for (const glm::dvec4& tap : patch) {
    if (tap.a < 0) return {};
    if (!coverage || tap.a > 0) shown.emplace_back(tap);
  }
  if (int(shown.size()) < (kPatchTaps + 1) / 2) return {};
  if (coverage && !(patch[kPatchTaps / 2].a > 0)) return {};
  const glm::dvec3 mean = mean_of(shown);
  const double count = double(shown.size());
  const double norm = std::sqrt(count * (covariance(shown, shown) + 3 * noise_variance));
  std::vector<glm::dvec3> out;
  for (const glm::dvec4& tap : patch)
    out.push_back(!coverage || tap.a > 0 ? (glm::dvec3(tap) - mean) / norm : glm::dvec3(0));
  return out;
}

}  // namespace

SearchedShifts choose_shifts(const std::vector<std::vector<ShownPatch>>& views,
                             double noise_variance, bool coverage) {
  std::vector<std::vector<std::vector<glm::dvec3>>> patches(views.size());
  SearchedShifts out;
  for (std::size_t v = 0; v < views.size(); ++v) {
    int first = -1;
    for (std::size_t shift = 0; shift < views[v].size(); ++shift) {
      patches[v].push_back(normalised(views[v][shift], noise_variance, coverage));
      if (first < 0 && !patches[v].back().empty()) first = int(shift);
    }
    out.shifts.push_back(first);
  }
  const auto correlation = [&](std::size_t v, int shift) {
    double sum = 0;
    for (std::size_t other = 0; other < views.size(); ++other)
      for (int tap = 0; tap < kPatchTaps && other != v && out.shifts[other] >= 0; ++tap)
        sum += glm::dot(patches[v][shift][tap], patches[other][out.shifts[other]][tap]);
    return sum;
  };
  for (int round = 0; round < shaders::kSearchRounds; ++round)
    for (std::size_t v = 0; v < views.size(); ++v) {
      if (out.shifts[v] < 0) continue;
      std::vector<std::pair<double, int>> ranked;
      for (int shift = 0; shift < int(views[v].size()); ++shift)
        if (!patches[v][shift].empty()) ranked.emplace_back(-correlation(v, shift), shift);
      std::sort(ranked.begin(), ranked.end());
      out.shifts[v] = ranked[0].second;
      if (ranked.size() > 1) out.margin = std::min(out.margin, ranked[1].first - ranked[0].first);
    }
  return out;
}

glm::ivec3 SweepFrame::voxel(const glm::ivec2& column, int layer) const {
  glm::ivec3 out;
  out[u()] = column.x;
  out[v()] = column.y;
  out[axis] = sign > 0 ? layer : voxels[axis] - 1 - layer;
  return out;
}

SelectedColumns select(const BitVolume& bits, const SweepFrame& frame, int layer,
                       const glm::ivec2& origin, std::span<const std::uint8_t> on_path) {
  SelectedColumns out;
  for (int dv = 0; dv < kBrickEdge; ++dv)
    for (int du = 0; du < kBrickEdge; ++du) {
      const glm::ivec2 column = origin + glm::ivec2(du, dv);
      const glm::ivec3 voxel = frame.voxel(column, layer);
      const bool stands = bits.standing(voxel);
      const bool bare = stands && !bits.standing(frame.voxel(column, layer - 1));
      if (bare || on_path[std::size_t(column.y) * frame.voxels[frame.u()] + column.x]) {
        out.judged.push_back(column);
        continue;
      }
      bool exposed = false;
      for (int face = 0; face < 6; ++face) {
        glm::ivec3 neighbour = voxel;
        neighbour[face / 2] += face % 2 ? 1 : -1;
        exposed = exposed || !bits.standing(neighbour);
      }
      if (stands && exposed) out.occluders.push_back(voxel);
    }
  return out;
}

bool ColumnJudge::can_tell(int layer) const {
  const Consistency& c = scores_[layer];
  return c.seen >= rules_.min_views && c.texture >= rules_.min_texture;
}

double ColumnJudge::value(int layer) const { return can_tell(layer) ? scores_[layer].score : -2; }

int ColumnJudge::path_end(int bare) const {
  int end = bare + 1;
  while (end < layers() && standing_[end] && end <= bare + rules_.max_path) ++end;
  return end;
}

int ColumnJudge::explanation(int bare) const {
  const int end = path_end(bare);
  int best = bare;
  for (int layer = bare; layer < end; ++layer) {
    if (value(layer) <= value(best) && layer != bare) continue;
    best = layer;
    // A peak: good, and not exceeded by the layers right behind it.
    bool exceeded = false;
    for (int behind = layer + 1; behind <= layer + kPeakLayers && behind < end; ++behind)
      exceeded = exceeded || value(behind) > value(layer);
    const bool seen_to_be_one = layer + kPeakLayers < layers() || end < layers();
    if (value(layer) >= rules_.keep_score && !exceeded) return seen_to_be_one ? layer : -1;
  }
  return end < layers() ? best : -1;
}

std::vector<Decision> ColumnJudge::decisions(const glm::ivec2& column) const {
  std::vector<Decision> out;
  for (int layer = 0; layer < layers(); ++layer) {
    if (!standing_[layer] || (layer > 0 && standing_[layer - 1])) continue;
    const double score = scores_[layer].score;
    Decision d{column, layer, layer, float(score), float(score)};
    if (!can_tell(layer)) {
      d.outcome = Outcome::kUnseen;
    } else if (score >= rules_.keep_score) {
      d.outcome = Outcome::kKept;
    } else {
      const int surface = explanation(layer);
      if (surface < 0) break;
      const double best = scores_[surface].score;
      const bool better = best >= rules_.keep_score && best >= score + rules_.better_by;
      d.best_score = float(best);
      d.outcome = better ? Outcome::kBetter : Outcome::kUndecided;
      if (better) d.surface = surface;
    }
    out.push_back(d);
  }
  return out;
}

}  // namespace photohull::carving::reference
