// OpenCV's FileStorage, YAML, JSON or XML. Axes, pixels and coefficients are ours. Either a list
// "cameras" of maps with the names that OpenCV's calibration samples use (camera_matrix,
// distortion_coefficients, image_width, image_height, R, t, and image), or EasyMocap's pair
// intri.yml (K_NAME, dist_NAME) and extri.yml (Rot_NAME or the vector R_NAME, T_NAME).
#include <algorithm>
#include <cctype>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <opencv2/core/core.hpp>

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

/// Runs what may throw OpenCV's exceptions, and names the file where it does.
template <typename Call>
auto guarded(const fs::path& file, Call&& call) {
  try {
    return call();
  } catch (const Error&) {
    throw;
  } catch (const cv::Exception& failure) {
    throw Error(concat(file.string(), ": OpenCV cannot read it (", failure.err, ")"));
  } catch (const std::exception& failure) {  // its parser's strings and vectors
    throw Error(concat(file.string(), ": OpenCV cannot read it (", failure.what(), ")"));
  }
}

/// OpenCV's YAML parser does not come to an end on some files in which something follows what it
/// takes for the document: other documents, and what stands further left than a map's first key or
/// after a list in brackets. Files that OpenCV writes are one map, whose keys begin their lines.
void check_single_document(const std::string& text, const fs::path& file) {
  constexpr std::size_t kFirstLines = 2;  // %YAML:1.0 and ---
  if (!text.starts_with('%')) return;
  std::size_t line = 0;
  bool in_map = false;
  for (std::size_t at = 0; at < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view content = std::string_view(text).substr(at, end - at);
    const bool marks = content.starts_with("---") || content.starts_with("...");
    if (line == 0 ? content.find("---") != std::string_view::npos
                  : (marks && (line >= kFirstLines || trimmed(content) != "---")) ||
                        content.find('%') != std::string_view::npos)
      throw Error(concat(file.string(), " line ", line + 1,
                         ": must be one YAML document that opens with %YAML:1.0 and ---"));
    const std::string_view bare = trimmed(content);
    if (line > 0 && !in_map && !marks && !bare.empty() && bare[0] != '#') {
      const unsigned char first = static_cast<unsigned char>(content[0]);
      if (!std::isalpha(first) && first != '_')
        throw Error(concat(file.string(), " line ", line + 1,
                           ": must be a key that begins the line, as 'cameras:' does"));
      in_map = true;
    }
    at = end + 1;
  }
}

cv::FileStorage open(const fs::path& file) {
  const std::string text = read_text_file(file);
  check_single_document(text, file);
  cv::FileStorage storage;
  if (!storage.open(text, cv::FileStorage::READ | cv::FileStorage::MEMORY))
    throw Error(file.string() + ": is empty or no YAML, JSON or XML of OpenCV's");
  return storage;
}

/// OpenCV asks for the memory that rows and columns claim before it looks at the data.
void check_matrix_size(const cv::FileNode& node, const std::string& where) {
  constexpr double kMostNumbers = 1000;
  const cv::FileNode rows = node["rows"], columns = node["cols"];
  if (!rows.isInt() || !columns.isInt() || rows.real() < 0 || columns.real() < 0 ||
      rows.real() * columns.real() > kMostNumbers)
    throw Error(where + ": its rows and cols are no camera's");
}

/// A matrix or a plain list as numbers by rows; none where the node is absent.
std::vector<double> numbers_of(const cv::FileNode& node, const std::string& where) {
  std::vector<double> values;
  if (node.empty() || node.isNone()) return values;
  cv::Mat matrix;
  if (node.isMap()) {
    check_matrix_size(node, where);
    node >> matrix;
    if (matrix.channels() != 1) throw Error(where + ": must be a matrix of one channel");
    matrix.convertTo(matrix, CV_64F);
    for (int row = 0; row < matrix.rows; ++row)
      for (int column = 0; column < matrix.cols; ++column)
        values.push_back(matrix.at<double>(row, column));
  } else if (node.isSeq()) {
    for (const cv::FileNode& item : node) {
      if (!item.isReal() && !item.isInt()) throw Error(where + ": must hold numbers only");
      values.push_back(item.real());
    }
  } else {
    throw Error(where + ": must be a matrix");
  }
  for (const double value : values)
    if (!std::isfinite(value)) throw Error(where + ": holds a value that is not finite");
  return values;
}

