// Meshroom's and AliceVision's .sfm [Griwodz21], JSON with numbers as strings: world-to-camera
// rotation by columns (Eigen's order) and the camera's centre, axes as ours, pixel centres at whole
// numbers. By version of the file (src/aliceVision/sfmDataIO/jsonIO.cpp and CHANGES.md there):
//   before 1.2    pxFocalLength: one number;      principalPoint from the top-left corner
//   1.2.0         pxFocalLength: x and y;         the same
//   1.2.1         the same;                       principalPoint from the image's centre
//   1.2.2         focalLength in millimetres of sensorWidth, pixelRatio = fx / fy
//   1.2.5         pixelRatio = fy / fx
#include <algorithm>
#include <cctype>
#include <map>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/camera_checks.h"
#include "io/find_files.h"
#include "io/json_file.h"
#include "io/pose_parts.h"
#include "io/scene_readers.h"
#include "io/text_file.h"
#include "io/write_scene_parts.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

using nlohmann::ordered_json;
using Version = std::array<int, 3>;

constexpr double kSensorWidth = 36;  // millimetres, where a file states none

struct Lens {
  Intrinsics intrinsics;
  Distortion distortion;
};

Version read_version(const JsonNode& root) {
  const JsonNode node = root["version"];
  Version version{};
  for (int i = 0; i < 3; ++i) {
    const double part = node.at(std::size_t(i)).number();
    if (!(part >= 0 && part < 1e6)) throw Error(node.where() + ": is no version");
    version[i] = int(part);
  }
  return version;
}

void read_focal(const JsonNode& node, const Version& version, Intrinsics& k) {
  if (version < Version{1, 2, 2}) {
    const JsonNode focal = node["pxFocalLength"];
    const bool two = focal.json().is_array();
    k.fx = two ? focal.at(0).number() : focal.number();
    k.fy = two ? focal.at(1).number() : k.fx;
    return;
  }
  k.fx = node["focalLength"].number() / node.number("sensorWidth", kSensorWidth) * k.width;
  const double ratio = node.number("pixelRatio", 1);
  k.fy = version < Version{1, 2, 5} ? k.fx / ratio : k.fx * ratio;
}

