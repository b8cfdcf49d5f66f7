#include <array>

#include "cameras/refine_cameras.h"

namespace photohull {

const char* to_string(TrackSource source) {
  switch (source) {
    case TrackSource::kBoth:
      return "both";
    case TrackSource::kGiven:
      return "given";
    case TrackSource::kFound:
      return "found";
  }
  return "unknown";
}

void describe(Described& to, RefineCamerasOptions& o) {
  to.choice("tracks", &o.source,
            std::array{TrackSource::kBoth, TrackSource::kGiven, TrackSource::kFound},
            "features: those that the scene's file lists (given), found ones, or both");
}

}  // namespace photohull
