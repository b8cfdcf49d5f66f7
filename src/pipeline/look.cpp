#include "pipeline/look.h"

#include <limits>

#include "pipeline/texture_stage.h"
#include "render/scene_up.h"

namespace photohull::pipeline {

LookFindings look_at(const TriMesh& mesh, std::span<const PreparedView> views, int main) {
  LookFindings look;
  std::vector<Camera> cameras;
  for (const PreparedView& view : views) {
    look.cameras.push_back({view.name, view.source.camera});
    cameras.push_back(view.source.camera);
  }
  glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
  for (const glm::vec3& p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
  look.up = render::scene_up(cameras, mesh.origin + 0.5 * (glm::dvec3(low) + glm::dvec3(high)));
  look.up_axis = upward_axis(views);
  look.main_view = views[std::size_t(main)].name;
  return look;
}

}  // namespace photohull::pipeline
