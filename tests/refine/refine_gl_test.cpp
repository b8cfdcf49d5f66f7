#include "refine/refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <limits>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "bowl_scene.h"
#include "core/error.h"
#include "refine/job.h"
#include "refine/kernels/choose_views.h"
#include "refine/shared_work.h"
#include "refine/tile_helper.h"
#include "refine/tile_tasks.h"
#include "refine/view_choice.h"
#include "support/analytic_volumes.h"
#include "support/gl_context.h"
#include "support/scratch_folder.h"
#include "volume/extract_mesh.h"

namespace photohull::refine {
namespace {

class RefineSurface : public testing::Test {
 protected:
  RefineSurface() {
    options_.levels = 2;
    options_.noise_sigma = 0.01;
  }

  SparseVolume run(int edge, bool masks = true) {
    gpu::Context& context = test::gl_context();
    const auto hull_at = [&](const GridSpec& grid) { return scene_.hull(grid, masks); };
    return refine_surface(
        context,
        {scene_.grid(edge), hull_at, scene_.silhouettes(masks), projtex::ImageSet(scene_.views),
         scene_.cameras, larger_, before_, shared_},
        options_, progress_, &report_);
  }

  const test::BowlScene& scene_ = test::bowl_scene();
  RefineOptions options_;
  Progress progress_;
  RefineReport report_;
  projtex::OutOfCorePhotographs* larger_ = nullptr;
  const MomentBefore* before_ = nullptr;
  SharedWork* shared_ = nullptr;
};

TEST_F(RefineSurface, WhatIsSettledStaysCoarseAndIsNotMatchedAgain) {
  run(8);
  const auto samples = [&] { return report_.levels[1].samples; };
  const std::int64_t all = samples(), surfels = report_.levels[1].surfels;
  options_.settle.least_pixels = 1000;
  const SparseVolume volume = run(8);
  EXPECT_EQ(report_.levels[0].split, 0);
  EXPECT_GT(report_.levels[0].settled_pixels, 30);
  // Only bricks that the first level's surface did not pass are matched.
  EXPECT_LT(samples(), 0.2 * double(all));
  EXPECT_LT(double(report_.levels[1].surfels), 0.6 * double(surfels));
  EXPECT_LT(test::mean_error(volume), 0.4) << "the coarse level's surface";
}

TEST_F(RefineSurface, FindsTheBowl) {
  const SparseVolume volume = run(8);
  const SparseVolume hull = scene_.hull(scene_.grid(8));
  EXPECT_LT(test::mean_error(volume), 0.15);
  EXPECT_LT(test::mean_error(volume), 0.15 * test::mean_error(hull));
  EXPECT_EQ(open_edges(extract_mesh(volume)), 0u);
  for (std::size_t slot = 0; slot < volume.bricks.size(); ++slot) {
    const glm::ivec3 voxel = volume.bricks[slot] * kBrickEdge;
    EXPECT_GE(volume.at(voxel), hull.at(voxel)) << "the hull bounds the result";
  }

  ASSERT_EQ(report_.levels.size(), 2u);
  EXPECT_DOUBLE_EQ(report_.levels[0].voxel_size, 2 * report_.levels[1].voxel_size);
  EXPECT_DOUBLE_EQ(report_.levels[1].voxel_size, volume.grid.voxel_size);
  EXPECT_EQ(report_.levels[1].bricks, std::int64_t(volume.bricks.size()));
  for (const LevelReport& level : report_.levels) {
    EXPECT_GT(level.surfels, 1000);
    EXPECT_GT(level.samples, level.surfels);
    EXPECT_GT(level.mean_move, 0);
    EXPECT_LT(level.mean_move, 1);
    EXPECT_GT(level.split, 30);
    EXPECT_LE(level.split + level.settled_pixels + level.settled_plain + level.settled_flat,
              level.bricks);
  }
}

TEST_F(RefineSurface, SameDistancesInEveryRun) {
  const SparseVolume first = run(4), second = run(4);
  EXPECT_EQ(first.table, second.table);
  EXPECT_EQ(first.distance, second.distance);
}

/// The scene's photographs, of which it holds a few.
class FewPhotographs : public projtex::OutOfCorePhotographs {
 public:
  FewPhotographs(const test::BowlScene& scene, int most, double noise_sigma)
      : scene_(scene), most_(most), noise_sigma_(noise_sigma) {}

