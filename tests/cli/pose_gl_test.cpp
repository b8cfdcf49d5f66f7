// board, synthesize with a sheet, pose and reconstruct, from the command line.
#include <OpenImageIO/imagebuf.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "child_process.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "io/mesh/read_mesh.h"
#include "sphere_scene.h"
#include "support/scratch_folder.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

constexpr int kViews = 8;

class PoseCommand : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  json read(const std::string& name) const { return json::parse(read_bytes(folder_ / name)); }

  void make_board(const std::string& name = "board.pdf") const {
    const Finished made = run_photohull({"board", "--out", path(name)});
    ASSERT_EQ(made.code, 0) << made.err;
  }

  /// A pawn on the sheet, in `table`.
  void photograph_table() const {
    make_board();
    write_atomically(folder_ / "table.json", R"({"geometry": {"shape": "pawn"},
      "material": {"base": [0.6, 0.33, 0.16]}, "background": {"colour": [0.1, 0.12, 0.14]},
      "sheet": {"board": "board.json", "fill": 0.6, "hidden": 0.2},
      "image": {"width": 800, "height": 600, "samples": 3, "maps": false}, "truth_samples": 2000,
      "cameras": {"rings": [{"count": 4, "elevation": 32}, {"count": 4, "elevation": 55, "phase": 0.5}],
                  "distance": 3.2, "fill": 0.5},
      "degradations": {"k1": -0.05, "photon_noise": 0.01, "blur": 0.5}})");
    const Finished made = run_photohull({"synthesize", path("table.json"), "--out", path("table")});
    ASSERT_EQ(made.code, 0) << made.err;
  }

  ScratchFolder folder_;
};

double overlap(const Mask& a, const Mask& b) {
  double both = 0, either = 0;
  for (std::size_t i = 0; i < a.coverage.size(); ++i) {
    const bool x = a.coverage[i] >= 128, y = b.coverage[i] >= 128;
    both += x && y, either += x || y;
  }
  return both / either;
}

/// Share of the exact mask that the other one lacks.
double missed(const Mask& mask, const Mask& exact) {
  double lacking = 0, all = 0;
  for (std::size_t i = 0; i < exact.coverage.size(); ++i) {
    const bool there = exact.coverage[i] >= 128;
    all += there, lacking += there && mask.coverage[i] < 128;
  }
  return lacking / all;
}

TEST_F(PoseCommand, PhotographsOnASheetBecomeAScene) {
  photograph_table();
  // One that shows nothing, and one that is no photograph.
  const std::vector<std::uint8_t> grey(std::size_t(800) * 600 * 3, 90);
  io::write_png(folder_ / "table/images/grey.png", 800, 600, 3, grey);
  write_atomically(folder_ / "table/images/torn.png", "\x89PNG\r\n\x1a\n and nothing more");
  const Finished posed = run_photohull(
      {"pose", path("table/images"), "--board", path("board.json"), "--out", path("scene")});
  ASSERT_EQ(posed.code, 0) << posed.err;
  EXPECT_THAT(posed.out, HasSubstr("8 of 10 photographs have a pose"));
  EXPECT_THAT(posed.out, HasSubstr("grey.png"));
  EXPECT_THAT(posed.out, HasSubstr("no tag was found"));
  EXPECT_THAT(posed.out, HasSubstr("torn.png"));
  const json report = read("scene/pose.json");
  EXPECT_LT(report["rms"], 0.15);
  EXPECT_FALSE(report["bend"]["found"]);
  const ColourImage sides = io::read_image(folder_ / "scene/coverage.png");
  EXPECT_EQ(sides.width, 1000);
  EXPECT_THAT(posed.err, testing::Not(HasSubstr("coverage.png")));  // no gap
  // The cameras are where they were.
  const Scene scene = io::load_scene(path("scene"), {}), truth = io::load_scene(path("table"), {});
  ASSERT_EQ(scene.views.size(), std::size_t(kViews));
  const json sheet = read("table/spec.json")["result"]["sheet"];
  const glm::dvec3 origin(sheet["origin"][0], sheet["origin"][1], sheet["origin"][2]);
  const double unit = sheet["unit"];
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    const glm::dvec3 exact = (truth.views[i].camera.center() - origin) / unit;
    EXPECT_LT(glm::length(scene.views[i].camera.center() - exact), 1e-3 * glm::length(exact));
    EXPECT_NEAR(scene.views[i].camera.intrinsics.fx / truth.views[i].camera.intrinsics.fx, 1, 2e-3);
    ASSERT_FALSE(scene.views[i].mask.empty());
    EXPECT_TRUE(scene.views[i].mask_made);
    EXPECT_FALSE(truth.views[i].mask_made);
    // Where eight photographs do not agree on a shadow at the object's foot, it is part of the
    // mask; the object is whole.
    const Mask mask = io::read_mask(scene.views[i].mask),
               exact_mask = io::read_mask(truth.views[i].mask);
    EXPECT_GT(overlap(mask, exact_mask), 0.8) << scene.views[i].name;
    EXPECT_LT(missed(mask, exact_mask), 0.02) << scene.views[i].name;
  }
  const Finished made = run_photohull({"reconstruct", path("scene"), "--out", path("model"),
                                       "--method", "hull", "--resolution", "48"});
  EXPECT_TRUE(made.code == 0 || made.code == 3) << made.err;
  EXPECT_GE(read("model/report.json")["masks"]["full_evidence"], 1);  // no mask is believed alone
  // Nothing of the paper: no vertex lies below the box.
  const TriMesh mesh = read_mesh(path("model/mesh.ply"));
  ASSERT_FALSE(mesh.positions.empty());
  const double voxel = read("model/report.json")["grid"]["voxel_size"];
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    ASSERT_GT(mesh.world(v).z, scene.box->min.z - voxel);
}

