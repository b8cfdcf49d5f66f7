#include "print_passes.h"

#include <cstdio>

#include "print_pose.h"

namespace photohull::cli {

void print_passes(const pose::PoseJob& job, const pose::PassesPose& found) {
  const std::vector<pose::PosedPass>& passes = found.passes;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const pose::PosedPass& pass = passes[i];
    std::printf("pass %zu\n", i + 1);
    print_pose(pass.job.names, pass.pose.result, pass.pose.turntable);
    if (i == 0) continue;
    const pose::AxisTurn turn = pose::axis_turn(pass.joined.motion.rotation);
    std::printf(
        "the object      lay turned by %.3f +- %.3f degrees about (%.3f, %.3f, %.3f), moved by "
        "+- %.3g units; %d features\n",
        turn.degrees, pass.joined.turn_sigma, turn.axis.x, turn.axis.y, turn.axis.z,
        pass.joined.move_sigma, pass.joined.tracks);
    std::printf("seam             %.3f px, +- %.3f px by the motion\n", pass.joined.seam,
                pass.joined.seam_sigma);
  }
  std::printf("  %s\n", job.out.c_str());
}

}  // namespace photohull::cli
