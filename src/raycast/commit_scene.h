// Private to raycast: Embree scenes that are built whole.
#pragma once

#include <embree3/rtcore.h>
#include <tbb/parallel_for.h>

namespace photohull {

/// Embree builds by TBB's tasks. They are cancelled together with a task around them, when another
/// of its group has thrown; the scene would then have no tree, no error would say so, and the first
/// query would crash. So they get a context of their own.
inline void commit_scene(RTCScene scene) {
  tbb::task_group_context alone(tbb::task_group_context::isolated);
  tbb::parallel_for(
      0, 1, [&](int) { rtcCommitScene(scene); }, alone);
}

}  // namespace photohull
