// The order in which views are worked on.
#pragma once

#include "core/scene.h"

namespace photohull::pipeline {

/// Puts the views, and what tracks say of them, into the natural order of their names (2 before
/// 10), so that no result depends on the order in which the scene lists them: sums over views round
/// by it.
void sort_views_by_name(Scene& scene);

}  // namespace photohull::pipeline
