// What `photohull calibrate` writes, and photographs taken by the same camera, rig or turntable.
// Axes, pixels and coefficients are ours.
#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"
#include "core/option_word.h"
#include "io/camera_checks.h"
#include "io/find_files.h"
#include "io/json_file.h"
#include "io/load_scene.h"
#include "io/pose_parts.h"
#include "io/scene_readers.h"
#include "io/text_file.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr const char* kMark = "photohull_calibration";

glm::dvec3 read_triple(const JsonNode& node) {
  return {node.at(0).number(), node.at(1).number(), node.at(2).number()};
}

std::array<double, 9> read_rows(const JsonNode& node) {
  std::array<double, 9> rows;
  for (std::size_t i = 0; i < 9; ++i) rows[i] = node.at(i / 3).at(i % 3).number();
  return rows;
}

CameraLens lens_at(const JsonNode& node) {
  CameraLens lens;
  lens.intrinsics = intrinsics_of(read_rows(node["camera_matrix"]), node.where());
  lens.intrinsics.width = node["image_width"].size_in_pixels();
  lens.intrinsics.height = node["image_height"].size_in_pixels();
  const std::string model = node["model"].text();
  if (model == "fisheye")
    lens.distortion.model = DistortionModel::kFisheye;
  else if (model == "brown" || model == "rational")
    lens.distortion.model = DistortionModel::kBrown;
  else if (model != "pinhole")
    throw Error(concat(node.where(), ": the lens '", model.substr(0, 40),
                       "' is not known (pinhole, brown, rational, fisheye)"));
  const JsonNode terms = node["distortion_coefficients"];
  if (terms.size() > lens.distortion.coefficients.size())
    throw Error(concat(terms.where(), ": ", terms.size(), " coefficients are too many"));
  for (std::size_t i = 0; i < terms.size(); ++i)
    lens.distortion.coefficients[i] = terms.at(i).number();
  return lens;
}

Pose read_pose(const JsonNode& node) {
  return {checked_rotation(from_rows(read_rows(node["R"])), node.where(), "R"),
          read_triple(node["t"])};
}

RawView make_view(const CameraLens& lens, const Pose& pose, const std::string& listed,
                  const std::string& where) {
  RawView view;
  view.listed = listed;
  view.where = where;
  view.camera = {lens.intrinsics, pose};
  view.distortion = lens.distortion;
  return view;
}

/// CAMERA.png, or of CAMERA/ the only picture or the one of that moment.
std::string image_of_camera(const CalibratedImages& images, const std::string& camera) {
  if (images.moment.empty()) {
    const fs::path single = find_image(camera, {images.folder});
    if (!single.empty()) return single.lexically_relative(images.folder).string();
  }
  std::vector<fs::path> inside = images_in(images.folder / camera);
  if (!images.moment.empty())
    std::erase_if(inside, [&](const fs::path& p) { return p.stem().string() != images.moment; });
  if (inside.size() == 1) return inside[0].lexically_relative(images.folder).string();
  const std::string there = (images.folder / camera).string();
  if (inside.empty())
    throw Error(concat("the rig's camera ", camera, " has no picture (looked for ", there,
                       ".* and ", there, "/",
                       images.moment.empty() ? std::string("*") : images.moment + ".*", ")"));
  throw Error(concat(there, " holds ", inside.size(), " pictures; say with ", option_word("moment"),
                     " which one"));
}

void read_rig(const JsonNode& root, const CalibratedImages& images, RawScene& scene) {
  const JsonNode cameras = root["cameras"];
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const JsonNode camera = cameras.at(i);
    scene.views.push_back(make_view(lens_at(camera), read_pose(camera),
                                    image_of_camera(images, camera["name"].text()),
                                    camera.where()));
  }
}

/// Pictures that the calibration names, wherever its own were.
void read_named(const JsonNode& root, const CalibratedImages& images, RawScene& scene) {
  const CameraLens lens = lens_at(root);
  const JsonNode views = root["views"];
  std::size_t without = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const JsonNode view = views.at(i);
    const std::string name = view["name"].text();
    const fs::path image = find_image(fs::path(name).stem().string(), {images.folder});
    if (image.empty()) continue;
    if (!view.find("R")) {
      ++without;
      continue;
    }
    scene.views.push_back(
        make_view(lens, read_pose(view), image.filename().string(), view.where()));
  }
  if (without > 0)
    scene.warnings.push_back(concat(scene.file.string(), ": ", without,
                                    " pictures have no pose, for the board was not found or did "
                                    "not fit, and are left out"));
}

/// The table's frame: z along the axis and up in the picture, the origin where the axis passes
/// nearest to the camera's, x towards the camera at angle 0.
Pose cam_from_table(const glm::dvec3& direction, const glm::dvec3& point) {
  const glm::dvec3 z = direction.y <= 0 ? direction : -direction;
  // Nearest to the optical axis (0, 0, s): both across.
  const glm::dvec2 d(direction), p(point);
  const double across = glm::dot(d, d);
  const glm::dvec3 origin = across > 1e-9 ? point - direction * (glm::dot(p, d) / across) : point;
  glm::dvec3 x = -origin - z * glm::dot(-origin, z);
  if (!(glm::length(x) > 1e-9 * (1 + glm::length(origin)))) x = glm::dvec3(z.y, -z.x, 0);
  x = glm::normalize(x);
  return {glm::dmat3(x, glm::cross(z, x), z), origin};
}

