// Reconstructions that work: what is written, and what the options do to it.
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.h"
#include "io/mesh/write_mesh.h"
#include "sphere_scene.h"
#include "support/analytic_volumes.h"
#include "volume/write_vdb.h"

namespace photohull::test {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class Reconstruct : public SphereScene {
 protected:
  TriMesh mesh() const { return read_ply(path("out/mesh.ply")); }
  json report() const { return json::parse(read_bytes(path("out/report.json"))); }
  /// A textured block in path("block"), 24 views.
  void synthesize_block() const {
    write_bytes(path("block.json"), R"({"geometry": {"shape": "block"}, "truth_samples": 100,
        "image": {"width": 160, "height": 120, "samples": 2},
        "material": {"faces": true, "contrast": 0.6}, "cameras": {"rings": [
            {"count": 12, "elevation": 10}, {"count": 12, "elevation": 40, "phase": 0.5}]}})");
    succeed({"synthesize", path("block.json"), "--out", path("block")});
  }
  /// The scene file lists its views from the last to the first.
  void reverse_views() const {
    std::istringstream in(read_bytes(path("scene_par.txt")));
    std::string count, line, views;
    std::getline(in, count);
    while (std::getline(in, line)) views = line + "\n" + views;
    write_bytes(path("scene_par.txt"), count + "\n" + views);
  }
};

TEST_F(Reconstruct, WritesFourFilesWithAClosedMeshOfTheSphere) {
  const Finished run = succeed(reconstruct());
  EXPECT_THAT(listing(out()), ElementsAre("mesh.ply", "preview.png", "report.json", "volume.vdb"));
  for (const char* name : {"mesh.ply", "preview.png", "report.json", "volume.vdb"})
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
    "resumed_levels": 0, "refine": [], "refine_fits": [], "mesh": {"vertices": 1, "triangles": 1, "uniform_triangles": 1,
    "sharpened_vertices": 1, "unseen_share": 0.1}, "photometric": {"used": true}, "sharpness": [], "inputs": [], "surroundings": []})");
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
  EXPECT_EQ(r["scene"]["format"], "middlebury");
  EXPECT_EQ(r["scene"]["views"], kViews);
  EXPECT_EQ(r["box"]["source"], "bbox.txt");
  EXPECT_EQ(r["masks"]["source"], "mask files");
  EXPECT_EQ(r["options"]["resolution"], "32");
  EXPECT_EQ(r["mesh"]["triangles"], mesh().triangles.size());
  std::vector<std::string> stages;
  for (const json& stage : r["stages"]) stages.push_back(stage["name"]);
  EXPECT_THAT(stages,
              ElementsAre("scene", "device", "views", "cameras", "hull", "photometric", "images",
                          "refine", "clean", "mesh", "colour", "verdict", "files", "preview"));
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

