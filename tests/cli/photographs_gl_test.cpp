// Photographs that are not all there, not all readable, of another size, or very many.
#include <nlohmann/json.hpp>

#include "io/image_file.h"
#include "io/mesh/write_mesh.h"
#include "io/write_scene.h"
#include "sphere_scene.h"
#include "support/analytic_volumes.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class PhotographsOfScenes : public SphereScene {
 protected:
  Arguments hull(const Arguments& more = {}) const {
    Arguments all = reconstruct({"--method", "hull"});
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  nlohmann::json report() const {
    return nlohmann::json::parse(read_bytes(out() + "/report.json"));
  }
  static void expect_left_out(const nlohmann::json& entry, const std::string& name,
                              const std::string& reason, const std::string& detail) {
    EXPECT_THAT(entry["name"], HasSubstr(name));
    EXPECT_EQ(entry["reason"], reason);
    EXPECT_THAT(entry["detail"], HasSubstr(detail));
  }
};

/// Every other pixel row and column averaged away, rounded to the nearest.
void write_half(const fs::path& from, const fs::path& to, int channels) {
  const ColourImage image = io::read_image(from);
  const int width = image.width / 2, height = image.height / 2;
  std::vector<std::uint8_t> half;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c) {
        int sum = 2;
        for (int k = 0; k < 4; ++k)
          sum += image.bytes[4 * (std::size_t(2 * y + k / 2) * image.width + 2 * x + k % 2) + c];
        half.push_back(std::uint8_t(sum / 4));
      }
  fs::create_directories(to.parent_path());
  io::write_png(to, width, height, channels, half);
}

TEST_F(PhotographsOfScenes, AFewAreLeftOutAndReported) {
  fs::remove(image(2));
  write_bytes(image(9), "no picture\n");
  // The header of a file that is cut short tells nothing.
  const std::string whole = read_bytes(image(5));
  write_bytes(image(5), whole.substr(0, whole.size() / 2));
  const Finished run = succeed(hull());
  EXPECT_THAT(run.err, HasSubstr("1 of 16 photographs was not found and is left out (view2.png"));
  EXPECT_THAT(run.err, HasSubstr("1 of 16 photographs cannot be read and is left out (view9.png"));
  EXPECT_THAT(run.err, HasSubstr("1 of 14 photographs cannot be read and is left out (view5.png"));
  const nlohmann::json r = report();
  EXPECT_EQ(r["scene"]["views"], 13);
  EXPECT_EQ(r["photographs"]["listed"], 16);
  ASSERT_EQ(r["photographs"]["left_out"].size(), 3u);
  expect_left_out(r["photographs"]["left_out"][0], "view2.png", "missing", "looked in");
  expect_left_out(r["photographs"]["left_out"][1], "view9.png", "unreadable", "cannot be read");
  expect_left_out(r["photographs"]["left_out"][2], "view5.png", "unreadable", "cut short");
  EXPECT_EQ(r["masks"]["views"].size(), 13u);

  EXPECT_THAT(succeed({"info", scene()}).out, HasSubstr("14 of 16"));
  const auto info = nlohmann::json::parse(succeed({"info", scene(), "--json", "--cameras"}).out);
  EXPECT_EQ(info["views"].size(), 13u);
  EXPECT_EQ(info["left_out"].size(), 3u);
  EXPECT_THAT(info["warnings"].dump(), HasSubstr("view5.png"));
  EXPECT_THAT(succeed({"masks", scene(), "--masks", path("cutouts")}).out,
              HasSubstr("1 of 16 photographs was not found"));
  fs::remove_all(out());
  fail(1, hull({"--strict"}), {"view2.png", "view9.png", "--strict"});
  fail(1, {"info", scene(), "--strict"}, {"view2.png", "--strict"});
}

/// The result is that of a scene that never listed the photograph.
TEST_F(PhotographsOfScenes, WhatIsLeftOutLeavesNoTrace) {
  succeed(hull({"--views", "0-4,6-15"}));
  const std::string without = read_bytes(out() + "/mesh.ply");
  const std::string whole = read_bytes(image(5));
  for (const std::size_t length : {whole.size() / 2, std::size_t(10), std::size_t(0)}) {
    SCOPED_TRACE(length);
    write_bytes(image(5), whole.substr(0, length));
    if (length == 0) fs::remove(image(5));
    succeed(hull());
    EXPECT_TRUE(read_bytes(out() + "/mesh.ply") == without);
  }
}

TEST_F(PhotographsOfScenes, TooFewAreAnError) {
  for (int i = 0; i < 8; ++i) fs::remove(image(2 * i));
  fail(1, hull(),
       {"8 of 16 photographs were not found (view0.png, view2.png, view4.png and 5 more",
        path("images"), "two of three"});
  for (int i = 0; i < 8; ++i) fs::remove(image(2 * i + 1));
  fail(1, hull(), {"16 of 16 photographs were not found"});
  fail(1, {"info", scene()}, {"16 of 16"});
  for (int i = 0; i < 16; ++i) write_bytes(image(i), "no picture\n");
  fail(1, hull(), {"16 of 16 photographs cannot be read", "view0.png"});
}

TEST_F(PhotographsOfScenes, TooFewThatDecodeAreAnError) {
  for (int i = 0; i < 6; ++i) {
    const std::string whole = read_bytes(image(i));
    write_bytes(image(i), whole.substr(0, whole.size() / 2));
  }
  fail(1, hull(), {"6 of 16 photographs cannot be read", "cut short", "two of three"});
}

