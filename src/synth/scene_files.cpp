#include "synth/scene_files.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <charconv>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/json_levels.h"
#include "core/option_word.h"
#include "core/read_file.h"
#include "io/image_file.h"
#include "io/mesh/write_mesh.h"
#include "io/write_scene.h"

namespace photohull::synth {
namespace fs = std::filesystem;
namespace {

constexpr const char* kMark = "INCOMPLETE";
constexpr const char* kParts[][2] = {
    {"images", ".png"}, {"masks", ".png"}, {"depth", ".exr"}, {"normals", ".exr"}};
constexpr const char* kPlates = "plates";

/// View names of the synthesized scene that a JSON file describes; nothing where it does not.
std::optional<std::vector<std::string>> described_views(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return std::nullopt;
  const auto j =
      nlohmann::json::parse(read_whole_file(file), json_level_guard(file.string()), false);
  if (!j.is_object() || !j.contains("result") || !j["result"].is_object()) return std::nullopt;
  const auto& result = j["result"];
  if (result.value("writer", nlohmann::json()) != "photohull synthesize") return std::nullopt;
  std::vector<std::string> names;
  for (const auto& name : result.value("views", nlohmann::json::array())) {
    if (!name.is_string()) return std::nullopt;
    const auto text = name.get<std::string>();
    if (text.empty() || text.find('/') != std::string::npos) return std::nullopt;
    names.push_back(text);
  }
  return names;
}

void make_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure)
    throw Error(concat(folder.string(), ": the folder cannot be made (", failure.message(),
                       "); choose another with ", option_word("out")));
}

/// Takes the pictures of an older synthesized scene out of a folder that holds one.
void clear_old_scene(const fs::path& folder) {
  std::error_code failure;
  if (!fs::exists(folder, failure)) return;
  if (!fs::is_directory(folder, failure))
    throw Error(
        concat(folder.string(), ": is not a folder; choose another with ", option_word("out")));
  const bool empty = fs::is_empty(folder, failure);
  if (failure)
    throw Error(concat(folder.string(), ": cannot be looked into (", failure.message(), ")"));
  if (empty) return;
  auto views = described_views(folder / kMark);
  if (!views) views = described_views(folder / "spec.json");
  if (!views)
    throw Error(concat(folder.string(),
                       ": the folder holds other files than a synthesized scene; nothing was "
                       "written, choose an empty or a new folder with ",
                       option_word("out")));
  for (const std::string& name : *views) {
    fs::remove(folder / kPlates / (name + ".png"), failure);
    for (const auto& [part, extension] : kParts)
      fs::remove(folder / part / (name + extension), failure);
  }
}

std::string number(double value) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

template <typename T>
void append(std::string& out, const T& value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

/// Codes pixels in memory, since OpenImageIO may take a full disk for a success.
void write_coded(const std::string& format, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                 const void* pixels, AtomicFile& file) {
  std::vector<unsigned char> coded;
  OIIO::Filesystem::IOVecOutput memory(coded);
  const auto output = OIIO::ImageOutput::create(format);
  if (!output) throw Error(format + " files cannot be written: OpenImageIO lacks its plug-in");
  output->threads(1);
  if (!output->set_ioproxy(&memory) || !output->open("memory." + format, spec) ||
      !output->write_image(type, pixels) || !output->close())
    throw Error(concat(file.target().string(), ": cannot be coded (", output->geterror(), ")"));
  file.write(coded.data(), coded.size());
}

}  // namespace

void write_exr(const fs::path& path, int width, int height, int channels, const float* pixels) {
  AtomicFile file(path);
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::FLOAT);
  if (channels == 1) spec.channelnames = {"Z"};
  spec.attribute("compression", "zips");
  spec.attribute("DateTime", "1970:01:01 00:00:00");  // else the time now: other bytes every time
  write_coded("exr", spec, OIIO::TypeDesc::FLOAT, pixels, file);
  file.commit();
}

SceneFiles::SceneFiles(const fs::path& folder, const std::vector<std::string>& views,
                       const ImageSpec& image)
    : folder_(folder), masks_(image.masks) {
  clear_old_scene(folder);
  make_folder(folder);
  const nlohmann::json mark = {{"result", {{"writer", "photohull synthesize"}, {"views", views}}}};
  write_atomically(folder / kMark, mark.dump() + "\n");
  std::error_code ignored;
  fs::remove(folder / "spec.json", ignored);
  for (const auto& [part, extension] : kParts) {
    const bool wanted = std::string_view(part) == "images" ||
                        (std::string_view(part) == "masks" ? image.masks : image.maps);
    if (wanted)
      make_folder(folder / part);
    else  // an older scene's, empty by now unless others put files there
      fs::remove(folder / part, ignored);
  }
}

