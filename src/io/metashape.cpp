// Agisoft Metashape's cameras as XML: camera-to-chunk matrices, axes as ours, and the chunk's
// rotation, translation and scale to the world. Focal length in pixels, principal point from the
// image's centre (from the corner in files with fx and fy), pixel centres at (0.5, 0.5).
// Distortion: Metashape Professional manual, appendix "Camera models"; its P1 is OpenCV's p2.
#include <cmath>
#include <map>
#include <pugixml.hpp>
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

struct Lens {
  Intrinsics intrinsics;
  Distortion distortion;
};

/// World from chunk: scale * rotation * x + translation.
struct Similarity {
  glm::dmat3 rotation{1.0};
  glm::dvec3 translation{0.0};
  double scale = 1;

  glm::dvec3 operator()(const glm::dvec3& p) const { return scale * (rotation * p) + translation; }
};

std::string where_of(const fs::path& file, const pugi::xml_node& node) {
  std::string text = concat(file.string(), " ", node.name());
  for (const char* key : {"id", "label"})
    if (const auto attribute = node.attribute(key))
      text += concat(" ", key, " ", attribute.value());
  return text;
}

std::vector<double> read_numbers_of(const pugi::xml_node& node, std::size_t count,
                                    const std::string& where) {
  const std::vector<std::string_view> fields = split_fields(node.child_value());
  if (fields.size() != count)
    throw Error(concat(where, ": ", node.name(), " has ", fields.size(), " numbers, but ", count,
                       " are needed"));
  std::vector<double> values;
  for (const std::string_view field : fields) {
    const auto value = parse_double(field);
    if (!value || !std::isfinite(*value))
      throw Error(concat(where, ": ", node.name(), " holds something that is no finite number"));
    values.push_back(*value);
  }
  return values;
}

/// A number, or what it is when absent.
double read_number(const pugi::xml_node& parent, const char* name, double absent,
                   const std::string& where) {
  const pugi::xml_node node = parent.child(name);
  return node ? read_numbers_of(node, 1, where)[0] : absent;
}

