// Masks and photographs from which nothing can be carved.
#include <nlohmann/json.hpp>

#include "io/image_file.h"
#include "sphere_scene.h"
#include "support/ray_cast.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class BadMasks : public SphereScene {
 protected:
  /// The folder's masks fail and the message names these.
  void refuse(const std::string& masks, const std::vector<std::string>& parts) const {
    fail(1, reconstruct({"--masks", path(masks)}), parts);
  }
  /// A mask of a speck in one corner, where the object is not.
  void write_speck(int view) const {
    std::vector<std::uint8_t> speck(kWidth * kHeight, 0);
    for (int y = 0; y < 6; ++y) std::fill_n(speck.begin() + y * kWidth, 6, 255);
    io::write_png(mask_file(view), kWidth, kHeight, 1, speck);
  }

  /// All photographs replaced by uniform ones of this colour and opacity.
  void paint_images(std::uint8_t value, std::uint8_t alpha) const {
    std::vector<std::uint8_t> pixels;
    for (int i = 0; i < kWidth * kHeight; ++i)
      pixels.insert(pixels.end(), {value, value, value, alpha});
    for (int i = 0; i < kViews; ++i) io::write_png(image(i), kWidth, kHeight, 4, pixels);
  }
};

TEST_F(BadMasks, AllBlack) {
  write_masks("black", 0, 0);
  refuse("black", {"all masks are empty", "white must be the object"});
}

TEST_F(BadMasks, Inverted) {
  write_masks("inverted", 0, 255);
  refuse("inverted", {"masks look inverted", "16 of 16"});
}

TEST_F(BadMasks, NotThereOrNotMasks) {
  refuse("nowhere", {path("nowhere"), "no such mask folder"});
  fs::create_directory(path("none"));
  refuse("none", {path("none"), "no mask for any of the 16 views", "view0.png.png"});
  write_bytes(mask_file(2), "no picture");
  refuse("cutouts", {mask_file(2)});
  const std::vector<std::uint8_t> small(10 * 10, 255);
  io::write_png(mask_file(2), 10, 10, 1, small);
  refuse("cutouts", {mask_file(2), "10 x 10", "96 x 72"});
}

TEST_F(BadMasks, MissingOnesAreNamedAndTheirViewsUsedWithout) {
  for (const int view : {2, 9}) fs::remove(mask_file(view));
  const std::string said = "no mask for 2 of 16 views (view2.png, view9.png)";
  const Finished run = succeed(reconstruct({"--masks", path("cutouts"), "--method", "hull"}));
  EXPECT_THAT(run.err, HasSubstr(said));
  const auto report = nlohmann::json::parse(read_bytes(path("out/report.json")));
  EXPECT_EQ(report["masks"]["views"].size(), std::size_t(kViews));
  EXPECT_EQ(report["masks"]["views"][3]["source"], "mask files");
  EXPECT_NE(report["masks"]["views"][2]["source"], "mask files");
  fail(1, reconstruct({"--masks", path("cutouts"), "--strict"}), {said, "--strict"});
}

TEST_F(BadMasks, ThoseOfZeroAndOneAreUnderstood) {
  const auto report = [&] { return nlohmann::json::parse(read_bytes(path("out/report.json"))); };
  succeed(reconstruct({"--method", "hull"}));
  const double right = report()["voxels_kept"];
  for (int view = 0; view < kViews; ++view) {
    std::vector<std::uint8_t> ones = io::read_mask(mask_file(view)).coverage;
    for (std::uint8_t& value : ones) value = value >= 128;
    io::write_png(mask_file(view), kWidth, kHeight, 1, ones);
  }
  const Finished run = succeed(reconstruct({"--method", "hull"}));
  EXPECT_THAT(run.err, HasSubstr("16 masks have no other values than 0 and 1"));
  EXPECT_NEAR(report()["voxels_kept"], right, 0.02 * right);
}

