// scan, from the command line: a sheet, COLMAP (a script in its place), films, and what is kept.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "child_process.h"
#include "core/atomic_file.h"
#include "core/child_process.h"
#include "fake_colmap.h"
#include "io/image_file.h"
#include "sphere_scene.h"
#include "support/scratch_folder.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char *kCamerasKept = "the cameras are those of the run before",
                     *kModelKept = "the model is that of the run before";

class ScanCommand : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  json read(const std::string& name) const { return json::parse(read_bytes(folder_ / name)); }

  /// A pawn on a sheet, photographed into `photos`, with the sheet's description among them.
  void photograph_table() const {
    ASSERT_EQ(run_photohull({"board", "--out", path("board.pdf")}).code, 0);
    write_atomically(folder_ / "table.json", R"({"geometry": {"shape": "pawn"},
      "material": {"base": [0.6, 0.33, 0.16]}, "background": {"colour": [0.1, 0.12, 0.14]},
      "sheet": {"board": "board.json", "fill": 0.6},
      "image": {"width": 640, "height": 480, "samples": 2, "maps": false}, "truth_samples": 2000,
      "cameras": {"rings": [{"count": 8, "elevation": 40}], "distance": 3.2, "fill": 0.5}})");
    const Finished made = run_photohull({"synthesize", path("table.json"), "--out", path("table")});
    ASSERT_EQ(made.code, 0) << made.err;
    fs::rename(folder_ / "table/images", folder_ / "photos");
    fs::copy(folder_ / "board.json", folder_ / "photos");
  }
  void write_photos(int count) const {
    fs::create_directories(folder_ / "photos");
    const std::vector<std::uint8_t> grey(std::size_t(64) * 48 * 3, 90);
    for (int i = 0; i < count; ++i)
      io::write_png(folder_ / "photos" / (std::to_string(i) + ".png"), 64, 48, 3, grey);
  }
  /// A quick model.
  Finished scan(const Arguments& more = {}, const RunOptions& options = {}) const {
    Arguments all = {"scan", path("photos"), "--out", path("model"), "--method",
                     "hull", "--resolution", "32",    "--texture",   "256"};
    all.insert(all.end(), more.begin(), more.end());
    return run_photohull(all, options);
  }

  ScratchFolder folder_;
};

TEST_F(ScanCommand, PhotographsOnASheetBecomeATexturedModelAndStepsAreKept) {
  photograph_table();
  const Finished first = scan();
  ASSERT_TRUE(first.code == 0 || first.code == 3) << first.err;
  EXPECT_THAT(first.out, HasSubstr("8 of 8 photographs have a pose"));
  EXPECT_THAT(first.err, Not(HasSubstr("of the run before")));
  for (const char* name : {"mesh.glb", "mesh.ply", "report.html", "report.json", "preview.png",
                           "scene/transforms.json", "scene/pose.json"})
    EXPECT_TRUE(fs::exists(folder_ / "model" / name)) << name;
  EXPECT_EQ(listing(folder_ / "model/scene/masks").size(), 8u);
  EXPECT_EQ(read("model/report.json")["texture"]["pages"].size(), 1u);

  // The same again does nothing, and tells the same.
  const Finished again = scan();
  EXPECT_EQ(again.code, first.code);
  EXPECT_THAT(again.err, AllOf(HasSubstr(kCamerasKept), HasSubstr(kModelKept)));
  EXPECT_THAT(again.out, AllOf(HasSubstr("mesh.glb"), HasSubstr("verdict: ")));

  // Another option of the model, and a mask that was touched up, leave the cameras.
  const Finished finer = scan({"--mesh-error", "1"});
  EXPECT_THAT(finer.err, AllOf(HasSubstr(kCamerasKept), Not(HasSubstr(kModelKept))));
  const fs::path mask = folder_ / "model/scene/masks" / listing(folder_ / "model/scene/masks")[0];
  const std::string before = read_bytes(mask);
  const std::vector<std::uint8_t> white(std::size_t(640) * 480, 255);
  io::write_png(mask, 640, 480, 1, white);
  const Finished touched = scan({"--mesh-error", "1"});
  EXPECT_THAT(touched.err, AllOf(HasSubstr(kCamerasKept), Not(HasSubstr(kModelKept))));

  // One of the sheet's, another photograph, and --fresh do not.
  EXPECT_THAT(scan({"--bar", "151"}).err, Not(HasSubstr(kCamerasKept)));
  EXPECT_EQ(read_bytes(mask), before);
  fs::remove(folder_ / "photos" / fs::path(listing(folder_ / "photos")[0]));
  EXPECT_THAT(scan({"--bar", "151"}).err, Not(HasSubstr(kCamerasKept)));
  EXPECT_THAT(scan({"--bar", "151", "--fresh"}).err, Not(HasSubstr("of the run before")));
}