std::vector<double> required(const cv::FileNode& parent, const std::string& key, std::size_t count,
                             const std::string& where) {
  std::vector<double> values = numbers_of(parent[key], concat(where, " ", key));
  if (values.size() != count)
    throw Error(concat(where, ": ", key, values.empty() ? " is missing" : " has ",
                       values.empty() ? "" : std::to_string(values.size()),
                       values.empty() ? ", but " : " numbers, but ", count, " are needed"));
  return values;
}

/// Coefficients in OpenCV's order; thin prism and tilt (after the eighth) must be zero.
Distortion distortion_of(std::vector<double> values, bool fisheye, const std::string& where) {
  Distortion d;
  if (values.size() > (fisheye ? 4 : 14))
    throw Error(concat(where, ": ", values.size(), " distortion coefficients are too many"));
  values.resize(14);
  for (std::size_t i = 8; i < 14; ++i)
    if (values[i] != 0)
      throw Error(where +
                  ": thin prism and tilted sensors are not supported; calibrate without "
                  "them or undistort the images");
  std::copy(values.begin(), values.begin() + 8, d.coefficients.begin());
  if (fisheye)
    d.model = DistortionModel::kFisheye;
  else if (d.coefficients != std::array<double, 8>{})
    d.model = DistortionModel::kBrown;
  return d;
}

glm::dmat3 rotation_from(const std::vector<double>& v, const std::string& where) {
  if (v.size() == 9)
    return checked_rotation(from_rows(std::span<const double, 9>(v.data(), 9)), where, "R");
  if (v.size() != 3) throw Error(where + ": R must be a 3x3 matrix or a rotation vector of 3");
  const glm::dvec3 turn(v[0], v[1], v[2]);
  const double angle = glm::length(turn);
  return angle > 0 ? glm::mat3_cast(glm::angleAxis(angle, turn / angle)) : glm::dmat3(1.0);
}

int size_of(const cv::FileNode& node, const std::string& where) {
  if (node.empty()) return 0;
  const double value = node.isInt() || node.isReal() ? node.real() : 0;
  if (!(value >= 1 && value <= 1e9) || value != std::floor(value))
    throw Error(where + ": the image size must be whole and positive");
  return int(value);
}

RawView read_entry(const cv::FileNode& node, const std::string& where) {
  RawView view;
  view.where = where;
  if (!node.isMap()) throw Error(where + ": must be a map");
  if (!node["image"].isString()) throw Error(where + ": image, the file's name, is missing");
  view.listed = node["image"].string();
  const std::vector<double> k = required(node, "camera_matrix", 9, where);
  view.camera.intrinsics = intrinsics_of(std::span<const double, 9>(k.data(), 9), where);
  view.camera.intrinsics.width = size_of(node["image_width"], where);
  view.camera.intrinsics.height = size_of(node["image_height"], where);
  const bool fisheye = node["model"].isString() && node["model"].string() == "fisheye";
  view.distortion =
      distortion_of(numbers_of(node["distortion_coefficients"], where), fisheye, where);
  const std::vector<double> t = required(node, "t", 3, where);
  view.camera.cam_from_world = {rotation_from(numbers_of(node["R"], where), where),
                                {t[0], t[1], t[2]}};
  return view;
}

