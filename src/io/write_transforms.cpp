#include <bit>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/write_scene.h"
#include "io/write_scene_parts.h"

namespace photohull::io {
namespace {

using nlohmann::ordered_json;

constexpr const char* kPointsFile = "points.ply";

ordered_json triple(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// Camera to world with the camera's axes turned from ours (y down, z forward) to OpenGL's.
ordered_json transform_matrix(const Camera& camera) {
  const glm::dmat3 r = glm::transpose(camera.cam_from_world.rotation);
  const glm::dvec3 center = camera.center();
  ordered_json rows = ordered_json::array();
  for (int row = 0; row < 3; ++row)
    rows.push_back({r[0][row], -r[1][row], -r[2][row], center[row]});
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

void add_distortion(const SourceView& view, ordered_json& frame) {
  const std::array<double, 8>& c = view.distortion.coefficients;
  switch (view.distortion.model) {
    case DistortionModel::kNone:
      return;
    case DistortionModel::kMeasured:
      refuse_distortion(view, "transforms.json");
    case DistortionModel::kPolynomial:
    case DistortionModel::kBrown: {
      const bool rational =
          view.distortion.model == DistortionModel::kBrown && (c[5] != 0 || c[6] != 0 || c[7] != 0);
      frame["camera_model"] = rational ? "FULL_OPENCV" : "OPENCV";
      frame["k1"] = c[0];
      frame["k2"] = c[1];
      frame["p1"] = c[2];
      frame["p2"] = c[3];
      frame["k3"] = c[4];
      if (rational || c[5] != 0) frame["k4"] = c[5];
      if (rational) frame["k5"] = c[6], frame["k6"] = c[7];
      return;
    }
    case DistortionModel::kFisheye:
      frame["camera_model"] = "OPENCV_FISHEYE";
      for (int i = 0; i < 4; ++i) frame[concat("k", i + 1)] = c[i];
      return;
  }
}

ordered_json frame_of(const SourceView& view, const std::filesystem::path& folder) {
  require_no_skew(view, "transforms.json");
  const Intrinsics& k = view.camera.intrinsics;
  ordered_json frame;
  frame["file_path"] = listed_name(view, folder, {"."});
  if (!view.mask.empty()) frame["mask_path"] = relative_path(view.mask, folder);
  if (view.mask_made) frame["mask_made"] = true;
  frame["w"] = k.width;
  frame["h"] = k.height;
  frame["fl_x"] = k.fx;
  frame["fl_y"] = k.fy;
  frame["cx"] = k.cx + 0.5;
  frame["cy"] = k.cy + 0.5;
  add_distortion(view, frame);
  frame["transform_matrix"] = transform_matrix(view.camera);
  return frame;
}

/// Little-endian, in doubles, as the world has them.
void write_points(const std::vector<glm::dvec3>& points, const std::filesystem::path& file) {
  static_assert(std::endian::native == std::endian::little);
  std::string bytes =
      concat("ply\nformat binary_little_endian 1.0\nelement vertex ", points.size(),
             "\nproperty double x\nproperty double y\nproperty double z\nend_header\n");
  bytes.append(reinterpret_cast<const char*>(points.data()), points.size() * sizeof(glm::dvec3));
  write_atomically(file, bytes);
}

}  // namespace

void write_transforms(const Scene& scene, const std::filesystem::path& folder) {
  make_folder(folder);
  ordered_json root;
  if (scene.box) root["aabb"] = {triple(scene.box->min), triple(scene.box->max)};
  if (!scene.points.empty()) {
    write_points(scene.points, folder / kPointsFile);
    root["ply_file_path"] = kPointsFile;
  }
  root["frames"] = ordered_json::array();
  for (const SourceView& view : scene.views) root["frames"].push_back(frame_of(view, folder));
  write_atomically(folder / "transforms.json", json_text(root));
}

}  // namespace photohull::io
