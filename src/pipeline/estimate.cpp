#include "pipeline/estimate.h"

#include <algorithm>
#include <cmath>

#include "calib/crop.h"

namespace photohull::pipeline {
namespace {

constexpr double kBase = 200e6;       // libraries, the driver's compiler
constexpr double kDecodedBytes = 5;   // a pixel: RGBA and coverage
constexpr double kCroppedBytes = 4;   // a pixel of what the box needs: distances to outlines
constexpr double kUploadedBytes = 7;  // a pixel with its mip chain on the device

}  // namespace

Cost estimate_cost(const CostQuestion& q) {
  Cost cost;
  double decoded = 0;
  for (const Camera& camera : q.cameras)
    decoded += double(camera.intrinsics.width) * camera.intrinsics.height;
  cost.bytes = std::int64_t(kBase + decoded * (kDecodedBytes + kCroppedBytes + kUploadedBytes));
  if (q.grid) {
    const glm::dvec3 n(q.grid->voxels());
    cost.bytes += std::int64_t(600 * 2 * (n.x * n.y + n.y * n.z + n.z * n.x));
  }
  return cost;
}

}  // namespace photohull::pipeline
