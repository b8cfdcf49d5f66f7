// Selection and update of a sweep's columns against their references.
#include "carving/sweep_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "support/cameras.h"
#include "support/gl_context.h"

namespace photohull::carving {
namespace {

using glm::ivec2;
using glm::ivec3;
using reference::ColumnJudge;
using reference::Consistency;
using reference::SweepFrame;
using test_kernels::SelectedLayer;
using test_kernels::SweepKernels;

template <typename T>
std::vector<T> sorted(std::vector<T> points) {
  std::sort(points.begin(), points.end(), [](const T& a, const T& b) {
    for (int i = 0; i < T::length(); ++i)
      if (a[i] != b[i]) return a[i] < b[i];
    return false;
  });
  return points;
}

/// Bricks without any voxel, full ones and random ones; `density` is the share that stands.
BitVolume random_bits(test::Rng& rng, const ivec3& bricks, double density) {
  BitVolume bits;
  bits.grid = {{0, 0, 0}, 1, bricks};
  for (int z = 0; z < bricks.z; ++z)
    for (int y = 0; y < bricks.y; ++y)
      for (int x = 0; x < bricks.x; ++x) {
        const double kind = test::uniform(rng, 0, 1);
        if (kind < 0.15) {
          bits.table.push_back(SparseVolume::kOutside);
          continue;
        }
        bits.table.push_back(std::uint32_t(bits.bricks.size()));
        bits.bricks.push_back({x, y, z});
        for (int word = 0; word < BitVolume::kWords; ++word) {
          std::uint32_t value = 0;
          for (int bit = 0; bit < 32; ++bit)
            value |= std::uint32_t(kind > 0.85 || test::uniform(rng, 0, 1) < density) << bit;
          bits.words.push_back(value);
        }
      }
  return bits;
}

class SweepKernelTest : public ::testing::Test {
 protected:
  void TearDown() override { context_.check_errors("sweep kernel test"); }

  std::vector<projtex::GridCamera> random_cameras(const GridSpec& grid, int count) {
    std::vector<projtex::GridCamera> cameras;
    for (int i = 0; i < count; ++i)
      cameras.push_back(projtex::to_grid(test::random_camera(rng_, grid.bounds(), 64, 64), grid));
    return cameras;
  }