std::vector<double> angles_of(const CalibratedImages& images, std::size_t count) {
  std::vector<double> angles = images.angles;
  if (angles.empty())
    for (std::size_t i = 0; i < count; ++i) angles.push_back(double(i) * images.step.value());
  if (angles.size() != count)
    throw UsageError(concat(angles.size(), " angles are stated for the ", count, " pictures of ",
                            images.folder.string(), "; give one for each, in natural order"));
  return angles;
}

void read_turntable(const JsonNode& root, const CalibratedImages& images, RawScene& scene) {
  const CameraLens lens = lens_at(root);
  const JsonNode table = root["turntable"];
  const glm::dvec3 axis = read_triple(table["axis"]);
  if (!(std::abs(glm::length(axis) - 1) < 1e-3))
    throw Error(concat(table.where(), ": axis must have length 1"));
  const glm::dvec3 direction = glm::normalize(axis);
  const Pose base = cam_from_table(direction, read_triple(table["point"]));
  const auto add = [&](const fs::path& image, double degrees) {
    // Turning about the axis as it points is turning about z, or the other way.
    const double sense = glm::dot(base.rotation[2], direction) > 0 ? 1 : -1;
    const double a = sense * degrees * std::acos(-1.0) / 180;
    const glm::dmat3 turn(glm::dvec3(std::cos(a), std::sin(a), 0),
                          glm::dvec3(-std::sin(a), std::cos(a), 0), glm::dvec3(0, 0, 1));
    scene.views.push_back(make_view(lens, {base.rotation * turn, base.translation},
                                    image.filename().string(), image.string()));
  };
  if (images.step || !images.angles.empty()) {
    const std::vector<fs::path> files = images_in(images.folder);
    const std::vector<double> angles = angles_of(images, files.size());
    for (std::size_t i = 0; i < files.size(); ++i) add(files[i], angles[i]);
    return;
  }
  const JsonNode views = root["views"];
  for (std::size_t i = 0; i < views.size(); ++i) {
    const JsonNode view = views.at(i);
    const auto angle = view.find("angle_degrees");
    const fs::path image =
        find_image(fs::path(view["name"].text()).stem().string(), {images.folder});
    if (angle && !image.empty()) add(image, angle->number());
  }
}

}  // namespace

bool is_calibration(const fs::path& file) {
  return file.extension() == ".json" && file_head(file).find(kMark) != std::string::npos;
}

CameraLens calibrated_lens(const fs::path& file, const std::string& camera) {
  const nlohmann::json json = parse_json(file);
  const JsonNode root(json, file.string());
  if (root[kMark].text() != "rig") return lens_at(root);
  const JsonNode cameras = root["cameras"];
  std::string names;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::string name = cameras.at(i)["name"].text();
    if (name == camera) return lens_at(cameras.at(i));
    names += (i ? ", " : "") + name;
  }
  throw Error(concat(file.string(), ": is a rig's calibration with the cameras ",
                     names.substr(0, 200),
                     camera.empty() ? concat("; ", option_word("lens_from"),
                                             " takes one camera's, or give ", option_word("rig"))
                                    : ", and none is called " + camera));
}

RawScene read_calibration(const fs::path& file, const CalibratedImages& images) {
  const nlohmann::json json = parse_json(file);
  const JsonNode root(json, file.string());
  std::error_code failure;
  if (!fs::is_directory(images.folder, failure))
    throw Error(concat(images.folder.string(), ": is no folder of photographs (",
                       option_word("images"), ")"));
  RawScene scene;
  scene.format = SceneFormat::kOpenCv;
  scene.file = file;
  scene.image_folders = {images.folder};
  const std::string kind = root[kMark].text();
  const bool stepped = images.step || !images.angles.empty();
  if (stepped && kind != "turntable")
    throw UsageError(concat(option_word("step"), " and ", option_word("angles"),
                            " are for turntables; ", file.string(), " is a ", kind,
                            "'s calibration"));
  if (!images.moment.empty() && kind != "rig")
    throw UsageError(concat(option_word("moment"), " is for rigs; ", file.string(), " is a ", kind,
                            "'s calibration"));
  if (kind == "rig")
    read_rig(root, images, scene);
  else if (kind == "turntable")
    read_turntable(root, images, scene);
  else if (kind == "camera")
    read_named(root, images, scene);
  else
    throw Error(concat(root[kMark].where(), ": '", kind.substr(0, 40),
                       "' is not known (camera, rig, turntable)"));
  if (scene.views.empty())
    throw Error(concat(
        images.folder.string(), ": none of its pictures is called as one of ", file.string(),
        kind == "turntable" ? concat("; give ", option_word("step"), " or ", option_word("angles"))
                            : ""));
  return scene;
}

}  // namespace photohull::io
