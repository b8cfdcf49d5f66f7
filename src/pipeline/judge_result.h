// The stage that says how good the result is.
#pragma once

#include <optional>

#include "core/mesh.h"
#include "pipeline/findings.h"
#include "pipeline/methods/method.h"
#include "pipeline/missing_picture.h"
#include "pipeline/surroundings.h"

namespace photohull::pipeline {

/// What is judged beside the subject.
struct Judged {
  const TriMesh& mesh;   ///< coloured, of the subject's box
  const Around& around;  ///< what surrounds it, if that was made
  const CameraFindings& cameras;
  const SilhouetteFindings& silhouettes;
  std::int64_t stem_vertices = 0;  ///< of the mesh
};

struct Judgement {
  VerdictFindings findings;
  MissingPicture missing, explained;  ///< empty unless `pictures`, or where there is none
};

Judgement judge_result(const SurfaceJob& job, const Judged& judged, bool pictures);

}  // namespace photohull::pipeline