TEST_F(BadMasks, HolesInThemAreMendedUnlessTheyAreToBeKept) {
  // Discs of 4 pixels' radius out of the sphere's middle, in every view.
  for (int view = 0; view < kViews; ++view) {
    const Mask mask = io::read_mask(mask_file(view));
    std::vector<std::uint8_t> torn = mask.coverage;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        if (std::hypot(x - 0.5 * kWidth, y - 0.5 * kHeight) < 4)
          torn[std::size_t(y * kWidth + x)] = 0;
    io::write_png(mask_file(view), kWidth, kHeight, 1, torn);
  }
  const auto kept_voxels = [&](const char* holes) {
    run_photohull(reconstruct({"--method", "hull", "--mask-holes", holes}));
    const auto report = nlohmann::json::parse(read_bytes(path("out/report.json")));
    EXPECT_EQ(report["masks"]["mended"], std::string(holes) == "mend" ? kViews : 0);
    return double(report["voxels_kept"]);
  };
  EXPECT_GT(kept_voxels("mend"), 1.05 * kept_voxels("keep"));
  fail(2, reconstruct({"--mask-holes", "ignore"}), {"--mask-holes ignore", "mend or keep"});
}

TEST_F(BadMasks, OfSomethingElseAreNamedAndLeftOut) {
  for (const int view : {3, 7}) write_speck(view);
  succeed(reconstruct({"--masks", path("cutouts")}));
  const auto report = nlohmann::json::parse(read_bytes(path("out/report.json")));
  EXPECT_THAT(report["left_out"].get<std::vector<std::string>>(),
              testing::UnorderedElementsAre("view3.png", "view7.png"));
  const std::int64_t kept = report["voxels_kept"];
  fail(1, reconstruct({"--masks", path("cutouts"), "--keep-views", "--views-may-miss", "0"}),
       {"nothing is left of the box"});
  fail(1, reconstruct({"--masks", path("cutouts"), "--keep-views", "--views-may-miss", "1"}),
       {"nothing is left of the box"});
  // Two may miss: what the other fourteen have stands, and the verdict tells of the two.
  const Finished both = run_photohull(
      reconstruct({"--masks", path("cutouts"), "--keep-views", "--views-may-miss", "2"}));
  EXPECT_EQ(both.code, 3);
  EXPECT_THAT(both.err, HasSubstr("the silhouettes contradict each other"));
  const auto other = nlohmann::json::parse(read_bytes(path("out/report.json")));
  EXPECT_EQ(other["left_out"].size(), 0u);
  EXPECT_NEAR(double(other["voxels_kept"]), double(kept), 0.02 * double(kept));
}

TEST_F(BadMasks, ThatCarveEverythingAwayNameTheViews) {
  // Too many to be left out.
  for (const int view : {1, 3, 5, 7, 9, 11}) write_speck(view);
  refuse("cutouts", {"nothing is left of the box", "view9.png removes", "masks"});
}

TEST_F(BadMasks, VoxelsThatAreTooLargeAreNotBlamedOnTheMasks) {
  fail(1, reconstruct({"--resolution", "2"}), {"voxels of 1 are too large", "--resolution"});
}

TEST_F(BadMasks, OneEmptyMaskIsNamedAndLeftOut) {
  const std::vector<std::uint8_t> black(kWidth * kHeight, 0);
  io::write_png(mask_file(5), kWidth, kHeight, 1, black);
  const Finished run = succeed(reconstruct());
  EXPECT_THAT(run.err, HasSubstr("warning: view5.png: the mask is empty"));
  EXPECT_THAT(run.err, HasSubstr("warning: view view5.png is left out"));
  const auto report = nlohmann::json::parse(read_bytes(path("out/report.json")));
  EXPECT_EQ(report["left_out"], nlohmann::json::array({"view5.png"}));
}

TEST_F(BadMasks, UniformPhotographsGiveTheHullAndAWarning) {
  paint_images(90, 255);
  const Finished carved = succeed(reconstruct({"--method", "space-carving"}));
  const auto report = nlohmann::json::parse(read_bytes(path("out/report.json")));
  EXPECT_EQ(report["photo"]["voxels_carved"], 0);
  EXPECT_THAT(carved.err, HasSubstr("warning: the photographs show too little texture"));
  const Finished refined = succeed(reconstruct());
  EXPECT_THAT(refined.err,
              HasSubstr("warning: the photographs tell where the surface is on 0 % of it only"));
}

TEST_F(BadMasks, TransparentPhotographsCountAsUnmasked) {
  paint_images(0, 0);
  const Finished run = run_photohull(reconstruct({"--masks", "auto", "--method", "hull"}));
  EXPECT_EQ(run.code, 3);
  EXPECT_THAT(run.err, HasSubstr("warning: without masks the hull is the box"));
}

}  // namespace
}  // namespace photohull::test
