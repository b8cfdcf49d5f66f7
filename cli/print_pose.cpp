#include "print_pose.h"

#include <cstdio>

namespace photohull::cli {

void print_pose(const std::vector<std::string>& names, const PoseResult& result,
                const pose::TurntableFinding& turntable) {
  int posed = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const PosedPhoto& p = result.photos[i];
    posed += p.posed;
    if (!p.posed) std::printf("%-32s left out: %s\n", names[i].c_str(), p.reason.c_str());
  }
  std::printf("%d of %zu photographs have a pose\n", posed, names.size());
  for (const PosedCamera& c : result.cameras)
    std::printf("focal length     %.2f +- %.2f px, %d photographs (%s)\n", c.intrinsics.fx,
                c.focal_sigma, c.photographs, c.name.c_str());
  std::printf("reprojection     %.4f px rms\n", result.rms);
  std::printf("at the object    +- %.4f px\n", result.object_error);
  if (result.bend.found)
    std::printf("the sheet is bent: it rises or falls by %.3g +- %.2g units at its rim\n",
                result.bend.height, result.bend.height_sigma);
  const TurntableMotion& motion = turntable.motion;
  if (turntable.found())
    std::printf(
        "turntable        %d photographs around one axis, %.3g degrees and %.3g units rms; the "
        "background is still\n",
        turntable.photographs(), motion.rms_degrees, motion.rms_length);
  else if (!turntable.stations.empty())
    std::printf("no turntable     the cameras fit one, but %s\n", turntable.reason().c_str());
}

void print_colmap_pose(const pose::PoseJob& job, const pose::ColmapPose& pose) {
  for (std::size_t i = 0; i < job.names.size(); ++i)
    if (!pose.found.photos[i].posed)
      std::printf("%-32s left out: %s\n", job.names[i].c_str(),
                  pose.found.photos[i].reason.c_str());
  std::printf("%zu of %zu photographs have a pose, from %zu points\n",
              pose.found.scene.views.size(), job.names.size(), pose.found.scene.points.size());
  for (const AdjustedLens& lens : pose.lenses)
    std::printf("focal length     %.1f +- %.1f px, principal point %.1f +- %.1f, %.1f +- %.1f px\n",
                lens.intrinsics.fx, lens.focal_sigma, lens.intrinsics.cx, lens.principal_sigma.x,
                lens.intrinsics.cy, lens.principal_sigma.y);
  if (pose.found.models > 1)
    std::printf("COLMAP made %d models that are not connected; the largest is taken\n",
                pose.found.models);
  std::printf("  %s, and COLMAP's model in %s\n", job.out.c_str(), pose.found.model.c_str());
}

}  // namespace photohull::cli
