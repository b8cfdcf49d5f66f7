// Bundler's bundle.out with list.txt [Snavely06]: world to camera in OpenGL's axes (x right, y up,
// z back), one focal length in pixels, distortion 1 + k1 r^2 + k2 r^4, pixels counted from the
// image's centre. https://www.cs.cornell.edu/~snavely/bundler/bundler-v0.4-manual.html
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

constexpr double kUnstated = std::numeric_limits<double>::quiet_NaN();

/// "NAME", "NAME FOCAL" or "NAME 0 FOCAL"; names may hold blanks.
std::string name_in_list(std::string_view line) {
  std::vector<std::string_view> fields = split_fields(line);
  const std::size_t n = fields.size();
  std::size_t names = n;
  if (n >= 3 && fields[n - 2] == "0" && parse_double(fields[n - 1])) names = n - 2;
  return std::string(fields[0].data(), fields[names - 1].data() + fields[names - 1].size());
}

std::vector<std::string> read_list(const fs::path& bundle) {
  const fs::path folder = folder_of(bundle);
  for (const fs::path& file : {folder / "list.txt", folder / ".." / "list.txt"}) {
    if (!is_file(file)) continue;
    std::vector<std::string> names;
    for (Lines lines(file); lines.next_content();) names.push_back(name_in_list(lines.text()));
    return names;
  }
  throw Error(concat(bundle.string(), ": there is no list.txt beside it, which names the images"));
}

template <std::size_t n>
std::array<double, n> read_numbers(Lines& lines, const char* what) {
  if (!lines.next_content()) throw Error(concat(lines.where(), ": the file ends before ", what));
  const std::vector<std::string_view> fields = split_fields(lines.text());
  if (fields.size() != n)
    throw Error(
        concat(lines.where(), ": ", fields.size(), " fields found, but ", what, " has ", n));
  std::array<double, n> values;
  for (std::size_t i = 0; i < n; ++i) values[i] = lines.number(fields[i], what);
  return values;
}

RawView read_camera(Lines& lines, const std::string& name) {
  RawView view;
  view.listed = name;
  const auto [focal, k1, k2] = read_numbers<3>(lines, "a camera's f k1 k2");
  view.where = lines.where();
  std::array<double, 9> rows;
  for (int row = 0; row < 3; ++row) {
    const auto values = read_numbers<3>(lines, "a row of R");
    std::copy(values.begin(), values.end(), rows.begin() + 3 * row);
  }
  const auto t = read_numbers<3>(lines, "t");
  if (focal == 0) return view;  // not registered
  view.camera.intrinsics.fx = view.camera.intrinsics.fy = focal;
  view.camera.intrinsics.cx = view.camera.intrinsics.cy = kUnstated;
  if (k1 != 0 || k2 != 0) view.distortion = {DistortionModel::kBrown, {k1, k2}};
  const glm::dmat3 rotation = checked_rotation(from_rows(rows), view.where, "R");
  view.camera.cam_from_world = {turned_about_x(rotation),
                                turned_about_x(glm::dvec3(t[0], t[1], t[2]))};
  return view;
}

/// "COUNT, and for each VIEW KEY X Y", from the image's centre with y up. A file may end before it.
void read_track(Lines& lines, const std::vector<std::optional<std::size_t>>& views,
                RawScene& scene) {
  if (!lines.next_content()) return;
  const std::vector<std::string_view> fields = split_fields(lines.text());
  const std::int64_t count = lines.integer(fields[0], "a track's length");
  if (count < 0 || std::uint64_t(count) != (fields.size() - 1) / 4 || fields.size() % 4 != 1)
    throw Error(concat(lines.where(), ": a track of ", count, " is stated, but ", fields.size() - 1,
                       " fields follow; each place is VIEW KEY X Y"));
  RawTrack track;
  for (std::size_t i = 1; i < fields.size(); i += 4) {
    const std::int64_t view = lines.integer(fields[i], "a track's view");
    if (view < 0 || std::uint64_t(view) >= views.size())
      throw Error(concat(lines.where(), ": the view ", view, " of a track is none of the ",
                         views.size(), " cameras"));
    const glm::dvec2 pixel(lines.number(fields[i + 2], "X"), -lines.number(fields[i + 3], "Y"));
    if (views[std::size_t(view)]) track.observations.push_back({*views[std::size_t(view)], pixel});
  }
  if (track.observations.size() >= 2) scene.tracks.push_back(std::move(track));
}

}  // namespace

