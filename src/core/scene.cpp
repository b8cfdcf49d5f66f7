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
  }
  return "unknown";
}

}  // namespace photohull
