// photohull evaluate --photos as a user runs it, on meshes of a photographed sphere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "eval/shapes.h"
#include "sphere_scene.h"
#include "support/scratch_folder.h"

namespace photohull::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class EvaluatePhotos : public SphereScene {
 protected:
  void SetUp() override {
    write_obj("right.obj", sphere(kCentre, kRadius, 5));
    write_obj("small.obj", sphere(kCentre, 0.9 * kRadius, 5));
    write_obj("away.obj", sphere(kCentre + 50.0, kRadius, 2));
    write_text(folder_ / "points.obj", "v 0 0 0\nv 1 1 1\n");
  }
  void write_obj(const std::string& name, const TriMesh& mesh) const {
    std::ofstream out(folder_ / name);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const glm::dvec3 p = mesh.world(i);
      out << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
    }
    for (const auto& t : mesh.triangles)
      out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  }
  Arguments judge(const std::string& mesh, const Arguments& more) const {
    Arguments all = {"evaluate", path(mesh), "--photos", scene(), "--masks", path("cutouts")};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  json figures(const std::string& mesh, const Arguments& more = {"--views", "3,8"}) const {
    Arguments all = judge(mesh, more);
    all.emplace_back("--json");
    return json::parse(succeed(all).out);
  }
};

TEST_F(EvaluatePhotos, TheRightMeshAgreesMore) {
  const json right = figures("right.obj")["photos"], small = figures("small.obj")["photos"];
  EXPECT_GT(right["all"]["zncc"], 0.6);  // the views are 50 degrees apart
  EXPECT_LT(small["all"]["zncc"], double(right["all"]["zncc"]) - 0.2);
  EXPECT_GT(right["all"]["silhouette_iou"], 0.97);
  EXPECT_NEAR(small["all"]["coverage"], 0.81, 0.02);
  EXPECT_EQ(right["views"].size(), 2u);
  EXPECT_EQ(right["views"][0]["view"], "view3.png");
  EXPECT_EQ(right["lenders"], kViews - 2);
  EXPECT_EQ(right["mask_source"], "mask files");
  EXPECT_EQ(
      figures("right.obj", {"--views", "view3.png", "--lenders", "0-2,4-7"})["photos"]["lenders"],
      7);
}

TEST_F(EvaluatePhotos, TextTellsTheSame) {
  const Finished run = succeed(judge("right.obj", {"--views", "3,8"}));
  EXPECT_THAT(run.out, HasSubstr("2 held out, 14 lend colour, masks from mask files"));
  EXPECT_THAT(run.out, HasSubstr("view3.png"));
  char figure[16];
  std::snprintf(figure, sizeof figure, "%.4f",
                double(figures("right.obj")["photos"]["all"]["zncc"]));
  EXPECT_THAT(run.out, HasSubstr(figure));
}

TEST_F(EvaluatePhotos, GoesWithTheTruth) {
  const json both = figures("small.obj", {"--views", "3,8", "--truth", path("right.obj"),
                                          "--samples", "2000", "--picture", path("worst.png")});
  EXPECT_NEAR(both["recon_to_gt"]["mean"], 0.1 * kRadius, 0.01);
  EXPECT_EQ(both["photos"], figures("small.obj")["photos"]);
  EXPECT_EQ(read_bytes(folder_ / "worst.png").substr(1, 3), "PNG");
  EXPECT_FALSE(figures("small.obj").contains("recon_to_gt"));
  EXPECT_EQ(figures("small.obj")["recon"], path("small.obj"));
}

TEST_F(EvaluatePhotos, WrongUsageIsTold) {
  const auto usage = [&](const Arguments& all, const std::vector<std::string>& parts) {
    fail(2, all, parts);
  };
  usage({"evaluate", path("right.obj")}, {"--truth", "--photos"});
  usage({"evaluate", path("right.obj"), "--views", "3"}, {"--views requires --photos"});
  usage({"evaluate", path("right.obj"), "--photos", scene(), "--views", "3", "--samples", "5000"},
        {"--samples requires --truth"});
  usage(judge("right.obj", {}), {"--photos needs --views"});
  usage(judge("right.obj", {"--views", "16"}), {"--views: '16' is out of range", "0 to 15"});
  usage(judge("right.obj", {"--views", "viewx.png"}), {"'viewx.png' is no view"});
  usage(judge("right.obj", {"--views", "*"}), {"all 16 views are held out"});
  usage(judge("right.obj", {"--views", "3", "--lenders", "2-4"}),
        {"--lenders: view 3 (view3.png)"});
  usage(judge("right.obj", {"--views", "3", "--lenders", "99"}), {"--lenders: '99'"});
  usage(judge("right.obj", {"--views", "3", "--window", "6"}),
        {"--window 6: expected an odd number of pixels from 3 to 63"});
  usage(judge("right.obj", {"--views", "3", "--least-angle", "70"}), {"--least-angle", "70"});
}

TEST_F(EvaluatePhotos, BadFilesAreTold) {
  fail(1, judge("points.obj", {"--views", "3"}), {"points.obj has no faces"});
  fail(1, judge("away.obj", {"--views", "3"}), {"no held-out view sees the mesh"});
  fail(1, judge("missing.obj", {"--views", "3"}), {"missing.obj"});
  fail(1, judge("right.obj", {"--views", "3", "--picture", path("none/p.png")}), {"none"});
  write_bytes(image(3), read_bytes(image(3)).substr(0, 900));
  fail(1, judge("right.obj", {"--views", "3", "--picture", path("p.png")}), {"view3.png"});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "p.png"));
}

TEST_F(EvaluatePhotos, JudgesWhatReconstructHeldOut) {
  succeed(reconstruct({"--hold-out", "3,8", "--method", "hull"}));
  const json report = json::parse(read_bytes(folder_ / "out" / "report.json"));
  EXPECT_EQ(report["scene"]["views"], kViews - 2);
  EXPECT_EQ(report["options"]["hold_out"], "3,8");
  const json j = figures("out/mesh.ply")["photos"]["all"];
  EXPECT_GT(j["zncc"], 0.5);
  EXPECT_GT(j["silhouette_iou"], 0.95);
  fail(2, reconstruct({"--hold-out", "16"}), {"--hold-out: '16' is out of range"});
  fail(1, reconstruct({"--hold-out", "1-15"}), {"left by --hold-out"});
}

}  // namespace
}  // namespace photohull::test