int read_size(const pugi::xml_node& node, const char* key, const std::string& where) {
  const auto value = parse_integer(node.attribute(key).value());
  if (!value || *value < 1 || *value > 1'000'000'000)
    throw Error(concat(where, ": resolution needs a positive ", key));
  return int(*value);
}

/// Frame cameras: (1 + k1 r^2 + ... + k4 r^8), p1 and p2. Fisheyes: the same polynomial of the
/// angle, without p1 and p2.
Distortion read_distortion(const pugi::xml_node& calibration, bool fisheye, bool swapped,
                           const std::string& where) {
  const auto number = [&](const char* name) { return read_number(calibration, name, 0, where); };
  for (const char* name : {"p3", "p4"})
    if (number(name) != 0)
      throw Error(concat(where, ": ", name,
                         " is not 0, which is not supported; calibrate without "
                         "it or export undistorted images"));
  const double k1 = number("k1"), k2 = number("k2"), k3 = number("k3"), k4 = number("k4");
  const double p1 = number(swapped ? "p2" : "p1"), p2 = number(swapped ? "p1" : "p2");
  if (fisheye) {
    if (p1 != 0 || p2 != 0)
      throw Error(where + ": p1 and p2 of a fisheye are not supported; calibrate without them");
    return {DistortionModel::kFisheye, {k1, k2, k3, k4}};
  }
  Distortion d{DistortionModel::kBrown, {k1, k2, p1, p2, k3, k4}};
  if (k4 != 0) d.model = DistortionModel::kPolynomial;
  if (d.coefficients == std::array<double, 8>{}) d.model = DistortionModel::kNone;
  return d;
}

Lens read_lens(const pugi::xml_node& sensor, const std::string& where) {
  pugi::xml_node calibration = sensor.find_child_by_attribute("calibration", "class", "adjusted");
  if (!calibration) calibration = sensor.child("calibration");
  if (!calibration) throw Error(where + ": calibration is missing; align the photos first");
  const std::string type = calibration.attribute("type").as_string("frame");
  if (type != "frame" && type != "fisheye")
    throw Error(concat(where, ": the camera type '", type.substr(0, 40),
                       "' is not supported (known: frame, fisheye); export undistorted images"));
  pugi::xml_node resolution = calibration.child("resolution");
  if (!resolution) resolution = sensor.child("resolution");
  Lens lens;
  Intrinsics& k = lens.intrinsics;
  k.width = read_size(resolution, "width", where);
  k.height = read_size(resolution, "height", where);
  const auto number = [&](const char* name) { return read_number(calibration, name, 0, where); };
  const bool old = bool(calibration.child("fx"));
  if (old) {
    k.fx = number("fx");
    k.fy = number("fy");
    k.skew = number("skew");
    k.cx = number("cx");
    k.cy = number("cy");
  } else {
    k.fy = number("f");
    k.fx = k.fy + number("b1");
    k.skew = number("b2");
    k.cx = number("cx") + 0.5 * k.width;
    k.cy = number("cy") + 0.5 * k.height;
  }
  lens.distortion = read_distortion(calibration, type == "fisheye", !old, where);
  return lens;
}

Similarity read_similarity(const pugi::xml_node& transform, const std::string& where) {
  Similarity s;
  if (const auto node = transform.child("rotation")) {
    const std::vector<double> r = read_numbers_of(node, 9, where);
    s.rotation = checked_rotation(from_rows(std::span<const double, 9>(r.data(), 9)), where,
                                  "the chunk's rotation");
  }
  if (const auto node = transform.child("translation")) {
    const std::vector<double> t = read_numbers_of(node, 3, where);
    s.translation = {t[0], t[1], t[2]};
  }
  s.scale = read_number(transform, "scale", 1, where);
  if (!(s.scale > 0)) throw Error(where + ": the chunk's scale must be positive");
  return s;
}

Pose read_pose(const pugi::xml_node& transform, const Similarity& world_from_chunk,
               const std::string& where) {
  const std::vector<double> m = read_numbers_of(transform, 16, where);
  const double rows[9] = {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
  const glm::dmat3 chunk_from_cam =
      checked_rotation(from_rows(std::span<const double, 9>(rows)), where, "transform");
  return pose_at(glm::transpose(world_from_chunk.rotation * chunk_from_cam),
                 world_from_chunk({m[3], m[7], m[11]}));
}

/// The region, a box of any direction in the chunk, as the smallest box along the world's axes
/// that holds it.
std::optional<Box> read_region(const pugi::xml_node& region, const Similarity& world_from_chunk,
                               const std::string& where) {
  if (!region.child("center") || !region.child("size") || !region.child("R")) return std::nullopt;
  const std::vector<double> c = read_numbers_of(region.child("center"), 3, where);
  const std::vector<double> s = read_numbers_of(region.child("size"), 3, where);
  const std::vector<double> r = read_numbers_of(region.child("R"), 9, where);
  const glm::dmat3 axes = from_rows(std::span<const double, 9>(r.data(), 9));
  Box box{glm::dvec3(1e300), glm::dvec3(-1e300)};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5,
                          corner & 4 ? 0.5 : -0.5);
    const glm::dvec3 p = world_from_chunk(glm::dvec3(c[0], c[1], c[2]) +
                                          axes * (sign * glm::dvec3(s[0], s[1], s[2])));
    box.min = glm::min(box.min, p);
    box.max = glm::max(box.max, p);
  }
  return box;
}

class Reader {
 public:
  explicit Reader(const fs::path& file) {
    scene_.format = SceneFormat::kMetashape;
    scene_.file = file;
    scene_.pixel_center = 0.5;
    scene_.image_folders = {folder_of(file), folder_of(file) / "images"};
  }

  RawScene read() {
    const std::string text = read_text_file(scene_.file);
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
    if (!parsed)
      throw Error(concat(scene_.file.string(), " byte ", parsed.offset, ": not valid XML (",
                         parsed.description(), ")"));
    const pugi::xml_node chunk = document.child("document").child("chunk");
    if (!chunk) throw Error(scene_.file.string() + ": document/chunk is missing");
    if (chunk.next_sibling("chunk"))
      scene_.warnings.push_back(scene_.file.string() + ": only the first of its chunks was read");
    for (const pugi::xml_node& sensor : chunk.child("sensors").children("sensor"))
      sensors_.emplace(sensor.attribute("id").value(), sensor);
    const std::string where = where_of(scene_.file, chunk);
    world_from_chunk_ = read_similarity(chunk.child("transform"), where);
    read_cameras(chunk.child("cameras"));
    scene_.box = read_region(chunk.child("region"), world_from_chunk_, where);
    scene_.box_source = concat("region of ", scene_.file.filename().string());
    if (left_out_ > 0)
      scene_.warnings.push_back(
          concat(scene_.file.string(), ": ", left_out_, " images have no pose and are left out"));
    return std::move(scene_);
  }

 private:
  /// Cameras may lie in groups, one level deep.
  void read_cameras(const pugi::xml_node& cameras) {
    for (const pugi::xml_node& group : cameras.children("group")) read_list(group);
    read_list(cameras);
  }

