#include "eval/error_mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/image.h"
#include "io/mesh/write_mesh.h"

namespace photohull::eval {

glm::dvec3 error_colour(double distance, double range) {
  // ColorBrewer's RdBu with a white middle.
  static const glm::dvec3 kStops[] = {
      {33, 102, 172}, {103, 169, 207}, {250, 250, 250}, {239, 138, 98}, {178, 24, 43}};
  PHOTOHULL_CHECK(range > 0);
  const double at = 2 + 2 * std::clamp(distance / range, -1.0, 1.0);
  const int stop = std::min(int(at), 3);
  return glm::mix(kStops[stop], kStops[stop + 1], at - stop);
}

std::vector<double> vertex_distances(const TriMesh& result, const SignedDistance& truth,
                                     Progress& progress) {
  constexpr std::size_t kBlock = 16384;
  std::vector<double> distance(result.positions.size());
  for (std::size_t begin = 0; begin < distance.size(); begin += kBlock) {
    progress.check_cancelled();
    progress.update(double(begin) / double(distance.size()));
    tbb::parallel_for(begin, std::min(distance.size(), begin + kBlock),
                      [&](std::size_t i) { distance[i] = truth.at(result.world(i)).distance; });
  }
  return distance;
}

void write_error_mesh(AtomicFile& file, const TriMesh& result, const SignedDistance& truth,
                      double range, Progress& progress) {
  TriMesh mesh = result;
  mesh.confidence.clear();
  mesh.colours.clear();
  std::vector<double> distance = vertex_distances(result, truth, progress);
  for (const double d : distance) {
    const glm::dvec3 code = error_colour(d, range) / 255.0;
    mesh.colours.emplace_back(linear_from_srgb(code.r), linear_from_srgb(code.g),
                              linear_from_srgb(code.b));
  }
  write_ply(file, mesh, {{"distance", std::move(distance)}});
}

}  // namespace photohull::eval
