#include "pipeline/estimate.h"

namespace photohull::pipeline {
namespace {

// Fitted on the runs of docs/guide/limits.md by `bench/estimates.py --fit`. Bytes:
constexpr double kBaseBytes = 305e6;  // libraries, the driver's compiler, batches of rays
constexpr double kPixelBytes = 8;     // colour and coverage; around the box outlines and mip chain
constexpr double kFaceBytes = 377;    // a face of the box, in voxels: bricks, mesh and files
constexpr double kUnmaskedFaceBytes = 330, kUnmaskedSweepFaceBytes = 1200;

// CPU seconds:
constexpr double kBaseSeconds = 3.2;
constexpr double kPixelSeconds = 1e-8;      // of the files: decoding
constexpr double kMadePixelSeconds = 2e-6;  // masks from the background, cameras checked by them
constexpr double kUnmaskedPixelSeconds = 1.4e-6;  // rays that search the box, some pixels apart
constexpr double kHullFaceSeconds = 2e-6;
constexpr double kRefineFaceSeconds = 30e-6, kUnmaskedRefineFaceSeconds = 35e-6;
constexpr double kSweepFaceSeconds = 71e-6, kUnmaskedSweepFaceSeconds = 270e-6;

double pixels(const std::vector<Intrinsics>& pictures) {
  double sum = 0;
  for (const Intrinsics& k : pictures) sum += double(k.width) * k.height;
  return sum;
}

double bytes_a_face(const CostQuestion& q) {
  if (q.masks != Silhouettes::kNone || q.method == Method::kHull) return kFaceBytes;
  return q.method == Method::kRefine ? kUnmaskedFaceBytes : kUnmaskedSweepFaceBytes;
}

double seconds_a_face(const CostQuestion& q) {
  const bool open = q.masks == Silhouettes::kNone;
  switch (q.method) {
    case Method::kHull:
      return kHullFaceSeconds;
    case Method::kRefine:
      return open ? kUnmaskedRefineFaceSeconds : kRefineFaceSeconds;
    case Method::kVoxelColoring:
    case Method::kSpaceCarving:
      break;
  }
  return open ? kUnmaskedSweepFaceSeconds : kSweepFaceSeconds;
}

}  // namespace

Cost estimate_cost(const CostQuestion& q) {
  std::vector<Intrinsics> read;
  for (const Camera& camera : q.cameras) read.push_back(camera.intrinsics);
  const double read_pixels = pixels(read);
  double bytes = kBaseBytes + kPixelBytes * read_pixels;
  Cost cost;
  cost.cpu_seconds = kBaseSeconds + kPixelSeconds * pixels(q.files);
  if (q.masks == Silhouettes::kMade) cost.cpu_seconds += kMadePixelSeconds * read_pixels;
  if (q.masks == Silhouettes::kNone && q.method == Method::kRefine)
    cost.cpu_seconds += kUnmaskedPixelSeconds * read_pixels;
  if (q.grid) {
    const glm::dvec3 n(q.grid->voxels());
    const double faces = 2 * (n.x * n.y + n.y * n.z + n.z * n.x);
    bytes += bytes_a_face(q) * faces;
    cost.cpu_seconds += seconds_a_face(q) * faces;
  }
  cost.bytes = std::int64_t(bytes);
  return cost;
}

}  // namespace photohull::pipeline
