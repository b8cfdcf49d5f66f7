// Masks made from the background, from the command line.
#include <nlohmann/json.hpp>

#include "io/image_file.h"
#include "sphere_scene.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

class MasksCommand : public SphereScene {
 protected:
  /// The wall without the sphere, as ray_cast takes it.
  static std::vector<std::uint8_t> wall(int width = kWidth, int height = kHeight) {
    std::vector<std::uint8_t> pixels;
    for (int i = 0; i < width * height; ++i)
      for (const double light : {0.01, 0.012, 0.03})
        pixels.push_back(std::uint8_t(std::lround(255 * srgb_from_linear(light))));
    return pixels;
  }
  void write_plates() const {
    fs::create_directories(folder_ / "empty");
    for (const SourceView& view : scene_.views)
      io::write_png(folder_ / "empty" / view.name, kWidth, kHeight, 3, wall());
  }
  std::string plate(int view) const { return path("empty/" + scene_.views[view].name); }
  Arguments masks(const Arguments& more) const {
    Arguments all = {"masks", scene()};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

TEST_F(MasksCommand, OnePlateServesAFixedCamera) {
  io::write_png(folder_ / "wall.png", kWidth, kHeight, 3, wall());
  const Finished run = succeed(masks(
      {"--background", path("wall.png"), "--compare", path("cutouts"), "--out", out(), "--json"}));
  const json j = json::parse(run.out);
  EXPECT_EQ(j["source"], "background plate");
  ASSERT_EQ(j["views"].size(), std::size_t(kViews));
  for (const json& view : j["views"]) {
    EXPECT_GT(double(view["iou"]), 0.93) << view;
    EXPECT_LT(double(view["missed"]), 0.02) << view;
    EXPECT_GT(double(view["confidence"]), 0.7) << view;
    EXPECT_LT(double(view["confidence"]), 1) << view;
  }
  // What was written is what serves as masks.
  EXPECT_EQ(listing(out()).size(), std::size_t(kViews));
  EXPECT_TRUE(fs::exists(path("out/view5.png")));
  const json given =
      json::parse(succeed(masks({"--masks", out(), "--compare", path("cutouts"), "--json"})).out);
  EXPECT_EQ(given["views"][5]["iou"], j["views"][5]["iou"]);
  EXPECT_EQ(given["views"][5]["confidence"], 1.0);
  std::filesystem::remove(mask_file(5));
  const Finished lacking = run_photohull(masks({"--masks", out(), "--compare", path("cutouts")}));
  EXPECT_EQ(lacking.code, 1);
  EXPECT_THAT(lacking.err, testing::HasSubstr("there is no mask for view5.png"));
}

TEST_F(MasksCommand, MadeMasksAreKeptForTheNextRun) {
  write_plates();
  const auto reconstruct = [&](const Arguments& more) {
    Arguments all = {"reconstruct", scene(), "--background", path("empty"),
                     "--method",    "hull",  "--out",        out()};
    all.insert(all.end(), more.begin(), more.end());
    return succeed(all).err;
  };
  const std::string taken = "the masks are those that the run before made",
                    file = out() + "/.photohull-masks";
  EXPECT_THAT(reconstruct({}), Not(HasSubstr(taken)));
  const std::string mesh = read_bytes(out() + "/mesh.ply"), kept = read_bytes(file);
  EXPECT_THAT(reconstruct({}), HasSubstr(taken));
  EXPECT_EQ(read_bytes(out() + "/mesh.ply"), mesh);
  EXPECT_THAT(reconstruct({"--resolution", "30"}), HasSubstr(taken));
  EXPECT_EQ(read_bytes(file), kept);
  // Not where they are asked for anew, or of another background.
  EXPECT_THAT(reconstruct({"--fresh"}), Not(HasSubstr(taken)));
  fs::copy_file(plate(1), plate(0), fs::copy_options::overwrite_existing);
  fs::last_write_time(plate(0), fs::file_time_type::clock::now() + std::chrono::seconds(5));
  EXPECT_THAT(reconstruct({}), Not(HasSubstr(taken)));
  // What is left of a file is not taken.
  for (const std::string& left :
       {kept.substr(0, kept.size() / 2), std::string("{}"), std::string()}) {
    write_bytes(file, left);
    EXPECT_THAT(reconstruct({}), HasSubstr(".photohull-masks: damaged")) << left.size();
    EXPECT_EQ(read_bytes(out() + "/mesh.ply"), mesh);
  }
}

TEST_F(MasksCommand, PhotographsAreNotOverwritten) {
  const std::string photographs = fs::path(image(0)).parent_path().string();
  const std::string before = read_bytes(image(0));
  const Finished run = run_photohull(masks({"--out", photographs}));
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("is the folder of the scene's photographs"));
  EXPECT_EQ(read_bytes(image(0)), before);
}

TEST_F(MasksCommand, PhotographsThatShareANameKeepTheirFolders) {
  for (const auto& [view, name] : {std::pair{3, "left/same.png"}, std::pair{4, "right/same.png"}}) {
    const fs::path place = folder_ / "images" / name;
    fs::create_directories(place.parent_path());
    fs::rename(image(view), place);
    scene_.views[std::size_t(view)].image = place;
  }
  write_scene_file();
  succeed(masks({"--masks", "background", "--out", out()}));
  EXPECT_THAT(listing(out()),
              testing::IsSupersetOf({"images/left/same.png.png", "images/right/same.png.png"}));
  EXPECT_EQ(json::parse(succeed(masks({"--masks", out(), "--strict", "--json"})).out)["source"],
            "mask files");
}

TEST_F(MasksCommand, ReportsSayHowSureTheMasksAre) {
  write_plates();
  succeed({"reconstruct", scene(), "--out", out(), "--resolution", "32", "--method", "hull",
           "--background", path("empty")});
  const json r = json::parse(read_bytes(path("out/report.json")));
  EXPECT_EQ(r["masks"]["source"], "background plate");
  EXPECT_EQ(r["options"]["background"], path("empty"));
  double least = 1;
  ASSERT_EQ(r["masks"]["views"].size(), std::size_t(kViews));
  for (const json& view : r["masks"]["views"]) least = std::min(least, double(view["confidence"]));
  EXPECT_EQ(r["masks"]["confidence"], least);
  const Finished info = succeed({"info", scene(), "--check-masks", "--background", path("empty")});
  EXPECT_THAT(info.out, HasSubstr("masks          background plate: confidence "));
  const json checked = json::parse(
      succeed({"info", scene(), "--check-masks", "--background", path("empty"), "--json"}).out);
  EXPECT_EQ(checked["masks"]["views"], r["masks"]["views"]);
}

TEST_F(MasksCommand, BackgroundModelIsUsedInPlaceOfMasksOnDemand) {
  fs::rename(folder_ / "cutouts", folder_ / "masks");
  EXPECT_EQ(json::parse(succeed(masks({"--json"})).out)["source"], "mask files");
  EXPECT_EQ(json::parse(succeed(masks({"--masks", "background", "--json"})).out)["source"],
            "background model");
}

TEST_F(MasksCommand, DoubtfulMasksAreNamed) {
  write_plates();
  // In this plate the sphere is there already, but for a trace.
  const ColourImage taken = io::read_image(image(3));
  std::vector<std::uint8_t> ghost = wall();
  for (std::size_t i = 0; i < ghost.size(); ++i) {
    const std::uint8_t there = taken.bytes[i / 3 * 4 + i % 3];
    ghost[i] = std::uint8_t(there > ghost[i] ? there - (there - ghost[i]) / 12 : there);
  }
  io::write_png(plate(3), kWidth, kHeight, 3, ghost);
  const Finished run = succeed(masks({"--background", path("empty")}));
  EXPECT_THAT(run.out + run.err, HasSubstr("view3.png"));
  EXPECT_THAT(run.out, HasSubstr("warning: the masks of 1 views are doubtful (view3.png)"));
}

TEST_F(MasksCommand, BadBackgroundsAreNamed) {
  const auto refuse = [&](const std::vector<std::string>& parts) {
    fail(1, masks({"--background", path("empty")}), parts);
  };
  refuse({path("empty"), "no such background"});
  write_plates();
  io::write_png(plate(2), 64, 48, 3, wall(64, 48));
  refuse({plate(2), "64 x 48", "96 x 72", "view2.png"});
  write_bytes(plate(2), "no picture");
  refuse({plate(2)});
  const std::string good = read_bytes(plate(1));
  write_bytes(plate(2), good.substr(0, good.size() / 2));  // its header tells the size
  refuse({plate(2)});
  fs::remove(plate(2));
  refuse({path("empty"), "no background for view2.png"});
  // The photographs themselves are no backgrounds.
  fail(1, masks({"--background", path("images")}), {"no background for view0.png"});
  write_plates();
  for (const char* given : {"none", "cutouts"})
    fail(2,
         masks({"--background", path("empty"), "--masks",
                given == std::string("none") ? given : path(given)}),
         {"--background and ", "exclude each other"});
  fail(2, masks({"--background", ""}), {"--background is empty"});
  fail(2, masks({"--out", ""}), {"--out is empty"});
}

}  // namespace
}  // namespace photohull::test