/// The distortion's kind, in lower case: newer files name it apart from the projection's.
std::string lens_type(const JsonNode& node) {
  std::string type = node["type"].text();
  const std::string distortion = node.text("distortionType", "none");
  if (distortion != "none" && !distortion.empty()) type += " " + distortion;
  std::transform(type.begin(), type.end(), type.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return type;
}

Distortion read_distortion(const JsonNode& node) {
  std::vector<double> p;
  if (const auto list = node.find("distortionParams"); list && list->json().is_array())
    for (std::size_t i = 0; i < list->size(); ++i) p.push_back(list->at(i).number());
  const std::string type = lens_type(node);
  const auto is = [&](std::initializer_list<const char*> names, std::size_t count) {
    if (std::find(names.begin(), names.end(), type) == names.end()) return false;
    if (p.size() > count)
      throw Error(
          concat(node.where(), ": ", p.size(), " distortionParams, but ", type, " has ", count));
    p.resize(count);
    return true;
  };
  Distortion d;
  if (type == "pinhole") return d;
  d.model = DistortionModel::kBrown;
  if (is({"radial1", "pinhole radialk1"}, 1)) {
    d.coefficients[0] = p[0];
  } else if (is({"radial3", "pinhole radialk3"}, 3)) {
    d.coefficients = {p[0], p[1], 0, 0, p[2]};
  } else if (is({"brown", "pinhole brown"}, 5)) {
    d.coefficients = {p[0], p[1], p[3], p[4], p[2]};
  } else if (is({"fisheye", "fisheye4", "pinhole fisheye"}, 4)) {
    d.model = DistortionModel::kFisheye;
    d.coefficients = {p[0], p[1], p[2], p[3]};
    return d;
  } else {
    throw Error(concat(node.where(), ": the camera type '", type.substr(0, 60),
                       "' is not supported (known: pinhole, radial1, radial3, brown, fisheye); "
                       "export undistorted images"));
  }
  if (d.coefficients == std::array<double, 8>{}) d.model = DistortionModel::kNone;
  return d;
}

Lens read_lens(const JsonNode& node, const Version& version) {
  Lens lens;
  Intrinsics& k = lens.intrinsics;
  k.width = node["width"].size_in_pixels();
  k.height = node["height"].size_in_pixels();
  read_focal(node, version, k);
  const JsonNode principal = node["principalPoint"];
  k.cx = principal.at(0).number();
  k.cy = principal.at(1).number();
  if (version >= Version{1, 2, 1}) k.cx += 0.5 * k.width, k.cy += 0.5 * k.height;
  lens.distortion = read_distortion(node);
  return lens;
}

Pose read_pose(const JsonNode& node) {
  const JsonNode transform = node["pose"]["transform"];
  const JsonNode r = transform["rotation"], c = transform["center"];
  glm::dmat3 rotation;
  for (int i = 0; i < 9; ++i) rotation[i / 3][i % 3] = r.at(std::size_t(i)).number();
  return pose_at(checked_rotation(rotation, r.where(), "the rotation"),
                 {c.at(0).number(), c.at(1).number(), c.at(2).number()});
}

/// The entries of a list by one of their fields.
std::map<std::string, JsonNode> by_id(const JsonNode& root, const char* list, const char* id) {
  std::map<std::string, JsonNode> found;
  const auto nodes = root.find(list);
  for (std::size_t i = 0; nodes && i < nodes->size(); ++i)
    found.emplace(nodes->at(i)[id].identifier(), nodes->at(i));
  return found;
}

/// Places in views without a pose are passed over.
void read_track(const JsonNode& point, const std::map<std::string, std::size_t>& index,
                RawScene& scene) {
  const auto list = point.find("observations");
  RawTrack track;
  for (std::size_t i = 0; list && i < list->size(); ++i) {
    const JsonNode place = list->at(i);
    const auto view = index.find(place["observationId"].identifier());
    const JsonNode x = place["x"];
    if (view != index.end())
      track.observations.push_back({view->second, {x.at(0).number(), x.at(1).number()}});
  }
  if (track.observations.size() >= 2) scene.tracks.push_back(std::move(track));
}

ordered_json lens_json(const SourceView& view, std::size_t index) {
  require_no_skew(view, "AliceVision");
  const Intrinsics& k = view.camera.intrinsics;
  const std::array<double, 8>& c = view.distortion.coefficients;
  std::string type = "pinhole";
  ordered_json parameters = ordered_json::array();
  if (view.distortion.model == DistortionModel::kFisheye) {
    type = "fisheye4";
    parameters = {number_text(c[0]), number_text(c[1]), number_text(c[2]), number_text(c[3])};
  } else if (view.distortion.model == DistortionModel::kBrown && c[5] == 0 && c[6] == 0 &&
             c[7] == 0) {
    type = "brown";
    for (const int i : {0, 1, 4, 2, 3}) parameters.push_back(number_text(c[i]));
  } else {
    require_pinhole(view, "AliceVision");
  }
  const std::string focal = number_text(k.fx * kSensorWidth / k.width);
  return {
      {"intrinsicId", std::to_string(index)},
      {"width", std::to_string(k.width)},
      {"height", std::to_string(k.height)},
      {"sensorWidth", number_text(kSensorWidth)},
      {"sensorHeight", number_text(kSensorWidth * k.height / k.width)},
      {"serialNumber", ""},
      {"type", type},
      {"initializationMode", "calibrated"},
      {"initialFocalLength", focal},
      {"focalLength", focal},
      {"pixelRatio", number_text(k.fy / k.fx)},
      {"pixelRatioLocked", "true"},
      {"principalPoint", {number_text(k.cx - 0.5 * k.width), number_text(k.cy - 0.5 * k.height)}},
      {"distortionInitializationMode", "calibrated"},
      {"distortionParams", parameters},
      {"undistortionOffset", {"0", "0"}},
      {"undistortionParams", ""},
      {"locked", "true"}};
}

ordered_json pose_json(const Camera& camera, std::size_t index) {
  ordered_json rotation = ordered_json::array(), center = rotation;
  for (int i = 0; i < 9; ++i)
    rotation.push_back(number_text(camera.cam_from_world.rotation[i / 3][i % 3]));
  for (int axis = 0; axis < 3; ++axis) center.push_back(number_text(camera.center()[axis]));
  return {{"poseId", std::to_string(index)},
          {"pose", {{"transform", {{"rotation", rotation}, {"center", center}}}, {"locked", "1"}}}};
}

}  // namespace