TEST_F(Reconstruct, NoiseThatIsKnownReachesTheVerdict) {
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

TEST_F(Reconstruct, ViewsInAnotherOrderGiveTheSameBytes) {
  succeed(reconstruct({}));
  const std::string expected = read_bytes(path("out/mesh.ply"));
  reverse_views();
  succeed(reconstruct({}));
  EXPECT_EQ(read_bytes(path("out/mesh.ply")), expected);
}

TEST_F(Reconstruct, ABoxMuchTooLargeIsMadeSmaller) {
  const Finished run = succeed(reconstruct({"--box", "-60 -60 -60 60 60 60"}));  // cameras inside
  EXPECT_THAT(run.err, HasSubstr("times larger than what the silhouettes leave"));
  const auto box = report()["box"];
  EXPECT_LT(double(box["max"][0]) - double(box["min"][0]), 10);
  EXPECT_EQ(report()["verdict"]["level"], "good");
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

TEST_F(Reconstruct, MethodsDifferAsTheyShould) {
  double volumes[3] = {};
  int sweeps[3] = {};
  int i = 0;
  for (const char* method : {"hull", "voxel-coloring", "space-carving"}) {
    succeed(reconstruct({"--method", method}));
    volumes[i] = signed_volume(mesh());
    sweeps[i++] = report()["photo"]["sweeps"];
    EXPECT_EQ(report()["options"]["method"], method);
  }
  EXPECT_LE(volumes[2], volumes[0] * 1.001);
  EXPECT_LE(volumes[1], volumes[0] * 1.001);
  EXPECT_THAT(sweeps, ElementsAre(0, 1, testing::Ge(6)));
}

TEST_F(Reconstruct, DraftTakesLargerVoxelsAndOnlyTheHull) {
  succeed(reconstruct({"--quality", "draft"}));
  const double draft = report()["grid"]["voxel_size"];
  EXPECT_EQ(report()["options"]["method"], "hull");
  succeed(reconstruct({"--quality", "normal", "--method", "hull"}));
  EXPECT_GT(draft, 2 * report()["grid"]["voxel_size"].get<double>());
}

TEST_F(Reconstruct, MasksMayBeFoundOrLeftOut) {
  const Finished none = run_photohull(reconstruct({"--masks", "none", "--method", "hull"}));
  EXPECT_EQ(none.code, 3);
  EXPECT_THAT(none.err, HasSubstr("no view has a mask"));
  EXPECT_EQ(report()["verdict"]["level"], "failed");
  EXPECT_EQ(report()["masks"]["source"], "none");
  EXPECT_THAT(none.err, HasSubstr("warning: without masks the hull is the box"));
  EXPECT_GT(signed_volume(mesh()), 1.5 * kSphereVolume);
  succeed(reconstruct({"--masks", "auto", "--method", "hull"}));
  EXPECT_EQ(report()["masks"]["source"], "background model");
  EXPECT_NEAR(signed_volume(mesh()), 1.05 * kSphereVolume, 0.15 * kSphereVolume);
  EXPECT_EQ(open_edges(mesh()), 0u);
}

TEST_F(Reconstruct, SweepsSampleAndCompareAsTold) {
  succeed(reconstruct({"--method", "voxel-coloring", "--sampler", "ewa", "--supersample", "2",
                       "--consistency", "robust-variance"}));
  EXPECT_EQ(report()["photo"]["sampler"], "ewa");
  EXPECT_EQ(report()["photo"]["r_consistency"], 0.0);
  EXPECT_EQ(report()["photo"]["supersample"], 2);
  EXPECT_EQ(report()["photo"]["consistency"], "robust-variance");
  EXPECT_NEAR(signed_volume(mesh()), kSphereVolume, 0.1 * kSphereVolume);
  succeed(reconstruct({"--method", "voxel-coloring"}));
  EXPECT_EQ(report()["photo"]["sampler"], "anisotropic");
  EXPECT_EQ(report()["photo"]["consistency"], "zncc");
}

TEST_F(Reconstruct, SweepsSearchAsFarAsTold) {
  succeed(reconstruct({"--method", "voxel-coloring", "--r-consistency", "0.5"}));
  EXPECT_EQ(report()["photo"]["r_consistency"], 0.5);
  EXPECT_NEAR(signed_volume(mesh()), kSphereVolume, 0.1 * kSphereVolume);
  fail(2, reconstruct({"--method", "voxel-coloring", "--r-consistency", "9"}),
       {"--r-consistency 9", "0 to 4 pixels"});
  fail(2, reconstruct({"--r-consistency", "1"}), {"--r-consistency", "no plane sweep"});
}

TEST_F(Reconstruct, WithoutMasksColoursCarve) {
  succeed(reconstruct({"--masks", "none", "--method", "space-carving"}));
  EXPECT_GT(report()["photo"]["voxels_carved"], 100);
  EXPECT_EQ(open_edges(mesh()), 0u);
}

TEST_F(Reconstruct, WithoutMasksPhotographsFindTheSurface) {
  run_photohull(reconstruct({"--masks", "none", "--method", "hull"}));  // fails its own checks
  const double hull = signed_volume(mesh());
  succeed(reconstruct({"--masks", "none"}));
  EXPECT_GT(open_edges(mesh()), 0u);  // nothing bounds what no photograph tells
  succeed(reconstruct({"--masks", "none", "--unseen", "closed"}));
  EXPECT_FALSE(report()["refine"].empty());
  // Sixteen small pictures 50 degrees apart tell of part of the ball only.
  EXPECT_NEAR(signed_volume(mesh()), kSphereVolume, 0.4 * kSphereVolume);
  EXPECT_LT(signed_volume(mesh()), 0.8 * hull);
  EXPECT_EQ(open_edges(mesh()), 0u);
}

TEST_F(Reconstruct, WithoutMasksTheVerdictSaysWhatIsExplained) {
  const Finished run = succeed(reconstruct({"--masks", "none", "--evidence"}));
  EXPECT_THAT(run.out, HasSubstr("of the texture that the photographs show in the box"));
  EXPECT_THAT(listing(out()), Contains("explained.png"));
  EXPECT_THAT(listing(out()), testing::Not(Contains("missing.png")));
  const json verdict = report()["verdict"], photographs = verdict["photographs"];
  EXPECT_EQ(photographs["views"].size(), std::size_t(kViews));
  EXPECT_GT(photographs["explained"], 0.5);
  EXPECT_EQ(verdict["explained_png_shows"].get<std::string>().rfind("view", 0), 0u);
  succeed(reconstruct({"--evidence"}));
  EXPECT_FALSE(report()["verdict"].contains("photographs"));
  EXPECT_THAT(listing(out()), Contains("missing.png"));
}

TEST_F(Reconstruct, PhotographsOfOtherViewsAreNeverGood) {
  for (int i = 0; i < kViews / 2; ++i) {
    const std::string bytes = read_bytes(image(i));
    write_bytes(image(i), read_bytes(image(i + kViews / 2)));
    write_bytes(image(i + kViews / 2), bytes);
  }
  const Finished run = run_photohull(reconstruct({"--masks", "none"}));
  if (run.code == 0) {
    EXPECT_NE(report()["verdict"]["level"], "good");
  }
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

TEST_F(Reconstruct, ViewsAndBoxSelect) {
  succeed(reconstruct(
      {"--method", "hull", "--views", "0-4,view6*", "--box", "0.1 -1.2 -0.7 1.1 0.8 1.3"}));
  EXPECT_EQ(report()["scene"]["views"], 6);
  EXPECT_EQ(report()["options"]["views"], "0-4,view6*");
  EXPECT_EQ(report()["box"]["source"], "--box");
  // The plane x = 0.1 halves the sphere; half a voxel of slack on the cut.
  EXPECT_NEAR(signed_volume(mesh()), 0.5 * kSphereVolume, 0.12 * kSphereVolume);
  EXPECT_EQ(open_edges(mesh()), 0u);
}

TEST_F(Reconstruct, VoxelSizeIsTaken) {
  succeed(reconstruct({"--method", "hull", "--voxel-size", "0.08"}));
  EXPECT_DOUBLE_EQ(report()["grid"]["voxel_size"], 0.08);
}

TEST_F(Reconstruct, SameBytesInEveryRunWhateverTheThreads) {
  for (const std::string method : {"hull", "voxel-coloring", "space-carving", "refine"}) {
    std::string mesh, volume;
    for (const std::string threads : {"1", "2", "3", "2"}) {
      succeed(reconstruct({"--method", method, "--threads", threads}));
      if (mesh.empty()) {
        mesh = read_bytes(path("out/mesh.ply"));
        volume = read_bytes(path("out/volume.vdb"));
      }
      EXPECT_TRUE(mesh == read_bytes(path("out/mesh.ply"))) << method << ", " << threads;
      EXPECT_TRUE(volume == read_bytes(path("out/volume.vdb"))) << method << ", " << threads;
    }
  }
}

TEST_F(Reconstruct, ABoxTakenExactlyCutsTheSurface) {
  const Arguments half = {"--method", "hull", "--box", "0.1 -1.2 -0.7 1.1 0.8 1.3"};
  const auto lowest = [&](Arguments more) {
    more.insert(more.begin(), half.begin(), half.end());
    succeed(reconstruct(more));
    double least = 1e9;
    const TriMesh cut = mesh();
    for (std::size_t i = 0; i < cut.positions.size(); ++i) least = std::min(least, cut.world(i).x);
    return least;
  };
  EXPECT_LT(lowest({}), 0.1 - 0.01);  // half a voxel of slack
  EXPECT_NEAR(lowest({"--box-exact"}), 0.1, 1e-6);
  EXPECT_EQ(report()["options"]["box_exact"], "true");
  EXPECT_EQ(open_edges(mesh()), 0u);
}

TEST_F(Reconstruct, ABoxTakenExactlyIsNotMadeSmaller) {
  const Arguments large = {"--method",     "hull", "--box", "-2.3 -2.3 -2.3 2.3 2.3 2.3",
                           "--resolution", "200"};
  succeed(reconstruct(large));
  EXPECT_THAT(report()["box"]["source"], HasSubstr("made smaller by the silhouettes"));
  for (const std::vector<std::string>& stands :
       {std::vector<std::string>{"--box-exact"}, {"--lattice", "fixed"}}) {
    Arguments more = large;
    more.insert(more.end(), stands.begin(), stands.end());
    // What few views see of so large a box may fail the result's own checks; the files are there.
    EXPECT_THAT(run_photohull(reconstruct(more)).code, testing::AnyOf(0, 3));
    EXPECT_EQ(report()["box"]["source"], "--box");
    EXPECT_DOUBLE_EQ(report()["grid"]["voxel_size"], 4.6 / 200);
  }
}

// Two boxes whose corners are whole voxels apart, and other views: the same voxels.
TEST_F(Reconstruct, AFixedLatticeFollowsBoxAndSizeAlone) {
  const Arguments fixed = {"--method", "hull", "--lattice", "fixed", "--voxel-size", "0.0625"};
  const auto grid_of = [&](Arguments more) {
    more.insert(more.begin(), fixed.begin(), fixed.end());
    succeed(reconstruct(more));
    return report()["grid"];
  };
  const json all = grid_of({"--box", "-1 -1.25 -0.75 1 1 1.5"});
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_DOUBLE_EQ(all["origin"][axis].get<double>(),
                     (std::array{-1.0, -1.25, -0.75})[std::size_t(axis)] - 2.5 * 0.0625);
  EXPECT_EQ(read_vdb_surface(path("out/volume.vdb")).grid.voxel_size, 0.0625);
  const json fewer = grid_of({"--box", "-1 -1.25 -0.75 1 1 1.5", "--views", "0-9"});
  EXPECT_EQ(fewer["origin"], all["origin"]);
  EXPECT_EQ(fewer["voxels"], all["voxels"]);
  const json part = grid_of({"--box", "-0.5 -1.25 -0.75 1 1 1.5"});
  EXPECT_DOUBLE_EQ(part["origin"][0].get<double>() - all["origin"][0].get<double>(), 0.5);
  EXPECT_EQ(part["origin"][1], all["origin"][1]);
}

// llvmpipe with vectors half as wide stands for another device: threads run in other groups.
TEST_F(Reconstruct, AnotherWidthOfVectorsLeavesTheHullsBytesAndTheSurface) {
  RunOptions narrow;
  narrow.environment = {"LP_NATIVE_VECTOR_WIDTH=128"};
  for (const std::string method : {"hull", "voxel-coloring", "refine"}) {
    const auto run = [&](const std::string& name, const RunOptions& options) {
      succeed({"reconstruct", scene(), "--out", path(name), "--masks", path("cutouts"),
               "--resolution", "32", "--device", "software", "--method", method},
              options);
      return path(name + "/mesh.ply");
    };
    const std::string wide = run("wide", {}), other = run("narrow", narrow);
    const json report = json::parse(read_bytes(path("narrow/report.json")));
    EXPECT_THAT(report["device"], HasSubstr("128 bits"));
    if (method == "hull") {
      EXPECT_TRUE(read_bytes(wide) == read_bytes(other));
    }
    const json apart =
        json::parse(succeed({"evaluate", other, "--truth", wide, "--json"}).out)["recon_to_gt"];
    const double voxel = report["grid"]["voxel_size"];
    EXPECT_LT(apart["mean"], 0.01 * voxel) << method;
    EXPECT_LT(apart["q95"], 0.05 * voxel) << method;
  }
}

TEST_F(Reconstruct, ADraftSaysWhatAHullIs) {
  const Finished run = succeed(reconstruct({"--quality", "draft", "--resolution", "32"}));
  EXPECT_THAT(run.out, HasSubstr("verdict: good"));
  EXPECT_THAT(run.out, HasSubstr("a visual hull is an outer bound"));
  EXPECT_EQ(report()["verdict"]["notes"].size(), 1u);
  succeed(reconstruct());
  EXPECT_EQ(report()["verdict"]["notes"].size(), 0u);
}

TEST_F(Reconstruct, MakesTheOutputFolderAndReplacesEarlierResults) {
  succeed({"reconstruct", scene(), "--out", path("a/b/c"), "--quality", "draft"});
  EXPECT_EQ(listing(path("a/b/c")).size(), 4u);
}

}  // namespace
}  // namespace photohull::test
