// Scenes that cannot be reconstructed: exit code 1 and one sentence that names file and field.
#include <cstring>

#include "io/image_file.h"
#include "io/write_scene.h"
#include "sphere_scene.h"
#include "support/cameras.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;

class BadScene : public SphereScene {
 protected:
  /// A plain reconstruction fails and names these; `info` too unless it needs pixels to know.
  void refuse(const std::vector<std::string>& parts, const Arguments& more = {}) const {
    fail(1, reconstruct(more), parts);
  }
  void refuse_scene(const std::vector<std::string>& parts, const Arguments& more = {}) const {
    refuse(parts, more);
    Arguments info = {"info", scene()};
    info.insert(info.end(), more.begin(), more.end());
    fail(1, info, parts);
  }
  std::string par() const { return path("scene_par.txt"); }
  /// The number at a position of the line of a view, replaced.
  void set_field(int view, int field, const std::string& value) const {
    std::istringstream in(read_bytes(par()));
    std::string text, line;
    for (int row = -1; std::getline(in, line); ++row) {
      std::istringstream words(line);
      std::string word, changed;
      for (int i = 0; words >> word; ++i)
        changed += (i ? " " : "") + (row == view && i == field ? value : word);
      text += changed + "\n";
    }
    write_bytes(par(), text);
  }
};