  void read_list(const pugi::xml_node& list) {
    for (const pugi::xml_node& camera : list.children("camera")) {
      if (!camera.child("transform")) {
        ++left_out_;
        continue;
      }
      RawView view;
      view.where = where_of(scene_.file, camera);
      view.listed = camera.attribute("label").value();
      if (view.listed.empty()) throw Error(view.where + ": label is missing");
      const auto sensor = sensors_.find(camera.attribute("sensor_id").value());
      if (sensor == sensors_.end())
        throw Error(view.where + ": sensor_id names a sensor that the file does not list");
      const Lens lens = read_lens(sensor->second, where_of(scene_.file, sensor->second));
      view.camera = {lens.intrinsics,
                     read_pose(camera.child("transform"), world_from_chunk_, view.where)};
      view.distortion = lens.distortion;
      scene_.views.push_back(std::move(view));
    }
  }

  RawScene scene_;
  std::map<std::string, pugi::xml_node> sensors_;
  Similarity world_from_chunk_;
  std::size_t left_out_ = 0;
};

void add(pugi::xml_node parent, const char* name, const std::string& text) {
  parent.append_child(name).text().set(text.c_str());
}

void add_sensor(const SourceView& view, std::size_t index, pugi::xml_node sensors) {
  const Intrinsics& k = view.camera.intrinsics;
  const std::array<double, 8>& c = view.distortion.coefficients;
  const DistortionModel model = view.distortion.model;
  const bool fisheye = model == DistortionModel::kFisheye;
  if (model == DistortionModel::kMeasured ||
      (model == DistortionModel::kBrown && (c[5] != 0 || c[6] != 0 || c[7] != 0)))
    refuse_distortion(view, "Metashape");
  pugi::xml_node sensor = sensors.append_child("sensor");
  sensor.append_attribute("id") = index;
  sensor.append_attribute("type") = fisheye ? "fisheye" : "frame";
  const auto add_resolution = [&](pugi::xml_node parent) {
    pugi::xml_node resolution = parent.append_child("resolution");
    resolution.append_attribute("width") = k.width;
    resolution.append_attribute("height") = k.height;
  };
  add_resolution(sensor);
  pugi::xml_node calibration = sensor.append_child("calibration");
  calibration.append_attribute("type") = fisheye ? "fisheye" : "frame";
  calibration.append_attribute("class") = "adjusted";
  add_resolution(calibration);
  add(calibration, "f", number_text(k.fy));
  add(calibration, "cx", number_text(k.cx + 0.5 - 0.5 * k.width));
  add(calibration, "cy", number_text(k.cy + 0.5 - 0.5 * k.height));
  add(calibration, "b1", number_text(k.fx - k.fy));
  add(calibration, "b2", number_text(k.skew));
  const double radial[4] = {c[0], c[1], fisheye ? c[2] : c[4], fisheye ? c[3] : c[5]};
  for (int i = 0; i < 4; ++i) add(calibration, concat("k", i + 1).c_str(), number_text(radial[i]));
  add(calibration, "p1", number_text(fisheye ? 0 : c[3]));
  add(calibration, "p2", number_text(fisheye ? 0 : c[2]));
}

}  // namespace

fs::path find_metashape(const fs::path& folder) {
  for (const fs::path& file : files_ending(folder, ".xml"))
    if (is_metashape(file)) return file;
  return {};
}

bool is_metashape(const fs::path& file) {
  const std::string head = file_head(file);
  return file.extension() == ".xml" && head.find("<document") != std::string::npos &&
         head.find("<chunk") != std::string::npos;
}

RawScene read_metashape(const fs::path& file) { return Reader(file).read(); }

void write_metashape(const Scene& scene, const fs::path& folder) {
  make_folder(folder);
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("document");
  root.append_attribute("version") = "1.5.0";
  pugi::xml_node chunk = root.append_child("chunk");
  chunk.append_attribute("label") = "Chunk 1";
  pugi::xml_node sensors = chunk.append_child("sensors"), cameras = chunk.append_child("cameras");
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    const SourceView& view = scene.views[i];
    add_sensor(view, i, sensors);
    pugi::xml_node camera = cameras.append_child("camera");
    camera.append_attribute("id") = i;
    camera.append_attribute("sensor_id") = i;
    camera.append_attribute("label") = listed_name(view, folder, {".", "images"}).c_str();
    const glm::dmat3& r = view.camera.cam_from_world.rotation;
    const glm::dvec3 center = view.camera.center();
    std::string matrix;
    for (int row = 0; row < 3; ++row)
      matrix += vector_text(r[row]) + " " + number_text(center[row]) + " ";
    add(camera, "transform", matrix + "0 0 0 1");
  }
  std::ostringstream out;
  document.save(out, "  ");
  write_atomically(folder / "cameras.xml", out.str());
  write_bbox_file(scene, folder);
}

}  // namespace photohull::io
