// Contract of the kernel that labels space.
#ifndef PHOTOHULL_SHADERS_LABEL_H
#define PHOTOHULL_SHADERS_LABEL_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace photohull::shaders {
using glm::ivec4;
using glm::vec4;
#elif !defined(constexpr)
#define constexpr const
#endif

constexpr int kLabelParametersBinding = 0;
constexpr int kLabelNeighboursBinding = 0;
constexpr int kLabelEvidenceBinding = 1;
constexpr int kLabelsBinding = 2;
constexpr int kLabelFlowBinding = 3;

struct LabelParameters {
  ivec4 counts;  // x: voxels
  vec4 weights;  // x: rate of the steps
};

#ifdef __cplusplus
static_assert(sizeof(LabelParameters) == 32);
}  // namespace photohull::shaders
#endif

#endif  // PHOTOHULL_SHADERS_LABEL_H
