#include "pipeline/keep_evidence.h"

namespace photohull::pipeline {

Evidence keep_evidence(const TriMesh& mesh, const std::vector<render::PooledEvidence>& evidence) {
  Evidence out;
  out.mesh = mesh;
  for (const render::PooledEvidence& e : evidence) {
    out.scalars["scatter"].push_back(e.scatter);
    out.scalars["disagreement"].push_back(e.disagreement);
    out.scalars["fine_share"].push_back(e.fine_share);
  }
  return out;
}

}  // namespace photohull::pipeline