  gpu::Context& context_ = test::gl_context();
  test::Rng rng_{41};
};

/// A sweep through random occupancy with made-up scores; every step is compared to the references.
class ColumnsTest : public SweepKernelTest,
                    public ::testing::WithParamInterface<std::pair<int, int>> {
 protected:
  Consistency random_score() {
    Consistency c;
    c.score = float(test::uniform(rng_, -1, 1));
    c.seen = int(test::uniform(rng_, 1, 8));
    c.used = c.seen;
    c.texture = float(test::uniform(rng_, 0, 1e-3));
    return c;
  }

  void compare_selection(const SelectedLayer& found, const BitVolume& bits, const SweepFrame& frame,
                         int layer, const std::vector<std::uint8_t>& on_path) {
    SelectedLayer expected;
    for (int v = 0; v < frame.voxels[frame.v()]; v += kBrickEdge)
      for (int u = 0; u < frame.voxels[frame.u()]; u += kBrickEdge) {
        const auto part = reference::select(bits, frame, layer, {u, v}, on_path);
        expected.judged.insert(expected.judged.end(), part.judged.begin(), part.judged.end());
        expected.occluders.insert(expected.occluders.end(), part.occluders.begin(),
                                  part.occluders.end());
      }
    EXPECT_EQ(sorted(found.judged), sorted(expected.judged)) << "layer " << layer;
    EXPECT_EQ(sorted(found.occluders), sorted(expected.occluders)) << "layer " << layer;
  }

  void compare_decisions(const SweepKernels& kernels, const BitVolume& bits,
                         const SweepFrame& frame, const reference::JudgeRules& rules,
                         const std::vector<std::vector<Consistency>>& scores);
  void sweep(double density, const reference::JudgeRules& rules);
};

void ColumnsTest::compare_decisions(const SweepKernels& kernels, const BitVolume& bits,
                                    const SweepFrame& frame, const reference::JudgeRules& rules,
                                    const std::vector<std::vector<Consistency>>& scores) {
  const int layers = frame.voxels[frame.axis], width = frame.voxels[frame.u()];
  std::map<std::pair<int, int>, std::vector<Decision>> found;
  for (const Decision& d : kernels.decisions()) found[{d.column.x, d.column.y}].push_back(d);
  int outcomes[4] = {};
  for (int i = 0; i < int(scores.size()); ++i) {
    const ivec2 column(i % width, i / width);
    std::vector<std::uint8_t> standing;
    for (int layer = 0; layer < layers; ++layer)
      standing.push_back(bits.standing(frame.voxel(column, layer)));
    const auto expected = ColumnJudge(rules, standing, scores[i]).decisions(column);
    auto& mine = found[{column.x, column.y}];
    std::sort(mine.begin(), mine.end(),
              [](const Decision& a, const Decision& b) { return a.bare < b.bare; });
    ASSERT_EQ(mine.size(), expected.size()) << column.x << ", " << column.y;
    for (std::size_t k = 0; k < mine.size(); ++k) {
      EXPECT_TRUE(mine[k] == expected[k]) << column.x << ", " << column.y;
      ++outcomes[int(expected[k].outcome)];
    }
  }
  for (const int count : outcomes) EXPECT_GT(count, 10);
}

void ColumnsTest::sweep(double density, const reference::JudgeRules& rules) {
  const BitVolume bits = random_bits(rng_, {3, 2, 4}, density);
  SweepFrame frame{GetParam().first, GetParam().second, bits.grid.voxels()};
  SweepKernels kernels(context_, bits, frame, random_cameras(bits.grid, 1));
  kernels.parameters.thresholds = {rules.keep_score, rules.better_by, rules.min_views, 0};
  kernels.parameters.noise = {0, rules.min_texture, 0, 0};
  kernels.parameters.chunk.y = rules.max_path;
  const int layers = frame.voxels[frame.axis], width = frame.voxels[frame.u()];
  const int columns = width * frame.voxels[frame.v()];
  std::vector<std::vector<Consistency>> scores(columns);
  for (auto& column : scores)
    for (int layer = 0; layer < layers; ++layer) column.push_back(random_score());

  std::uint32_t judged = 0;
  std::size_t decided = 0;
  for (int layer = 0; layer < layers; ++layer) {
    const std::vector<std::uint8_t> on_path = kernels.on_path();
    const SelectedLayer selected = kernels.select(layer);
    compare_selection(selected, bits, frame, layer, on_path);
    std::vector<glm::vec4> packed;
    for (const ivec2& column : selected.judged) {
      const Consistency& c = scores[column.y * width + column.x][layer];
      packed.emplace_back(c.score, c.used, c.texture, c.seen);
    }
    judged += std::uint32_t(packed.size());
    kernels.update(packed);
    // Every decision puts its surface among the occluders.
    const std::vector<Decision> decisions = kernels.decisions();
    std::vector<ivec3> hiding = selected.occluders;
    for (; decided < decisions.size(); ++decided)
      hiding.push_back(frame.voxel(decisions[decided].column, decisions[decided].surface));
    EXPECT_EQ(sorted(kernels.occluders()), sorted(hiding)) << "layer " << layer;
  }
  EXPECT_EQ(kernels.judged_count(), judged);

  compare_decisions(kernels, bits, frame, rules, scores);
}

TEST_P(ColumnsTest, LongPathsThroughDenseVoxels) { sweep(0.93, {0.6, 0.15, 3, 2e-4, 64}); }

TEST_P(ColumnsTest, PathsEndAtTheLongestLength) { sweep(0.97, {0.9, 0.15, 2, 1e-4, 3}); }

TEST_P(ColumnsTest, ManySurfacesPerColumn) { sweep(0.6, {0.3, 0.3, 4, 3e-4, 64}); }

INSTANTIATE_TEST_SUITE_P(Directions, ColumnsTest,
                         ::testing::Values(std::pair(0, 1), std::pair(1, -1), std::pair(2, 1),
                                           std::pair(2, -1)));

TEST_F(SweepKernelTest, AnEmptyVolumeSelectsNothing) {
  BitVolume bits;
  bits.grid = {{0, 0, 0}, 1, {2, 2, 2}};
  bits.table.assign(8, SparseVolume::kOutside);
  SweepKernels kernels(context_, bits, {2, 1, {16, 16, 16}}, random_cameras(bits.grid, 1));
  for (const int layer : {0, 7, 15}) {
    const SelectedLayer selected = kernels.select(layer);
    EXPECT_TRUE(selected.judged.empty());
    EXPECT_TRUE(selected.occluders.empty());
    kernels.update({});
    EXPECT_TRUE(kernels.decisions().empty());
  }
}

}  // namespace
}  // namespace photohull::carving
