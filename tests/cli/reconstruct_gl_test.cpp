// Reconstructions that work: what is written, and what the options do to it.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "reconstruct_fixture.h"
#include "support/analytic_volumes.h"
#include "volume/write_vdb.h"

namespace photohull::test {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

class ReconstructBlock : public Reconstruct {
 protected:
  /// A textured block in path("block"), 24 views.
  void synthesize_block() const {
    write_bytes(path("block.json"), R"({"geometry": {"shape": "block"}, "truth_samples": 100,
        "image": {"width": 160, "height": 120, "samples": 2},
        "material": {"faces": true, "contrast": 0.6}, "cameras": {"rings": [
            {"count": 12, "elevation": 10}, {"count": 12, "elevation": 40, "phase": 0.5}]}})");
    succeed({"synthesize", path("block.json"), "--out", path("block")});
  }
};

TEST_F(Reconstruct, WritesFiveFilesWithAClosedMeshOfTheSphere) {
  const Finished run = succeed(reconstruct());
  EXPECT_THAT(listing(out()),
              ElementsAre("mesh.ply", "preview.png", "report.html", "report.json", "volume.vdb"));
  for (const char* name : {"mesh.ply", "preview.png", "report.html", "report.json", "volume.vdb"})
    EXPECT_THAT(run.out, HasSubstr(path(std::string("out/") + name)));
  const TriMesh sphere = mesh();
  EXPECT_EQ(open_edges(sphere), 0u);
  EXPECT_NEAR(signed_volume(sphere), kSphereVolume, 0.06 * kSphereVolume);
  EXPECT_EQ(sphere.normals.size(), sphere.positions.size());
  EXPECT_EQ(sphere.colours.size(), sphere.positions.size());
  const SparseVolume volume = read_vdb_surface(path("out/volume.vdb"));
  const double voxel = std::pow(volume.grid.voxel_size, 3);
  EXPECT_NEAR(double(volume.inside_voxels()) * voxel, signed_volume(sphere), 0.03 * kSphereVolume);
}

TEST_F(Reconstruct, ReportHasTheDocumentedFields) {
  const Finished run = succeed(reconstruct({"--json"}));
  EXPECT_EQ(run.out, read_bytes(path("out/report.json")));
  const json r = report();
  const json schema = json::parse(R"({
    "photohull": "", "device": "", "noise_sigma": 0.1, "voxels_kept": 1, "wall_seconds": 0.1,
    "cpu_seconds": 0.1, "peak_memory_bytes": 1, "warnings": [], "files": [], "stages": [],
    "left_out": [], "verdict": {"level": "good"}, "image_scale": {"smallest": 0.1, "largest": 0.1},
    "photographs": {"listed": 1, "left_out": [], "scaled": 1, "passed_over": 1},
    "options": {}, "scene": {"path": "", "format": "", "views": 1},
    "box": {"min": [], "max": [], "source": ""}, "masks": {"source": "", "confidence": 0.1, "mended": 0, "left_out": [], "offset": 0.1, "disagreement": 0.1},
    "grid": {"origin": [], "voxel_size": 0.1, "voxels": [], "bricks_stored": 1},
    "hull": {"nodes_tested": 1, "bricks_evaluated": 1},
    "thin_parts": {"line_pixels": 1, "looked_at": 1, "unexplained": 1, "placed": 1, "restored_pixels": 1, "stem_vertices": 1},
    "photo": {"sweeps": 1, "voxels_judged": 1, "voxels_carved": 1, "voxels_undecided": 1},
    "resumed_levels": 0, "followed": false, "hull_trust": [], "refine": [], "refine_fits": [], "mesh": {"vertices": 1, "triangles": 1, "uniform_triangles": 1,
    "sharpened_vertices": 1, "unseen_share": 0.1}, "up": [], "up_axis": [], "preview_png_shows": "", "cameras": [], "photometric": {"used": true}, "sharpness": [], "inputs": [], "surroundings": [],
    "device_work": {"uploads": 1, "bytes_up": 1, "downloads": 1, "bytes_down": 1}})");
  const json fields = schema.flatten();
  for (const auto& [key, value] : fields.items()) {
    const json::json_pointer pointer(key);
    ASSERT_TRUE(r.contains(pointer)) << key;
    EXPECT_EQ(r[pointer].is_number(), value.is_number()) << key;
    EXPECT_EQ(r[pointer].is_string(), value.is_string()) << key;
    EXPECT_TRUE(!value.is_number_integer() || r[pointer].is_number_integer()) << key;
  }
  // Nothing stands in the report that is not documented.
  for (const auto& [key, value] : r.items()) EXPECT_TRUE(schema.contains(key)) << key;
  ASSERT_FALSE(r["device_work"]["kernels"].empty());
  for (const json& kernel : r["device_work"]["kernels"])
    for (const char* key : {"name", "launches", "groups", "seconds", "cpu_seconds"})
      EXPECT_TRUE(kernel.contains(key)) << key;
  EXPECT_EQ(r["scene"]["format"], "middlebury");
  EXPECT_EQ(r["scene"]["views"], kViews);
  EXPECT_EQ(r["box"]["source"], "bbox.txt");
  EXPECT_EQ(r["masks"]["source"], "mask files");
  EXPECT_EQ(r["options"]["resolution"], "32");
  EXPECT_EQ(r["mesh"]["triangles"], mesh().triangles.size());
  std::vector<std::string> stages;
  for (const json& stage : r["stages"]) stages.push_back(stage["name"]);
  EXPECT_THAT(stages, ElementsAre("scene", "device", "views", "cameras", "silhouettes", "hull",
                                  "photometric", "images", "refine", "clean", "mesh", "colour",
                                  "volume", "verdict", "page", "preview", "files"));
}

