#include "pipeline/estimate.h"

#include <algorithm>

#include "pipeline/methods/method.h"

namespace photohull::pipeline {
namespace {

// Fitted on the runs of docs/guide/limits.md by `python3 -m bench estimates --fit`; what faces cost
// stands in the methods' entries. Bytes:
constexpr double kBaseBytes = 285e6;        // libraries, the driver's compiler, batches of rays
constexpr double kPixelBytes = 6.7;         // without silhouettes: colour, twice, and its mip chain
constexpr double kMaskedPixelBytes = 14.8;  // with: coverage and distances as well
// Of a part: photographs until they are cut; then those that are cut with depths beside the part,
// and bricks that hold its surface. Without silhouettes a pixel takes as much less as of a whole.
constexpr double kUncutPixelBytes = 5, kMaskedUncutPixelBytes = 9;
constexpr double kPartPixelBytes = 21, kMaskedPartPixelBytes = 29, kPartBrickBytes = 22.6e3;
constexpr double kHullAreaBytes = 525;  // bricks, mesh and files of a voxel's square
constexpr double kUsualHull = 0.29;     // area of the hull, of that of the box
// While a texture is made:
constexpr double kTexturePixelBytes = 4, kMapPixelBytes = 5, kTextureFaceBytes = 300;
constexpr double kTexelsOfPixel = 1.6;  // for each pixel on the box's faces, gaps included
constexpr double kChartTexelBytes = 148, kPageTexelBytes = 14;

// CPU seconds:
constexpr double kBaseSeconds = 1.9;
constexpr double kPixelSeconds = 1e-8;        // of the files: decoding
constexpr double kMadePixelSeconds = 4.9e-7;  // masks from the background, cameras checked by them

double pixels(const std::vector<Intrinsics>& pictures) {
  double sum = 0;
  for (const Intrinsics& k : pictures) sum += double(k.width) * k.height;
  return sum;
}

/// While a texture is made, of `faces` voxels: what is left of the job, maps of the photographs,
/// charts and a page (texture/texture_mesh.h).
double bytes_with_texture(const CostQuestion& q, double read_pixels, double faces) {
  const double third = double(q.texture_bytes) / 3;
  const double across = q.pixel > 0 ? q.grid->voxel_size / q.pixel : 1;
  const double texels = kTexelsOfPixel * faces * across * across;
  return kBaseBytes + kTexturePixelBytes * read_pixels + kTextureFaceBytes * faces +
         std::min(third, kMapPixelBytes * read_pixels) +
         std::min(third, kChartTexelBytes * texels) + std::min(third, kPageTexelBytes * texels);
}

/// While photographs are read, and then; without voxels, while they are read alone.
double bytes_of_part(const CostQuestion& q, double cut_pixels) {
  const bool open = q.masks == Silhouettes::kNone;
  const double reading =
      kBaseBytes + (open ? kUncutPixelBytes : kMaskedUncutPixelBytes) * q.part->pixels;
  const double cut = kBaseBytes + (open ? kPartPixelBytes : kMaskedPartPixelBytes) * cut_pixels +
                     kPartBrickBytes * q.part->bricks;
  return q.grid ? std::max(reading, cut) : reading;
}

}  // namespace

Cost estimate_cost(const CostQuestion& q) {
  std::vector<Intrinsics> read;
  for (const Camera& camera : q.cameras) read.push_back(camera.intrinsics);
  const double read_pixels = pixels(read);
  const bool open = q.masks == Silhouettes::kNone;
  double bytes = kBaseBytes + (open ? kPixelBytes : kMaskedPixelBytes) * read_pixels;
  if (q.part) bytes = bytes_of_part(q, read_pixels);
  Cost cost;
  cost.cpu_seconds = kBaseSeconds + kPixelSeconds * pixels(q.files);
  if (q.masks == Silhouettes::kMade) cost.cpu_seconds += kMadePixelSeconds * read_pixels;
  const MethodCost& method = method_of(q.method).cost;
  if (open) cost.cpu_seconds += method.unmasked_pixel_seconds * read_pixels;
  if (q.grid) {
    const glm::dvec3 n(q.grid->voxels());
    const double faces = 2 * (n.x * n.y + n.y * n.z + n.z * n.x);
    const double area = q.hull_area.value_or(kUsualHull * faces);
    if (!q.part) bytes += open ? method.unmasked_face_bytes * faces : kHullAreaBytes * area;
    if (q.texture_bytes > 0)
      bytes = std::max(bytes, bytes_with_texture(q, read_pixels, open ? faces : area / kUsualHull));
    cost.cpu_seconds += (open ? method.unmasked_face_seconds : method.face_seconds) * faces;
  }
  cost.bytes = std::int64_t(bytes);
  return cost;
}

}  // namespace photohull::pipeline
