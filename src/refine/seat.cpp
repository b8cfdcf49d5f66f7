#include "refine/seat.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "refine/contacts.h"
#include "refine/displacement.h"

namespace photohull::refine {
namespace {

constexpr int kRounds = 10;  // of averaging with the neighbours: three or four voxels around
// Of a vertex where neither photographs nor silhouettes tell anything, and of the differences
// between neighbours: contacts are to be met, not smoothed. With membranes of 2, 0.1 and 0.02, F at
// 0.1 % of the synthetic plaster at 192 voxels is 86.6, 87.4 and 87.9 (hull 87.9).
constexpr float kHold = 0.001f;
constexpr double kMembrane = 0.02, kFairing = 0.004;
constexpr int kIterations = 8;
constexpr double kUnsure = 0.1;  // voxels: standard deviation of a contact at its ray
constexpr double kLeastTight = 1e-3;

/// Unit normals of the faces around each vertex, weighted by area.
std::vector<glm::vec3> face_normals(const TriMesh& mesh, std::span<const glm::vec3> positions) {
  std::vector<glm::vec3> out(positions.size(), glm::vec3(0));
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::vec3 n = glm::cross(positions[b] - positions[a], positions[c] - positions[a]);
    out[a] += n, out[b] += n, out[c] += n;
  }
  for (glm::vec3& n : out) n /= std::max(glm::length(n), 1e-12f);
  return out;
}

/// What contacts ask of the vertices, as offsets from where they are.
std::vector<Peak> asked(const SparseVolume& hull, std::span<const Contact> contacts,
                        std::span<const glm::vec3> positions, std::span<const float> tight,
                        const SeatOptions& options) {
  std::vector<Peak> out(positions.size());  // offset: the weighted sum
  for (const Contact& c : contacts) {
    const glm::vec3 at = (1 - c.along) * positions[c.a] + c.along * positions[c.b];
    // The ray touches the hull here, or other silhouettes keep the object from it.
    if (c.lack > -hull.interpolated(glm::dvec3(at)) + options.margin) continue;
    const double chance = (1 - c.along) * tight[c.a] + c.along * tight[c.b];
    const double odds = (1 - chance) / std::max(chance, kLeastTight);  // that it is elsewhere
    const double behind = double(c.lack) - double(c.least);
    const double outline = kUnsure * kUnsure;
    const auto weight =
        float(outline / (outline + double(c.unsure) * double(c.unsure) + odds * behind * behind));
    for (const auto& [vertex, share] : {std::pair(c.a, 1 - c.along), std::pair(c.b, c.along)}) {
      out[vertex].offset += weight * share * c.lack;
      out[vertex].weight += weight * share;
    }
  }
  return out;
}

}  // namespace

std::vector<float> information_around(const VertexGraph& graph, std::span<const float> weights) {
  // The mean of the roots, squared: 4 at one surfel in ten and nothing at the others is 0.04.
  std::vector<float> mean, next(weights.size());
  for (const float weight : weights) mean.push_back(std::sqrt(std::max(weight, 0.0f)));
  for (int round = 0; round < kRounds; ++round) {
    tbb::parallel_for(std::size_t(0), mean.size(), [&](std::size_t i) {
      float sum = mean[i];
      for (const std::uint32_t j : graph.of(i)) sum += mean[j];
      next[i] = sum / float(1 + graph.of(i).size());
    });
    mean.swap(next);
  }
  for (float& root : mean) root *= root;
  return mean;
}

void seat_outlines(const SparseVolume& hull, const SilhouetteCones& cones,
                   const MeshSurfels& surfels, const SeatBeliefs& beliefs,
                   const SeatOptions& options, std::vector<float>& moves) {
  if (options.passes == 0) return;
  const TriMesh& mesh = surfels.mesh;
  const std::span<const glm::vec3> positions = surfels.positions;
  const std::size_t n = positions.size();
  const std::vector<float> photographs = moves, fair(n, 1);
  RegularizeOptions smooth;
  smooth.membrane = kMembrane, smooth.fairing = kFairing;
  smooth.reweightings = 1, smooth.iterations = kIterations;
  for (int pass = 0; pass < options.passes; ++pass) {
    std::vector<glm::vec3> moved(positions.begin(), positions.end());
    for (std::size_t i = 0; i < n; ++i) moved[i] += moves[i] * mesh.normals[i];
    const std::vector<glm::vec3> normals = face_normals(mesh, moved);
    std::vector<Peak> peaks =
        asked(hull, find_contacts(hull.grid, mesh, moved, normals, cones, options.reach), moved,
              beliefs.tight, options);
    for (std::size_t i = 0; i < n; ++i) {
      const float own = beliefs.information[i] + kHold;
      peaks[i].offset =
          (peaks[i].offset + own * (photographs[i] - moves[i])) / (peaks[i].weight + own);
      peaks[i].weight += own;
    }
    const std::vector<float> more = regularize(surfels.graph, peaks, moved, normals, fair, smooth);
    for (std::size_t i = 0; i < n; ++i) moves[i] += more[i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double under = -hull.interpolated(glm::dvec3(positions[i])) - moves[i];
    const double known = kUnsure / std::sqrt(double(beliefs.information[i]) + kHold);
    if (under < std::min(options.margin * double(beliefs.tight[i]), known))
      moves[i] += float(options.margin);
  }
}

}  // namespace photohull::refine
