#include "calib/diagnose.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <set>

#include "calib/feature_tracks.h"
#include "calib/free_matches.h"
#include "calib/frontier.h"
#include "calib/triangulate.h"
#include "core/error.h"

namespace photohull {
namespace {

constexpr int kNeighbours = 2;           // views that each one is matched with, by every guess
constexpr std::size_t kMostOfPair = 60;  // matches that count: no pair outweighs the others
constexpr int kFewestMatches = 100;
constexpr int kFewestPairs = 3;

using Cameras = std::vector<Camera>;

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + long(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The smaller of the two in the middle: of two pairs the one that may be the other view's fault
/// does not count.
double lower_median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + long((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string number(double value, int digits) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

/// To three significant digits, for lengths of unknown unit and ratios.
std::string rough(double value) {
  char text[48];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

Cameras cameras_of(std::span<const View> views) {
  Cameras cameras;
  for (const View& view : views) cameras.push_back(view.camera);
  return cameras;
}

Cameras reread(Cameras cameras, const PoseReading& reading) {
  for (Camera& camera : cameras) camera.cam_from_world = reading.pose(camera.cam_from_world);
  return cameras;
}

/// Views that may see the same, whether the poses are inverted or not, or follow one another.
std::vector<std::pair<int, int>> pairs_to_match(const Cameras& cameras) {
  std::set<std::pair<int, int>> pairs;
  const int n = int(cameras.size());
  const auto add = [&](int i, int j) {
    if (i != j) pairs.emplace(std::min(i, j), std::max(i, j));
  };
  for (const bool inverted : {false, true}) {
    const Cameras read = reread(cameras, {.inverted = inverted});
    for (int i = 0; i < n; ++i) {
      std::vector<std::pair<double, int>> others;
      for (int j = 0; j < n; ++j)
        if (j != i) others.emplace_back(-glm::dot(read[i].forward(), read[j].forward()), j);
      std::sort(others.begin(), others.end());
      for (int k = 0; k < std::min(kNeighbours, int(others.size())); ++k) add(i, others[k].second);
    }
  }
  for (int i = 0; i + 1 < n; ++i) add(i, i + 1);
  return {pairs.begin(), pairs.end()};
}

double epipolar_residual(const Cameras& cameras, int a, int b, const glm::dvec2& in_a,
                         const glm::dvec2& in_b) {
  const glm::dvec2 d = epipolar_distances(cameras[a], cameras[b], {a, b, in_a, in_b});
  return std::sqrt(0.5 * glm::dot(d, d));
}

/// Distances of matches from their epipolar lines, in the matches' order; infinite where no point
/// in front of both cameras has such pixels.
std::vector<double> match_residuals(const Cameras& cameras,
                                    const std::vector<PairMatches>& matches) {
  std::vector<std::vector<double>> by_pair(matches.size());
  tbb::parallel_for(std::size_t(0), matches.size(), [&](std::size_t i) {
    const PairMatches& m = matches[i];
    for (std::size_t k = 0; k < std::min(kMostOfPair, m.pixels.size()); ++k) {
      const auto& [p, q] = m.pixels[k];
      const bool in_front = triangulate(cameras, {{{m.view_a, p}, {m.view_b, q}}}).has_value();
      const double r = epipolar_residual(cameras, m.view_a, m.view_b, p, q);
      by_pair[i].push_back(in_front && std::isfinite(r) ? r : INFINITY);
    }
  });
  std::vector<double> all;
  for (const auto& part : by_pair) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// All readings, the best first.
std::vector<PoseReading> try_readings(const Cameras& given,
                                      const std::vector<PairMatches>& matches) {
  constexpr double kLeastTolerance = 0.5, kMostTolerance = 8;  // pixels
  std::vector<PoseReading> readings;
  std::vector<std::vector<double>> residuals;
  double best = INFINITY;
  for (const bool inverted : {false, true})
    for (int flips = 0; flips < 8; ++flips) {
      PoseReading r{inverted, {(flips & 1) != 0, (flips & 2) != 0, (flips & 4) != 0}};
      residuals.push_back(match_residuals(reread(given, r), matches));
      r.residual = median(residuals.back());
      best = std::min(best, r.residual);
      readings.push_back(r);
    }
  const double tolerance = std::clamp(4 * best, kLeastTolerance, kMostTolerance);
  for (std::size_t i = 0; i < readings.size(); ++i)
    readings[i].explained = double(std::count_if(residuals[i].begin(), residuals[i].end(),
                                                 [&](double r) { return r <= tolerance; })) /
                            double(residuals[i].size());
  std::stable_sort(readings.begin(), readings.end(),
                   [](const auto& a, const auto& b) { return a.explained > b.explained; });
  return readings;
}

/// What a pair of views says on how well their cameras fit.
struct Evidence {
  int a, b;
  double residual;
};

/// Names the views whose pairs are worse than the others', the worst first: without its pairs the
/// rest is judged anew. Views that another kind of evidence has judged stay as they are. Returns
/// the residual that is usual.
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

/// Names views by tracks of three views and more, which also see what lies along the epipolar
/// lines: most triples of such a view are inconsistent, and the worst of them is in the most.
/// Returns whether there are any.
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

/// Squared residuals for each shift, of what one view or pair of views observes.
struct ShiftCost {
  int view = 0;
  std::array<double, 3> squares{};
  double least() const { return *std::min_element(squares.begin(), squares.end()); }
};

/// Sums of inliers' costs against their spread, by view.
void add_costs(const std::vector<ShiftCost>& costs, double least_sigma, double to_sigma,
               std::vector<std::array<double, 3>>& by_view, std::array<double, 3>& rms,
               int& count) {
  constexpr double kOutlier = 4;  // spreads
  std::vector<double> lengths;
  for (const ShiftCost& c : costs) lengths.push_back(std::sqrt(c.least()));
  const double sigma = std::max(least_sigma, median(lengths) * to_sigma);
  for (const ShiftCost& c : costs) {
    if (!(c.least() < kOutlier * kOutlier * sigma * sigma)) continue;
    ++count;
    for (int s = 0; s < 3; ++s) {
      by_view[std::size_t(c.view)][s] += c.squares[s] / (sigma * sigma);
      rms[s] += c.squares[s];
    }
  }
  for (double& r : rms) r = count > 0 ? std::sqrt(r / count) : 0;
}

/// Where the parabola through the costs for -0.5, 0 and 0.5 pixels is least; NaN where nowhere.
double least_of(const std::array<double, 3>& cost) {
  const double curvature = 2 * (cost[0] + cost[2] - 2 * cost[1]), slope = cost[2] - cost[0];
  return curvature > 1e-12 ? -slope / (2 * curvature) : NAN;
}

PixelCentreFit fit_pixel_centre(std::span<const View> views, const std::vector<ViewFit>& fits,
                                const std::vector<Track>& tracks,
                                const std::vector<FrontierPair>& tangents) {
  constexpr double kMostSigma = 0.1, kNear = 0.15;  // pixels
  PixelCentreFit fit;
  std::array<Cameras, 3> shifted;
  for (int s = 0; s < 3; ++s) {
    shifted[s] = cameras_of(views);
    for (Camera& camera : shifted[s]) {
      camera.intrinsics.cx += PixelCentreFit::kShifts[s];
      camera.intrinsics.cy += PixelCentreFit::kShifts[s];
    }
  }
  std::vector<ShiftCost> track_costs, tangent_costs;
  for (const Track& track : tracks) {
    ShiftCost cost{track.observations[0].view, {}};
    bool usable = true;
    for (const Observation& o : track.observations)
      usable = usable && !fits[std::size_t(o.view)].disagrees;
    for (int s = 0; usable && s < 3; ++s) {
      const auto point = triangulate(shifted[s], track);
      usable = point.has_value();
      if (usable) cost.squares[s] = std::pow(reprojection_rms(shifted[s], track, *point), 2);
    }
    if (usable) track_costs.push_back(cost);
  }
  for (const FrontierPair& t : tangents) {
    if (fits[std::size_t(t.view_a)].disagrees || fits[std::size_t(t.view_b)].disagrees) continue;
    ShiftCost cost{t.view_a, {}};
    for (int s = 0; s < 3; ++s)
      cost.squares[s] =
          std::pow(epipolar_residual(shifted[s], t.view_a, t.view_b, t.pixel_a, t.pixel_b), 2);
    tangent_costs.push_back(cost);
  }
  std::vector<std::array<double, 3>> by_view(views.size(), std::array<double, 3>{});
  add_costs(track_costs, 0.03, 1 / 1.1774, by_view, fit.tracks, fit.track_count);
  add_costs(tangent_costs, 0.15, 1.4826, by_view, fit.tangents, fit.tangent_count);
  const auto sum_without = [&](std::size_t left_out) {
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < by_view.size(); ++i)
      for (int s = 0; i != left_out && s < 3; ++s) sum[s] += by_view[i][s];
    return sum;
  };
  const double n = double(views.size());
  fit.shift = least_of(sum_without(views.size()));
  double variance = 0;
  for (std::size_t i = 0; i < views.size(); ++i)
    variance += std::pow(least_of(sum_without(i)) - fit.shift, 2);
  fit.sigma = std::sqrt(variance * (n - 1) / n);
  if (!std::isfinite(fit.shift) || !std::isfinite(fit.sigma)) {
    fit.shift = 0;
    fit.sigma = INFINITY;
    return fit;
  }
  for (const double s : PixelCentreFit::kShifts)
    if (std::abs(fit.shift - s) < kNear && fit.sigma < kMostSigma) {
      fit.tells = true;
      fit.best = s;
    }
  return fit;
}

bool on_an_image(const Camera& camera, const Box& box) {
  constexpr int kProbes = 6;  // along each side
  for (int i = 0; i < kProbes * kProbes * kProbes; ++i) {
    const glm::ivec3 at(i % kProbes, i / kProbes % kProbes, i / kProbes / kProbes);
    const auto pixel =
        camera.project(box.min + box.size() * (glm::dvec3(at) / double(kProbes - 1)));
    if (pixel && camera.on_image(*pixel)) return true;
  }
  return false;
}

BoxFit fit_box(const Cameras& cameras, const std::vector<PairMatches>& matches, const Box& box) {
  constexpr double kLargestResidual = 4;  // pixels
  BoxFit fit;
  fit.diagonal = box.diagonal();
  std::vector<double> distances;
  for (const Camera& camera : cameras) {
    fit.seen_by += on_an_image(camera, box);
    fit.cameras_inside += box.contains(camera.center());
    distances.push_back(glm::distance(camera.center(), box.center()));
  }
  fit.distance = median(distances);
  std::vector<glm::dvec3> points;
  for (const PairMatches& m : matches)
    for (std::size_t k = 0; k < std::min(kMostOfPair, m.pixels.size()); ++k) {
      const auto& [p, q] = m.pixels[k];
      if (!(epipolar_residual(cameras, m.view_a, m.view_b, p, q) < kLargestResidual)) continue;
      if (const auto point = triangulate(cameras, {{{m.view_a, p}, {m.view_b, q}}}))
        points.push_back(*point);
    }
  fit.points = int(points.size());
  if (points.empty()) return fit;
  Box around;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const glm::dvec3& p : points) values.push_back(p[axis]);
    std::sort(values.begin(), values.end());
    around.min[axis] = values[values.size() / 20];
    around.max[axis] = values[values.size() - 1 - values.size() / 20];
  }
  fit.points_inside = double(std::count_if(points.begin(), points.end(),
                                           [&](const glm::dvec3& p) { return box.contains(p); })) /
                      double(points.size());
  fit.points_diagonal = around.diagonal();
  distances.clear();
  for (const Camera& camera : cameras)
    distances.push_back(glm::distance(camera.center(), around.center()));
  fit.points_distance = median(distances);
  return fit;
}

std::string percent(double share) { return concat(std::lround(100 * share), " %"); }

void describe_readings(CameraDiagnosis& d) {
  // Chance has some matches near any line, and a true reading misses few.
  constexpr double kExplains = 0.5, kClearly = 0.6;
  const PoseReading& best = d.readings.front();
  d.given = *std::find_if(d.readings.begin(), d.readings.end(),
                          [](const PoseReading& r) { return r.as_given(); });
  d.misread = best.explained >= kExplains && d.given.explained < kClearly * best.explained;
  if (d.misread)
    d.faults.push_back(concat("the poses are misread: as given they explain ",
                              percent(d.given.explained), " of ", d.matches, " feature matches; ",
                              to_string(best), " explains ", percent(best.explained), " (median ",
                              number(best.residual, 2), " px from the epipolar lines)"));
  else if (d.given.explained < kExplains)
    d.faults.push_back(concat("the poses explain only ", percent(d.given.explained), " of ",
                              d.matches,
                              " feature matches, and no other reading of them more than ",
                              percent(best.explained), ": they are wrong in another way"));
}

std::string evidence_text(const ViewFit& fit) {
  switch (fit.by) {
    case ViewFit::By::kMatches:
      return concat("px from the epipolar lines (median over ", fit.count, " pairs of views)");
    case ViewFit::By::kSilhouettes:
      return concat("px between the silhouettes' tangents (median of ", fit.count, ")");
    case ViewFit::By::kTracks:
      return concat("px from where the others put its points (median of ", fit.count, " tracks)");
  }
  return "";
}

void describe_views(std::span<const View> views, CameraDiagnosis& d) {
  int unknown = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewFit& fit = d.views[i];
    unknown += fit.count == 0;
    if (fit.disagrees)
      d.faults.push_back(concat(views[i].name,
                                " disagrees with the other views: ", number(fit.residual, 2), " ",
                                evidence_text(fit), ", the others ", number(fit.others, 2), " px"));
  }
  if (unknown > 0)
    d.notes.push_back(
        concat(unknown, " of ", views.size(), " views share too little with others to be judged"));
}

void describe_pixel_centre(CameraDiagnosis& d) {
  const PixelCentreFit& fit = *d.pixel_centre;
  if (fit.tells && fit.best != 0)
    d.faults.push_back(concat(
        "the principal points are half a pixel too ", fit.best > 0 ? "small" : "large",
        " in x and y: shifted by ", number(fit.shift, 2), " +- ", number(fit.sigma, 2),
        " px they fit best; give a --pixel-center that is 0.5 ", fit.best > 0 ? "less" : "more"));
  else if (!fit.tells && std::isfinite(fit.sigma))
    d.notes.push_back(
        concat("no pixel centre clearly fits: the best shift of the principal points is ",
               number(fit.shift, 2), " +- ", number(fit.sigma, 2), " px, none of -0.5, 0 and 0.5"));
  else if (!fit.tells)
    d.notes.push_back("the pixel centre cannot be told: too few tracks and no silhouettes");
}

void describe_box(std::size_t views, CameraDiagnosis& d) {
  constexpr int kFewestPoints = 50;
  constexpr double kInside = 0.05, kTooLarge = 8, kTooSmall = 1.0 / 50;
  const BoxFit& b = *d.box;
  const bool compare = b.points >= kFewestPoints && b.points_diagonal > 0;
  const double size = compare ? b.diagonal / b.points_diagonal : 1;
  const std::string against =
      compare ? concat("; its diagonal (", rough(b.diagonal), ") is ", rough(size),
                       " times that of the matched points (", rough(b.points_diagonal),
                       "), its distance from the cameras (", rough(b.distance), ") ",
                       rough(b.distance / b.points_distance), " times theirs (",
                       rough(b.points_distance), "): is it in other units?")
              : concat("; its diagonal is ", rough(b.diagonal), ", its distance from the cameras ",
                       rough(b.distance));
  if (b.seen_by == 0)
    d.faults.push_back(concat("no camera has the box on its image", against));
  else if (b.cameras_inside > 0)
    d.faults.push_back(
        concat(b.cameras_inside, " of ", views, " cameras stand inside the box", against));
  else if (compare && (b.points_inside < kInside || size > kTooLarge || size < kTooSmall))
    d.faults.push_back(concat("the box holds ", percent(b.points_inside), " of ", b.points,
                              " matched points", against));
}

}  // namespace

Pose PoseReading::pose(const Pose& given) const {
  Pose pose = given;
  if (inverted) {
    pose.rotation = glm::transpose(given.rotation);
    pose.translation = -(pose.rotation * given.translation);
  }
  glm::dmat3 flip(1.0);
  for (int axis = 0; axis < 3; ++axis)
    if (flipped[std::size_t(axis)]) flip[axis][axis] = -1;
  return {flip * pose.rotation, flip * pose.translation};
}

std::string to_string(const PoseReading& reading) {
  if (reading.as_given()) return "as given";
  std::string text = reading.inverted
                         ? "inverse (camera-to-world was given for world-to-camera or vice versa)"
                         : "";
  std::string axes;
  int count = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (reading.flipped[std::size_t(axis)]) {
      axes += (axes.empty() ? "" : ", ") + std::string(1, "xyz"[axis]);
      ++count;
    }
  if (count > 0)
    text += concat(text.empty() ? "" : ", ", "camera axes ", axes, " flipped",
                   count % 2 == 1 ? " (the world is left-handed)" : "");
  return text;
}

CameraDiagnosis diagnose_cameras(std::span<const View> views, const std::optional<Box>& box,
                                 Progress& progress) {
  CameraDiagnosis d;
  const Cameras cameras = cameras_of(views);
  const std::vector<PairMatches> matches =
      match_without_cameras(views, pairs_to_match(cameras), progress);
  progress.update(0.4);
  d.pairs = int(matches.size());
  for (const PairMatches& m : matches) d.matches += int(std::min(kMostOfPair, m.pixels.size()));
  if (d.matches >= kFewestMatches && d.pairs >= kFewestPairs) {
    d.readings = try_readings(cameras, matches);
    describe_readings(d);
  } else {
    d.notes.push_back(concat("the reading of the poses cannot be checked: only ", d.matches,
                             " feature matches between the photographs"));
  }
  progress.check_cancelled();
  progress.update(0.5);
  if (d.misread) {
    d.notes.push_back("views, pixel centre and box are not judged by misread poses");
    return d;
  }
  std::vector<Outline> outlines;
  for (const View& view : views)
    outlines.push_back(view.mask.empty() ? Outline() : outline_of(view.mask));
  const std::vector<FrontierPair> tangents = frontier_pairs(cameras, outlines);
  d.views.resize(views.size());
  d.usual_residual =
      find_disagreeing(evidence_of(cameras, matches), ViewFit::By::kMatches, d.views);
  find_disagreeing(evidence_of(cameras, tangents), ViewFit::By::kSilhouettes, d.views);
  if (views.size() >= 3) {
    TrackOptions options;
    options.features = 1500;
    const std::vector<Track> tracks = find_tracks(views, options, progress);
    d.pixel_centre = fit_pixel_centre(views, d.views, tracks, tangents);
    // A principal point that is off in all views is no single view's fault.
    Cameras centred = cameras;
    for (Camera& camera : centred) {
      camera.intrinsics.cx += d.pixel_centre->shift;
      camera.intrinsics.cy += d.pixel_centre->shift;
    }
    if (find_inconsistent(centred, tracks, d.views))
      d.pixel_centre = fit_pixel_centre(views, d.views, tracks, tangents);
  }
  describe_views(views, d);
  if (d.pixel_centre) describe_pixel_centre(d);
  if (box) {
    d.box = fit_box(cameras, matches, *box);
    describe_box(views.size(), d);
  }
  progress.update(1);
  return d;
}

}  // namespace photohull
