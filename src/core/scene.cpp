#include "core/scene.h"

namespace photohull {

const char* to_string(SceneFormat format) {
  switch (format) {
    case SceneFormat::kMiddlebury:
      return "middlebury";
    case SceneFormat::kColmapText:
      return "colmap-text";
    case SceneFormat::kColmapBinary:
      return "colmap-binary";
    case SceneFormat::kTransforms:
      return "transforms";
    case SceneFormat::kBundler:
      return "bundler";
    case SceneFormat::kNvm:
      return "nvm";
    case SceneFormat::kOpenMvg:
      return "openmvg";
    case SceneFormat::kAliceVision:
      return "alicevision";
    case SceneFormat::kMetashape:
      return "metashape";
    case SceneFormat::kRealityCapture:
      return "realitycapture";
    case SceneFormat::kStrecha:
      return "strecha";
    case SceneFormat::kPmvs:
      return "pmvs";
    case SceneFormat::kMvsNet:
      return "mvsnet";
    case SceneFormat::kMve:
      return "mve";
    case SceneFormat::kProjection:
      return "projection";
    case SceneFormat::kMatlab:
      return "matlab";
    case SceneFormat::kOpenCv:
      return "opencv";
  }
  return "unknown";
}

const char* to_string(LeftOutView::Reason reason) {
  switch (reason) {
    case LeftOutView::Reason::kMissing:
      return "missing";
    case LeftOutView::Reason::kUnreadable:
      return "unreadable";
    case LeftOutView::Reason::kSize:
      return "shape";
  }
  return "unknown";
}

}  // namespace photohull