/// A folder of half-size copies gives the same bytes as a scene that was written for them.
TEST_F(PhotographsOfScenes, HalfSizeCopiesScaleTheirCameras) {
  Scene half = scene_;
  for (SourceView& view : half.views) {
    Intrinsics& k = view.camera.intrinsics;
    k = {k.width / 2,           k.height / 2, k.fx / 2, k.fy / 2, 0, (k.cx + 0.5) / 2 - 0.5,
         (k.cy + 0.5) / 2 - 0.5};
    view.image = folder_ / "small/images" / view.name;
    write_half(folder_ / "images" / view.name, view.image, 3);
    write_half(folder_ / "cutouts" / view.name, folder_ / "halves" / view.name, 1);
  }
  io::write_transforms(half, folder_ / "small");
  for (SourceView& view : half.views)
    view.camera = scene_.views[std::size_t(&view - &half.views[0])].camera;
  io::write_transforms(half, folder_ / "stated");
  const auto mesh_of = [&](const std::string& scene, const std::string& masks,
                           const std::string& image_scale = "auto") {
    const Finished run =
        succeed({"reconstruct", path(scene), "--out", out(), "--method", "hull", "--resolution",
                 "32", "--masks", path(masks), "--image-scale", image_scale});
    const bool scaled = run.err.find("16 of 16 photographs are scaled copies") != std::string::npos;
    EXPECT_EQ(scaled, scene == "stated");
    EXPECT_EQ(report()["photographs"]["scaled"], scaled ? 16 : 0);
    return read_bytes(out() + "/mesh.ply");
  };
  const std::string right = mesh_of("small", "halves");
  EXPECT_TRUE(mesh_of("stated", "halves") == right);
  EXPECT_TRUE(mesh_of("stated", "cutouts") == right);  // masks of the cameras' size
  const std::string coarse = mesh_of("small", "halves", "0.5");
  EXPECT_FALSE(coarse == right);
  EXPECT_EQ(report()["image_scale"]["largest"], 0.5);
  EXPECT_TRUE(mesh_of("stated", "halves", "0.5") == coarse);
  const double volume = signed_volume(read_ply(out() + "/mesh.ply"));
  mesh_of("stated", "cutouts", "0.5");  // averaged once instead of twice: not the same bytes
  EXPECT_NEAR(signed_volume(read_ply(out() + "/mesh.ply")), volume, 0.002 * volume);
}

TEST_F(PhotographsOfScenes, AnotherShapeIsLeftOutWithItsReason) {
  io::write_colmap_text(scene_, folder_ / "t");
  const std::vector<std::uint8_t> grey(std::size_t(kWidth) * kHeight * 3, 100);
  io::write_png(image(3), kHeight, kWidth, 3, grey);
  const Finished run = succeed({"reconstruct", path("t"), "--out", out(), "--method", "hull",
                                "--resolution", "16", "--masks", path("cutouts")});
  EXPECT_THAT(run.err, HasSubstr("the sides are swapped"));
  expect_left_out(report()["photographs"]["left_out"][0], "view3.png", "shape", "72 x 96");
}

/// Indices of --views count what the scene lists, as --hold-out's do.
TEST_F(PhotographsOfScenes, HeldOutViewsKeepTheirIndices) {
  fs::remove(image(1));
  succeed(hull({"--hold-out", "2,8"}));
  const Arguments judge = {"evaluate", out() + "/mesh.ply", "--photos", scene(),
                           "--masks",  path("cutouts"),     "--views"};
  const auto judged = [&](const std::string& views) {
    Arguments all = judge;
    all.push_back(views);
    return succeed(all).out;
  };
  EXPECT_THAT(judged("2,8"), testing::AllOf(HasSubstr("view2.png"), HasSubstr("view8.png"),
                                            HasSubstr("1 of 16 photographs was not found")));
  EXPECT_THAT(judged("1,8"), Not(HasSubstr("view1.png ")));
  Arguments none = judge;
  none.push_back("1");
  fail(1, none, {"no photograph of --views can be used (view1.png"});
}

TEST_F(PhotographsOfScenes, AVideoIsThinnedOut) {
  Scene video = scene_;
  video.views.clear();
  for (int i = 0; i < 2000; ++i) {
    SourceView view = scene_.views[std::size_t(i % kViews)];
    view.name = "f" + std::to_string(i) + ".png";
    fs::create_hard_link(view.image, folder_ / "images" / view.name);
    view.image = folder_ / "images" / view.name;
    // A slow move along the path between the first camera and the second.
    view.camera.cam_from_world.translation += 1e-4 * i;
    video.views.push_back(view);
  }
  io::write_transforms(video, folder_ / "video");
  const Finished run = succeed({"info", path("video")});
  EXPECT_THAT(run.out, HasSubstr("120 of 2000 photographs are used"));
  EXPECT_THAT(run.out, HasSubstr("120 of 2000 (transforms format)"));
  EXPECT_THAT(succeed({"info", path("video"), "--views", "all"}).out,
              HasSubstr("views          2000 ("));
  EXPECT_THAT(succeed({"info", path("video"), "--views", "spread:24"}).out,
              HasSubstr("views          24 of 2000"));
  fail(2, {"info", path("video"), "--views", "spread:1"}, {"--views spread:1", "2 or more"});
}

}  // namespace
}  // namespace photohull::test
