// What of a photograph the model explains, as a picture.
#pragma once

#include <span>

#include "assess/explained.h"
#include "pipeline/missing_picture.h"

namespace photohull::pipeline {

/// The photograph with the most places that the model should explain and does not (missed,
/// disagreeing or alone), with a square on every place that was looked at: red where other views
/// agree on surface that the model lacks, orange where it is there and the views disagree, yellow
/// where one view alone sees it, violet where nothing is and nothing was found, blue what lies
/// outside the box. What is explained is left as it is; what is plain, or was not looked at, is
/// darkened. Empty where no view has textured places.
MissingPicture draw_explained(std::span<const PreparedView> views,
                              const assess::Explained& explained);

}  // namespace photohull::pipeline
