// What photographs lack that a model is to be made of, said with what to do.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/scene.h"

namespace photohull::pipeline {

/// What is known of a photograph before its camera is.
struct PhotoLook {
  std::string name;
  double sharpness = 0;  ///< to be compared with the others'; 0: not known
  double exposure = 0;   ///< that the camera chose, as the others' are given; 0: not known
};

/// Warnings, each a sentence: photographs that are much less sharp than the median of all; an
/// exposure that changes by a stop or more; views that look at `middle` (world) from one side
/// only, or leave a gap of a quarter of the circle or more about it as seen from `up` (nothing: as
/// the cameras tell). Nothing is said of the sides where views do not look at one place, as in a
/// room, or most look down.
std::vector<std::string> check_photographs(std::span<const PhotoLook> photographs,
                                           std::span<const SourceView> views,
                                           const glm::dvec3& middle,
                                           const std::optional<glm::dvec3>& up);

}  // namespace photohull::pipeline
