#include "pipeline/stage_weights.h"

#include "pipeline/methods/method.h"
#include "pipeline/reconstruct_options.h"
#include "pipeline/texture_stage.h"

namespace photohull::pipeline {

double Weights::cameras(const ReconstructOptions& options) {
  if (options.takes_rig_cameras()) return kLookAtCameras;
  if (!options.refine_cameras) return options.quality == Quality::kDraft ? 0 : kLookAtCameras;
  return *options.refine_cameras == RefineCameras::kOff ? 0 : kCameras;
}

double total_weight(const ReconstructOptions& options) {
  return Weights::kScene + Weights::kViews + Weights::cameras(options) +
         (options.photometric != Photometric::kOff ? Weights::kPhotometric : 0) + Weights::kDevice +
         Weights::kSilhouettes + Weights::kHull + Weights::kImages + method_of(options).weight +
         (options.mesh_error.value > 0 ? Weights::kSimplify : 0) + Weights::kClean +
         (makes_texture(options) ? Weights::kTexture : 0) +
         (options.report_page == ReportPage::kOn ? Weights::kPage : 0) + Weights::kMesh +
         Weights::kColour + Weights::kVerdict + Weights::kPreview + Weights::kVolume +
         Weights::kFiles;
}

}  // namespace photohull::pipeline
