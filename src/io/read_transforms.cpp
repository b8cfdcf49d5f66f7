// transforms.json as written for NeRF, Instant-NGP and nerfstudio: camera-to-world matrices in
// OpenGL's axes (x right, y up, z back) and intrinsics for all frames or for each. Pixel centres
// are at (0.5, 0.5).
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "io/camera_checks.h"
#include "io/json_file.h"
#include "io/raw_scene.h"
#include "io/read_ply.h"
#include "io/text_file.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;

constexpr const char* kPointsField = "ply_file_path";

/// One frame's fields with those of the whole file behind them.
class Fields {
 public:
  Fields(const json& frame, const json& scene, std::string where)
      : frame_(frame), scene_(scene), where_(std::move(where)) {}

  const std::string& where() const { return where_; }

  /// 0 where the field is absent or null.
  double number(const char* key, double fallback = 0) const {
    if (const json* value = find(key)) return finite(*value, key);
    return fallback;
  }

  /// Whole and positive, or 0 where absent: sizes are often written as 640.0.
  int size(const char* key) const {
    const json* value = find(key);
    if (!value) return 0;
    const double number = finite(*value, key);
    if (!(number >= 1) || number != std::floor(number) || number > 1e9)
      throw Error(concat(where_, ": ", key, " is ", number,
                         ", but a whole positive number of pixels is needed"));
    return int(number);
  }

  std::string text(const char* key) const { return string_of(find(key), key); }

  /// A string that only the frame itself can state.
  std::string own_text(const char* key) const {
    const auto found = frame_.find(key);
    return string_of(found == frame_.end() || found->is_null() ? nullptr : &*found, key);
  }

  bool flag(const char* key) const {
    const json* value = find(key);
    if (value && !value->is_boolean())
      throw Error(concat(where_, ": ", key, " must be true or false"));
    return value && value->get<bool>();
  }

  bool has(const char* key) const { return find(key) != nullptr; }
  bool frame_has(const char* key) const { return frame_.contains(key); }

 private:
  const json* find(const char* key) const {
    for (const json* object : {&frame_, &scene_}) {
      const auto found = object->find(key);
      if (found != object->end() && !found->is_null()) return &*found;
    }
    return nullptr;
  }

  std::string string_of(const json* value, const char* key) const {
    if (!value) return {};
    if (!value->is_string()) throw Error(concat(where_, ": ", key, " must be a string"));
    return value->get<std::string>();
  }

  double finite(const json& value, const char* key) const {
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      throw Error(concat(where_, ": ", key, " must be a finite number"));
    return value.get<double>();
  }

  const json& frame_;
  const json& scene_;
  std::string where_;
};

double angle(const Fields& fields, const char* key) {
  const double value = fields.number(key);
  if (value < 0 || value >= 3.14159)
    throw Error(concat(fields.where(), ": ", key, " is ", value,
                       ", but an angle in radians between 0 and pi is needed"));
  return value;
}

void read_intrinsics(const Fields& fields, RawView& view) {
  constexpr double kUnstated = std::numeric_limits<double>::quiet_NaN();
  Intrinsics& k = view.camera.intrinsics;
  k.width = fields.size("w");
  k.height = fields.size("h");
  k.cx = fields.number("cx", kUnstated);
  k.cy = fields.number("cy", kUnstated);
  view.angle_x = angle(fields, "camera_angle_x");
  view.angle_y = angle(fields, "camera_angle_y");
  // A field of view given for one frame beats a focal length given for all of them.
  const bool own_angle = (fields.frame_has("camera_angle_x") || fields.frame_has("camera_angle_y"));
  const bool own_focal = fields.frame_has("fl_x") || fields.frame_has("fl_y");
  if (!own_angle || own_focal) {
    k.fx = fields.number("fl_x");
    k.fy = fields.number("fl_y");
    for (const char* key : {"fl_x", "fl_y"})
      if (fields.has(key) && fields.number(key) <= 0)
        throw Error(concat(fields.where(), ": ", key, " is ", fields.number(key),
                           ", but focal lengths must be positive; leave it out where the field of "
                           "view or the other one says it"));
  }
  if (k.fx == 0 && k.fy == 0 && view.angle_x == 0 && view.angle_y == 0)
    throw Error(
        concat(fields.where(),
               ": there is no focal length; add fl_x (pixels) or camera_angle_x (radians)"));
}

Distortion read_distortion(const Fields& fields) {
  const std::string model = fields.text("camera_model");
  const bool fisheye = model == "OPENCV_FISHEYE" || fields.flag("is_fisheye");
  if (!fisheye && !model.empty() && model != "OPENCV" && model != "PINHOLE" &&
      model != "SIMPLE_PINHOLE" && model != "SIMPLE_RADIAL" && model != "RADIAL" &&
      model != "PERSPECTIVE" && model != "FULL_OPENCV")
    throw Error(concat(fields.where(), ": camera_model ", model,
                       " is not known; use PINHOLE, OPENCV, FULL_OPENCV or OPENCV_FISHEYE"));
  Distortion d;
  const double k1 = fields.number("k1"), k2 = fields.number("k2"), k3 = fields.number("k3"),
               k4 = fields.number("k4"), p1 = fields.number("p1"), p2 = fields.number("p2");
  if (fisheye) {
    d.model = DistortionModel::kFisheye;
    d.coefficients = {k1, k2, k3, k4};
    return d;
  }
  const double k5 = fields.number("k5"), k6 = fields.number("k6");
  // OpenCV's k4 to k6 are a denominator; nerfstudio's k4, alone, is the term of the eighth power.
  const bool eighth = model != "FULL_OPENCV" && k4 != 0 && k5 == 0 && k6 == 0;
  d.coefficients = {k1, k2, p1, p2, k3, k4, k5, k6};
  if (d.coefficients != std::array<double, 8>{})
    d.model = eighth ? DistortionModel::kPolynomial : DistortionModel::kBrown;
  return d;
}

