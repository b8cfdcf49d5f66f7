// Private to module cameras: the questions that diagnose_cameras asks, each on its own.
#pragma once

#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "cameras/diagnose.h"
#include "cameras/feature_tracks.h"
#include "cameras/free_matches.h"
#include "cameras/frontier.h"

namespace photohull::diagnosis {

using Cameras = std::vector<Camera>;

inline constexpr std::size_t kMostOfPair = 60;  // matches that count: no pair outweighs the others

/// Root mean square, over both images, of the distances from the epipolar lines, pixels.
inline double epipolar_residual(const Cameras& cameras, int a, int b, const glm::dvec2& in_a,
                                const glm::dvec2& in_b) {
  const glm::dvec2 d = epipolar_distances(cameras[a], cameras[b], {a, b, in_a, in_b});
  return std::sqrt(0.5 * glm::dot(d, d));
}

/// Views that may see the same, whether the poses are inverted or not, or follow one another.
std::vector<std::pair<int, int>> pairs_to_match(const Cameras& cameras);

/// All readings of the poses, the best first.
std::vector<PoseReading> try_readings(const Cameras& given,
                                      const std::vector<PairMatches>& matches);

/// What a pair of views says on how well their cameras fit.
struct Evidence {
  int a, b;
  double residual;  ///< pixels
};

std::vector<Evidence> evidence_of(const Cameras& cameras, const std::vector<PairMatches>& matches);
std::vector<Evidence> evidence_of(const Cameras& cameras,
                                  const std::vector<FrontierPair>& tangents);

/// Names the views whose pairs are worse than the others', the worst first: without its pairs the
/// rest is judged anew. Views that another kind of evidence has judged stay as they are. Returns
/// the residual that is usual.
double find_disagreeing(const std::vector<Evidence>& evidence, ViewFit::By by,
                        std::vector<ViewFit>& fits);

/// Names views by tracks of three views and more, which also see what lies along the epipolar
/// lines: most triples of such a view are inconsistent, and the worst of them is in the most.
/// Returns whether there are any.
bool find_inconsistent(const Cameras& cameras, std::vector<Track> tracks,
                       std::vector<ViewFit>& fits);

/// Views that disagree (`fits`) do not count.
PixelCentreFit fit_pixel_centre(const Cameras& cameras, const std::vector<ViewFit>& fits,
                                const std::vector<Track>& tracks,
                                const std::vector<FrontierPair>& tangents);

BoxFit fit_box(const Cameras& cameras, const std::vector<PairMatches>& matches, const Box& box);

// Faults and notes in words.
void describe_readings(CameraDiagnosis& d);
void describe_views(std::span<const PreparedView> views, CameraDiagnosis& d);
void describe_pixel_centre(CameraDiagnosis& d);
void describe_box(std::size_t views, CameraDiagnosis& d);

}  // namespace photohull::diagnosis
