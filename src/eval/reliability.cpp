#include "eval/reliability.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/option_word.h"
#include "eval/error_mesh.h"

namespace photohull::eval {
namespace {

/// Ranks from 1; equal values share the mean of theirs.
std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0, next; first < order.size(); first = next) {
    next = first + 1;
    while (next < order.size() && values[order[next]] == values[order[first]]) ++next;
    for (std::size_t i = first; i < next; ++i) ranks[order[i]] = 0.5 * double(first + next + 1);
  }
  return ranks;
}

std::optional<double> correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double mean = 0.5 * (double(a.size()) + 1);  // of ranks
  double aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    aa += (a[i] - mean) * (a[i] - mean);
    bb += (b[i] - mean) * (b[i] - mean);
    ab += (a[i] - mean) * (b[i] - mean);
  }
  if (!(aa > 0 && bb > 0)) return {};
  return ab / std::sqrt(aa * bb);
}

/// From the ranks of the vertices within, after Mann and Whitney.
std::optional<double> area_under_curve(const std::vector<double>& ranks,
                                       const std::vector<char>& within) {
  double sum = 0, good = 0;
  for (std::size_t i = 0; i < ranks.size(); ++i)
    if (within[i]) sum += ranks[i], good += 1;
  const double bad = double(ranks.size()) - good;
  if (good == 0 || bad == 0) return {};
  return (sum - 0.5 * good * (good + 1)) / (good * bad);
}

void fill_bins(const std::vector<double>& confidence, const std::vector<char>& within,
               Reliability& r) {
  for (int b = 0; b < kReliabilityBins; ++b)
    r.bins.push_back({double(b) / kReliabilityBins, double(b + 1) / kReliabilityBins, 0, 0, 0});
  for (std::size_t i = 0; i < confidence.size(); ++i) {
    const int b =
        std::clamp(int(std::ceil(confidence[i] * kReliabilityBins)) - 1, 0, kReliabilityBins - 1);
    ReliabilityBin& bin = r.bins[std::size_t(b)];
    ++bin.count;
    bin.confidence += confidence[i];
    bin.within += within[i];
  }
  for (ReliabilityBin& bin : r.bins) {
    if (bin.count == 0) continue;
    r.calibration_error += std::abs(bin.confidence - bin.within) / double(confidence.size());
    bin.confidence /= double(bin.count);
    bin.within /= double(bin.count);
  }
}

}  // namespace

Reliability reliability_of(const std::vector<float>& confidence,
                           const std::vector<double>& distances, double distance) {
  PHOTOHULL_CHECK_OP(confidence.size(), ==, distances.size());
  if (!(distance > 0 && std::isfinite(distance)))
    throw UsageError(
        concat(option_word("reliability"), " (world units) must be above 0, not ", distance));
  std::vector<double> seen, errors;
  for (std::size_t i = 0; i < confidence.size(); ++i) {
    if (!(confidence[i] >= 0 && confidence[i] <= 1))
      throw Error(concat("the confidence of vertex ", i, " is ", confidence[i],
                         ": expected a number from 0 to 1"));
    if (confidence[i] == 0) continue;
    seen.push_back(double(confidence[i]));
    errors.push_back(std::abs(distances[i]));
  }
  if (seen.empty())
    throw Error("no vertex of the result has a confidence above 0: there is nothing to judge");
  Reliability r;
  r.distance = distance;
  r.seen = seen.size();
  r.unseen = confidence.size() - seen.size();
  std::vector<char> within(seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    within[i] = errors[i] <= distance;
    r.confidence += seen[i];
    r.within += within[i];
    r.brier += (seen[i] - within[i]) * (seen[i] - within[i]);
  }
  for (double* sum : {&r.confidence, &r.within, &r.brier}) *sum /= double(seen.size());
  fill_bins(seen, within, r);
  const std::vector<double> ranks = ranks_of(seen);
  r.auc = area_under_curve(ranks, within);
  r.spearman = correlation(ranks, ranks_of(errors));
  return r;
}

namespace {

std::vector<double> distances_from(const TriMesh& result, const Truth& truth, Progress& progress) {
  if (!truth.is_points()) return vertex_distances(result, truth.surface(), progress);
  std::vector<double> distance;
  for (std::size_t i = 0; i < result.positions.size(); ++i)
    distance.push_back(truth.distance(result.world(i)));
  return distance;
}

}  // namespace

Reliability measure_reliability(const TriMesh& result, const Truth& truth, double distance,
                                Progress& progress) {
  if (result.confidence.empty())
    throw Error(concat("the result has no confidence to judge: ", option_word("reliability"),
                       " needs a PLY with the vertex property 'confidence', such as the mesh.ply "
                       "of photohull reconstruct"));
  PHOTOHULL_CHECK_OP(result.confidence.size(), ==, result.positions.size());
  return reliability_of(result.confidence, distances_from(result, truth, progress), distance);
}

}  // namespace photohull::eval
