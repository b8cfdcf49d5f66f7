// plan, batch and run with parts: a whole on coarser voxels, its parts on finer ones, joined.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "batch_scenes.h"
#include "io/mesh/read_mesh.h"
#include "pipeline/join_parts.h"
#include "support/analytic_volumes.h"
#include "support/places.h"
#include "volume/components.h"
#include "volume/write_vdb.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

/// How two volumes on one grid differ near the surface of either, in voxels.
struct Difference {
  double mean = 0, far = 0;  ///< far: share of the voxels that differ by a quarter or more
};

Difference difference(const SparseVolume& a, const SparseVolume& b) {
  const glm::ivec3 n = a.grid.voxels();
  double sum = 0, far = 0, count = 0;
  for (int x = 0; x < n.x; ++x)
    for (int y = 0; y < n.y; ++y)
      for (int z = 0; z < n.z; ++z) {
        const double p = double(a.at({x, y, z})), q = double(b.at({x, y, z}));
        if (std::min(std::abs(p), std::abs(q)) > 1) continue;
        sum += std::abs(p - q), far += std::abs(p - q) > 0.25, ++count;
      }
  return {sum / count, far / count};
}

class Parts : public BatchScenes {
 protected:
  static std::string temple() { return in_checkout("datasets/templeSparseRing"); }
  json report(const std::string& folder) const {
    return json::parse(read_bytes(folder_ / folder / "report.json"));
  }
};

