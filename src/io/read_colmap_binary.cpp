// COLMAP sparse models as binary files: cameras.bin, images.bin and, where present, points3D.bin.
// All numbers are little-endian and unaligned.
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <map>

#include "core/error.h"
#include "io/colmap_model.h"
#include "io/text_file.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

static_assert(std::endian::native == std::endian::little);

/// Reads a file front to back. Nothing is believed: each read is checked against the file's size,
/// and errors name file, offset and field.
class BinaryFile {
 public:
  explicit BinaryFile(const fs::path& path) : path_(path), in_(path, std::ios::binary) {
    std::error_code failure;
    size_ = is_file(path) ? fs::file_size(path, failure) : 0;
    if (!is_file(path) || failure || !in_)
      throw Error(concat(path.string(), ": there is no such file, or it cannot be opened"));
  }

  template <typename T>
  T read(const char* field) {
    T value;
    require(sizeof value, field);
    if (!in_.read(reinterpret_cast<char*>(&value), sizeof value))
      throw Error(concat(where(), ": ", field, " cannot be read; check the disk"));
    offset_ += sizeof value;
    return value;
  }

  double read_finite(const char* field) {
    const double value = read<double>(field);
    if (!std::isfinite(value))
      throw Error(concat(where(), ": ", field, " is ", value, ", not a finite number"));
    return value;
  }

  /// A count of items that take at least `item_bytes` each and so must fit into what is left.
  std::uint64_t read_count(std::uint64_t item_bytes, const char* field) {
    const std::uint64_t count = read<std::uint64_t>(field);
    if (count > (size_ - offset_) / item_bytes)
      throw Error(concat(where(), ": ", field, " is ", count, ", but the ", size_ - offset_,
                         " bytes that follow cannot hold so many; the file is damaged"));
    return count;
  }

  /// Up to and without a zero byte.
  std::string read_string(const char* field) {
    constexpr std::size_t kLongest = 4096;
    std::string text;
    while (const char c = read<char>(field)) {
      text += c;
      if (text.size() > kLongest)
        throw Error(concat(where(), ": ", field, " is longer than ", kLongest,
                           " bytes; the file is damaged"));
    }
    return text;
  }

  void skip(std::uint64_t bytes, const char* field) {
    require(bytes, field);
    // Seeking throws the stream's buffer away, which short skips, by far the most, should keep.
    if (bytes < 4096)
      in_.ignore(std::streamsize(bytes));
    else
      in_.seekg(std::streamoff(bytes), std::ios::cur);
    offset_ += bytes;
  }

  void expect_end() const {
    if (offset_ != size_)
      throw Error(concat(where(), ": ", size_ - offset_,
                         " bytes are left after the last entry; the file is damaged"));
  }

  /// "FILE offset 123", to open an error message.
  std::string where() const { return concat(path_.string(), " offset ", offset_); }

 private:
  void require(std::uint64_t bytes, const char* field) const {
    if (bytes > size_ - offset_)
      throw Error(concat(where(), ": the file ends within ", field, " (", bytes, " bytes needed, ",
                         size_ - offset_, " left); it was cut short, copy it again"));
  }

  fs::path path_;
  std::ifstream in_;
  std::uint64_t size_ = 0;
  std::uint64_t offset_ = 0;
};

ColmapCameras read_cameras(const fs::path& path) {
  BinaryFile file(path);
  constexpr std::uint64_t kSmallest = 4 + 4 + 8 + 8 + 3 * 8;
  ColmapCameras cameras;
  for (std::uint64_t left = file.read_count(kSmallest, "the number of cameras"); left > 0; --left) {
    const std::string where = file.where();
    const auto id = file.read<std::uint32_t>("camera_id");
    const ColmapLens& lens = colmap_lens(file.read<std::int32_t>("model_id"), where);
    const auto width = file.read<std::uint64_t>("width");
    const auto height = file.read<std::uint64_t>("height");
    std::vector<double> parameters;
    for (int i = 0; i < lens.parameters; ++i) parameters.push_back(file.read_finite("params"));
    if (!cameras.emplace(id, make_colmap_camera(lens, width, height, parameters, where)).second)
      throw Error(concat(where, ": camera_id ", id, " is listed twice; remove one"));
  }
  file.expect_end();
  return cameras;
}

void read_images(const ColmapCameras& cameras, RawScene& scene) {
  BinaryFile file(scene.file);
  constexpr std::uint64_t kSmallest = 4 + 7 * 8 + 4 + 1 + 8, kObservation = 24;
  std::map<std::int64_t, RawTrack> tracks;
  for (std::uint64_t left = file.read_count(kSmallest, "the number of images"); left > 0; --left) {
    const std::string where = file.where();
    file.read<std::uint32_t>("image_id");
    std::array<double, 4> quaternion;
    for (double& q : quaternion) q = file.read_finite("qvec");
    glm::dvec3 translation;
    for (int axis = 0; axis < 3; ++axis) translation[axis] = file.read_finite("tvec");
    const auto camera_id = file.read<std::uint32_t>("camera_id");
    std::string name = file.read_string("name");
    const std::uint64_t observations = file.read_count(kObservation, "num_points2D");
    for (std::uint64_t i = 0; i < observations; ++i) {
      const auto x = file.read_finite("points2D x"), y = file.read_finite("points2D y");
      const auto point = file.read<std::int64_t>("points2D point3D_id");
      if (point >= 0) tracks[point].observations.push_back({scene.views.size(), {x, y}});
    }
    scene.views.push_back(
        make_colmap_view(std::move(name), quaternion, translation, camera_id, cameras, where));
  }
  file.expect_end();
  for (auto& [point, track] : tracks) scene.tracks.push_back(std::move(track));
}

void read_points(const fs::path& path, RawScene& scene) {
  BinaryFile file(path);
  constexpr std::uint64_t kSmallest = 8 + 3 * 8 + 3 + 8 + 8, kTrackElement = 8;
  for (std::uint64_t left = file.read_count(kSmallest, "the number of points"); left > 0; --left) {
    file.read<std::uint64_t>("point3D_id");
    glm::dvec3 point;
    for (int axis = 0; axis < 3; ++axis) point[axis] = file.read_finite("xyz");
    file.skip(3 + 8, "rgb and error");
    const std::uint64_t track = file.read_count(kTrackElement, "track_length");
    file.skip(track * kTrackElement, "track");
    scene.points.push_back(point);
  }
  file.expect_end();
}

}  // namespace

RawScene read_colmap_binary(const fs::path& folder) {
  RawScene scene = begin_colmap_scene(folder, SceneFormat::kColmapBinary);
  scene.file = folder / "images.bin";
  read_images(read_cameras(folder / "cameras.bin"), scene);
  if (is_file(folder / "points3D.bin")) read_points(folder / "points3D.bin", scene);
  return scene;
}

}  // namespace photohull::io