TEST_F(ScanCommand, WithoutTheSheetsFileItsTagsAreNoticed) {
  photograph_table();
  fs::remove(folder_ / "photos/board.json");
  const Finished posed = scan(
      {}, with_colmap(folder_.path(),
                      "case $1 in mapper) echo 'failed to create sparse model'; exit 1;; esac"));
  EXPECT_EQ(posed.code, 1);
  EXPECT_THAT(posed.err, HasSubstr("shows tags of a printed sheet"));
  EXPECT_THAT(posed.err, HasSubstr("--board"));
}

TEST_F(ScanCommand, MistakesAreNamed) {
  write_photos(4);
  const auto expect = [&](int code, const Finished& ended, const std::string& words) {
    EXPECT_EQ(ended.code, code) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr(words));
  };
  RunOptions nowhere;
  nowhere.environment = {"PATH=" + path("nowhere")};
  expect(1, scan({}, nowhere), "COLMAP, which is not installed");
  expect(1,
         scan({}, with_colmap(folder_.path(),
                              "case $1 in mapper) echo 'failed to create'; exit 1;; esac")),
         "cameras of 0 of 4 photographs, and three are needed");
  expect(2, scan({"--bar", "149"}), "--bar is for photographs on a printed sheet");
  expect(2, scan({"--frames", "9"}), "--frames is for films");
  expect(2, scan({"--video", "a.mp4"}), "photographs and --video exclude each other");
  expect(2, run_photohull({"scan", "--out", path("model")}), "PHOTOS is missing");
  expect(2, run_photohull({"scan", path("photos"), "--out", path("photos")}),
         "is the folder of the photographs");
  expect(1, run_photohull({"scan", "--video", path("none.mp4"), "--out", path("model")}),
         "there is no such film");
  write_atomically(folder_ / "file", "a file");
  expect(1, run_photohull({"scan", path("photos"), "--out", path("file/model")}), "--out");
  fs::copy(folder_ / "photos/0.png", folder_ / "one.png");
  expect(1, run_photohull({"scan", path("one.png"), "--out", path("one")}),
         "three photographs at least, and there are 1");
  ASSERT_EQ(run_photohull({"board", "--out", path("board.pdf")}).code, 0);
  expect(1, scan({"--board", path("board.json")}), "no tag was found");
  expect(2, scan({"--board", path("board.json"), "--ordered"}), "--ordered does not go together");
}

TEST_F(ScanCommand, CtrlCLeavesNoStepThatIsTakenForDone) {
  write_photos(4);
  RunOptions options =
      with_colmap(folder_.path(), "case $1 in exhaustive_matcher) sleep 100;; esac");
  options.signal_after = " matches\n";
  options.signal_delay_seconds = 1;
  options.signal = SIGINT;
  EXPECT_EQ(scan({}, options).code, 130);
  EXPECT_FALSE(fs::exists(folder_ / "model/scene/transforms.json"));
  EXPECT_TRUE(read("model/scene/.photohull-scan").empty());
}

TEST_F(ScanCommand, AFilmGivesItsSharpestPictures) {
  if (!is_on_path("ffmpeg") || !is_on_path("ffprobe")) GTEST_SKIP() << "ffmpeg is not installed";
  photograph_table();
  // Each view stands still for a second of two pictures, of which the first is out of focus.
  Arguments words = {"ffmpeg",
                     "-v",
                     "error",
                     "-framerate",
                     "1",
                     "-i",
                     path("photos/%04d.png"),
                     "-vf",
                     "fps=2,gblur=sigma=4:enable='not(mod(n,2))'",
                     "-c:v",
                     "libx264",
                     "-crf",
                     "10",
                     "-pix_fmt",
                     "yuv444p",
                     path("film.mkv")};
  const Finished filmed = run_program(words);
  ASSERT_EQ(filmed.code, 0) << filmed.err;
  const auto pose = [&] {
    return run_photohull({"pose", "--video", path("film.mkv"), "--frames", "8", "--board",
                          path("board.json"), "--no-masks", "--out", path("scene")});
  };
  Finished posed = pose();
  ASSERT_EQ(posed.code, 0) << posed.err;
  EXPECT_THAT(posed.out, HasSubstr("8 of 8 photographs have a pose"));
  EXPECT_THAT(posed.err, Not(HasSubstr("less sharp")));
  EXPECT_EQ(listing(folder_ / "scene/frames").size(), 8u);
  EXPECT_THAT(read("scene/pose.json")["rms"].get<double>(), testing::Lt(0.3));
  // Frames of an earlier film go; what is no frame stays, and is told.
  posed = pose();
  EXPECT_EQ(posed.code, 0) << posed.err;
  write_atomically(folder_ / "scene/frames/mine.txt", "mine");
  posed = pose();
  EXPECT_EQ(posed.code, 1);
  EXPECT_THAT(posed.err, HasSubstr("did not make it"));
}

}  // namespace
}  // namespace photohull::test