TEST_F(Parts, TogetherAreTheWholeInOnePiece) {
  const Finished run = succeed({"batch", temple(), "--resolution", "80", "--parts", "3",
                                "--report-page", "off", "--out", path("job")});
  EXPECT_THAT(run.out, HasSubstr("5 scenes, 0 of them made before"));
  const std::string name = "job/templeSparseRing";
  // The same voxels, of one part, are what parts are to be.
  succeed({"reconstruct", temple(), "--follow", path(name + ".whole"), "--part", "1/1", "--out",
           path("one")});
  const SparseVolume joined = read_vdb_surface(folder_ / name / "volume.vdb"),
                     one = read_vdb_surface(folder_ / "one/volume.vdb");
  ASSERT_EQ(joined.grid.bricks, one.grid.bricks);
  EXPECT_LT(glm::distance(joined.grid.origin, one.grid.origin), 1e-9);
  const Difference d = difference(joined, one);
  EXPECT_LT(d.mean, 0.012);
  EXPECT_LT(d.far, 0.01);
  EXPECT_NEAR(double(joined.inside_voxels()), double(one.inside_voxels()),
              0.005 * double(one.inside_voxels()));
  EXPECT_EQ(component_sizes(joined).size(), component_sizes(one).size()) << "dust of parts is gone";
  const json told = report(name);
  EXPECT_EQ(told["mesh"]["open_edges"], 0);
  EXPECT_GT(told["mesh"]["seam_vertices"], 50);
  EXPECT_EQ(told["parts"].size(), 3u);
  EXPECT_EQ(told["verdict"], report(name + ".whole")["verdict"]);
  const TriMesh mesh = read_mesh(folder_ / name / "mesh.ply");
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_EQ(mesh.colours.size(), mesh.positions.size());
  EXPECT_EQ(mesh.triangles.size(), told["mesh"]["triangles"]);

  // Where memory does not suffice for the volumes, the parts that have them are listed.
  std::vector<fs::path> parts;
  for (const json& part : told["parts"])
    parts.push_back((folder_ / name / part["folder"].get<std::string>()).lexically_normal());
  Progress progress;
  const pipeline::JoinedParts apart = pipeline::join_parts(
      folder_ / (name + ".whole"), parts, folder_ / "apart", std::int64_t(1000), progress);
  EXPECT_FALSE(apart.joined);
  EXPECT_EQ(report("apart")["parts"][1]["folder"], "../job/templeSparseRing.part2");
  EXPECT_EQ(report("apart")["parts"].size(), 3u);
  EXPECT_FALSE(fs::exists(folder_ / "apart/volume.vdb"));
  EXPECT_EQ(read_bytes(folder_ / "apart/mesh.ply"), read_bytes(folder_ / name / "mesh.ply"));

  // A part in which nothing is left changes nothing.
  fs::create_directories(folder_ / "empty");
  json nothing = report(name + ".part1");
  nothing["mesh"]["triangles"] = 0;
  write_bytes(folder_ / "empty/report.json", nothing.dump());
  write_bytes(folder_ / "empty/mesh.ply", "");
  fs::copy_file(parts.front() / "volume.vdb", folder_ / "empty/volume.vdb");
  std::vector<fs::path> more = parts;
  more.push_back(folder_ / "empty");
  EXPECT_EQ(pipeline::join_parts(folder_ / (name + ".whole"), more, folder_ / "with", {}, progress)
                .triangles,
            apart.triangles);

  // A result that is damaged is named.
  const auto refusal = [&] {
    try {
      pipeline::join_parts(folder_ / (name + ".whole"), more, folder_ / "without", {}, progress);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("nothing was refused");
  };
  fs::remove(folder_ / "empty/mesh.ply");
  nothing["mesh"]["triangles"] = 5;
  write_bytes(folder_ / "empty/report.json", nothing.dump());
  EXPECT_THAT(refusal(), HasSubstr("empty/mesh.ply"));
  nothing.erase("mesh");
  write_bytes(folder_ / "empty/report.json", nothing.dump());
  EXPECT_THAT(refusal(), HasSubstr("empty/report.json"));
  EXPECT_FALSE(fs::exists(folder_ / "without/report.json"));

  // A part that was lost is made again, and joined to the same model.
  const std::string before = read_bytes(folder_ / name / "mesh.ply");
  fs::remove(folder_ / (name + ".part2/volume.vdb"));
  EXPECT_THAT(succeed({"batch", temple(), "--resolution", "80", "--parts", "3", "--report-page",
                       "off", "--out", path("job")})
                  .out,
              HasSubstr("5 scenes, 3 of them made before"));
  EXPECT_EQ(read_bytes(folder_ / name / "mesh.ply"), before);
}

TEST_F(Parts, BelieveTheHullAsFarAsTheWholeSays) {
  const Arguments usual = {"--masks", path("cutouts"), "--report-page", "off"};
  const auto made = [&](Arguments arguments, const std::string& to) {
    arguments.insert(arguments.begin(), {"reconstruct", scene()});
    arguments.insert(arguments.end(), usual.begin(), usual.end());
    arguments.insert(arguments.end(), {"--out", path(to)});
    return run_photohull(arguments);
  };
  ASSERT_EQ(made({"--resolution", "24"}, "whole").code, 0);
  json whole = report("whole");
  const std::vector<double> trust = whole["hull_trust"];
  ASSERT_EQ(trust.size(), 5u);
  for (std::size_t i = 0; i < trust.size(); ++i) {
    EXPECT_GE(trust[i], 0);
    EXPECT_LE(trust[i], i == 0 ? 1 : trust[i - 1]) << "smaller voxels are not nearer to the hull";
  }
  const auto mesh_with = [&](const json& told, const std::string& to) {
    whole["hull_trust"] = told;
    write_bytes(folder_ / "whole/report.json", whole.dump());
    const Finished part = made({"--follow", path("whole"), "--part", "1/1"}, to);
    EXPECT_EQ(part.code, 0) << part.err;
    return read_bytes(folder_ / to / "mesh.ply");
  };
  // Of a whole at half the voxels the second number counts.
  const std::string none = mesh_with({1, 0, 1, 1, 1}, "none");
  EXPECT_EQ(mesh_with({0, 0, 0, 0, 0}, "also_none"), none);
  EXPECT_NE(mesh_with({0, 1, 0, 0, 0}, "all"), none);
  whole["hull_trust"] = {1, 2};
  write_bytes(folder_ / "whole/report.json", whole.dump());
  const Finished damaged = made({"--follow", path("whole"), "--part", "1/1"}, "damaged");
  EXPECT_EQ(damaged.code, 1);
  EXPECT_THAT(damaged.err, AllOf(HasSubstr("whole/report.json"), HasSubstr("hull_trust")));
}

TEST_F(Parts, OfHullsAreTheHullInOnePiece) {
  const auto make = [&](const std::string& count) {
    succeed({"batch", scene(), "--masks", path("cutouts"), "--method", "hull", "--resolution", "64",
             "--parts", count, "--report-page", "off", "--out", path(count)});
    return folder_ / count / fs::path(scene()).filename();
  };
  const fs::path one = make("1");
  const SparseVolume volume = read_vdb_surface(one / "volume.vdb");
  const TriMesh mesh = read_mesh(one / "mesh.ply");
  for (const char* count : {"2", "5"}) {
    const fs::path folder = make(count);
    const SparseVolume joined = read_vdb_surface(folder / "volume.vdb");
    ASSERT_EQ(joined.grid.bricks, volume.grid.bricks);
    EXPECT_LT(difference(joined, volume).mean, 1e-3) << count;
    EXPECT_EQ(difference(joined, volume).far, 0) << count;
    EXPECT_EQ(joined.inside_voxels(), volume.inside_voxels()) << count;
    const TriMesh stitched = read_mesh(folder / "mesh.ply");
    EXPECT_EQ(open_edges(stitched), 0u) << count;
    EXPECT_EQ(stitched.triangles.size(), mesh.triangles.size()) << count;
  }
}

TEST_F(Parts, WithoutTheWholeThereAreNone) {
  write_masks("nothing", 0, 0);
  const Finished run =
      run_photohull({"batch", scene(), "--masks", path("nothing"), "--resolution", "32", "--parts",
                     "2", "--report-page", "off", "--out", path("job")});
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err,
              AllOf(HasSubstr(".part1: "), HasSubstr("has no result, of which this is a part"),
                    HasSubstr("without which the parts cannot be joined"),
                    HasSubstr("4 of 4 scenes have no result")));
}