  std::span<const Camera> cameras() const override { return scene_.cameras; }
  int most() const override { return most_; }
  double noise_sigma() const override { return noise_sigma_; }
  const projtex::HeldPhotographs& hold(std::span<const int> numbers) override {
    EXPECT_LE(int(numbers.size()), most_);
    ++times_;
    std::vector<PreparedView> views;
    std::vector<Camera> cameras;
    std::vector<int> layers(scene_.views.size(), -1);
    for (const int n : numbers) {
      layers[std::size_t(n)] = int(views.size());
      views.push_back(scene_.views[std::size_t(n)]);
      cameras.push_back(scene_.cameras[std::size_t(n)]);
    }
    held_ =
        projtex::HeldPhotographs{projtex::ImageSet(views), std::move(cameras), std::move(layers)};
    return *held_;
  }
  int times() const { return times_; }

 private:
  const test::BowlScene& scene_;
  int most_;
  double noise_sigma_;
  int times_ = 0;
  std::optional<projtex::HeldPhotographs> held_;
};

TEST_F(RefineSurface, HoldingAFewPhotographsAtATimeChangesNothing) {
  constexpr int kEdge = 6;
  const SparseVolume all = run(kEdge);
  FewPhotographs few(scene_, ViewChoice::kMostViews, options_.noise_sigma);
  larger_ = &few;
  const SparseVolume some = run(kEdge);
  EXPECT_GT(few.times(), 3 * int(scene_.views.size()) / ViewChoice::kMostViews);
  EXPECT_EQ(all.table, some.table);
  EXPECT_EQ(all.distance, some.distance);
}

/// Several processes at one surface. Helpers have a device of their own, as other processes have.
class SharedSurface : public RefineSurface {
 protected:
  static constexpr int kEdge = 6;

  /// As many tiles as are asked for, with helpers; how many tasks these did is in helped_.
  SparseVolume run_shared(int tiles, int helpers, bool masks = true) {
    ScratchFolder scratch;
    SharedWork shared(scratch.path(), "job", tiles, progress_);
    const projtex::ImageSet images(scene_.views);
    const projtex::Photographs photographs{images, scene_.cameras, options_.noise_sigma};
    const FileSizeLimit full(most_bytes_);
    shared.publish(photographs, larger_);
    shared_ = &shared;
    std::atomic<bool> ended = false;
    std::vector<std::thread> threads;
    for (int i = 0; i < helpers; ++i)
      threads.emplace_back([&] {
        const auto context = gpu::Context::create("auto");
        TileHelper helper(*context, scratch.path());
        while (!ended)
          if (helper.help())
            ++helped_;
          else
            std::this_thread::yield();
      });
    SparseVolume volume = run(kEdge, masks);
    ended = true;
    for (std::thread& thread : threads) thread.join();
    shared_ = nullptr;
    return volume;
  }

