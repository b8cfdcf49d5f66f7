// pose --with colmap, from the command line: COLMAP itself, and scripts in its place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "cameras/gauge.h"
#include "child_process.h"
#include "core/atomic_file.h"
#include "core/child_process.h"
#include "fake_colmap.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "sphere_scene.h"
#include "support/scratch_folder.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

class PoseWithColmap : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  void write_photos(int count) const {
    fs::create_directories(folder_ / "my photos");
    const std::vector<std::uint8_t> grey(std::size_t(64) * 48 * 3, 90);
    for (int i = 0; i < count; ++i)
      io::write_png(folder_ / "my photos" / (std::to_string(i) + ".PNG"), 64, 48, 3, grey);
  }
  Finished pose(const RunOptions& options, const Arguments& more = {}) const {
    Arguments all = {"pose", path("my photos"), "--with", "colmap", "--out", path("scan")};
    all.insert(all.end(), more.begin(), more.end());
    return run_photohull(all, options);
  }
  /// Of a textured object; `cameras` of the spec.
  void photograph(const std::string& cameras) const {
    write_atomically(folder_ / "folds.json", R"({"geometry": {"shape": "folds"},
      "material": {"contrast": 1}, "image": {"width": 640, "height": 480, "maps": false},
      "truth_samples": 2000, "cameras": {"fill": 0.8, )" +
                                                 cameras + "}}");
    const Finished made = run_photohull({"synthesize", path("folds.json"), "--out", path("true")});
    ASSERT_EQ(made.code, 0) << made.err;
    fs::create_directories(folder_ / "my photos");
    for (const auto& entry : fs::directory_iterator(folder_ / "true/images"))
      fs::copy(entry.path(), folder_ / "my photos");
  }
  Finished pose_patiently() const {
    RunOptions patient;
    patient.timeout_seconds = 600;
    return pose(patient);
  }
  /// The focal length's error, relative, and the principal point's in pixels.
  static glm::dvec3 lens_error(const SourceView& view, const SourceView& truth) {
    const Intrinsics &k = view.camera.intrinsics, &t = truth.camera.intrinsics;
    return {k.cx - t.cx, k.cy - t.cy, k.fx / t.fx - 1};
  }

  ScratchFolder folder_;
};

TEST_F(PoseWithColmap, SaysThatColmapIsNotInstalled) {
  write_photos(4);
  RunOptions options;
  options.environment = {"PATH=" + path("nowhere")};
  const Finished posed = pose(options);
  EXPECT_EQ(posed.code, 1);
  EXPECT_THAT(posed.err, HasSubstr("COLMAP, which is not installed"));
  EXPECT_THAT(posed.err, HasSubstr("--board"));
  EXPECT_FALSE(fs::exists(folder_ / "scan/transforms.json"));
}

TEST_F(PoseWithColmap, RepeatsTheLastLinesOfAFailure) {
  write_photos(4);
  const Finished posed = pose(with_colmap(
      folder_.path(),
      "case $1 in feature_extractor) echo begun; echo 'the disk is full' >&2; exit 7;; esac"));
  EXPECT_EQ(posed.code, 1);
  EXPECT_THAT(posed.err, HasSubstr("colmap feature_extractor failed (exit code 7)"));
  EXPECT_THAT(posed.err, HasSubstr("the disk is full"));
  EXPECT_THAT(read_bytes(folder_ / "scan/colmap/colmap.log").size(), testing::Gt(10u));
}

TEST_F(PoseWithColmap, SaysThatNoModelResultsAndWhy) {
  write_photos(4);
  const Finished posed = pose(with_colmap(
      folder_.path(),
      "case $1 in feature_extractor) echo 'Processed file [1/4]'; echo '  Name:       "
      "lens_1/00001_0.PNG'; echo '  Features:        17';; mapper) echo '=> No good initial "
      "image "
      "pair found.'; echo 'ERROR: failed to create sparse model' >&2; exit 1;; esac"));
  EXPECT_EQ(posed.code, 1);
  EXPECT_THAT(posed.err, HasSubstr("cameras of 0 of 4 photographs, and three are needed"));
  EXPECT_THAT(posed.err, HasSubstr("0.PNG: COLMAP found only 17 features"));
}

