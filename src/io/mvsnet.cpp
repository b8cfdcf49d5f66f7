// MVSNet and DTU [Yao18]: cams/NAME_cam.txt with "extrinsic" (world to camera, 4x4), "intrinsic"
// (K, 3x3) and the depths to search, images in images/NAME.*. Axes as ours.
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

constexpr std::string_view kEnding = "_cam.txt";

/// `count` numbers after a line that holds only `title`, over any number of lines.
std::vector<double> read_block(Lines& lines, std::string_view title, std::size_t count) {
  if (!lines.next_content() || lines.text() != title)
    throw Error(concat(lines.where(), ": a line '", title, "' is needed here"));
  std::vector<double> values;
  while (values.size() < count) {
    if (!lines.next_content()) throw Error(concat(lines.where(), ": the file ends within ", title));
    for (const std::string_view field : split_fields(lines.text(), count + 1))
      values.push_back(lines.number(field, title));
  }
  if (values.size() != count)
    throw Error(concat(lines.where(), ": more than ", count, " numbers follow ", title));
  return values;
}

RawView read_camera(const fs::path& file) {
  Lines lines(file);
  RawView view;
  view.where = file.string();
  view.listed = file.filename().string();
  view.listed.resize(view.listed.size() - kEnding.size());
  const std::vector<double> e = read_block(lines, "extrinsic", 16);
  const std::vector<double> k = read_block(lines, "intrinsic", 9);
  if (e[12] != 0 || e[13] != 0 || e[14] != 0 || e[15] != 1)
    throw Error(concat(view.where, ": the last row of extrinsic must be 0 0 0 1"));
  const glm::dmat3 rows(e[0], e[1], e[2], e[4], e[5], e[6], e[8], e[9], e[10]);
  view.camera.cam_from_world = {
      checked_rotation(glm::transpose(rows), view.where, "the rotation of extrinsic"),
      {e[3], e[7], e[11]}};
  view.camera.intrinsics = intrinsics_of(std::span<const double, 9>(k.data(), 9), view.where);
  return view;
}

/// Nearest and farthest depth of the box or the points; nothing where the scene has neither.
std::optional<glm::dvec2> depth_range(const Scene& scene, const Camera& camera) {
  std::vector<glm::dvec3> points = scene.points;
  if (scene.box) {
    points.clear();
    for (int corner = 0; corner < 8; ++corner)
      points.push_back(scene.box->min +
                       scene.box->size() * glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2));
  }
  double nearest = 1e300, farthest = 0;
  for (const glm::dvec3& p : points) {
    const double depth = camera.to_camera(p).z;
    if (!(depth > 0)) continue;
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  if (!(nearest < farthest)) return std::nullopt;
  return glm::dvec2(nearest, farthest);
}

}  // namespace

fs::path find_mvsnet(const fs::path& folder) {
  for (const fs::path& candidate : {folder / "cams", folder / "Cameras", folder})
    if (!files_ending(candidate, kEnding).empty()) return candidate;
  return {};
}

bool is_mvsnet(const fs::path& file) { return file.filename().string().ends_with(kEnding); }

RawScene read_mvsnet(const fs::path& folder) {
  RawScene scene;
  scene.format = SceneFormat::kMvsNet;
  // What belongs to the scene, such as bbox.txt, lies beside cams/.
  scene.file =
      (find_mvsnet(folder / "..") == folder / ".." / "cams" ? folder / ".." : folder) / "*_cam.txt";
  scene.image_folders = {folder / ".." / "images", folder / "images", folder, folder / ".."};
  for (const fs::path& file : files_ending(folder, kEnding))
    scene.views.push_back(read_camera(file));
  return scene;
}

void write_mvsnet(const Scene& scene, const fs::path& folder) {
  constexpr int kDepths = 192;  // MVSNet's default number of depths
  make_folder(folder / "cams");
  make_folder(folder / "images");
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    const SourceView& view = scene.views[i];
    require_pinhole(view, "MVSNet's format");
    place_image(view, folder / "images", numbered_name(i));
    const Pose& pose = view.camera.cam_from_world;
    std::ostringstream out;
    out << "extrinsic\n";
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        out << number_text(pose.rotation[column][row]) << " ";
      out << number_text(pose.translation[row]) << "\n";
    }
    out << "0 0 0 1\n\nintrinsic\n" << matrix_lines(view.camera.intrinsics.k());
    if (const auto range = depth_range(scene, view.camera))
      out << "\n"
          << number_text(range->x) << " " << number_text((range->y - range->x) / (kDepths - 1))
          << " " << kDepths << " " << number_text(range->y) << "\n";
    write_atomically(folder / "cams" / (numbered_name(i) + "_cam.txt"), out.str());
  }
  write_bbox_file(scene, folder);
}

}  // namespace photohull::io
