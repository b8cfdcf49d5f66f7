// Lens models and conventions of COLMAP's sparse models (Schoenberger and Frahm, CVPR 2016;
// https://colmap.github.io/cameras.html and format.html).
#include "io/colmap_model.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "core/error.h"
#include "io/camera_checks.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr ColmapLens kLenses[] = {
    {"SIMPLE_PINHOLE", 0, 3, true, DistortionModel::kNone},
    {"PINHOLE", 1, 4, false, DistortionModel::kNone},
    {"SIMPLE_RADIAL", 2, 4, true, DistortionModel::kBrown},
    {"RADIAL", 3, 5, true, DistortionModel::kBrown},
    {"OPENCV", 4, 8, false, DistortionModel::kBrown},
    {"OPENCV_FISHEYE", 5, 8, false, DistortionModel::kFisheye},
    {"FULL_OPENCV", 6, 12, false, DistortionModel::kBrown},
    {"SIMPLE_RADIAL_FISHEYE", 8, 4, true, DistortionModel::kFisheye},
    {"RADIAL_FISHEYE", 9, 5, true, DistortionModel::kFisheye},
};

[[noreturn]] void unknown_lens(const std::string& model, const std::string& where) {
  std::string known;
  for (const ColmapLens& lens : kLenses)
    known += (known.empty() ? "" : ", ") + std::string(lens.name);
  throw Error(concat(where, ": the camera model ", model, " is not supported (known: ", known,
                     "); undistort the images with COLMAP's image_undistorter"));
}

}  // namespace

const ColmapLens& colmap_lens(std::string_view name, const std::string& where) {
  for (const ColmapLens& lens : kLenses)
    if (name == lens.name) return lens;
  unknown_lens(concat("'", name.substr(0, 40), "'"), where);
}

const ColmapLens& colmap_lens(int id, const std::string& where) {
  for (const ColmapLens& lens : kLenses)
    if (id == lens.id) return lens;
  // Named, since these two are common; the file itself only holds the number.
  const char* name = id == 7 ? " (FOV)" : id == 10 ? " (THIN_PRISM_FISHEYE)" : "";
  unknown_lens(concat("number ", id, name), where);
}

ColmapCamera make_colmap_camera(const ColmapLens& lens, std::uint64_t width, std::uint64_t height,
                                std::span<const double> parameters, const std::string& where) {
  constexpr std::uint64_t kLargest = 1'000'000'000;
  PHOTOHULL_CHECK_OP(parameters.size(), ==, std::size_t(lens.parameters));
  if (width == 0 || height == 0 || width > kLargest || height > kLargest)
    throw Error(concat(where, ": the image size ", width, " x ", height, " is impossible"));
  ColmapCamera camera;
  Intrinsics& k = camera.intrinsics;
  const std::size_t focals = lens.one_focal ? 1 : 2;
  k.width = int(width);
  k.height = int(height);
  k.fx = parameters[0];
  k.fy = parameters[focals - 1];
  k.cx = parameters[focals];
  k.cy = parameters[focals + 1];
  // The coefficients come in OpenCV's order, as ours; shorter models leave out the last ones.
  const std::span<const double> coefficients = parameters.subspan(focals + 2);
  for (std::size_t i = 0; i < coefficients.size(); ++i)
    camera.distortion.coefficients[i] = coefficients[i];
  // A fisheye without coefficients still is no pinhole.
  if (lens.distortion == DistortionModel::kFisheye ||
      camera.distortion.coefficients != std::array<double, 8>{})
    camera.distortion.model = lens.distortion;
  check_camera({k, {}}, camera.distortion, where);
  return camera;
}

RawView make_colmap_view(std::string name, std::span<const double, 4> quaternion,
                         const glm::dvec3& translation, std::uint32_t camera_id,
                         const ColmapCameras& cameras, const std::string& where) {
  const auto camera = cameras.find(camera_id);
  if (camera == cameras.end())
    throw Error(concat(where, ": the image refers to camera ", camera_id,
                       ", which the cameras file does not list"));
  if (name.empty()) throw Error(concat(where, ": the image name is empty"));
  const glm::dquat q(quaternion[0], quaternion[1], quaternion[2], quaternion[3]);
  if (!(std::abs(glm::length(q) - 1.0) <= 1e-3))
    throw Error(concat(where, ": the quaternion QW QX QY QZ has length ", glm::length(q),
                       ", but a rotation needs length 1"));
  RawView view;
  view.listed = std::move(name);
  view.where = where;
  view.camera.intrinsics = camera->second.intrinsics;
  view.distortion = camera->second.distortion;
  view.camera.cam_from_world = {glm::mat3_cast(glm::normalize(q)), translation};
  return view;
}

RawScene begin_colmap_scene(const fs::path& folder, SceneFormat format) {
  RawScene scene;
  scene.format = format;
  scene.pixel_center = 0.5;
  scene.image_folders = {folder, folder / "images", folder / ".." / "images",
                         folder / ".." / ".." / "images"};
  return scene;
}

}  // namespace photohull::io
