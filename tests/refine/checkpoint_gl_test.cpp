// Jobs that stop between levels and go on.
#include <gtest/gtest.h>

#include <filesystem>

#include "bowl_scene.h"
#include "core/error.h"
#include "refine/refine.h"
#include "support/gl_context.h"
#include "support/scratch_folder.h"

namespace photohull::refine {
namespace {

namespace fs = std::filesystem;

/// Asks to stop when so much is done, and keeps warnings.
class StoppingProgress : public Progress {
 public:
  explicit StoppingProgress(double stop_at) : stop_at_(stop_at) {}
  ~StoppingProgress() override { process_cancellation().reset(); }
  void update(double fraction) override {
    if (fraction >= stop_at_) process_cancellation().cancel();
  }
  void warn(const std::string& message) override { warnings.push_back(message); }
  void note(const std::string& message) override { notes.push_back(message); }
  std::vector<std::string> warnings, notes;

 private:
  double stop_at_;
};

class CheckpointedRefine : public testing::Test {
 protected:
  SparseVolume run(Progress& progress, const CheckpointFile* file) {
    gpu::Context& context = test::gl_context();
    RefineOptions options;
    options.levels = 3;
    options.noise_sigma = 0.01;
    return refine_surface(context,
                          {scene_.grid(5), [&](const GridSpec& grid) { return scene_.hull(grid); },
                           scene_.silhouettes(), projtex::ImageSet(scene_.views), scene_.cameras},
                          options, progress, &report_, file);
  }
  SparseVolume run_through(const CheckpointFile* file) {
    warnings_.clear();
    StoppingProgress progress(2);
    SparseVolume volume = run(progress, file);
    warnings_ = progress.warnings;
    notes_ = progress.notes;
    return volume;
  }
  void run_until(double fraction) {
    StoppingProgress progress(fraction);
    EXPECT_THROW(run(progress, &file_), Cancelled);
  }

  const test::BowlScene& scene_ = test::bowl_scene();
  ScratchFolder folder_;
  CheckpointFile file_{folder_ / "checkpoint", "a job"};
  RefineReport report_;
  std::vector<std::string> warnings_, notes_;
};

TEST_F(CheckpointedRefine, GoesOnAndEndsTheSame) {
  const SparseVolume whole = run_through(nullptr);
  EXPECT_TRUE(notes_.empty());
  const std::size_t levels = report_.levels.size();
  run_until(0.7);  // two of three levels
  const SparseVolume resumed = run_through(&file_);
  EXPECT_EQ(report_.resumed, 2);
  ASSERT_EQ(notes_.size(), 1u);
  EXPECT_NE(notes_[0].find("2 of 3 levels"), std::string::npos) << notes_[0];
  ASSERT_EQ(report_.levels.size(), levels);
  EXPECT_GT(report_.levels.front().surfels, 100);
  EXPECT_EQ(resumed.table, whole.table);
  EXPECT_EQ(resumed.distance, whole.distance);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(CheckpointedRefine, AnotherJobStartsAnew) {
  run_until(0.7);
  file_.job = "another";
  run_through(&file_);
  EXPECT_EQ(report_.resumed, 0);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(CheckpointedRefine, DamagedFilesAreNamedAndLeft) {
  run_until(0.4);
  const std::string good = read_text(file_.path);
  ASSERT_GT(good.size(), 4000u);
  std::string huge = good, foreign = good;
  huge.replace(huge.size() / 2, 64, std::string(64, '\xff'));
  foreign.replace(0, 4, "????");
  for (const std::string& bad : {std::string(), good.substr(0, 40), good.substr(0, good.size() / 2),
                                 good.substr(0, good.size() - 1), good + "x", huge, foreign}) {
    write_text(file_.path, bad);
    run_through(&file_);
    EXPECT_EQ(report_.resumed, 0);
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_[0].find(file_.path.string()), std::string::npos);
  }
}

TEST_F(CheckpointedRefine, FolderThatTakesNoFileIsAWarning) {
  file_.path = folder_ / "missing/checkpoint";
  run_through(&file_);
  EXPECT_EQ(report_.levels.size(), 3u);
  EXPECT_EQ(warnings_.size(), 2u);
}

}  // namespace
}  // namespace photohull::refine
