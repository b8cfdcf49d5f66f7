// COLMAP sparse models, text and binary, without observations
// (https://colmap.github.io/format.html).
#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <sstream>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/colmap_model.h"
#include "io/write_scene.h"
#include "io/write_scene_parts.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

struct CameraEntry {
  const ColmapLens* lens = nullptr;
  int width = 0, height = 0;
  std::vector<double> parameters;

  bool operator==(const CameraEntry&) const = default;
};

struct ImageEntry {
  double quaternion[4];  ///< w x y z
  glm::dvec3 translation;
  std::uint32_t camera = 0;  ///< index of a CameraEntry; ids count from 1
  std::string name;
};

struct Model {
  std::vector<CameraEntry> cameras;
  std::vector<ImageEntry> images;
};

CameraEntry camera_entry(const SourceView& view) {
  require_no_skew(view, "COLMAP");
  const Intrinsics& k = view.camera.intrinsics;
  const std::array<double, 8>& c = view.distortion.coefficients;
  const char* name = "PINHOLE";
  if (view.distortion.model == DistortionModel::kPolynomial ||
      view.distortion.model == DistortionModel::kMeasured)
    refuse_distortion(view, "COLMAP");
  if (view.distortion.model == DistortionModel::kFisheye) name = "OPENCV_FISHEYE";
  if (view.distortion.model == DistortionModel::kBrown)
    name = c[4] == 0 && c[5] == 0 && c[6] == 0 && c[7] == 0 ? "OPENCV" : "FULL_OPENCV";
  CameraEntry entry{&colmap_lens(name, view.name), k.width, k.height, {}};
  entry.parameters = {k.fx, k.fy, k.cx + 0.5, k.cy + 0.5};
  entry.parameters.insert(entry.parameters.end(), c.begin(),
                          c.begin() + entry.lens->parameters - 4);
  return entry;
}

Model model_of(const Scene& scene, const fs::path& folder) {
  Model model;
  for (const SourceView& view : scene.views) {
    const CameraEntry entry = camera_entry(view);
    const auto shared = std::find(model.cameras.begin(), model.cameras.end(), entry);
    const Pose& pose = view.camera.cam_from_world;
    const glm::dquat q = glm::normalize(glm::quat_cast(pose.rotation));
    model.images.push_back(
        {{q.w, q.x, q.y, q.z},
         pose.translation,
         std::uint32_t(shared - model.cameras.begin()),
         listed_name(view, folder, {".", "images", "../images", "../../images"})});
    if (shared == model.cameras.end()) model.cameras.push_back(entry);
  }
  return model;
}

/// Grows a binary file's contents, little-endian and unaligned.
class Bytes {
 public:
  template <typename T>
  void add(T value) {
    const char* first = reinterpret_cast<const char*>(&value);
    bytes_.append(first, sizeof value);
  }
  void add_string(const std::string& text) { bytes_.append(text.c_str(), text.size() + 1); }
  const std::string& contents() const { return bytes_; }

 private:
  std::string bytes_;
};

/// The formats want a reprojection error; points here were not triangulated from observations.
constexpr double kUnknownError = -1.0;

}  // namespace

void write_colmap_text(const Scene& scene, const fs::path& folder) {
  make_folder(folder);
  const Model model = model_of(scene, folder);
  std::ostringstream cameras, images, points;
  cameras << "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]\n";
  for (std::size_t i = 0; i < model.cameras.size(); ++i) {
    const CameraEntry& camera = model.cameras[i];
    cameras << i + 1 << " " << camera.lens->name << " " << camera.width << " " << camera.height;
    for (const double value : camera.parameters) cameras << " " << number_text(value);
    cameras << "\n";
  }
  images << "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then POINTS2D[] (none here)\n";
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    const ImageEntry& image = model.images[i];
    images << i + 1;
    for (const double value : image.quaternion) images << " " << number_text(value);
    for (int axis = 0; axis < 3; ++axis) images << " " << number_text(image.translation[axis]);
    images << " " << image.camera + 1 << " " << image.name << "\n\n";
  }
  points << "# POINT3D_ID X Y Z R G B ERROR TRACK[]\n";
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    points << i + 1;
    for (int axis = 0; axis < 3; ++axis) points << " " << number_text(scene.points[i][axis]);
    points << " 0 0 0 " << kUnknownError << "\n";
  }
  write_atomically(folder / "cameras.txt", cameras.str());
  write_atomically(folder / "images.txt", images.str());
  write_atomically(folder / "points3D.txt", points.str());
  write_bbox_file(scene, folder);
}

void write_colmap_binary(const Scene& scene, const fs::path& folder) {
  make_folder(folder);
  const Model model = model_of(scene, folder);
  Bytes cameras, images, points;
  cameras.add(std::uint64_t(model.cameras.size()));
  for (std::size_t i = 0; i < model.cameras.size(); ++i) {
    const CameraEntry& camera = model.cameras[i];
    cameras.add(std::uint32_t(i + 1));
    cameras.add(std::int32_t(camera.lens->id));
    cameras.add(std::uint64_t(camera.width));
    cameras.add(std::uint64_t(camera.height));
    for (const double value : camera.parameters) cameras.add(value);
  }
  images.add(std::uint64_t(model.images.size()));
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    const ImageEntry& image = model.images[i];
    images.add(std::uint32_t(i + 1));
    for (const double value : image.quaternion) images.add(value);
    for (int axis = 0; axis < 3; ++axis) images.add(image.translation[axis]);
    images.add(std::uint32_t(image.camera + 1));
    images.add_string(image.name);
    images.add(std::uint64_t(0));  // observations
  }
  points.add(std::uint64_t(scene.points.size()));
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    points.add(std::uint64_t(i + 1));
    for (int axis = 0; axis < 3; ++axis) points.add(scene.points[i][axis]);
    for (int channel = 0; channel < 3; ++channel) points.add(std::uint8_t(0));
    points.add(kUnknownError);
    points.add(std::uint64_t(0));  // track length
  }
  write_atomically(folder / "cameras.bin", cameras.contents());
  write_atomically(folder / "images.bin", images.contents());
  write_atomically(folder / "points3D.bin", points.contents());
  write_bbox_file(scene, folder);
}

}  // namespace photohull::io
