// Parts of the study. Private to it.
#pragma once

#include <vector>

#include "lab/visibility/study.h"
#include "visibility/kernels/visibility_map.h"

namespace photohull::visibility {

/// How much of what is in a texel the sub-pixel maps know, at texels drawn at random.
std::vector<DetectionCell> detect_triangles(gpu::Context& context, const StudyScene& scene,
                                            const Geometry& geometry, int resolution,
                                            unsigned seed);

/// A volume of 256^3 voxels, rasterised and marched, against the voxel walk.
std::vector<VolumeCell> study_volumes(gpu::Context& context, const StudyOptions& options,
                                      Progress& progress);

}  // namespace photohull::visibility
