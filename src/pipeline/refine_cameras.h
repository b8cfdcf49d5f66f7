// Cameras of a scene refined against its photographs, and what is reported of it.
#pragma once

#include <span>
#include <string>

#include "cameras/refine_cameras.h"
#include "core/scene.h"

namespace photohull::pipeline {

enum class RefineCameras { kOff, kAuto, kPoses, kPosesAndIntrinsics };

const char* to_string(RefineCameras refine);

/// Carries what a refinement of the undistorted views' cameras changed over to the photographs'
/// own, one for each.
void apply(const CameraRefinement& refinement, std::span<SourceView> views);

/// Does the gain pay? The held-out residual must have fallen by a fifth, and to begin with be more
/// than what matching leaves; or to the half, by intrinsics that all views share.
bool pays(const CameraRefinement& refinement);

/// Were focal lengths or principal points refined?
bool shares_intrinsics(const CameraRefinement& refinement);

/// JSON: what changed, whether it is used, and each view's residual before and after, pixels.
std::string to_json(const CameraRefinement& refinement, const Scene& scene, bool used);

}  // namespace photohull::pipeline
