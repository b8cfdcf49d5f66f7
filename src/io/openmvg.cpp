// OpenMVG's sfm_data.json [Moulon16]: world-to-camera rotation by rows and the camera's centre,
// axes as ours, one focal length in pixels, pixel centres at whole numbers (as its image
// undistortion samples). The lists of views, intrinsics and extrinsics refer to each other by
// number; types of intrinsics are named where they first occur (cereal's polymorphic_id).
#include <cmath>
#include <map>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/camera_checks.h"
#include "io/find_files.h"
#include "io/json_file.h"
#include "io/pose_parts.h"
#include "io/scene_readers.h"
#include "io/write_scene_parts.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

using nlohmann::ordered_json;

/// cereal marks a type's first occurrence, where its name is written, by the highest bit.
constexpr std::int64_t kNewType = std::int64_t(1) << 31;

struct Lens {
  Intrinsics intrinsics;
  Distortion distortion;
};

glm::dvec3 read_triple(const JsonNode& node) {
  return {node.at(0).number(), node.at(1).number(), node.at(2).number()};
}

glm::dmat3 read_rotation(const JsonNode& node) {
  glm::dmat3 rows;
  for (int row = 0; row < 3; ++row) rows[row] = read_triple(node.at(row));
  return checked_rotation(glm::transpose(rows), node.where(), "the rotation");
}

/// The numbers of a field such as "disto_k3".
void read_terms(const JsonNode& data, const char* key, std::initializer_list<int> places,
                Distortion& distortion) {
  const JsonNode terms = data[key];
  std::size_t i = 0;
  for (const int place : places) distortion.coefficients[place] = terms.at(i++).number();
}

Lens read_lens(const std::string& type, const JsonNode& data) {
  Lens lens;
  // Newer files nest what all pinholes share.
  const JsonNode base = data.find("value0").value_or(data);
  Intrinsics& k = lens.intrinsics;
  k.width = base["width"].size_in_pixels();
  k.height = base["height"].size_in_pixels();
  k.fx = k.fy = base["focal_length"].number();
  k.cx = base["principal_point"].at(0).number();
  k.cy = base["principal_point"].at(1).number();
  Distortion& d = lens.distortion;
  if (type == "pinhole") return lens;
  d.model = DistortionModel::kBrown;
  if (type == "pinhole_radial_k1") {
    read_terms(data, "disto_k1", {0}, d);
  } else if (type == "pinhole_radial_k3") {
    read_terms(data, "disto_k3", {0, 1, 4}, d);
  } else if (type == "pinhole_brown_t2") {
    read_terms(data, "disto_t2", {0, 1, 4, 2, 3}, d);
  } else if (type == "fisheye") {
    d.model = DistortionModel::kFisheye;
    read_terms(data, "fisheye", {0, 1, 2, 3}, d);
    return lens;
  } else {
    throw Error(concat(data.where(), ": the camera type '", type.substr(0, 40),
                       "' is not supported (known: pinhole, pinhole_radial_k1, "
                       "pinhole_radial_k3, pinhole_brown_t2, fisheye); undistort the images"));
  }
  if (d.coefficients == std::array<double, 8>{}) d.model = DistortionModel::kNone;
  return lens;
}

std::map<std::string, Lens> read_lenses(const JsonNode& root) {
  std::map<std::string, Lens> lenses;
  std::map<std::int64_t, std::string> types;
  const JsonNode list = root["intrinsics"];
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonNode entry = list.at(i), value = entry["value"];
    const auto id = std::int64_t(value["polymorphic_id"].number());
    if (const auto name = value.find("polymorphic_name")) types[id & (kNewType - 1)] = name->text();
    lenses[entry["key"].identifier()] =
        read_lens(types[id & (kNewType - 1)], value["ptr_wrapper"]["data"]);
  }
  return lenses;
}

std::map<std::string, Pose> read_poses(const JsonNode& root) {
  std::map<std::string, Pose> poses;
  const JsonNode list = root["extrinsics"];
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonNode value = list.at(i)["value"];
    poses[list.at(i)["key"].identifier()] =
        pose_at(read_rotation(value["rotation"]), read_triple(value["center"]));
  }
  return poses;
}

/// Places in views without a pose are passed over.
void read_track(const JsonNode& point, const std::map<std::string, std::size_t>& index,
                RawScene& scene) {
  const auto list = point.find("observations");
  RawTrack track;
  for (std::size_t i = 0; list && i < list->size(); ++i) {
    const JsonNode place = list->at(i);
    const auto view = index.find(place["key"].identifier());
    const JsonNode x = place["value"]["x"];
    if (view != index.end())
      track.observations.push_back({view->second, {x.at(0).number(), x.at(1).number()}});
  }
  if (track.observations.size() >= 2) scene.tracks.push_back(std::move(track));
}

