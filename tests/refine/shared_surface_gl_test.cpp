// Several processes at one surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>
#include <vector>

#include "refine/job.h"
#include "refine/kernels/choose_views.h"
#include "refine/shared_work.h"
#include "refine/tile_helper.h"
#include "refine/tile_tasks.h"
#include "refine_surface.h"
#include "support/scratch_folder.h"
#include "volume/extract_mesh.h"

namespace photohull::refine {
namespace {

/// Helpers have a device of their own, as other processes have.
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

}  // namespace
}  // namespace photohull::refine