TEST_F(Reconstruct, MeshErrorLeavesFewerTriangles) {
  succeed(reconstruct({"--method", "hull"}));
  const std::size_t uniform = mesh().triangles.size();
  EXPECT_EQ(report()["mesh"]["uniform_triangles"], uniform);
  EXPECT_FALSE(report()["mesh"].contains("error_voxels"));
  succeed(reconstruct({"--method", "hull", "--mesh-error", "0.25"}));
  const TriMesh simple = mesh();
  const json r = report()["mesh"];
  EXPECT_LT(simple.triangles.size(), uniform / 3);
  EXPECT_EQ(open_edges(simple), 0u);
  EXPECT_EQ(simple.colours.size(), simple.positions.size());
  EXPECT_EQ(r["triangles"], simple.triangles.size());
  EXPECT_EQ(r["uniform_triangles"], uniform);
  EXPECT_DOUBLE_EQ(r["error_voxels"]["limit"], 0.25);
  EXPECT_LE(r["error_voxels"]["max"], 0.25);
  EXPECT_GT(r["error_voxels"]["max"], 0.0);
  // The same in world units.
  const double voxel = report()["grid"]["voxel_size"];
  succeed(reconstruct({"--method", "hull", "--mesh-error", std::to_string(voxel) + "u"}));
  EXPECT_NEAR(report()["mesh"]["error_voxels"]["limit"], 1, 1e-3);
  EXPECT_LT(mesh().triangles.size(), simple.triangles.size());
}

TEST_F(Reconstruct, OutlinesMoveByTheMaskOffset) {
  succeed(reconstruct({"--method", "hull", "--mask-offset", "0"}));
  const std::int64_t kept = report()["voxels_kept"];
  succeed(reconstruct({"--method", "hull", "--mask-offset", "2"}));
  EXPECT_EQ(report()["masks"]["offset"], 2);
  EXPECT_GT(std::int64_t(report()["voxels_kept"]), kept * 21 / 20);
  succeed(reconstruct({"--method", "hull", "--mask-offset", "-2"}));
  EXPECT_LT(std::int64_t(report()["voxels_kept"]), kept * 19 / 20);
  for (const char* text : {"x", "nan", "1e9", "2px", ""})
    fail(2, reconstruct({"--mask-offset", text}), {std::string("--mask-offset ") + text});
}

TEST_F(ReconstructBlock, NoiseThatIsKnownReachesTheVerdict) {
  synthesize_block();
  // The hull is the same: what differs is how much of its texture the verdict believes.
  const auto with_noise = [&](const char* noise) {
    run_photohull({"reconstruct", path("block"), "--out", out(), "--resolution", "48", "--method",
                   "hull", "--noise", noise});
    return report();
  };
  const json quiet = with_noise("0"), noisy = with_noise("30");
  EXPECT_EQ(noisy["voxels_kept"], quiet["voxels_kept"]);
  EXPECT_NEAR(noisy["noise_sigma"], 30.0 / 255, 1e-9);
  EXPECT_LT(double(noisy["verdict"]["signals"]["textured"]),
            0.8 * double(quiet["verdict"]["signals"]["textured"]));
  for (const char* text : {"-1", "256", "nan"})
    fail(2, reconstruct({"--noise", text}), {std::string("--noise ") + text});
}

