// Agreement with photographs, for programs.
#pragma once

#include <string>

#include "eval/photo_agreement.h"

namespace photohull::eval {

/// JSON, indented by two: `around`, the JSON object that to_json(Evaluation) gives, or one that
/// names the result, with the key "photos" added (docs/guide/evaluate.md).
std::string to_json(const PhotoAgreement& agreement, const std::string& around = {});

}  // namespace photohull::eval
