// Double-precision references of the statistics (shaders/include/consistency_*.glsl) but for
// normalised cross-correlation, which photo_reference.h has; written from the definitions.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "carving/statistic.h"

namespace photohull::carving::reference {

/// What the views that count show on the taps that all of them show, square-root encoded.
struct CommonPatches {
  std::vector<std::vector<glm::dvec3>> views;  ///< as many taps each
  std::size_t middle = 0;                      ///< which tap is the voxel itself
};

struct ImageNoise {
  double variance = 0;
  double least_texture = 0;  ///< variance, below which statistics of contrast say nothing
};

struct Evidence {
  double score = -1;      ///< 0.7 and more: consistent
  double confidence = 0;  ///< in [0, 1]; 0: too little evidence
  int used = 0;           ///< views
  double margin = 1;  ///< least distance of a comparison that decides something from its threshold
};

/// Fewer than two views, or taps than half a patch, are no evidence.
Evidence gain_variance(const CommonPatches& patches, const ImageNoise& noise);
Evidence adaptive_variance(const CommonPatches& patches, const ImageNoise& noise);
Evidence robust_variance(const CommonPatches& patches, const ImageNoise& noise);
Evidence histogram_consistency(const CommonPatches& patches, const ImageNoise& noise);
Evidence census(const CommonPatches& patches, const ImageNoise& noise);

}  // namespace photohull::carving::reference
