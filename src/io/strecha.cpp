// Strecha's multi-view benchmark [Strecha08]: IMAGE.camera holds K, three zeros, the
// camera-to-world rotation, the camera's centre, and the image size; P = K [R^T | -R^T c]. Axes as
// ours.
#include <cmath>
#include <sstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/camera_checks.h"
#include "io/find_files.h"
#include "io/pose_parts.h"
#include "io/scene_readers.h"
#include "io/text_file.h"
#include "io/write_scene_parts.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kNumbers = 9 + 3 + 9 + 3 + 2;
constexpr std::string_view kEnding = ".camera";

RawView read_camera(const fs::path& file) {
  const std::vector<double> v = read_numbers(file, kNumbers);
  RawView view;
  view.where = file.string();
  view.listed = file.filename().string();
  view.listed.resize(view.listed.size() - kEnding.size());
  view.camera.intrinsics = intrinsics_of(std::span<const double, 9>(&v[0], 9), view.where);
  if (v[9] != 0 || v[10] != 0 || v[11] != 0)
    throw Error(concat(view.where,
                       ": the line after K must be 0 0 0: what else would mean is "
                       "not defined; undistort the images"));
  const glm::dmat3 world_from_cam =
      checked_rotation(from_rows(std::span<const double, 9>(&v[12], 9)), view.where, "R");
  view.camera.cam_from_world = pose_at(glm::transpose(world_from_cam), {v[21], v[22], v[23]});
  for (const double size : {v[24], v[25]})
    if (!(size >= 1 && size <= 1e9) || size != std::floor(size))
      throw Error(concat(view.where, ": the image size ", v[24], " x ", v[25], " is impossible"));
  view.camera.intrinsics.width = int(v[24]);
  view.camera.intrinsics.height = int(v[25]);
  return view;
}

}  // namespace

fs::path find_strecha(const fs::path& folder) {
  return files_ending(folder, kEnding).empty() ? fs::path() : folder;
}

bool is_strecha(const fs::path& file) { return file.extension() == kEnding; }

RawScene read_strecha(const fs::path& folder) {
  RawScene scene;
  scene.format = SceneFormat::kStrecha;
  scene.file = folder / "*.camera";
  scene.image_folders = {folder, folder / "images", folder / "..", folder / ".." / "images"};
  for (const fs::path& file : files_ending(folder, kEnding))
    scene.views.push_back(read_camera(file));
  return scene;
}

void write_strecha(const Scene& scene, const fs::path& folder) {
  make_folder(folder);
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    const SourceView& view = scene.views[i];
    require_pinhole(view, "Strecha's format");
    const bool flat = fs::path(view.name).filename() == view.name;  // else names may repeat
    const std::string name =
        place_image(view, folder, flat ? fs::path(view.name).stem().string() : numbered_name(i));
    std::ostringstream out;
    const Camera& camera = view.camera;
    const glm::dmat3 r = glm::transpose(camera.cam_from_world.rotation);
    out << matrix_lines(camera.intrinsics.k()) << "0 0 0\n"
        << matrix_lines(r) << vector_text(camera.center()) << "\n"
        << camera.intrinsics.width << " " << camera.intrinsics.height << "\n";
    write_atomically(folder / (name + ".camera"), out.str());
  }
  write_bbox_file(scene, folder);
}

}  // namespace photohull::io
