#include "pipeline/photometric_stage.h"

#include <algorithm>
#include <utility>

#include "carving/fit_grid.h"
#include "pipeline/photometric.h"
#include "volume/extract_mesh.h"

namespace photohull::pipeline {
namespace {

// Voxels along the box: of the hull that gains are measured on, and of that on which is seen
// whether they differ.
constexpr int kPhotometricVoxels = 160, kCheckVoxels = 64;

struct CoarseHull {
  TriMesh mesh;
  double voxel_size = 0;
};

CoarseHull coarse_hull(int voxels, Hull& hull, const Subject& subject) {
  const double coarse = carving::voxel_size_for(subject.box, voxels);
  const GridSpec grid = carving::fit_grid(subject.box, std::max(coarse, subject.grid.voxel_size));
  return {extract_mesh(hull.carve(grid)), grid.voxel_size};
}

/// A quick look before gains are solved for.
std::optional<MeasuredGains> are_alike(const PhotometricJob& job, const TriMesh& mesh,
                                       double voxel_size, const std::vector<PreparedView>& views) {
  if (job.options.photometric != Photometric::kAuto) return std::nullopt;
  const auto found = find_alike(mesh, voxel_size, job.noise_sigma, views, job.progress);
  if (!found) return std::nullopt;
  return MeasuredGains{{found->json, found->line}, std::nullopt};
}

MeasuredGains measure(const PhotometricJob& job, const TriMesh& mesh, double voxel_size,
                      const std::vector<PreparedView>& views) {
  PhotometricOutcome found = measure_photometric(job.options.photometric, mesh, voxel_size,
                                                 job.noise_sigma, views, job.progress);
  if (!found.warning.empty()) job.progress.warn(found.warning);
  MeasuredGains out{{found.json, found.line}, std::nullopt};
  if (found.used) out.gains = std::move(found.calibration);
  return out;
}

}  // namespace

bool gains_are_known(const PhotometricJob& job) {
  return job.rig && job.options.photometric == Photometric::kAuto;
}

MeasuredGains measure_gains_on_hull(const PhotometricJob& job, Hull& hull, const Subject& subject) {
  if (gains_are_known(job)) return gains_of(*job.rig, subject.views);
  if (job.options.photometric == Photometric::kAuto) {
    const CoarseHull quick = coarse_hull(kCheckVoxels, hull, subject);
    if (auto alike = are_alike(job, quick.mesh, quick.voxel_size, subject.views)) return *alike;
  }
  const CoarseHull fine = coarse_hull(kPhotometricVoxels, hull, subject);
  return measure(job, fine.mesh, fine.voxel_size, subject.views);
}

MeasuredGains measure_gains_on(const PhotometricJob& job, const TriMesh& mesh, double voxel_size,
                               const std::vector<PreparedView>& views) {
  if (auto alike = are_alike(job, mesh, voxel_size, views)) return *alike;
  return measure(job, mesh, voxel_size, views);
}

}  // namespace photohull::pipeline
