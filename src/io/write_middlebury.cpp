#include <sstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/write_scene.h"
#include "io/write_scene_parts.h"

namespace photohull::io {

void write_middlebury(const Scene& scene, const std::filesystem::path& folder) {
  make_folder(folder);
  std::ostringstream out;
  out << scene.views.size() << "\n";
  for (const SourceView& view : scene.views) {
    if (view.distortion.model != DistortionModel::kNone)
      throw Error(concat(view.name,
                         ": its camera has lens distortion, which the Middlebury format "
                         "cannot express; write COLMAP or undistort first"));
    out << listed_name(view, folder, {".", "images"});
    const glm::dmat3 k = view.camera.intrinsics.k();
    const Pose& pose = view.camera.cam_from_world;
    for (const glm::dmat3& m : {k, pose.rotation})
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) out << " " << number_text(m[column][row]);
    for (int axis = 0; axis < 3; ++axis) out << " " << number_text(pose.translation[axis]);
    out << "\n";
  }
  write_atomically(folder / "scene_par.txt", out.str());
  write_bbox_file(scene, folder);
}

}  // namespace photohull::io
