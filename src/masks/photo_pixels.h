// A photograph's light, and the object's colours in it. Private to module masks: includes OpenCV.
#pragma once

#include <glm/glm.hpp>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/silhouette.h"

namespace photohull {

/// Red, green and blue.
struct Pixels {
  cv::Mat linear, root;  ///< CV_32FC3: linear light and its square root
  cv::Mat known;         ///< CV_8U, 0 around what was not photographed; empty: all are

  explicit Pixels(const ColourImage& image);

  static glm::dvec3 bilinear(const cv::Mat& from, const glm::dvec2& p);
};

/// Up to 64 colours of the object, linear light, spread evenly over what lies well within its
/// outline; none where there is too little of it.
std::vector<glm::dvec3> palette_of(const Pixels& pixels, const SilhouetteDistance& distance);

/// How much of the object it takes to change a background's light by `change`: 1 where it hides
/// the background. The median over the palette's colours that differ from the background in the
/// same direction; nothing where none does.
std::optional<double> share_of(std::span<const glm::dvec3> palette, const glm::dvec3& change,
                               const glm::dvec3& background);

}  // namespace photohull