TEST_F(PoseWithColmap, GivesMasksAndOrderToColmap) {
  write_photos(3);
  fs::create_directories(folder_ / "masks");
  const std::vector<std::uint8_t> white(std::size_t(64) * 48, 255);
  io::write_png(folder_ / "masks/0.png", 64, 48, 1, white);
  io::write_png(folder_ / "masks/2.PNG.png", 64, 48, 1, white);
  const Finished posed =
      pose(with_colmap(folder_.path(), "echo \"$@\" >> '" + path("words") +
                                           "'; case $1 in mapper) echo 'failed to create sparse "
                                           "model'; exit 1;; esac"),
           {"--masks", path("masks"), "--ordered"});
  EXPECT_EQ(posed.code, 1);
  const std::string words = read_bytes(folder_ / "words");
  EXPECT_THAT(words, HasSubstr("--ImageReader.mask_path " + path("scan/colmap/masks")));
  EXPECT_THAT(words, HasSubstr("sequential_matcher"));
  EXPECT_THAT(words, testing::Not(HasSubstr("exhaustive_matcher")));
  EXPECT_TRUE(fs::exists(folder_ / "scan/colmap/masks/lens_1/00001_0.PNG.png"));
  EXPECT_FALSE(fs::exists(folder_ / "scan/colmap/masks/lens_1/00002_1.PNG.png"));
  EXPECT_TRUE(fs::exists(folder_ / "scan/colmap/masks/lens_1/00003_2.PNG.png"));
  EXPECT_EQ(read_bytes(folder_ / "scan/colmap/images/lens_1/00002_1.PNG"),
            read_bytes(folder_ / "my photos/1.PNG"));
  const Finished nowhere = pose({}, {"--masks", path("my photos/none")});
  EXPECT_EQ(nowhere.code, 1);
  EXPECT_THAT(nowhere.err, HasSubstr("there is no such mask folder"));
}

TEST_F(PoseWithColmap, GivesFocalLengthsToColmap) {
  write_photos(3);
  const RunOptions listing_words =
      with_colmap(folder_.path(), "echo \"$@\" >> '" + path("words") +
                                      "'; case $1 in mapper) echo 'failed to create sparse "
                                      "model'; exit 1;; esac");
  EXPECT_EQ(pose(listing_words, {"--focal", "70.5"}).code, 1);
  std::string words = read_bytes(folder_ / "words");
  EXPECT_THAT(words, HasSubstr("--ImageReader.camera_params 70.5,32,24,0"));
  EXPECT_THAT(words, testing::Not(HasSubstr("--image_list_path")));
  // Of another size: a lens of its own, whose principal point is another.
  const std::vector<std::uint8_t> grey(std::size_t(128) * 96 * 3, 90);
  io::write_png(folder_ / "my photos/3.PNG", 128, 96, 3, grey);
  fs::remove(folder_ / "words");
  EXPECT_EQ(pose(listing_words, {"--focal", "28mm"}).code, 1);
  words = read_bytes(folder_ / "words");
  const std::string list = "--image_list_path " + path("scan/colmap/images.txt");
  EXPECT_THAT(words, HasSubstr(list + " --ImageReader.camera_params 51.772,32,24,0"));
  EXPECT_THAT(words, HasSubstr(list + " --ImageReader.camera_params 103.544,64,48,0"));
  const Finished wide = pose(listing_words, {"--focal", "7"});
  EXPECT_EQ(wide.code, 2);
  EXPECT_THAT(wide.err, HasSubstr("--focal 7: in 0.PNG, of 64 x 48 pixels, it is a field of view"));
}

