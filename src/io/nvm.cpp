// VisualSFM's NVM_V3 [Wu13]: world-to-camera quaternion w x y z and the camera's centre, axes as
// ours, one focal length in pixels, principal point in the image's centre unless FixedK states
// one. The distortion is of the measured point: ideal = measured (1 + r |measured|^2).
// http://ccwu.me/vsfm/doc.html#nvm
#include <glm/gtc/quaternion.hpp>
#include <sstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/find_files.h"
#include "io/pose_parts.h"
#include "io/scene_readers.h"
#include "io/text_file.h"
#include "io/write_scene_parts.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kNumbers = 10;  // f, quaternion, centre, r, 0
constexpr double kPixelCenter = 0.5;  // SiftGPU's

/// The calibration that all cameras share: fx cx fy cy and perhaps r.
std::optional<Intrinsics> read_header(Lines& lines) {
  if (!lines.next_content() || !lines.text().starts_with("NVM_V3"))
    throw Error(concat(lines.where(), ": the first line must begin with NVM_V3"));
  const std::vector<std::string_view> fields = split_fields(lines.text());
  if (fields.size() < 2 || fields[1] != "FixedK") return std::nullopt;
  if (fields.size() < 6)
    throw Error(concat(lines.where(), ": FixedK must be followed by fx cx fy cy"));
  Intrinsics k;
  k.fx = lines.number(fields[2], "fx");
  k.cx = lines.number(fields[3], "cx");
  k.fy = lines.number(fields[4], "fy");
  k.cy = lines.number(fields[5], "cy");
  return k;
}

std::int64_t read_count(Lines& lines, const char* what) {
  if (!lines.next_content()) throw Error(concat(lines.where(), ": the file ends before ", what));
  return lines.integer(lines.text(), what);
}

RawView read_camera(const Lines& lines, const std::optional<Intrinsics>& fixed) {
  const std::vector<std::string_view> fields = split_fields(lines.text());
  if (fields.size() < kNumbers + 1)
    throw Error(concat(lines.where(), ": ", fields.size(),
                       " fields found, but an image name and 10 numbers are needed"));
  const std::size_t first = fields.size() - kNumbers;
  std::array<double, kNumbers> v;
  for (std::size_t i = 0; i < kNumbers; ++i) v[i] = lines.number(fields[first + i], "a number");
  RawView view;
  view.where = lines.where();
  // Names may hold blanks; VisualSFM writes those as quotation marks.
  view.listed = std::string(fields[0].data(), fields[first - 1].data() + fields[first - 1].size());
  std::replace(view.listed.begin(), view.listed.end(), '"', ' ');
  constexpr double kUnstated = std::numeric_limits<double>::quiet_NaN();
  Intrinsics& k = view.camera.intrinsics;
  k.fx = k.fy = v[0];
  k.cx = k.cy = kUnstated;
  if (fixed) k = *fixed;
  const glm::dmat3 rotation = rotation_of(std::span<const double, 4>(&v[1], 4), view.where);
  view.camera.cam_from_world = pose_at(rotation, {v[5], v[6], v[7]});
  if (v[8] != 0) view.distortion = {DistortionModel::kMeasured, {v[8]}};
  return view;
}

/// After X Y Z R G B "COUNT, and for each VIEW FEATURE X Y", from the principal point.
void read_track(const Lines& lines, const std::vector<std::string_view>& fields, RawScene& scene) {
  constexpr std::size_t kCount = 6;
  if (fields.size() <= kCount) return;
  const std::int64_t count = lines.integer(fields[kCount], "a track's length");
  const std::size_t rest = fields.size() - kCount - 1;
  if (count < 0 || std::uint64_t(count) != rest / 4 || rest % 4 != 0)
    throw Error(concat(lines.where(), ": a track of ", count, " is stated, but ", rest,
                       " fields follow; each place is VIEW FEATURE X Y"));
  RawTrack track;
  for (std::size_t i = kCount + 1; i < fields.size(); i += 4) {
    const std::int64_t view = lines.integer(fields[i], "a track's view");
    if (view < 0 || std::uint64_t(view) >= scene.views.size())
      throw Error(concat(lines.where(), ": the view ", view, " of a track is none of the ",
                         scene.views.size(), " cameras"));
    track.observations.push_back({std::size_t(view), glm::dvec2(lines.number(fields[i + 2], "X"),
                                                                lines.number(fields[i + 3], "Y"))});
  }
  if (track.observations.size() >= 2) scene.tracks.push_back(std::move(track));
}

}  // namespace

fs::path find_nvm(const fs::path& folder) { return only_file_ending(folder, ".nvm"); }

bool is_nvm(const fs::path& file) { return file.extension() == ".nvm"; }

RawScene read_nvm(const fs::path& file) {
  RawScene scene;
  scene.format = SceneFormat::kNvm;
  scene.file = file;
  scene.pixel_center = kPixelCenter;
  scene.track_origin = TrackOrigin::kPrincipal;
  scene.image_folders = {folder_of(file), folder_of(file) / "images"};
  Lines lines(file);
  const std::optional<Intrinsics> fixed = read_header(lines);
  const std::int64_t cameras = read_count(lines, "the number of cameras");
  for (std::int64_t i = 0; i < cameras; ++i) {
    if (!lines.next_content())
      throw Error(concat(lines.where(), ": ", cameras, " cameras are stated but ", i, " listed"));
    scene.views.push_back(read_camera(lines, fixed));
  }
  // A file may end here, and may hold further models after the first one's points.
  if (!lines.next_content()) return scene;
  const std::int64_t points = lines.integer(lines.text(), "the number of points");
  for (std::int64_t i = 0; i < points; ++i) {
    if (!lines.next_content())
      throw Error(concat(lines.where(), ": ", points, " points are stated but ", i, " listed"));
    const std::vector<std::string_view> fields = split_fields(lines.text());
    if (fields.size() < 3) throw Error(concat(lines.where(), ": a point needs X Y Z"));
    read_track(lines, fields, scene);
    scene.points.emplace_back(lines.number(fields[0], "X"), lines.number(fields[1], "Y"),
                              lines.number(fields[2], "Z"));
  }
  if (lines.next_content() && lines.text() != "0")
    scene.warnings.push_back(concat(file.string(), ": only the first of its models was read"));
  return scene;
}

void write_nvm(const Scene& scene, const fs::path& folder) {
  make_folder(folder);
  std::ostringstream out;
  out << "NVM_V3\n\n" << scene.views.size() << "\n";
  for (const SourceView& view : scene.views) {
    require_no_skew(view, "NVM");
    require_square_pixels(view, "NVM");
    require_centred(view, "NVM");
    const bool measured =
        view.distortion.model == DistortionModel::kMeasured && view.distortion.coefficients[1] == 0;
    if (!measured) require_pinhole(view, "NVM");
    std::string name = listed_name(view, folder, {".", "images"});
    std::replace(name.begin(), name.end(), ' ', '"');
    const glm::dquat q = glm::normalize(glm::quat_cast(view.camera.cam_from_world.rotation));
    out << name << "\t" << number_text(view.camera.intrinsics.fx);
    for (const double value : {q.w, q.x, q.y, q.z}) out << " " << number_text(value);
    out << " " << vector_text(view.camera.center()) << " "
        << number_text(view.distortion.coefficients[0]) << " 0\n";
  }
  out << "\n" << scene.points.size() << "\n";
  for (const glm::dvec3& p : scene.points) out << vector_text(p) << " 128 128 128 0\n";
  out << "\n0\n";
  write_atomically(folder / "scene.nvm", out.str());
  write_bbox_file(scene, folder);
}

}  // namespace photohull::io
