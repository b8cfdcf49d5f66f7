#include "sphere_scene.h"

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "core/error.h"
#include "io/image_file.h"
#include "io/write_scene.h"
#include "support/cameras.h"
#include "support/ray_cast.h"
#include "support/silhouettes.h"

namespace photohull::test {
namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

namespace {

/// Colour of the sphere's texture, or of a plain dark wall.
glm::dvec3 trace(const glm::dvec3& eye, const glm::dvec3& ray) {
  const double along = glm::dot(kCentre - eye, ray);
  const double off = glm::length(eye + along * ray - kCentre);
  if (off >= kRadius) return glm::dvec3(0.01, 0.012, 0.03);
  const double depth = along - std::sqrt(kRadius * kRadius - off * off);
  return 0.1 + 0.9 * noise_colour(eye + depth * ray, 0.12);
}

/// The photographs are the same for all tests: cast once a process.
const std::vector<std::pair<Camera, ColourImage>>& photographs() {
  static const auto all = [] {
    std::vector<std::pair<Camera, ColourImage>> made;
    for (const Camera& camera : cameras_around(kCentre, 4.0, kViews, 145.0, kWidth, kHeight))
      made.emplace_back(camera, ray_cast(camera, trace, 2));
    return made;
  }();
  return all;
}

}  // namespace

SphereScene::SphereScene() {
  std::string name = (fs::temp_directory_path() / "photohull_cli_XXXXXX").string();
  if (!::mkdtemp(name.data())) throw Error("no temporary folder");
  folder_ = name;
  fs::create_directories(folder_ / "images");
  scene_.box = Box{kCentre - 1.0, kCentre + 1.0};
  for (const auto& [camera, image] : photographs()) {
    SourceView view;
    view.name = concat("view", scene_.views.size(), ".png");
    view.image = folder_ / "images" / view.name;
    view.camera = camera;
    io::write_png(view.image, kWidth, kHeight, 4, image.bytes);
    scene_.views.push_back(view);
  }
  write_masks("cutouts", 255, 0);
  write_scene_file();
}

SphereScene::~SphereScene() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void SphereScene::write_scene_file() const { io::write_middlebury(scene_, folder_); }

void SphereScene::write_masks(const std::string& name, int object, int background) const {
  fs::create_directories(folder_ / name);
  for (const SourceView& view : scene_.views) {
    Mask mask = sphere_outline(view.camera, kCentre, kRadius).mask;
    for (std::uint8_t& c : mask.coverage)
      c = std::uint8_t(background + (object - background) * c / 255);
    io::write_png(folder_ / name / view.name, kWidth, kHeight, 1, mask.coverage);
  }
}

Arguments SphereScene::reconstruct(const Arguments& more) const {
  Arguments all = {"reconstruct", scene(), "--out", out()};
  all.insert(all.end(), more.begin(), more.end());
  const auto given = [&](const char* name) {
    return std::find(all.begin(), all.end(), name) != all.end();
  };
  if (!given("--masks")) all.insert(all.end(), {"--masks", path("cutouts")});
  if (!given("--resolution") && !given("--voxel-size") && !given("--quality"))
    all.insert(all.end(), {"--resolution", "32"});
  return all;
}

Finished SphereScene::succeed(const Arguments& arguments, const RunOptions& options) const {
  Finished finished = run_photohull(arguments, options);
  EXPECT_EQ(finished.code, 0) << finished.err;
  EXPECT_TRUE(finished.error_lines("photohull: ").empty()) << finished.err;
  return finished;
}

Finished SphereScene::fail(int code, const Arguments& arguments,
                           const std::vector<std::string>& parts, const RunOptions& options) const {
  const std::vector<std::string> before = listing(out());
  Finished finished = run_photohull(arguments, options);
  EXPECT_EQ(finished.code, code) << finished.err;
  EXPECT_EQ(finished.out, "");
  EXPECT_EQ(finished.error_lines("photohull: ").size(), 1u) << finished.err;
  const std::vector<std::string> lines = finished.error_lines();
  EXPECT_THAT(lines.empty() ? "" : lines.back(), StartsWith("photohull: "));
  for (const std::string& part : parts)
    EXPECT_THAT(lines.empty() ? "" : lines.back(), HasSubstr(part));
  EXPECT_EQ(listing(out()), before);
  return finished;
}

std::vector<std::string> listing(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ignored))
    names.push_back(entry.path().lexically_relative(folder).string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string read_bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

void edit(const fs::path& file, const std::string& from, const std::string& to) {
  std::string text = read_bytes(file);
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from << " is not in " << file;
  write_bytes(file, text.replace(at, from.size(), to));
}

}  // namespace photohull::test
