// What photographs lack that a model is to be made of, said with what to do.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/coverage.h"

namespace photohull::pipeline {

/// What is known of a photograph before its camera is.
struct PhotoLook {
  std::string name;
  double sharpness = 0;  ///< to be compared with the others'; 0: not known
  double exposure = 0;   ///< that the camera chose, as the others' are given; 0: not known
};

/// Warnings, each a sentence: photographs that are much less sharp than the median of all; an
/// exposure that changes by a stop or more; the gaps that were found in what the photographs cover,
/// with the file that shows them in a picture (empty: none does).
std::vector<std::string> check_photographs(std::span<const PhotoLook> photographs,
                                           const Coverage& coverage, const std::string& picture);

}  // namespace photohull::pipeline