fs::path find_alicevision(const fs::path& folder) {
  if (is_file(folder / "cameras.sfm")) return folder / "cameras.sfm";
  return only_file_ending(folder, ".sfm");
}

bool is_alicevision(const fs::path& file) { return file.extension() == ".sfm"; }

RawScene read_alicevision(const fs::path& file) {
  const nlohmann::json json = parse_json(file);
  const JsonNode root(json, file.string());
  RawScene scene;
  scene.format = SceneFormat::kAliceVision;
  scene.file = file;
  const fs::path folder = folder_of(file);
  scene.image_folders = {folder, folder / "images", folder / ".." / "images"};
  const Version version = read_version(root);
  const auto lenses = by_id(root, "intrinsics", "intrinsicId");
  const auto poses = by_id(root, "poses", "poseId");
  const JsonNode views = root["views"];
  std::size_t left_out = 0;
  std::map<std::string, std::size_t> index;  // of each viewId
  for (std::size_t i = 0; i < views.size(); ++i) {
    const JsonNode v = views.at(i);
    if (v.find("rigId"))
      throw Error(v.where() + ": poses of rigs are not read; export cameras without a rig");
    const auto lens = lenses.find(v["intrinsicId"].identifier());
    const auto pose = poses.find(v["poseId"].identifier());
    if (lens == lenses.end() || pose == poses.end()) {
      ++left_out;
      continue;
    }
    RawView view;
    view.where = v.where();
    view.listed = v["path"].text();
    const Lens read = read_lens(lens->second, version);
    view.camera = {read.intrinsics, read_pose(pose->second)};
    view.distortion = read.distortion;
    if (const auto id = v.find("viewId")) index[id->identifier()] = scene.views.size();
    scene.views.push_back(std::move(view));
  }
  if (const auto points = root.find("structure"); points && points->json().is_array())
    for (std::size_t i = 0; i < points->size(); ++i) {
      const JsonNode x = points->at(i)["X"];
      scene.points.emplace_back(x.at(0).number(), x.at(1).number(), x.at(2).number());
      read_track(points->at(i), index, scene);
    }
  if (left_out > 0)
    scene.warnings.push_back(concat(file.string(), ": ", left_out, " of ", views.size(),
                                    " images have no pose and are left out"));
  return scene;
}

void write_alicevision(const Scene& scene, const fs::path& folder) {
  make_folder(folder);
  ordered_json views = ordered_json::array(), lenses = views, poses = views, points = views;
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    const SourceView& view = scene.views[i];
    const std::string id = std::to_string(i);
    views.push_back({{"viewId", id},
                     {"poseId", id},
                     {"intrinsicId", id},
                     {"path", listed_name(view, folder, {".", "images"})},
                     {"width", std::to_string(view.camera.intrinsics.width)},
                     {"height", std::to_string(view.camera.intrinsics.height)}});
    lenses.push_back(lens_json(view, i));
    poses.push_back(pose_json(view.camera, i));
  }
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    ordered_json x = ordered_json::array();
    for (int axis = 0; axis < 3; ++axis) x.push_back(number_text(scene.points[i][axis]));
    points.push_back({{"landmarkId", std::to_string(i)},
                      {"descType", "unknown"},
                      {"color", {"128", "128", "128"}},
                      {"X", x}});
  }
  const ordered_json root = {{"version", {"1", "2", "6"}},
                             {"views", views},
                             {"intrinsics", lenses},
                             {"poses", poses},
                             {"structure", points}};
  write_atomically(folder / "cameras.sfm", json_text(root));
  write_bbox_file(scene, folder);
}

}  // namespace photohull::io
