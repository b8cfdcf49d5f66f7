// Which views disagree with the rest.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>

#include "cameras/diagnose_parts.h"
#include "cameras/triangulate.h"
#include "core/median.h"

namespace photohull::diagnosis {
namespace {

/// The smaller of the two in the middle: of two pairs the one that may be the other view's fault
/// does not count.
double lower_median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + long((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Triples of a track's observations, spread over all that there are.
void add_triples(const Track& track, std::vector<Track>& triples) {
  constexpr std::size_t kMost = 12;
  const auto& o = track.observations;
  const std::size_t n = o.size(), all = n * (n - 1) * (n - 2) / 6;
  const std::size_t step = std::max<std::size_t>(1, all / kMost);
  std::size_t index = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      for (std::size_t k = j + 1; k < n; ++k)
        if (index++ % step == 0) triples.push_back({{o[i], o[j], o[k]}});
}

}  // namespace

double find_disagreeing(const std::vector<Evidence>& evidence, ViewFit::By by,
                        std::vector<ViewFit>& fits) {
  constexpr double kLeast = 1.5, kFactor = 4;  // pixels; times what is usual
  constexpr std::size_t kFewestOfView = 2, kFewestViews = 4;
  const std::size_t n = fits.size();
  std::vector<bool> named(n, false);
  for (;;) {
    std::vector<std::vector<double>> of_view(n);
    for (const Evidence& e : evidence) {
      if (!named[std::size_t(e.b)]) of_view[std::size_t(e.a)].push_back(e.residual);
      if (!named[std::size_t(e.a)]) of_view[std::size_t(e.b)].push_back(e.residual);
    }
    std::vector<double> known;
    for (std::size_t i = 0; i < n; ++i)
      if (!named[i] && of_view[i].size() >= kFewestOfView)
        known.push_back(lower_median(of_view[i]));
    const double usual = median(known);
    std::size_t worst = n;
    for (std::size_t i = 0; i < n; ++i) {
      if (of_view[i].size() < kFewestOfView || (fits[i].count > 0 && fits[i].by != by)) continue;
      fits[i] = {lower_median(of_view[i]), usual, int(of_view[i].size()), by, named[i]};
      if (!named[i] && fits[i].residual > std::max(kLeast, kFactor * usual) &&
          (worst == n || fits[i].residual > fits[worst].residual))
        worst = i;
    }
    if (worst == n || known.size() < kFewestViews) return usual;
    named[worst] = fits[worst].disagrees = true;
  }
}

bool find_inconsistent(const Cameras& cameras, std::vector<Track> tracks,
                       std::vector<ViewFit>& fits) {
  constexpr double kLeast = 0.7, kFactor = 4;  // pixels, times what is usual
  constexpr int kFewest = 8;                   // triples of a view
  constexpr double kMost = 0.75;               // share of them
  for (bool named = false;; named = true) {
    for (Track& track : tracks)
      std::erase_if(track.observations,
                    [&](const Observation& o) { return fits[std::size_t(o.view)].disagrees; });
    std::erase_if(tracks, [](const Track& t) { return t.observations.size() < 3; });
    std::vector<Track> triples;
    for (const Track& track : tracks) add_triples(track, triples);
    std::vector<double> rms(triples.size());
    tbb::parallel_for(std::size_t(0), triples.size(), [&](std::size_t t) {
      const auto point = triangulate(cameras, triples[t]);
      rms[t] = point ? reprojection_rms(cameras, triples[t], *point) : INFINITY;
    });
    const double usual = median(rms), limit = std::max(kLeast, kFactor * usual);
    std::vector<int> all(fits.size(), 0), bad(fits.size(), 0);
    for (std::size_t t = 0; t < triples.size(); ++t)
      for (const Observation& o : triples[t].observations) {
        ++all[std::size_t(o.view)];
        bad[std::size_t(o.view)] += rms[t] > limit;
      }
    std::size_t worst = fits.size();
    for (std::size_t i = 0; i < fits.size(); ++i)
      if (all[i] >= kFewest && bad[i] >= kMost * all[i] &&
          (worst == fits.size() || bad[i] > bad[worst]))
        worst = i;
    if (worst == fits.size()) return named;
    std::vector<double> distances;
    for (const Track& track : tracks) {
      Track rest;
      std::optional<glm::dvec2> here;
      for (const Observation& o : track.observations)
        if (o.view == int(worst))
          here = o.pixel;
        else
          rest.observations.push_back(o);
      if (!here) continue;
      const auto point = triangulate(cameras, rest);
      const auto pixel = point ? cameras[worst].project(*point) : std::nullopt;
      distances.push_back(pixel ? glm::distance(*pixel, *here) : INFINITY);
    }
    fits[worst] = {median(distances), usual, int(distances.size()), ViewFit::By::kTracks, true};
  }
}

std::vector<Evidence> evidence_of(const Cameras& cameras, const std::vector<PairMatches>& matches) {
  std::vector<Evidence> evidence;
  for (const PairMatches& m : matches) {
    std::vector<double> r;
    for (const auto& [p, q] : m.pixels)
      r.push_back(epipolar_residual(cameras, m.view_a, m.view_b, p, q));
    evidence.push_back({m.view_a, m.view_b, median(std::move(r))});
  }
  return evidence;
}

std::vector<Evidence> evidence_of(const Cameras& cameras,
                                  const std::vector<FrontierPair>& tangents) {
  std::vector<Evidence> evidence;
  for (const FrontierPair& t : tangents)
    evidence.push_back(
        {t.view_a, t.view_b, epipolar_residual(cameras, t.view_a, t.view_b, t.pixel_a, t.pixel_b)});
  return evidence;
}

}  // namespace photohull::diagnosis