  std::atomic<int> helped_ = 0;
  rlim_t most_bytes_ = RLIM_INFINITY;  // of a file
};

TEST_F(SharedSurface, IsThatOfOneProcessHoweverItIsCut) {
  const SparseVolume alone = run(kEdge);
  const std::vector<LevelReport> levels = report_.levels;
  for (const auto& [tiles, helpers] : {std::pair{2, 0}, {3, 1}, {50, 2}}) {
    const SparseVolume together = run_shared(tiles, helpers);
    EXPECT_EQ(alone.table, together.table) << tiles;
    EXPECT_EQ(alone.distance, together.distance) << tiles;
    EXPECT_EQ(report_.levels[0].samples, levels[0].samples) << tiles;
    EXPECT_EQ(report_.levels[1].samples, levels[1].samples) << tiles;
    EXPECT_EQ(helped_ > 0, helpers > 0);
  }
}

TEST_F(SharedSurface, TilesAreMatchedAndFittedAsTheWhole) {
  const ScratchFolder scratch;
  SharedWork shared(scratch.path(), "job", 5, progress_);
  gpu::Context& context = test::gl_context();
  const projtex::ImageSet images(scene_.views);
  const std::vector<carving::Silhouette> silhouettes = scene_.silhouettes();
  const GridSpec grid = scene_.grid(kEdge);
  const HullAt hull_at = [&](const GridSpec& of) { return scene_.hull(of); };
  RefineJob job{context,
                hull_at,
                {scene_.cameras, silhouettes},
                {images, scene_.cameras, options_.noise_sigma},
                options_,
                grid.voxel_size};
  const TriMesh mesh = extract_mesh(scene_.hull(grid));
  const VertexGraph graph = make_graph(mesh);
  const std::vector<glm::vec3> positions = voxel_positions(grid, mesh);
  const MeshSurfels surfels{grid, mesh, graph, positions};
  const std::vector<glm::vec3> bends = curvatures(graph, positions, mesh.normals, 1);
  std::vector<ViewChoice> choices =
      choose_views(job.context, grid, mesh, job.photographs, options_.match);
  choices[1].views.clear();
  const OffsetRange range{-1, 0.5, 5};
  const Matches matches = match_vertices(job, grid, mesh, bends, choices, range);
  const Matches textures = vertex_textures(job, grid, mesh, choices);
  const std::vector<PatchFit> fits = fit_in_tiles(job, surfels, choices);
  EXPECT_GT(std::ranges::count_if(matches.texture, [](float t) { return t < 0.99f; }), 100);

  job.shared = &shared;
  ASSERT_GE(shared.tiles_of(comparable(choices).size()), 3u);
  const Matches tiled = match_vertices(job, grid, mesh, bends, choices, range);
  EXPECT_EQ(tiled.scores, matches.scores);
  EXPECT_EQ(tiled.texture, matches.texture);
  EXPECT_EQ(tiled.samples, matches.samples);
  EXPECT_EQ(tiled.range.count, range.count);
  const Matches tiled_textures = vertex_textures(job, grid, mesh, choices);
  EXPECT_EQ(tiled_textures.texture, textures.texture);
  EXPECT_EQ(tiled_textures.samples, textures.samples);
  const std::vector<PatchFit> tiled_fits = fit_in_tiles(job, surfels, choices);
  ASSERT_EQ(tiled_fits.size(), fits.size());
  for (std::size_t i = 0; i < fits.size(); ++i) {
    ASSERT_EQ(tiled_fits[i].normal, fits[i].normal) << i;
    ASSERT_EQ(tiled_fits[i].offset, fits[i].offset) << i;
    ASSERT_EQ(tiled_fits[i].information, fits[i].information) << i;
    ASSERT_EQ(tiled_fits[i].held_after, fits[i].held_after) << i;
  }
}

TEST_F(SharedSurface, WithoutMasksItIsTheSame) {
  const SparseVolume alone = run(kEdge, false);
  const SparseVolume together = run_shared(9, 1, false);
  EXPECT_GT(helped_, 0);
  EXPECT_EQ(alone.table, together.table);
  EXPECT_EQ(alone.distance, together.distance);
}

TEST_F(SharedSurface, OnAFullDiskItIsTheSame) {
  const SparseVolume alone = run(kEdge);
  most_bytes_ = 1000;
  const SparseVolume together = run_shared(9, 1);
  EXPECT_EQ(helped_, 0);
  EXPECT_EQ(alone.distance, together.distance);
}

TEST_F(SharedSurface, ADeviceThatRoundsDifferentlyDoesNotHelp) {
  const ScratchFolder scratch;
  std::string task;
  ListWriter writer(task);
  TaskHead{"job", "another renderer", TaskKind::kMatch, 0}.write(writer);
  write_text(scratch / "job.0-0-match-0.task", task);
  TileHelper helper(test::gl_context(), scratch.path());
  try {
    helper.help();
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("begun on another renderer"), std::string::npos);
  }
}

TEST_F(SharedSurface, DamagedTasksAreErrors) {
  const ScratchFolder scratch;
  write_text(scratch / "job.0-0-match-0.task", "no task");
  TileHelper helper(test::gl_context(), scratch.path());
  EXPECT_THROW(helper.help(), Error);
  std::string task;
  ListWriter writer(task);
  TaskHead{"job", test::gl_context().device().renderer, TaskKind::kFit, 1}.write(writer);
  write_text(scratch / "job.0-0-match-0.task", task);
  EXPECT_THROW(helper.help(), Error) << "there are no such photographs";
}

TEST_F(SharedSurface, HelpersHoldAsFewPhotographsAsTheirOwner) {
  const SparseVolume alone = run(kEdge);
  FewPhotographs few(scene_, ViewChoice::kMostViews, options_.noise_sigma);
  larger_ = &few;
  const SparseVolume together = run_shared(9, 1);
  EXPECT_GT(helped_, 0);
  EXPECT_EQ(alone.table, together.table);
  EXPECT_EQ(alone.distance, together.distance);
}

/// The bowl, moved by an offset in voxels, on a lattice of its own.
SparseVolume moved_bowl(const GridSpec& grid, const glm::dvec3& offset) {
  return sample_volume(
      grid.bricks + 1,
      [&](const glm::dvec3& v) {
        return test::bowl(grid.world(v - 3.5 - offset)) / grid.voxel_size;
      },
      grid.world(glm::dvec3(-3.5)), grid.voxel_size);
}

TEST_F(RefineSurface, FollowsTheMomentBefore) {
  options_.levels = 3;
  const double alone = test::mean_error(run(8));
  EXPECT_FALSE(report_.followed);
  const MomentBefore before{moved_bowl(scene_.grid(8), {2, -1.5, 1})};
  before_ = &before;
  const double followed = test::mean_error(run(8));
  EXPECT_TRUE(report_.followed);
  EXPECT_EQ(report_.levels.size(), 2u);
  EXPECT_LT(followed, 1.1 * alone);
}

TEST_F(RefineSurface, AMomentThatFollowedLeavesTheLastLevelAlone) {
  options_.levels = 3;
  const MomentBefore before{moved_bowl(scene_.grid(8), {0.5, -0.4, 0.3}), true};
  const double alone = test::mean_error(run(8));
  before_ = &before;
  const double followed = test::mean_error(run(8));
  EXPECT_TRUE(report_.followed);
  EXPECT_EQ(report_.levels.size(), 1u);
  EXPECT_LT(followed, 1.1 * alone);
}

TEST_F(RefineSurface, AMomentThatIsElsewhereIsNotFollowed) {
  options_.levels = 3;
  const SparseVolume alone = run(6);
  const MomentBefore before{moved_bowl(scene_.grid(6), glm::dvec3(18, 0, 0))};
  before_ = &before;
  const SparseVolume volume = run(6);
  EXPECT_FALSE(report_.followed);
  EXPECT_EQ(volume.table, alone.table);
  EXPECT_EQ(volume.distance, alone.distance);
}

TEST_F(RefineSurface, WithoutMasksNoMomentIsFollowed) {
  const MomentBefore before{moved_bowl(scene_.grid(4), glm::dvec3(0))};
  before_ = &before;
  run(4, false);
  EXPECT_FALSE(report_.followed);
}

TEST_F(RefineSurface, WithoutMasks) {
  const SparseVolume box = scene_.hull(scene_.grid(5), false);
  const SparseVolume volume = run(5, false);
  EXPECT_GT(volume.inside_voxels(), 1000u);
  EXPECT_LT(test::mean_error(volume), 0.5 * test::mean_error(box));
}

TEST_F(RefineSurface, OneLevel) {
  options_.levels = 1;
  const SparseVolume volume = run(4);
  EXPECT_LT(test::mean_error(volume), 0.5 * test::mean_error(scene_.hull(scene_.grid(4))));
  EXPECT_EQ(report_.levels.size(), 1u);
}

TEST_F(RefineSurface, VotingFindsWhatTheSearchAloneCannotReach) {
  options_.voting = false;
  const double searched = test::mean_error(run(5));
  options_.voting = true;
  EXPECT_LT(test::mean_error(run(5)), 0.7 * searched);
}

TEST_F(RefineSurface, FittingThePhotographsBringsItNearer) {
  options_.fit_passes = 0;
  const double matched = test::mean_error(run(8));
  EXPECT_TRUE(report_.fits.empty());
  options_.fit_passes = 2;
  EXPECT_LT(test::mean_error(run(8)), matched);
  ASSERT_FALSE(report_.fits.empty());
  EXPECT_TRUE(report_.fits[0].kept);
  EXPECT_GT(report_.fits[0].held_before, 0.3);
  EXPECT_GT(report_.fits[0].mean_move, 0);
}

TEST_F(RefineSurface, TheLastPassSeatsItOnTheOutlinesWhateverTheOthersGained) {
  options_.seat.passes = 0;
  options_.fit_passes = 1;
  const double fitted = test::mean_error(run(8));
  options_.seat = {};
  for (const int passes : {1, 3}) {
    options_.fit_passes = passes;
    EXPECT_LT(test::mean_error(run(8)), 0.95 * fitted) << passes;
    ASSERT_FALSE(report_.fits.empty());
    EXPECT_TRUE(report_.fits.back().kept);
  }
}

TEST_F(RefineSurface, CanBeCancelled) {
  process_cancellation().cancel();
  EXPECT_THROW(run(4), Cancelled);
  process_cancellation().reset();
}

TEST_F(RefineSurface, BadOptionsAreNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::function<void(RefineOptions&)>> mistakes = {
      [](RefineOptions& o) { o.levels = -1; },
      [](RefineOptions& o) { o.levels = 9; },
      [](RefineOptions& o) { o.coarse_iterations = 0; },
      [](RefineOptions& o) { o.fine_offsets = 2; },
      [](RefineOptions& o) { o.coarse_offsets = 65; },
      [](RefineOptions& o) { o.step = 0; },
      [](RefineOptions& o) { o.follow.levels = 0; },
      [](RefineOptions& o) { o.follow.least_inside = 1.1; },
      [](RefineOptions& o) { o.aggregations = -1; },
      [](RefineOptions& o) { o.noise_sigma = 0; },
      [&](RefineOptions& o) { o.noise_sigma = nan; },
      [&](RefineOptions& o) { o.step = nan; },
      [](RefineOptions& o) { o.vote.band = 0; },
      [](RefineOptions& o) { o.vote.least_weight = 0; },
      [](RefineOptions& o) { o.close.longest = -1; },
      [](RefineOptions& o) { o.restore.least_views = 0; },
      [](RefineOptions& o) { o.match.best_pairs = 0; },
      [](RefineOptions& o) { o.match.nearest_angle = o.match.farthest_angle; },
      [](RefineOptions& o) { o.peak.full_score = o.peak.least_score; },
      [](RefineOptions& o) { o.fit_passes = -1; },
      [](RefineOptions& o) { o.fit.slope = 0; },
      [](RefineOptions& o) { o.fit.largest_offset = 3; },
      [&](RefineOptions& o) { o.fit.unit_deviation = nan; },
      [](RefineOptions& o) { o.regularize.robust = 0; }};
  for (std::size_t i = 0; i < mistakes.size(); ++i) {
    options_ = {};
    mistakes[i](options_);
    EXPECT_THROW(options_.validate(), UsageError) << i;
  }
  EXPECT_THROW(run(4), UsageError);
  EXPECT_NO_THROW(RefineOptions().validate());
}

}  // namespace
}  // namespace photohull::refine