void SceneFiles::write_picture(const std::string& view, int width, int height,
                               const std::vector<std::uint8_t>& rgb) const {
  io::write_png(folder_ / "images" / (view + ".png"), width, height, 3, rgb);
}

void SceneFiles::write_picture(const std::string& view, int width, int height,
                               const std::vector<std::uint16_t>& rgb) const {
  const fs::path path = folder_ / "images" / (view + ".png");
  AtomicFile file(path);
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT16);
  write_coded("png", spec, OIIO::TypeDesc::UINT16, rgb.data(), file);
  file.commit();
}

void SceneFiles::write_maps(const std::string& view, const Picture& picture) const {
  const int w = picture.width, h = picture.height;
  write_exr(folder_ / "depth" / (view + ".exr"), w, h, 1, picture.depth.data());
  write_exr(folder_ / "normals" / (view + ".exr"), w, h, 3, &picture.normal.data()->x);
}

void SceneFiles::write_plate(const std::string& view, int width, int height,
                             const std::vector<std::uint8_t>& rgb) const {
  make_folder(folder_ / kPlates);
  io::write_png(folder_ / kPlates / (view + ".png"), width, height, 3, rgb);
}

void SceneFiles::write_mask(const std::string& view, const Mask& mask) const {
  io::write_png(folder_ / "masks" / (view + ".png"), mask.width, mask.height, 1, mask.coverage);
}

void SceneFiles::write_truth(const TriMesh& mesh, const std::vector<TruthSample>& samples) const {
  write_ply(folder_ / "gt.ply", mesh);
  std::string out = concat(
      "ply\nformat binary_little_endian 1.0\n"
      "comment area-uniform samples of gt.ply; views = cameras with a free line of sight\n"
      "element vertex ",
      samples.size(),
      "\nproperty double x\nproperty double y\nproperty double z\n"
      "property float nx\nproperty float ny\nproperty float nz\n"
      "property ushort views\nend_header\n");
  for (const TruthSample& s : samples)
    append(out, s.position), append(out, s.normal), append(out, s.views);
  write_atomically(folder_ / "gt_visible.ply", out);
}

void SceneFiles::write_cameras(const std::vector<std::string>& views,
                               const std::vector<LensCamera>& written,
                               const std::vector<LensCamera>& exact, bool differ,
                               const Box& box) const {
  const auto scene_of = [&](const std::vector<LensCamera>& cameras) {
    Scene scene;
    scene.path = folder_;
    scene.box = box;
    for (std::size_t i = 0; i < views.size(); ++i)
      scene.views.push_back({views[i] + ".png", folder_ / "images" / (views[i] + ".png"),
                             masks_ ? folder_ / "masks" / (views[i] + ".png") : fs::path(),
                             cameras[i].camera, cameras[i].distortion});
    return scene;
  };
  const Scene scene = scene_of(written);
  io::write_transforms(scene, folder_);
  io::write_colmap_text(scene, folder_ / "colmap_text");
  io::write_colmap_binary(scene, folder_ / "colmap_binary");
  std::error_code ignored;
  if (written.front().distortion.model == DistortionModel::kNone)
    io::write_middlebury(scene, folder_ / "middlebury");
  else  // the format has no distortion; an older scene's file would tell other cameras
    fs::remove(folder_ / "middlebury" / "scene_par.txt", ignored);
  if (differ)
    io::write_transforms(scene_of(exact), folder_ / "true_cameras");
  else
    fs::remove(folder_ / "true_cameras" / "transforms.json", ignored);
  std::string corners;
  for (const glm::dvec3& p : {box.min, box.max})
    corners += number(p.x) + " " + number(p.y) + " " + number(p.z) + "\n";
  write_atomically(folder_ / "bbox.txt", corners);
}

void SceneFiles::finish(const std::string& spec_json) const {
  write_atomically(folder_ / "spec.json", spec_json);
  std::error_code ignored;
  fs::remove(folder_ / kMark, ignored);
}

}  // namespace photohull::synth