TEST_F(Reconstruct, UnseenOpenLeavesOutWhatNoCameraSees) {
  const auto few = [&](const char* unseen) {
    return reconstruct({"--method", "hull", "--views", "0-2", "--unseen", unseen});
  };
  succeed(few("closed"));
  const TriMesh closed = mesh();
  EXPECT_EQ(open_edges(closed), 0u);
  EXPECT_GT(std::count(closed.confidence.begin(), closed.confidence.end(), 0.0f), 20);
  succeed(few("open"));
  const TriMesh open = mesh();
  EXPECT_GT(open_edges(open), 20u);
  EXPECT_LT(open.triangles.size(), closed.triangles.size());
  EXPECT_GT(open.triangles.size(), closed.triangles.size() / 8);
}

TEST_F(Reconstruct, RejectsBadMeshErrors) {
  for (const char* text : {"-1", "nan", "inf", "x", "0.2v", "0.2uu", "u"})
    fail(2, reconstruct({"--mesh-error", text}), {std::string("--mesh-error ") + text});
  fail(2, reconstruct({"--unseen", "maybe"}), {"--unseen maybe", "open, closed"});
}

TEST_F(Reconstruct, ConfidenceIsTheChanceThatItsEvidenceGives) {
  succeed(reconstruct({"--method", "refine", "--evidence"}));
  EXPECT_THAT(listing(out()), Contains("evidence.ply"));
  VertexScalars scalars;
  const TriMesh judged = read_ply(path("out/evidence.ply"), scalars);
  EXPECT_EQ(judged.confidence, mesh().confidence);
  ASSERT_EQ(scalars.size(), 3u);
  std::size_t seen = 0, near = 0;
  double sum = 0;
  const double voxel = report()["grid"]["voxel_size"];
  for (std::size_t i = 0; i < judged.positions.size(); ++i) {
    const float scatter = float(scalars["scatter"][i]), c = judged.confidence[i];
    const double share = scalars["fine_share"][i], deviation = scalars["disagreement"][i];
    if (c == 0) continue;
    ++seen;
    EXPECT_GE(scatter, 0);
    EXPECT_GT(deviation, 0);
    EXPECT_GT(share, 0);
    sum += c;
    near += std::abs(glm::distance(judged.world(i), kCentre) - kRadius) < voxel;
  }
  ASSERT_GT(seen, judged.positions.size() / 2);
  // Honest: as many lie within a voxel as confidence says, roughly.
  EXPECT_NEAR(sum / double(seen), double(near) / double(seen), 0.2);
  EXPECT_GT(sum / double(seen), 0.7);
}

TEST_F(Reconstruct, VolumeIsReadableByOpenVdbsOwnTool) {
  succeed(reconstruct({"--method", "hull"}));
  const Finished print = run_program({VDB_PRINT, "-l", path("out/volume.vdb")});
  EXPECT_EQ(print.code, 0) << print.err;
  for (const char* text : {"surface", "Cd", "confidence", "level set", "photohull_version"})
    EXPECT_THAT(print.out, HasSubstr(text));
}

TEST_F(Reconstruct, StronglyBlurredViewsAreLeftOut) {
  write_bytes(path("ball.json"), R"({"geometry": {"shape": "sphere"}, "truth_samples": 100,
      "image": {"width": 160, "height": 120, "samples": 2, "maps": false},
      "cameras": {"rings": [{"count": 16, "elevation": 10}]},
      "degradations": {"motion_blur": 14, "motion_blur_views": 0.125}})");
  succeed({"synthesize", path("ball.json"), "--out", path("ball")});
  const auto run = [&](const Arguments& more) {
    Arguments arguments = {"reconstruct", path("ball"), "--out",        out(),
                           "--method",    "hull",       "--resolution", "32"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_photohull(arguments);
  };
  const Finished left = run({});
  EXPECT_EQ(left.code, 0);
  EXPECT_EQ(report()["left_out"].size(), 2u);
  EXPECT_EQ(report()["sharpness"].size(), 16u);
  EXPECT_THAT(report()["warnings"].dump(), HasSubstr("2 views are blurred beside the others"));
  EXPECT_EQ(run({"--keep-views"}).code, 0);
  EXPECT_EQ(report()["left_out"].size(), 0u);
}

TEST_F(Reconstruct, MakesTheOutputFolderAndReplacesEarlierResults) {
  succeed({"reconstruct", scene(), "--out", path("a/b/c"), "--quality", "draft"});
  EXPECT_THAT(listing(path("a/b/c")),
              UnorderedElementsAre("volume.vdb", "mesh.ply", "preview.png", "report.html",
                                   "report.json", ".photohull-masks"));
}

}  // namespace
}  // namespace photohull::test
