#include "pipeline/mask_policy.h"
#include "scene_arguments.h"

namespace photohull::cli {

pipeline::BoxOptions SceneArguments::box_options() const {
  pipeline::BoxOptions out{box == kFindBox, box_scale};
  out.validate();
  return out;
}

void SceneArguments::complete_box(Scene& loaded) const {
  const pipeline::BoxOptions asked = box_options();
  if (!asked.find && asked.scale == 1) return;
  Progress silent;
  pipeline::complete_box(asked, pipeline::mask_policy(options().masks), loaded, silent);
}

}  // namespace photohull::cli
