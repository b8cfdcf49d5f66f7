#include "pipeline/stage_weights.h"

#include "pipeline/reconstruct.h"

namespace photohull::pipeline {

double Weights::cameras(const ReconstructOptions& options) {
  if (!options.refine_cameras) return options.quality == Quality::kDraft ? 0 : kLookAtCameras;
  return *options.refine_cameras == RefineCameras::kOff ? 0 : kCameras;
}

double total_weight(const ReconstructOptions& options) {
  const Method method = options.effective_method();
  return Weights::kScene + Weights::kViews + Weights::cameras(options) +
         (options.photometric != Photometric::kOff ? Weights::kPhotometric : 0) + Weights::kDevice +
         Weights::kHull + Weights::kImages +
         (method == Method::kHull     ? 0
          : method == Method::kRefine ? Weights::kRefine
                                      : Weights::kPhoto) +
         (options.mesh_error.value > 0 ? Weights::kSimplify : 0) + Weights::kClean +
         Weights::kMesh + Weights::kColour + Weights::kVerdict + Weights::kPreview +
         Weights::kFiles;
}

}  // namespace photohull::pipeline
