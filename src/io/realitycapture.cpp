// RealityCapture's "Internal/External camera parameters" as CSV: position in a world with z up,
// heading, pitch and roll in degrees, focal length and principal point in millimetres of a frame
// 36 mm wide along the image's longer side, the latter from the image's centre. Looking straight
// down, top to the north, is 0 0 0: rotation to the world Rz(-heading) Rx(pitch) Ry(roll) in
// OpenGL's camera axes (as nerfstudio's process_data/realitycapture_utils.py reads it).
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/find_files.h"
#include "io/pose_parts.h"
#include "io/scene_readers.h"
#include "io/text_file.h"
#include "io/usable_views.h"
#include "io/write_scene_parts.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr double kFrame = 36;  // millimetres
constexpr double kDegree = std::numbers::pi / 180;
constexpr const char* kColumns[] = {"x",  "y",  "alt", "heading", "pitch", "roll", "f", "px",
                                    "py", "k1", "k2",  "k3",      "k4",    "t1",   "t2"};

std::vector<std::string> split_commas(std::string_view line) {
  std::vector<std::string> fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    fields.emplace_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return fields;
}

glm::dmat3 about(int axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  glm::dmat3 m(1.0);
  m[a][a] = c, m[b][b] = c, m[a][b] = s, m[b][a] = -s;
  return m;
}

class Reader {
 public:
  Reader(const fs::path& file, const fs::path& images) : lines_(file) {
    scene_.format = SceneFormat::kRealityCapture;
    scene_.file = file;
    scene_.pixel_center = 0.5;
    scene_.image_folders = {folder_of(file), folder_of(file) / "images",
                            folder_of(file) / ".." / "images"};
    if (!images.empty()) scene_.image_folders = {images};
  }

  RawScene read() {
    read_header();
    while (lines_.next_content()) {
      fields_ = split_commas(lines_.text());
      if (fields_.size() != column_.size())
        throw Error(concat(lines_.where(), ": ", fields_.size(), " columns, but the header has ",
                           column_.size()));
      scene_.views.push_back(read_view());
    }
    return std::move(scene_);
  }

 private:
  void read_header() {
    while (lines_.next() && lines_.text().empty()) {
    }
    const std::vector<std::string> names = split_commas(lines_.text());
    for (std::size_t i = 0; i < names.size(); ++i) {
      std::string name = names[i];
      if (name.starts_with("#")) name.erase(0, 1);
      if (!column_.emplace(name, i).second)
        throw Error(concat(lines_.where(), ": the column ", name, " is there twice"));
    }
    for (const char* name : {"name", "x", "y", "alt", "heading", "pitch", "roll", "f"})
      if (!column_.count(name))
        throw Error(concat(lines_.where(), ": the column ", name,
                           " is missing; export "
                           "'Internal/External camera parameters'"));
  }

  double number(const char* name) const {
    const auto found = column_.find(name);
    return found == column_.end() ? 0 : lines_.number(fields_[found->second], name);
  }

  RawView read_view() {
    RawView view;
    view.where = lines_.where();
    view.listed = fields_[column_["name"]];
    if (view.listed.empty()) throw Error(view.where + ": name is empty");
    const glm::dmat3 world_from_cam = about(2, -number("heading") * kDegree) *
                                      about(0, number("pitch") * kDegree) *
                                      about(1, number("roll") * kDegree);
    view.camera.cam_from_world = pose_at(turned_about_x(glm::transpose(world_from_cam)),
                                         {number("x"), number("y"), number("alt")});
    const double k4 = number("k4");
    view.distortion.coefficients = {number("k1"), number("k2"), number("t1"),
                                    number("t2"), number("k3"), k4};
    if (view.distortion.coefficients != std::array<double, 8>{})
      view.distortion.model = k4 != 0 ? DistortionModel::kPolynomial : DistortionModel::kBrown;
    Intrinsics& k = view.camera.intrinsics;
    k.fx = number("f");
    k.cx = number("px");
    k.cy = number("py");
    // The unit is a share of the image, whose size stands nowhere else; without the image the
    // view cannot be used anyway, which load_scene says.
    const fs::path image = find_image(view.listed, scene_.image_folders);
    if (image.empty()) return view;
    const ImageSize size = image_size_or_none(image);
    if (size.width == 0) return view;
    const double unit = std::max(size.width, size.height) / kFrame;
    k.fx *= unit;
    k.fy = k.fx;
    k.cx = k.cx * unit + 0.5 * size.width;
    k.cy = k.cy * unit + 0.5 * size.height;
    return view;
  }

  RawScene scene_;
  Lines lines_;
  std::map<std::string, std::size_t> column_;
  std::vector<std::string> fields_;
};

}  // namespace

fs::path find_realitycapture(const fs::path& folder) {
  for (const fs::path& file : files_ending(folder, ".csv"))
    if (is_realitycapture(file)) return file;
  return {};
}

bool is_realitycapture(const fs::path& file) {
  const std::string head = file_head(file);
  const std::string_view line = std::string_view(head).substr(0, head.find('\n'));
  return file.extension() == ".csv" && line.find("name,") != std::string::npos &&
         line.find("heading") != std::string::npos;
}

RawScene read_realitycapture(const fs::path& file, const fs::path& images) {
  return Reader(file, images).read();
}

void write_realitycapture(const Scene& scene, const fs::path& folder) {
  make_folder(folder);
  std::ostringstream out;
  out << "#name";
  for (const char* column : kColumns) out << "," << column;
  out << "\n";
  for (const SourceView& view : scene.views) {
    require_no_skew(view, "RealityCapture");
    require_square_pixels(view, "RealityCapture");
    const std::array<double, 8>& c = view.distortion.coefficients;
    const DistortionModel model = view.distortion.model;
    if (model == DistortionModel::kFisheye || model == DistortionModel::kMeasured ||
        (model == DistortionModel::kBrown && (c[5] != 0 || c[6] != 0 || c[7] != 0)))
      refuse_distortion(view, "RealityCapture");
    const std::string name = listed_name(view, folder, {".", "images"});
    if (name.find(',') != std::string::npos)
      throw Error(concat(view.name,
                         ": its name holds a comma, which RealityCapture's CSV cannot "
                         "express; rename the image"));
    // Rz(-heading) Rx(pitch) Ry(roll): the middle angle is between -90 and 90 degrees.
    const glm::dmat3 r = glm::transpose(turned_about_x(view.camera.cam_from_world.rotation));
    const double pitch = std::atan2(r[1][2], std::hypot(r[1][0], r[1][1]));
    const double heading = -std::atan2(-r[1][0], r[1][1]);
    const double roll = std::atan2(-r[0][2], r[2][2]);
    const Intrinsics& k = view.camera.intrinsics;
    const double unit = std::max(k.width, k.height) / kFrame;
    const glm::dvec3 center = view.camera.center();
    out << name;
    for (const double value :
         {center.x, center.y, center.z, heading / kDegree, pitch / kDegree, roll / kDegree,
          k.fx / unit, (k.cx + 0.5 - 0.5 * k.width) / unit, (k.cy + 0.5 - 0.5 * k.height) / unit,
          c[0], c[1], c[4], c[5], c[2], c[3]})
      out << "," << number_text(value);
    out << "\n";
  }
  write_atomically(folder / "cameras.csv", out.str());
  write_bbox_file(scene, folder);
}

}  // namespace photohull::io
