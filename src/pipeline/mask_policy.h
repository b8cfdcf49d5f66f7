// What --masks means for the preparation of views.
#pragma once

#include "io/load_scene.h"
#include "views/prepare_views.h"

namespace photohull::pipeline {

inline MaskPolicy mask_policy(io::MaskSource source) {
  return source == io::MaskSource::kNone         ? MaskPolicy::kNone
         : source == io::MaskSource::kBackground ? MaskPolicy::kBackground
                                                 : MaskPolicy::kAuto;
}

}  // namespace photohull::pipeline