/// Rows and columns of transform_matrix, which has 3 or 4 rows of 4.
double element(const json& matrix, int row, int column, const std::string& where) {
  if (!matrix.is_array() || matrix.size() < 3 || matrix.size() > 4 || !matrix[row].is_array() ||
      matrix[row].size() != 4 || !matrix[row][column].is_number() ||
      !std::isfinite(matrix[row][column].get<double>()))
    throw Error(concat(where, ": transform_matrix must be 4 rows of 4 finite numbers"));
  return matrix[row][column].get<double>();
}

Pose read_pose(const json& frame, const std::string& where) {
  const auto found = frame.find("transform_matrix");
  if (found == frame.end()) throw Error(concat(where, ": transform_matrix is missing"));
  glm::dmat3 axes;
  glm::dvec3 center;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      axes[column][row] = element(*found, row, column, where);
    center[row] = element(*found, row, 3, where);
  }
  for (int column = 0; found->size() == 4 && column < 4; ++column)
    if (std::abs(element(*found, 3, column, where) - (column == 3 ? 1.0 : 0.0)) > 1e-6)
      throw Error(concat(where, ": the last row of transform_matrix must be 0 0 0 1"));
  glm::dmat3 world_from_cam = checked_rotation(axes, where, "transform_matrix");
  // OpenGL's camera looks along -z with y up, ours along +z with y down.
  world_from_cam[1] = -world_from_cam[1];
  world_from_cam[2] = -world_from_cam[2];
  const glm::dmat3 rotation = glm::transpose(world_from_cam);
  return {rotation, -(rotation * center)};
}

void read_aabb(const json& root, RawScene& scene) {
  const auto found = root.find("aabb");
  if (found == root.end() || found->is_null()) return;
  Box box;
  for (int corner = 0; corner < 2; ++corner)
    for (int axis = 0; axis < 3; ++axis) {
      const bool shaped = found->is_array() && found->size() == 2 && (*found)[corner].is_array() &&
                          (*found)[corner].size() == 3 && (*found)[corner][axis].is_number();
      if (!shaped)
        throw Error(concat(scene.file.string(),
                           ": aabb must be [[x, y, z], [x, y, z]], smallest corner first"));
      (corner == 0 ? box.min : box.max)[axis] = (*found)[corner][axis].get<double>();
    }
  scene.box = box;
  scene.box_source = concat("aabb of ", scene.file.filename().string());
}

/// The sparse points in the PLY file that nerfstudio's field names. They help and are not needed:
/// where they cannot be had, a warning says why.
void read_points(const json& root, RawScene& scene) {
  const auto found = root.find(kPointsField);
  if (found == root.end() || found->is_null()) return;
  if (!found->is_string())
    throw Error(concat(scene.file.string(), ": ", kPointsField, " must be a string"));
  const fs::path file = scene.file.parent_path() / found->get<std::string>();
  const auto go_without = [&](const std::string& reason) {
    scene.warnings.push_back(concat(scene.file.string(), ": the sparse points that ", kPointsField,
                                    " names are done without: ", reason));
  };
  std::error_code failure;
  if (!is_file(file)) return go_without(concat(file.string(), " is not there"));
  if (fs::file_size(file, failure) > kMaxTextFileBytes)
    return go_without(concat(file.string(), " is larger than ", kMaxTextFileBytes >> 20, " MiB"));
  try {
    const TriMesh cloud = read_ply(file);
    scene.points.reserve(cloud.positions.size());
    for (std::size_t i = 0; i < cloud.positions.size(); ++i) scene.points.push_back(cloud.world(i));
  } catch (const MemoryError&) {
    throw;
  } catch (const Error& unreadable) {
    go_without(unreadable.what());
  }
}

}  // namespace

RawScene read_transforms(const fs::path& json_file) {
  RawScene scene;
  scene.format = SceneFormat::kTransforms;
  scene.file = json_file;
  scene.pixel_center = 0.5;
  scene.image_folders = {json_file.parent_path()};
  const json root = parse_json(json_file);
  if (!root.is_object() || !root.contains("frames") || !root["frames"].is_array())
    throw Error(concat(json_file.string(),
                       ": the array \"frames\" is missing; this is no "
                       "transforms.json"));
  const json& frames = root["frames"];
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::string where = concat(json_file.string(), " frame ", i);
    if (!frames[i].is_object()) throw Error(concat(where, ": must be an object"));
    const Fields fields(frames[i], root, where);
    RawView view;
    view.where = where;
    view.listed = fields.own_text("file_path");
    if (view.listed.empty()) throw Error(concat(where, ": file_path is missing or empty"));
    view.mask = fields.own_text("mask_path");
    view.mask_made = fields.flag("mask_made");
    read_intrinsics(fields, view);
    view.distortion = read_distortion(fields);
    view.camera.cam_from_world = read_pose(frames[i], where);
    scene.views.push_back(std::move(view));
  }
  read_aabb(root, scene);
  read_points(root, scene);
  return scene;
}

}  // namespace photohull::io