ordered_json lens_json(const SourceView& view, std::size_t index) {
  require_no_skew(view, "OpenMVG");
  require_square_pixels(view, "OpenMVG");
  const Intrinsics& k = view.camera.intrinsics;
  const std::array<double, 8>& c = view.distortion.coefficients;
  ordered_json data = {{"width", k.width},
                       {"height", k.height},
                       {"focal_length", k.fx},
                       {"principal_point", {k.cx, k.cy}}};
  std::string type = "pinhole";
  if (view.distortion.model == DistortionModel::kFisheye) {
    type = "fisheye";
    data["fisheye"] = {c[0], c[1], c[2], c[3]};
  } else if (view.distortion.model == DistortionModel::kBrown && c[5] == 0 && c[6] == 0 &&
             c[7] == 0) {
    type = "pinhole_brown_t2";
    data["disto_t2"] = {c[0], c[1], c[4], c[2], c[3]};
  } else {
    require_pinhole(view, "OpenMVG");
  }
  // Each entry names its type as if it were the first of it.
  return {{"key", index},
          {"value",
           {{"polymorphic_id", kNewType + std::int64_t(index) + 1},
            {"polymorphic_name", type},
            {"ptr_wrapper", {{"id", kNewType + std::int64_t(index) + 1}, {"data", data}}}}}};
}

}  // namespace

fs::path find_openmvg(const fs::path& folder) {
  for (const char* name : {"sfm_data.json", "sfm_data_perspective.json"})
    if (fs::exists(folder / name)) return folder / name;
  return {};
}

bool is_openmvg(const fs::path& file) {
  return file.extension() == ".json" &&
         file_head(file).find("\"sfm_data_version\"") != std::string::npos;
}

RawScene read_openmvg(const fs::path& file) {
  const nlohmann::json json = parse_json(file);
  const JsonNode root(json, file.string());
  RawScene scene;
  scene.format = SceneFormat::kOpenMvg;
  scene.file = file;
  const fs::path folder = folder_of(file);
  const std::string images = root.text("root_path", "");
  scene.image_folders = {folder / images, folder, folder / "images", folder / ".." / "images"};
  const std::map<std::string, Lens> lenses = read_lenses(root);
  const std::map<std::string, Pose> poses = read_poses(root);
  const JsonNode views = root["views"];
  std::size_t left_out = 0;
  std::map<std::string, std::size_t> index;  // of each view's key
  for (std::size_t i = 0; i < views.size(); ++i) {
    const JsonNode data = views.at(i)["value"]["ptr_wrapper"]["data"];
    // Files without polymorphic views hold the fields here, others one level deeper.
    const JsonNode v = data.find("value0").value_or(data);
    const auto lens = lenses.find(v["id_intrinsic"].identifier());
    const auto pose = poses.find(v["id_pose"].identifier());
    if (lens == lenses.end() || pose == poses.end()) {
      ++left_out;
      continue;
    }
    RawView view;
    view.where = v.where();
    view.listed = (fs::path(v.text("local_path", "")) / v["filename"].text()).string();
    view.camera = {lens->second.intrinsics, pose->second};
    view.distortion = lens->second.distortion;
    if (const auto key = views.at(i).find("key")) index[key->identifier()] = scene.views.size();
    scene.views.push_back(std::move(view));
  }
  if (const auto points = root.find("structure"))
    for (std::size_t i = 0; i < points->size(); ++i) {
      const JsonNode value = points->at(i)["value"];
      scene.points.push_back(read_triple(value["X"]));
      read_track(value, index, scene);
    }
  if (left_out > 0)
    scene.warnings.push_back(concat(file.string(), ": ", left_out, " of ", views.size(),
                                    " images have no pose and are left out"));
  return scene;
}

void write_openmvg(const Scene& scene, const fs::path& folder) {
  make_folder(folder);
  ordered_json views = ordered_json::array(), lenses = views, poses = views, points = views;
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    const SourceView& view = scene.views[i];
    const Intrinsics& k = view.camera.intrinsics;
    const ordered_json data = {
        {"local_path", ""}, {"filename", listed_name(view, folder, {".", "images"})},
        {"width", k.width}, {"height", k.height},
        {"id_view", i},     {"id_intrinsic", i},
        {"id_pose", i}};
    views.push_back({{"key", i},
                     {"value",
                      {{"polymorphic_id", 1 << 30},
                       {"ptr_wrapper", {{"id", kNewType + i + 1}, {"data", data}}}}}});
    lenses.push_back(lens_json(view, i));
    const glm::dmat3& r = view.camera.cam_from_world.rotation;
    ordered_json rows = ordered_json::array();
    for (int row = 0; row < 3; ++row) rows.push_back({r[0][row], r[1][row], r[2][row]});
    const glm::dvec3 c = view.camera.center();
    poses.push_back({{"key", i}, {"value", {{"rotation", rows}, {"center", {c.x, c.y, c.z}}}}});
  }
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    const glm::dvec3& p = scene.points[i];
    points.push_back(
        {{"key", i}, {"value", {{"X", {p.x, p.y, p.z}}, {"observations", ordered_json::array()}}}});
  }
  const ordered_json root = {{"sfm_data_version", "0.3"},
                             {"root_path", ""},
                             {"views", views},
                             {"intrinsics", lenses},
                             {"extrinsics", poses},
                             {"structure", points},
                             {"control_points", ordered_json::array()}};
  write_atomically(folder / "sfm_data.json", json_text(root));
  write_bbox_file(scene, folder);
}

}  // namespace photohull::io