fs::path find_bundler(const fs::path& folder) {
  for (const char* name : {"bundle.out", "bundle/bundle.out", "bundle.rd.out"})
    if (is_file(folder / name)) return folder / name;
  return {};
}

bool is_bundler(const fs::path& file) { return file.filename().string().ends_with(".out"); }

RawScene read_bundler(const fs::path& file) {
  RawScene scene;
  scene.format = SceneFormat::kBundler;
  scene.file = file;
  const fs::path folder = folder_of(file);
  scene.image_folders = {folder, folder / "images", folder / "..", folder / ".." / "images"};
  const std::vector<std::string> names = read_list(file);
  Lines lines(file);
  const auto [cameras, points] = read_numbers<2>(lines, "the numbers of cameras and points");
  if (cameras != double(names.size()))
    throw Error(concat(lines.where(), ": ", cameras, " cameras are stated, but list.txt names ",
                       names.size(), " images"));
  std::size_t left_out = 0;
  std::vector<std::optional<std::size_t>> views;  // of each image
  for (const std::string& name : names) {
    RawView view = read_camera(lines, name);
    const bool registered = view.camera.intrinsics.fx != 0;
    views.push_back(registered ? std::optional(scene.views.size()) : std::nullopt);
    if (registered)
      scene.views.push_back(std::move(view));
    else
      ++left_out;
  }
  scene.track_origin = TrackOrigin::kPrincipal;
  for (double i = 0; i < points; ++i) {
    const auto p = read_numbers<3>(lines, "a point's position");
    scene.points.emplace_back(p[0], p[1], p[2]);
    lines.next_content();  // colour
    read_track(lines, views, scene);
  }
  if (left_out > 0)
    scene.warnings.push_back(concat(file.string(), ": ", left_out, " of ", names.size(),
                                    " images have no camera and are left out"));
  return scene;
}

void write_bundler(const Scene& scene, const fs::path& folder) {
  make_folder(folder);
  std::ostringstream out, list;
  out << "# Bundle file v0.3\n" << scene.views.size() << " " << scene.points.size() << "\n";
  for (const SourceView& view : scene.views) {
    require_no_skew(view, "Bundler");
    require_square_pixels(view, "Bundler");
    require_centred(view, "Bundler");
    const std::array<double, 8>& c = view.distortion.coefficients;
    const bool radial = view.distortion.model == DistortionModel::kBrown && c[2] == 0 &&
                        c[3] == 0 && c[4] == 0 && c[5] == 0 && c[6] == 0 && c[7] == 0;
    if (!radial) require_pinhole(view, "Bundler");
    out << number_text(view.camera.intrinsics.fx) << " " << number_text(c[0]) << " "
        << number_text(c[1]) << "\n";
    const glm::dmat3 r = turned_about_x(view.camera.cam_from_world.rotation);
    for (int row = 0; row < 3; ++row)
      out << number_text(r[0][row]) << " " << number_text(r[1][row]) << " "
          << number_text(r[2][row]) << "\n";
    out << vector_text(turned_about_x(view.camera.cam_from_world.translation)) << "\n";
    list << listed_name(view, folder, {".", "images"}) << "\n";
  }
  for (const glm::dvec3& p : scene.points) out << vector_text(p) << "\n128 128 128\n0\n";
  write_atomically(folder / "bundle.out", out.str());
  write_atomically(folder / "list.txt", list.str());
  write_bbox_file(scene, folder);
}

}  // namespace photohull::io