TEST_F(Parts, WhatGoesWithNoPartsIsRefused) {
  const auto refusal = [&](Arguments arguments) {
    arguments.insert(arguments.end(), {"--out", path("job")});
    const Finished run = run_photohull(arguments);
    EXPECT_EQ(run.code, 2) << run.err;
    return run.err;
  };
  EXPECT_THAT(refusal({"plan", scene(), "--parts", "4"}),
              HasSubstr("give --resolution or --voxel-size"));
  EXPECT_THAT(refusal({"plan", scene(), "--parts", "4", "--resolution", "64", "--frames", "1-2"}),
              HasSubstr("--parts and --frames exclude each other"));
  EXPECT_THAT(
      refusal({"plan", scene(), "--parts", "4", "--resolution", "64", "--method", "space-carving"}),
      HasSubstr("--method space-carving is not made in parts"));
  EXPECT_THAT(refusal({"plan", scene(), "--parts", "4", "--resolution", "64", "--export", "glb"}),
              HasSubstr("--export"));
  EXPECT_THAT(refusal({"reconstruct", scene(), "--part", "1/2"}), HasSubstr("--follow"));
  EXPECT_THAT(refusal({"reconstruct", scene(), "--finer", "2"}), HasSubstr("is for parts"));
  EXPECT_THAT(refusal({"plan", scene(), "--finer", "2"}), HasSubstr("is for parts"));
  EXPECT_THAT(refusal({"reconstruct", scene(), "--part", "3/2", "--follow", path("x")}),
              HasSubstr("a part and their number, such as 3/8"));
  EXPECT_THAT(refusal({"reconstruct", scene(), "--part", "1/2", "--follow", path("x"),
                       "--resolution", "64"}),
              HasSubstr("--resolution is the whole's matter"));
  const Finished missing = run_photohull(
      {"reconstruct", scene(), "--part", "1/2", "--follow", path("x"), "--out", path("job")});
  EXPECT_EQ(missing.code, 1);
  EXPECT_THAT(missing.err, HasSubstr("there is no such folder"));
  succeed({"reconstruct", scene(), "--masks", path("cutouts"), "--resolution", "20",
           "--report-page", "off", "--out", path("small")});
  const Finished many = run_photohull({"reconstruct", scene(), "--masks", path("cutouts"), "--part",
                                       "1/900", "--follow", path("small"), "--out", path("job")});
  EXPECT_EQ(many.code, 1);
  EXPECT_THAT(many.err, HasSubstr("too few for so many parts"));
}

}  // namespace
}  // namespace photohull::test