TEST_F(BadScene, Missing) {
  fail(1, {"reconstruct", path("nowhere"), "--out", out()}, {path("nowhere"), "no such file"});
  fail(1, {"info", path("nowhere")}, {path("nowhere")});
  fs::create_directories(folder_ / "empty");
  fail(1, {"reconstruct", path("empty"), "--out", out()}, {path("empty"), "no scene found"});
  fail(1, {"reconstruct", image(0), "--out", out()}, {image(0), "--format"});
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(BadScene, Images) {
  const Arguments strict = {"--strict"};
  const std::string whole = read_bytes(image(3));
  fs::remove(image(3));
  refuse_scene({"scene_par.txt", "view3.png", "not found"}, strict);
  write_bytes(image(3), "not a picture at all\n");
  refuse_scene({"scene_par.txt", "view3.png", "cannot be read as an image"}, strict);
  write_bytes(image(3), "");
  refuse_scene({"scene_par.txt", "view3.png", "cannot be read as an image"}, strict);
  for (const std::size_t length : {std::size_t(20), whole.size() / 2, whole.size() - 20}) {
    write_bytes(image(3), whole.substr(0, length));
    refuse({"view3.png"}, strict);
  }
  fs::remove(image(3));
  fs::create_directories(image(3));
  refuse_scene({"view3.png", "not found"}, strict);
}

TEST_F(BadScene, ImageOfAnotherSize) {
  io::write_colmap_text(scene_, folder_ / "t");
  const std::vector<std::uint8_t> grey(48 * 36 * 3, 100);
  io::write_png(image(3), 36, 48, 3, grey);
  fail(1, {"reconstruct", path("t"), "--out", out(), "--strict"},
       {"view3.png", "36 x 48", "96 x 72", "EXIF"});
  io::write_png(image(3), 48, 36, 3, grey);
  // A par file states no sizes, but the mask does.
  refuse({mask_file(3), "96 x 72", "48 x 36"});
}

TEST_F(BadScene, ParFile) {
  edit(par(), "16\n", "17\n");
  refuse_scene({"scene_par.txt", "17", "16"});
  edit(par(), "17\n", "many\n");
  refuse_scene({"scene_par.txt", "many"});
  edit(par(), "many\n", "16\n");
  edit(par(), "view5.png", "view4.png");
  refuse_scene({"scene_par.txt", "view4.png", "listed twice"});
}

TEST_F(BadScene, Matrices) {
  const std::string whole = read_bytes(par());
  const struct {
    int field;
    const char* value;
  } damages[] = {{1, "nan"},  {1, "0"},  {5, "-145"}, {9, "0"},
                 {10, "nan"}, {10, "7"}, {19, "inf"}, {20, "x"}};
  for (const auto& damage : damages) {
    SCOPED_TRACE(damage.value + std::string(" at ") + std::to_string(damage.field));
    set_field(2, damage.field, damage.value);
    refuse_scene({"scene_par.txt line 4"});
    write_bytes(par(), whole);
  }
  for (int i = 10; i <= 18; ++i) set_field(2, i, "0");  // a singular rotation
  refuse_scene({"scene_par.txt line 4", "not a rotation"});
}

TEST_F(BadScene, Box) {
  write_bytes(path("bbox.txt"), "0 0 0 1 1\n");
  refuse_scene({"bbox.txt", "6"});
  write_bytes(path("bbox.txt"), "0 0 0 1 0 1\n");
  refuse_scene({"bbox.txt", "along y"});
  write_bytes(path("bbox.txt"), "0 0 0 1 nan 1\n");
  refuse_scene({"bbox.txt"});
  fs::remove(path("bbox.txt"));
  // The first two cameras look down.
  refuse({"no camera has the box from --box"}, {"--views", "0-1", "--box", "0 0 100 1 1 101"});
  refuse({"the box from --box is 0.0017 across", "make --box larger"},
         {"--box", "0.1 -0.2 0.3 0.101 -0.199 0.301", "--quality", "draft"});
  // With masks such a box is made smaller; without them it may be a room, but for hulls.
  refuse({"camera view", "inside the box from --box"},
         {"--box", "-9 -9 -9 9 9 9", "--masks", "none", "--method", "hull"});
  refuse({"no surface was found", "cameras stand inside the box from --box"},
         {"--box", "-9 -9 -9 9 9 9", "--masks", "none"});
}

TEST_F(BadScene, TooFewViews) {
  refuse({"1 view is selected", "at least 2"}, {"--views", "3"});
  scene_.views.resize(1);
  write_scene_file();
  refuse_scene({"1 view is listed", "at least 2"});
  write_bytes(par(), "0\n");
  refuse_scene({"scene_par.txt"});
}

TEST_F(BadScene, TruncatedColmapBinaries) {
  io::write_colmap_binary(scene_, folder_ / "b");
  for (const char* name : {"cameras.bin", "images.bin", "points3D.bin"}) {
    const fs::path file = folder_ / "b" / name;
    const std::string whole = read_bytes(file);
    for (const std::size_t length :
         {std::size_t(0), std::size_t(5), whole.size() / 2, whole.size() - 1}) {
      write_bytes(file, whole.substr(0, length));
      fail(1, {"reconstruct", path("b"), "--out", out()}, {name});
    }
    write_bytes(file, whole);
  }
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(BadScene, DamagedTransforms) {
  io::write_transforms(scene_, folder_ / "j");
  const fs::path file = folder_ / "j/transforms.json";
  const std::string whole = read_bytes(file);
  write_bytes(file, whole.substr(0, whole.size() / 2));
  fail(1, {"reconstruct", path("j"), "--out", out()}, {"transforms.json"});
  write_bytes(file, "{}");
  fail(1, {"reconstruct", path("j"), "--out", out()}, {"transforms.json", "frames"});
  write_bytes(file, whole);
  edit(file, "\"transform_matrix\"", "\"matrix\"");
  fail(1, {"reconstruct", path("j"), "--out", out()}, {"transforms.json", "transform_matrix"});
}

TEST_F(BadScene, AbsurdResolutionSaysTheMemory) {
  RunOptions quick;
  quick.timeout_seconds = 20;
  for (const char* resolution : {"100000", "2147483647"})  // too much for parts, too
    fail(1, reconstruct({"--resolution", resolution}), {"MiB", "--resolution"}, quick);
  fail(1, reconstruct({"--resolution", "4300", "--method", "space-carving"}),
       {"MiB", "in parts it cannot be made", "--method"}, quick);
  fail(1, reconstruct({"--voxel-size", "1e-300"}), {"--voxel-size"});
  EXPECT_FALSE(fs::exists(out()));
}

}  // namespace
}  // namespace photohull::test
