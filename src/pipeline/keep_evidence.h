// What evidence.ply shows of the colours' evidence.
#pragma once

#include <vector>

#include "core/mesh.h"
#include "pipeline/reconstruct.h"
#include "render/confidence.h"

namespace photohull::pipeline {

/// The surface with a number for each vertex of what its views agree on.
Evidence keep_evidence(const TriMesh& mesh, const std::vector<render::PooledEvidence>& evidence);

}  // namespace photohull::pipeline
