#include "pipeline/estimate.h"

namespace photohull::pipeline {
namespace {

// Fitted on the runs of docs/limits.md. Bytes:
constexpr double kBaseBytes = 285e6;  // libraries, the driver's compiler, batches of rays
constexpr double kPixelBytes = 11;    // colour and coverage; around the box outlines and mip chain
constexpr double kFaceBytes = 490;    // a face of the box, in voxels: bricks, mesh and files
constexpr double kUnmaskedSweepFaceBytes = 1200;
// Without silhouettes refinement begins with all of the box: its bricks are stored.
constexpr double kUnmaskedFaceBytes = 75, kUnmaskedVoxelBytes = 15;

// CPU seconds:
constexpr double kBaseSeconds = 1.5;
constexpr double kPixelSeconds = 1e-8;        // of the files: decoding
constexpr double kMadePixelSeconds = 1.1e-6;  // masks from the background, cameras checked by them
constexpr double kHullFaceSeconds = 2e-6;
constexpr double kRefineFaceSeconds = 30e-6, kDoubtfulRefineFaceSeconds = 60e-6;
constexpr double kSweepFaceSeconds = 80e-6, kUnmaskedSweepFaceSeconds = 260e-6;

double pixels(const std::vector<Intrinsics>& pictures) {
  double sum = 0;
  for (const Intrinsics& k : pictures) sum += double(k.width) * k.height;
  return sum;
}

double bytes_of_grid(const CostQuestion& q, double faces, double voxels) {
  if (q.masks != Silhouettes::kNone || q.method == Method::kHull) return kFaceBytes * faces;
  if (q.method == Method::kRefine) return kUnmaskedFaceBytes * faces + kUnmaskedVoxelBytes * voxels;
  return kUnmaskedSweepFaceBytes * faces;
}

double seconds_a_face(const CostQuestion& q) {
  switch (q.method) {
    case Method::kHull:
      return kHullFaceSeconds;
    case Method::kRefine:
      return q.masks == Silhouettes::kGiven ? kRefineFaceSeconds : kDoubtfulRefineFaceSeconds;
    case Method::kVoxelColoring:
    case Method::kSpaceCarving:
      break;
  }
  return q.masks == Silhouettes::kNone ? kUnmaskedSweepFaceSeconds : kSweepFaceSeconds;
}

}  // namespace

Cost estimate_cost(const CostQuestion& q) {
  std::vector<Intrinsics> read;
  for (const Camera& camera : q.cameras) read.push_back(camera.intrinsics);
  double bytes = kBaseBytes + kPixelBytes * pixels(read);
  Cost cost;
  cost.cpu_seconds = kBaseSeconds + kPixelSeconds * pixels(q.files);
  if (q.masks == Silhouettes::kMade) cost.cpu_seconds += kMadePixelSeconds * pixels(read);
  if (q.grid) {
    const glm::dvec3 n(q.grid->voxels());
    const double faces = 2 * (n.x * n.y + n.y * n.z + n.z * n.x);
    bytes += bytes_of_grid(q, faces, n.x * n.y * n.z);
    cost.cpu_seconds += seconds_a_face(q) * faces;
  }
  cost.bytes = std::int64_t(bytes);
  return cost;
}

}  // namespace photohull::pipeline
