// What photohull pose found out of several passes, for people.
#pragma once

#include "pose/pose_passes.h"

namespace photohull::cli {

/// A few lines on standard output.
void print_passes(const pose::PoseJob& job, const pose::PassesPose& found);

}  // namespace photohull::cli
