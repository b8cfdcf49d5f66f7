// Private to module texture: one photograph for every triangle, so that few seams run between.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh.h"
#include "core/progress.h"
#include "texture/face_views.h"

namespace photohull::texture {

/// Of a triangle that no camera sees from its front.
inline constexpr std::int32_t kUnseen = -1;

/// Views that minimise: of every triangle its area times what its view lacks of the best one's
/// quality, and of every seam its length times `seam` (world units) [LempitskyIvanov07]; by alpha
/// expansion [Boykov01]. Throws Cancelled.
std::vector<std::int32_t> label_faces(const TriMesh& mesh,
                                      const std::vector<std::array<std::uint32_t, 3>>& neighbours,
                                      const FaceViews& views, std::size_t view_count, double seam,
                                      Progress& progress);

}  // namespace photohull::texture
