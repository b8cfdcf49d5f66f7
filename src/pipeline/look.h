// From where a model can be looked at.
#pragma once

#include <span>

#include "core/mesh.h"
#include "core/prepared_view.h"
#include "pipeline/findings.h"

namespace photohull::pipeline {

/// The cameras of the views with all of their photographs on them, the direction that is upward in
/// these, and the view `main`.
LookFindings look_at(const TriMesh& mesh, std::span<const PreparedView> views, int main);

}  // namespace photohull::pipeline