TEST_F(PoseCommand, AGapIsToldWithItsPicture) {
  photograph_table();
  const std::vector<std::string> names = listing(folder_ / "table/images");
  ASSERT_EQ(names.size(), std::size_t(kViews));
  // At 0, 90 and 45 degrees about the sheet.
  const Finished posed =
      run_photohull({"pose", path("table/images/" + names[0]), path("table/images/" + names[1]),
                     path("table/images/" + names[4]), "--board", path("board.json"), "--out",
                     path("scene"), "--no-masks", "--focal", "900"});
  ASSERT_EQ(posed.code, 0) << posed.err;
  EXPECT_EQ(read("scene/pose.json")["cameras"][0]["stated_focal_length"], 900);
  EXPECT_THAT(posed.err, HasSubstr("from one side: as seen from above they span 90 degrees"));
  EXPECT_THAT(posed.err, HasSubstr("; " + path("scene/coverage.png") + " shows where\n"));
  EXPECT_TRUE(fs::exists(folder_ / "scene/coverage.png"));
}

TEST_F(PoseCommand, AFocalLengthThatNoPhotographTakesIsTold) {
  photograph_table();
  fs::create_directories(folder_ / "phone");
  for (const std::string& name : listing(folder_ / "table/images")) {
    OIIO::ImageBuf photo(path("table/images/" + name));
    ASSERT_TRUE(photo.read(0, 0, true, OIIO::TypeDesc::UINT8));
    photo.specmod().attribute("Exif:FocalLengthIn35mmFilm", 40);
    ASSERT_TRUE(photo.write(path("phone/" + fs::path(name).stem().string() + ".jpg")));
  }
  const auto pose = [&] {
    return run_photohull({"pose", path("phone"), "--board", path("board.json"), "--out",
                          path("scene"), "--no-masks", "--focal", "900"});
  };
  const std::string warning =
      "--focal is not used: the photographs state their focal lengths, or cannot be read";
  const Finished all = pose();
  ASSERT_EQ(all.code, 0) << all.err;
  EXPECT_THAT(all.err, HasSubstr(warning));
  EXPECT_THAT(read("scene/pose.json")["warnings"].dump(), HasSubstr(warning));
  // One without is enough.
  fs::copy(folder_ / "table/images/0000.png", folder_ / "phone");
  const Finished but_one = pose();
  ASSERT_EQ(but_one.code, 0) << but_one.err;
  EXPECT_THAT(but_one.err, testing::Not(HasSubstr("is not used")));
}

TEST_F(PoseCommand, SameInputGivesTheSameBytes) {
  photograph_table();
  for (const char* out : {"one", "two"}) {
    const Finished posed = run_photohull({"pose", path("table/images"), "--board",
                                          path("board.json"), "--out", path(out), "--no-masks"});
    ASSERT_EQ(posed.code, 0) << posed.err;
  }
  EXPECT_EQ(read_bytes(folder_ / "one/pose.json"), read_bytes(folder_ / "two/pose.json"));
  EXPECT_EQ(read_bytes(folder_ / "one/transforms.json"),
            read_bytes(folder_ / "two/transforms.json"));
}

TEST_F(PoseCommand, MistakesAreNamed) {
  make_board();
  make_board("other.svg");
  EXPECT_THAT(read_bytes(folder_ / "other.svg"), testing::StartsWith("<svg"));
  const auto pose = [&](const Arguments& more) {
    Arguments all = {"pose", "--out", path("scene")};
    all.insert(all.end(), more.begin(), more.end());
    return run_photohull(all);
  };
  const Finished ending = run_photohull({"board", "--out", path("board.png")});
  EXPECT_EQ(ending.code, 2);
  EXPECT_THAT(ending.err, HasSubstr(".pdf or .svg"));
  const Finished no_diameter = run_photohull({"board", "--out", path("rim.pdf"), "--kind", "rim"});
  EXPECT_EQ(no_diameter.code, 2);
  EXPECT_THAT(no_diameter.err, HasSubstr("say how large the cylinder is: --diameter"));
  const Finished rim =
      run_photohull({"board", "--out", path("rim.pdf"), "--kind", "rim", "--diameter", "200"});
  EXPECT_EQ(rim.code, 0);
  EXPECT_THAT(rim.out, HasSubstr("40 tags of 12.5 mm on a strip of 628.6 x 18.75 mm, in 4 pieces"));
  EXPECT_EQ(read("rim.json")["tags"][0]["corners"][0].size(), 3u);
  fs::create_directories(folder_ / "photos");
  const std::vector<std::uint8_t> grey(std::size_t(64) * 48 * 3, 90);
  io::write_png(folder_ / "photos/a.png", 64, 48, 3, grey);
  const Finished blank = pose({path("photos"), "--board", path("board.json")});
  EXPECT_EQ(blank.code, 1);
  EXPECT_THAT(blank.err, HasSubstr("a.png: no tag was found"));
  EXPECT_FALSE(fs::exists(folder_ / "scene"));
  const Finished no_board = pose({path("photos"), "--board", path("photos/a.png")});
  EXPECT_EQ(no_board.code, 1);
  EXPECT_THAT(no_board.err, HasSubstr("a.png"));
  for (const char* focal : {"0", "28cm", "5"}) {
    const Finished refused =
        pose({path("photos"), "--board", path("board.json"), "--focal", focal});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr(std::string("--focal ") + focal + ": "));
  }
  const Finished bar = pose({path("photos"), "--board", path("board.json"), "--bar", "15"});
  EXPECT_EQ(bar.code, 2);
  EXPECT_THAT(bar.err, HasSubstr("150"));
}

}  // namespace
}  // namespace photohull::test
