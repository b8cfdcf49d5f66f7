// What does not fit into memory is made in parts, without being asked for.
#include "cli/make_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/reconstruct_scene.h"
#include "core/error.h"
#include "core/too_many_voxels.h"
#include "io/mesh/read_mesh.h"
#include "pipeline/write_results.h"
#include "sphere_scene.h"
#include "support/analytic_volumes.h"
#include "volume/write_vdb.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using testing::ThrowsMessage;

/// Notes what is done, and asks for a stop when it comes to a stage.
class Listener : public Progress {
 public:
  explicit Listener(std::string stop_at = {})
      : Progress(CancellationToken()), stop_at_(std::move(stop_at)) {}
  void stage(const std::string& name, double) override {
    stages.push_back(name);
    if (name == stop_at_) token().cancel();
  }
  void note(const std::string& message) override { notes.push_back(message); }
  std::vector<std::string> stages, notes;

 private:
  const std::string stop_at_;
};

class MakeModel : public SphereScene {
 protected:
  MakeModel() {
    load_.masks = io::MaskSource::kDirectory;
    load_.mask_directory = path("cutouts");
    job_.resolution = 160;
    job_.image_scale = 1;
    job_.tune = {"voting=0", "fit_passes=0"};
    job_.report_page = pipeline::ReportPage::kOff;
  }

  /// TooManyVoxels::room() with so many bytes.
  double room(std::int64_t bytes) {
    job_.max_memory = bytes;
    Progress silent;
    try {
      pipeline::reconstruct_to_folder(job_, pipeline::load_photographs(scene(), load_),
                                      folder_ / "tried", silent);
    } catch (const TooManyVoxels& problem) {
      return problem.room();
    }
    ADD_FAILURE() << bytes << " bytes are enough";
    return 1;
  }

  /// So many bytes that this is the room. Before masks are seen, what the room lacks is as many
  /// bytes as photographs alone take too many; after that it grows evenly.
  std::int64_t bytes_for(double wanted) {
    constexpr std::int64_t kLow = 1 << 20, kSome = 1 << 20;
    const std::int64_t photographs = kLow - std::int64_t(room(kLow));
    return photographs + std::int64_t(wanted / room(photographs + kSome) * double(kSome));
  }

  cli::MadeModel make(Progress& progress, const std::string& name) {
    return cli::make_model(job_, load_, folder_, folder_ / name, progress);
  }

  pipeline::ReconstructOptions job_;
  io::LoadSceneOptions load_;
};

TEST_F(MakeModel, WhatDoesNotFitIsMadeInPartsAndGoesOnWhereItWasStopped) {
  Progress silent;
  EXPECT_TRUE(make(silent, "one").report);
  job_.max_memory = bytes_for(0.85);
  Listener stopped("part2of3: refine");
  EXPECT_THROW(make(stopped, "parts"), Cancelled);
  EXPECT_THAT(stopped.notes, Contains(AllOf(HasSubstr("this job would take about"),
                                            HasSubstr("it is made in 3 parts"))));
  EXPECT_FALSE(fs::exists(folder_ / "parts/mesh.ply"));
  Listener again;
  const cli::MadeModel made = make(again, "parts");
  EXPECT_THAT(again.stages, Not(Contains(StartsWith("whole: "))));
  EXPECT_THAT(again.stages, Not(Contains(StartsWith("part1of3: "))));
  EXPECT_THAT(again.stages, Contains("part2of3: refine"));

  EXPECT_FALSE(made.report);
  EXPECT_EQ(made.views, kViews);
  const json report = json::parse(read_bytes(folder_ / "parts/report.json"));
  EXPECT_EQ(report["parts"].size(), 3u);
  EXPECT_FALSE(fs::exists(folder_ / "parts/parts")) << "they are joined";
  const SparseVolume joined = read_vdb_surface(folder_ / "parts/volume.vdb"),
                     one = read_vdb_surface(folder_ / "one/volume.vdb");
  EXPECT_NEAR(joined.grid.voxel_size, one.grid.voxel_size, 1e-12);
  EXPECT_NEAR(double(joined.inside_voxels()), double(one.inside_voxels()),
              0.01 * double(one.inside_voxels()));
  const TriMesh mesh = read_mesh(folder_ / "parts/mesh.ply");
  EXPECT_EQ(open_edges(mesh), 0u);
  EXPECT_EQ(std::int64_t(mesh.triangles.size()), made.triangles);

  testing::internal::CaptureStdout();
  cli::tell_results(path("parts"), false);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              AllOf(HasSubstr(concat(kViews, " views, ")),
                    HasSubstr(concat(made.triangles, " triangles, in 3 parts\n")),
                    HasSubstr("CPU s), peak memory "), HasSubstr("verdict: ")));
}

TEST_F(MakeModel, SaysWhyPartsDoNotHelp) {
  Progress silent;
  const auto attempt = [&] { make(silent, "out"); };
  job_.exports = {"glb"};
  job_.max_memory = bytes_for(0.85);
  EXPECT_THAT(attempt, ThrowsMessage<Error>(
                           AllOf(HasSubstr("this job would take about"),
                                 HasSubstr("in parts it cannot be made: part=1/1: export"))));
  job_.exports = {};
  job_.max_memory = std::int64_t(1) << 20;
  EXPECT_THAT(attempt, ThrowsMessage<Error>(HasSubstr("but may take 1 MiB (max_memory)")));
  EXPECT_THAT(attempt, ThrowsMessage<Error>(Not(HasSubstr("parts"))));
  job_.max_memory = bytes_for(0.05);
  EXPECT_THAT(attempt, ThrowsMessage<Error>(HasSubstr("this job would take about")));
  EXPECT_FALSE(fs::exists(folder_ / "out/report.json"));
  job_.max_memory.reset();
  job_.resolution = 200000;
  EXPECT_THAT(attempt, ThrowsMessage<Error>(HasSubstr("makes a lattice of")));
}

}  // namespace
}  // namespace photohull::test
