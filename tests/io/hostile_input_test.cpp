// Damaged and hostile files: whatever they hold, load_scene returns a scene or throws Error,
// without crashing and without asking for memory that the file's size does not justify.
#include <cstdint>
#include <cstring>
#include <fstream>

#include "io/load_scene.h"
#include "io/write_scene.h"
#include "scene_fixture.h"

namespace photohull::io {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;
using testing::AllOf;
using testing::HasSubstr;

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// True when the scene loads, false on Error; anything else fails the test.
bool loads(const fs::path& path) {
  try {
    load_scene(path);
    return true;
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr(path.parent_path().string()));
  } catch (const std::exception& other) {
    ADD_FAILURE() << path << ": " << other.what();
  }
  return false;
}

class HostileInput : public TemporaryFolder {
 protected:
  HostileInput() {
    for (const char* name : {"a.png", "b.png", "c.png"}) put_image(std::string("images/") + name);
    Scene scene = example_scene(folder_ / "images");
    write_middlebury(scene, folder_ / "m");
    write_transforms(scene, folder_ / "j");
    write_colmap_text(scene, folder_ / "t");
    write_colmap_binary(scene, folder_ / "b");
  }
  const std::vector<std::string> files_ = {"m/scene_par.txt", "m/bbox.txt",   "j/transforms.json",
                                           "t/cameras.txt",   "t/images.txt", "t/points3D.txt",
                                           "b/cameras.bin",   "b/images.bin", "b/points3D.bin"};
};

TEST_F(HostileInput, BinaryFilesCutAnywhereAreRefused) {
  for (const char* name : {"b/cameras.bin", "b/images.bin", "b/points3D.bin"}) {
    const std::string whole = contents(folder_ / name);
    for (std::size_t length = 0; length < whole.size(); ++length) {
      put(name, whole.substr(0, length));
      EXPECT_FALSE(loads(folder_ / "b")) << name << " cut to " << length;
    }
    put(name, whole + "x");
    EXPECT_THAT(error_of([&] { load_scene(folder_ / "b"); }),
                AllOf(HasSubstr(name), HasSubstr("1 bytes are left")));
    put(name, whole);
  }
  EXPECT_TRUE(loads(folder_ / "b"));
}

TEST_F(HostileInput, TruncationNamesFileOffsetAndField) {
  const std::string whole = contents(folder_ / "b/cameras.bin");
  put("b/cameras.bin", whole.substr(0, whole.size() - 3));
  EXPECT_THAT(error_of([&] { load_scene(folder_ / "b"); }),
              AllOf(HasSubstr("cameras.bin offset"), HasSubstr("within params")));
}

TEST_F(HostileInput, ImpossibleCountsAreRefusedBeforeTheyAreBelieved) {
  const std::uint64_t huge = ~std::uint64_t(0) / 2;
  for (const char* name : {"b/cameras.bin", "b/images.bin", "b/points3D.bin"}) {
    const std::string whole = contents(folder_ / name);
    std::string bytes = whole;
    std::memcpy(bytes.data(), &huge, sizeof huge);
    put(name, bytes);
    EXPECT_THAT(error_of([&] { load_scene(folder_ / "b"); }),
                AllOf(HasSubstr(name), HasSubstr("cannot hold so many")));
    put(name, whole);
  }
  // The number of observations of the last image is its last field.
  std::string images = contents(folder_ / "b/images.bin");
  std::memcpy(images.data() + images.size() - 8, &huge, sizeof huge);
  put("b/images.bin", images);
  EXPECT_THAT(error_of([&] { load_scene(folder_ / "b"); }), HasSubstr("num_points2D"));
}

TEST_F(HostileInput, UnknownBinaryLensIsNamed) {
  std::string cameras = contents(folder_ / "b/cameras.bin");
  const std::int32_t fov = 7;
  std::memcpy(cameras.data() + 12, &fov, sizeof fov);
  put("b/cameras.bin", cameras);
  EXPECT_THAT(error_of([&] { load_scene(folder_ / "b"); }),
              AllOf(HasSubstr("cameras.bin offset 8"), HasSubstr("FOV")));
}

// Random damage; the seed is fixed so that a failure can be repeated.
TEST_F(HostileInput, DamagedFilesNeverCrash) {
  std::uint32_t state = 12345;
  const auto random = [&](std::size_t below) {
    state = state * 1664525u + 1013904223u;
    return std::size_t((std::uint64_t(state) * below) >> 32);
  };
  const std::string palette = "\0\xff\x80-+.eE019nanif\"[]{},: \n\r#/\\"s;
  for (const std::string& name : files_) {
    const std::string whole = contents(folder_ / name);
    for (int round = 0; round < 300; ++round) {
      std::string bytes = whole;
      for (std::size_t hits = 1 + random(3); hits > 0; --hits) {
        const std::size_t at = random(bytes.size());
        switch (random(4)) {
          case 0:
            bytes[at] = palette[random(palette.size())];
            break;
          case 1:
            bytes[at] = char(bytes[at] ^ (1 << random(8)));
            break;
          case 2:
            bytes.erase(at, 1 + random(8));
            break;
          default:
            bytes.insert(at, bytes.substr(random(bytes.size()), 1 + random(16)));
            break;
        }
      }
      put(name, bytes);
      loads((folder_ / name).parent_path());
    }
    put(name, whole);
  }
  for (const char* intact : {"m", "j", "t", "b"}) EXPECT_TRUE(loads(folder_ / intact));
}

}  // namespace
}  // namespace photohull::io
