#include "scene_fixture.h"

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <glm/gtc/quaternion.hpp>

#include "io/image_file.h"

namespace photohull::io {
namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  folder_ = fs::temp_directory_path() / concat("photohull_io_", ::getpid(), "_", test->name());
  fs::create_directories(folder_);
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

fs::path TemporaryFolder::put(const std::string& name, const std::string& text) const {
  const fs::path path = folder_ / name;
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

fs::path TemporaryFolder::put_image(const std::string& name, int width, int height,
                                    int value) const {
  const fs::path path = folder_ / name;
  fs::create_directories(path.parent_path());
  const std::vector<std::uint8_t> pixels(std::size_t(width) * height * 3, std::uint8_t(value));
  write_png(path, width, height, 3, pixels);
  return path;
}

std::string error_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  } catch (const std::exception& other) {
    ADD_FAILURE() << "not an Error: " << other.what();
    return {};
  }
  ADD_FAILURE() << "no Error was thrown";
  return {};
}

Scene example_scene(const fs::path& images) {
  Scene scene;
  scene.box = Box{{-1, -2, -3}, {1.5, 2.5, 3.125}};
  for (int i = 0; i < 3; ++i) {
    SourceView view;
    view.name = std::string(1, char('a' + i)) + ".png";
    view.image = images / view.name;
    view.camera.intrinsics = {8, 6, 10.0 + i, 11.0 - 0.5 * i, 0.0, 3.1 + 0.2 * i, 2.7};
    const glm::dquat q = glm::normalize(glm::dquat(0.9, 0.1 * i, -0.2, 0.3));
    view.camera.cam_from_world = {glm::mat3_cast(q), {0.1 * i, -0.2, 7.0}};
    scene.views.push_back(view);
  }
  for (int i = 0; i < 12; ++i)
    scene.points.emplace_back(0.1 * i, std::sin(1.0 * i), 1.0 / 3.0 - 0.05 * i);
  return scene;
}

double largest_shift(const Scene& a, const Scene& b) {
  double largest = a.views.size() == b.views.size() ? 0.0 : 1e9;
  for (const SourceView& view : a.views) {
    const auto same = std::find_if(b.views.begin(), b.views.end(),
                                   [&](const SourceView& v) { return v.name == view.name; });
    if (same == b.views.end()) return 1e9;
    for (const glm::dvec3& p :
         {glm::dvec3(0), glm::dvec3(1, 0.5, -0.5), glm::dvec3(-1, 1, 2), glm::dvec3(0.3, -1, 1)}) {
      const auto pa = view.camera.project(p), pb = same->camera.project(p);
      if (!pa || !pb) return 1e9;
      largest = std::max(largest, glm::distance(*pa, *pb));
    }
  }
  return largest;
}

}  // namespace photohull::io
