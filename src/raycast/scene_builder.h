// Private to raycast: Embree scenes that are built whole.
#pragma once

#include <embree3/rtcore.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace photohull {

/// Builds Embree scenes, which it must outlive. Embree does so by TBB's tasks, which are cancelled
/// together with a task around them when another of its group has thrown: the scene would then have
/// no tree, no error would say so, and the first query would crash. So they get a context of their
/// own; the scene's task group refers to it as long as it lives.
class SceneBuilder {
 public:
  /// One thread builds the tree, in an arena of its own, so that it is the same tree in every run.
  /// Embree's own option for that would hold all of the process's TBB at one thread as long as the
  /// scene lives.
  void commit(RTCScene scene) {
    tbb::task_arena one(1);
    one.execute([&] {
      tbb::parallel_for(
          0, 1, [&](int) { rtcJoinCommitScene(scene); }, context_);
    });
  }

 private:
  tbb::task_group_context context_{tbb::task_group_context::isolated};
};

}  // namespace photohull
