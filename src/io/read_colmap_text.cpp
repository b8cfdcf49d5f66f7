// COLMAP sparse models as text: cameras.txt, images.txt and, where present, points3D.txt.
#include <limits>
#include <map>

#include "core/error.h"
#include "io/colmap_model.h"
#include "io/text_file.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

std::uint32_t identifier(const Lines& lines, std::string_view token, std::string_view field) {
  const std::int64_t id = lines.integer(token, field);
  if (id < 0 || id > std::numeric_limits<std::uint32_t>::max())
    throw Error(concat(lines.where(), ": ", field, " is ", id, ", but it must be 0 to 4294967295"));
  return std::uint32_t(id);
}

/// Negative sizes become 0, which make_colmap_camera refuses.
std::uint64_t extent(const Lines& lines, std::string_view token, std::string_view field) {
  return std::uint64_t(std::max<std::int64_t>(0, lines.integer(token, field)));
}

ColmapCameras read_cameras(const fs::path& file) {
  ColmapCameras cameras;
  for (Lines lines(file); lines.next_content();) {
    const auto fields = split_fields(lines.text(), 32);
    if (fields.size() < 4)
      throw Error(concat(lines.where(), ": ", fields.size(),
                         " fields found, but a camera needs CAMERA_ID MODEL WIDTH HEIGHT PARAMS"));
    const std::uint32_t id = identifier(lines, fields[0], "CAMERA_ID");
    const ColmapLens& lens = colmap_lens(fields[1], lines.where());
    if (fields.size() != std::size_t(4 + lens.parameters))
      throw Error(concat(lines.where(), ": ", fields.size() - 4, " parameters found, but ",
                         lens.name, " has ", lens.parameters));
    std::vector<double> parameters;
    for (int i = 0; i < lens.parameters; ++i)
      parameters.push_back(lines.number(fields[4 + i], "a camera parameter"));
    const ColmapCamera camera =
        make_colmap_camera(lens, extent(lines, fields[2], "WIDTH"),
                           extent(lines, fields[3], "HEIGHT"), parameters, lines.where());
    if (!cameras.emplace(id, camera).second)
      throw Error(concat(lines.where(), ": CAMERA_ID ", id, " is listed twice; remove one"));
  }
  return cameras;
}

using Tracks = std::map<std::int64_t, RawTrack>;  ///< by POINT3D_ID

/// An image's second line, "X Y POINT3D_ID" for each of its points. A file written by hand often
/// lacks it, and every other image would be lost in silence.
void read_observations(Lines& lines, std::size_t view, Tracks& tracks) {
  constexpr std::size_t kImageFields = 10;
  if (!lines.next()) return;
  const std::vector<std::string_view> fields = split_fields(lines.text());
  if (fields.size() == kImageFields)
    throw Error(concat(lines.where(),
                       ": 10 fields found where the 2D points of the image above "
                       "are expected; put an empty line after each image"));
  if (fields.size() % 3 != 0)
    throw Error(concat(lines.where(), ": ", fields.size(),
                       " fields found, but 2D points are X Y POINT3D_ID each"));
  for (std::size_t i = 0; i < fields.size(); i += 3) {
    const std::int64_t point = lines.integer(fields[i + 2], "POINT3D_ID");
    const glm::dvec2 pixel(lines.number(fields[i], "X"), lines.number(fields[i + 1], "Y"));
    if (point >= 0) tracks[point].observations.push_back({view, pixel});
  }
}

void read_images(const ColmapCameras& cameras, RawScene& scene) {
  Tracks tracks;
  for (Lines lines(scene.file); lines.next_content();) {
    constexpr std::size_t kFixed = 9;  // IMAGE_ID, quaternion, translation, CAMERA_ID
    const auto fields = split_fields(lines.text(), kFixed + 1);
    if (fields.size() <= kFixed)
      throw Error(concat(lines.where(), ": ", fields.size(),
                         " fields found, but an image needs IMAGE_ID QW QX QY QZ TX TY TZ "
                         "CAMERA_ID NAME, then a line of 2D points (which may be empty)"));
    constexpr const char* kNames[] = {"QW", "QX", "QY", "QZ", "TX", "TY", "TZ"};
    double pose[7];
    for (int i = 0; i < 7; ++i) pose[i] = lines.number(fields[1 + i], kNames[i]);
    // The name runs to the end of the line: it may hold blanks.
    const char* end = lines.text().data() + lines.text().size();
    scene.views.push_back(
        make_colmap_view(std::string(fields[kFixed].data(), end),
                         std::span<const double, 4>(pose, 4), {pose[4], pose[5], pose[6]},
                         identifier(lines, fields[8], "CAMERA_ID"), cameras, lines.where()));
    read_observations(lines, scene.views.size() - 1, tracks);
  }
  for (auto& [point, track] : tracks) scene.tracks.push_back(std::move(track));
}

void read_points(const fs::path& file, RawScene& scene) {
  for (Lines lines(file); lines.next_content();) {
    const auto fields = split_fields(lines.text(), 4);
    if (fields.size() < 4)
      throw Error(concat(lines.where(), ": ", fields.size(),
                         " fields found, but a point needs POINT3D_ID X Y Z"));
    scene.points.emplace_back(lines.number(fields[1], "X"), lines.number(fields[2], "Y"),
                              lines.number(fields[3], "Z"));
  }
}

}  // namespace

RawScene read_colmap_text(const fs::path& folder) {
  RawScene scene = begin_colmap_scene(folder, SceneFormat::kColmapText);
  scene.file = folder / "images.txt";
  read_images(read_cameras(folder / "cameras.txt"), scene);
  if (is_file(folder / "points3D.txt")) read_points(folder / "points3D.txt", scene);
  return scene;
}

}  // namespace photohull::io