void read_easymocap(const cv::FileStorage& intrinsics, const fs::path& file, RawScene& scene) {
  const cv::FileStorage poses = open(folder_of(file) / "extri.yml");
  for (const cv::FileNode& item : intrinsics["names"]) {
    if (!item.isString()) throw Error(file.string() + ": names must hold strings");
    RawView view;
    view.listed = item.string();
    view.where = concat(file.string(), " ", view.listed);
    const std::vector<double> k = required(intrinsics.root(), "K_" + view.listed, 9, view.where);
    view.camera.intrinsics = intrinsics_of(std::span<const double, 9>(k.data(), 9), view.where);
    view.distortion =
        distortion_of(numbers_of(intrinsics["dist_" + view.listed], view.where), false, view.where);
    std::vector<double> r = numbers_of(poses["Rot_" + view.listed], view.where);
    if (r.empty()) r = numbers_of(poses["R_" + view.listed], view.where);
    const std::vector<double> t = required(poses.root(), "T_" + view.listed, 3, view.where);
    view.camera.cam_from_world = {rotation_from(r, view.where), {t[0], t[1], t[2]}};
    scene.views.push_back(std::move(view));
  }
}

RawScene read(const fs::path& file) {
  RawScene scene;
  scene.format = SceneFormat::kOpenCv;
  scene.file = file.filename() == "extri.yml" ? folder_of(file) / "intri.yml" : file;
  const fs::path folder = folder_of(file);
  scene.image_folders = {folder, folder / "images"};
  const cv::FileStorage storage = open(scene.file);
  if (!storage["names"].empty() && storage["names"].isSeq()) {
    read_easymocap(storage, scene.file, scene);
    return scene;
  }
  const cv::FileNode cameras = storage["cameras"];
  if (!cameras.isSeq())
    throw Error(concat(file.string(),
                       ": there is neither a list 'cameras' nor EasyMocap's "
                       "'names'; a calibration alone has no poses"));
  for (std::size_t i = 0; i < cameras.size(); ++i)
    scene.views.push_back(read_entry(cameras[int(i)], concat(file.string(), " cameras[", i, "]")));
  return scene;
}

cv::Mat matrix_of(const glm::dmat3& m) {
  cv::Mat out(3, 3, CV_64F);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) out.at<double>(row, column) = m[column][row];
  return out;
}

}  // namespace

fs::path find_opencv(const fs::path& folder) {
  for (const char* name : {"intri.yml", "cameras.yml", "cameras.yaml", "opencv.json"})
    if (is_file(folder / name)) return folder / name;
  return {};
}

bool is_opencv(const fs::path& file) {
  const fs::path e = file.extension();
  if (e == ".yml" || e == ".yaml") return true;
  const std::string head = file_head(file);
  return (e == ".xml" && head.find("<opencv_storage") != std::string::npos) ||
         (e == ".json" && head.find("\"opencv-matrix\"") != std::string::npos);
}

RawScene read_opencv(const fs::path& file) {
  return guarded(file, [&] { return read(file); });
}

void write_opencv(const Scene& scene, const fs::path& folder) {
  make_folder(folder);
  cv::FileStorage out("cameras.yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
  out << "cameras"
      << "[";
  for (const SourceView& view : scene.views) {
    const DistortionModel model = view.distortion.model;
    if (model == DistortionModel::kPolynomial || model == DistortionModel::kMeasured)
      refuse_distortion(view, "OpenCV");
    const bool fisheye = model == DistortionModel::kFisheye;
    const Pose& pose = view.camera.cam_from_world;
    cv::Mat coefficients(1, fisheye ? 4 : 8, CV_64F), t(3, 1, CV_64F);
    for (int i = 0; i < coefficients.cols; ++i)
      coefficients.at<double>(i) = view.distortion.coefficients[i];
    for (int i = 0; i < 3; ++i) t.at<double>(i) = pose.translation[i];
    out << "{"
        << "image" << listed_name(view, folder, {".", "images"}) << "image_width"
        << view.camera.intrinsics.width << "image_height" << view.camera.intrinsics.height
        << "model" << (fisheye ? "fisheye" : "pinhole") << "camera_matrix"
        << matrix_of(view.camera.intrinsics.k()) << "distortion_coefficients" << coefficients << "R"
        << matrix_of(pose.rotation) << "t" << t << "}";
  }
  out << "]";
  write_atomically(folder / "cameras.yml", std::string(out.releaseAndGetString()));
  write_bbox_file(scene, folder);
}

}  // namespace photohull::io