TEST_F(PoseWithColmap, CtrlCEndsColmap) {
  write_photos(4);
  RunOptions options =
      with_colmap(folder_.path(), "case $1 in exhaustive_matcher) echo $$ > '" + path("pid") +
                                      "'; sleep 100; touch '" + path("went_on") + "';; esac");
  options.signal_after = " matches\n";
  options.signal_delay_seconds = 1;
  options.signal = SIGINT;
  const Finished posed = pose(options);
  EXPECT_EQ(posed.code, 130) << posed.err;
  ASSERT_TRUE(fs::exists(folder_ / "pid"));
  const std::string bytes = read_bytes(folder_ / "pid");
  const pid_t child = pid_t(std::stol(bytes));
  EXPECT_NE(::kill(child, 0), 0);
  EXPECT_FALSE(fs::exists(folder_ / "went_on"));
}

TEST_F(PoseWithColmap, MistakesAreNamed) {
  write_photos(2);
  const Finished few = pose({});
  EXPECT_EQ(few.code, 1);
  EXPECT_THAT(few.err, HasSubstr("three photographs at least, and there are 2"));
  const Finished bar = pose({}, {"--bar", "149"});
  EXPECT_EQ(bar.code, 2);
  EXPECT_THAT(bar.err, HasSubstr("--bar does not go together with --with colmap"));
  const Finished neither = run_photohull({"pose", path("my photos"), "--out", path("scan")});
  EXPECT_EQ(neither.code, 2);
  EXPECT_THAT(neither.err, HasSubstr("--with colmap"));
  // What is not this program's is left alone.
  write_photos(4);
  fs::create_directories(folder_ / "scan/colmap/images");
  write_atomically(folder_ / "scan/colmap/images/mine.txt", "mine");
  const Finished foreign = pose(with_colmap(folder_.path(), "true"));
  EXPECT_EQ(foreign.code, 1);
  EXPECT_THAT(foreign.err, HasSubstr("did not make"));
  EXPECT_TRUE(fs::exists(folder_ / "scan/colmap/images/mine.txt"));
}

TEST_F(PoseWithColmap, FindsTheCamerasOfATexturedObject) {
  ASSERT_TRUE(is_on_path("colmap")) << "scripts/test.sh installs it";
  photograph(R"("principal_offset": [14, -9], "rings": [{"count": 12, "elevation": 20},
                 {"count": 12, "elevation": 55}])");
  write_atomically(folder_ / "my photos/torn.jpg", "no picture");
  write_atomically(folder_ / "my photos/IMG_1.HEIC", "no reader");
  write_atomically(folder_ / "my photos/._1.png", "hidden");
  const Finished posed = pose_patiently();
  ASSERT_EQ(posed.code, 0) << posed.err;
  EXPECT_THAT(posed.out, HasSubstr("24 of 25 photographs have a pose"));
  EXPECT_THAT(posed.out, HasSubstr("torn.jpg"));
  EXPECT_THAT(posed.err, HasSubstr("IMG_1.HEIC"));
  const json report = json::parse(read_bytes(folder_ / "scan/pose.json"));
  EXPECT_TRUE(fs::exists(folder_ / "scan" / std::string(report["model"]) / "images.bin"));
  const Scene scene = io::load_scene(folder_ / "scan", {}),
              truth = io::load_scene(folder_ / "true", {});
  ASSERT_EQ(scene.views.size(), truth.views.size());
  // The mapper has the principal point in the middle; two rings tell where it is.
  const glm::dvec3 error = lens_error(scene.views[0], truth.views[0]);
  EXPECT_LT(std::abs(error.x), 1.5);
  EXPECT_LT(std::abs(error.y), 4);
  EXPECT_LT(std::abs(error.z), 0.01);
  for (const double sigma : report["cameras"][0]["principal_point_sigma"]) EXPECT_LT(sigma, 4);
  std::vector<glm::dvec3> from, to;
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    ASSERT_EQ(scene.views[i].name, truth.views[i].name);
    cameras.push_back(scene.views[i].camera);
    from.push_back(scene.views[i].camera.center());
    to.push_back(truth.views[i].camera.center());
  }
  const std::vector<Camera> moved = with_world_moved(cameras, from, to);
  const double distance = glm::length(to[0] - to[6]) / 2;  // of one ring, across
  for (std::size_t i = 0; i < moved.size(); ++i)
    EXPECT_LT(glm::length(moved[i].center() - to[i]), 0.01 * distance) << scene.views[i].name;
}

}  // namespace
}  // namespace photohull::test
