// What a diagnosis says.
#include <algorithm>
#include <cstdio>

#include "cameras/diagnose_parts.h"
#include "core/error.h"
#include "core/option_word.h"

namespace photohull {

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

namespace diagnosis {
namespace {

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

std::string percent(double share) { return concat(std::lround(100 * share), " %"); }

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

}  // namespace

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

void describe_views(std::span<const PreparedView> views, CameraDiagnosis& d) {
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
    d.faults.push_back(concat("the principal points are half a pixel too ",
                              fit.best > 0 ? "small" : "large", " in x and y: shifted by ",
                              number(fit.shift, 2), " +- ", number(fit.sigma, 2),
                              " px they fit best; give a ", option_word("pixel_center"),
                              " that is 0.5 ", fit.best > 0 ? "less" : "more"));
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

}  // namespace diagnosis
}  // namespace photohull
