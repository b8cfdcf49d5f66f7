// An evaluation for programs.
#pragma once

#include <string>

#include "eval/evaluate.h"

namespace photohull::eval {

/// The evaluation as JSON, indented by two, with the keys of docs/guide/evaluate.md.
std::string to_json(const Evaluation& evaluation);

}  // namespace photohull::eval
