// The sweep's tests of visibility against their references.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "carving/sweep_kernels.h"
#include "core/parse_name.h"
#include "support/cameras.h"
#include "support/gl_context.h"
#include "visibility/sweep_reference.h"

namespace photohull::carving {
namespace {

using glm::ivec3;
using test_kernels::SweepKernels;
using visibility::SweepTest;

constexpr int kVoxels = 24;
constexpr int kLayer = 8;

/// 3^3 bricks of which only the middle one stands; the sweep goes along z.
BitVolume middle_brick() {
  BitVolume bits;
  bits.grid = {{0, 0, 0}, 1, {3, 3, 3}};
  for (int i = 0; i < 27; ++i) {
    bits.table.push_back(std::uint32_t(i));
    bits.bricks.emplace_back(i % 3, i / 3 % 3, i / 9);
    for (int k = 0; k < BitVolume::kWords; ++k) bits.words.push_back(i == 13 ? ~0u : 0);
  }
  return bits;
}

class SweepVisibility : public ::testing::TestWithParam<SweepTest> {
 protected:
  void TearDown() override { context_.check_errors("sweep visibility test"); }

  projtex::GridCamera camera(const BitVolume& bits) {
    const glm::dvec3 eye(test::uniform(rng_, -30, 54), test::uniform(rng_, -30, 54),
                         test::uniform(rng_, -60, -20));
    return projtex::to_grid(test::look_at(eye, {12, 12, 10}, 90, 96, 80), bits.grid);
  }

  gpu::Context& context_ = test::gl_context();
  test::Rng rng_{17};
};

TEST_P(SweepVisibility, SharesOfTheViewsAreTheReferences) {
  const BitVolume bits = middle_brick();
  const double bias = 1.4;
  double all = 0, seen = 0;
  int compared = 0, different = 0;
  for (int trial = 0; trial < 6; ++trial) {
    const std::vector<projtex::GridCamera> cameras{camera(bits), camera(bits)};
    SweepKernels kernels(context_, bits, {2, 1, ivec3(kVoxels)}, cameras,
                         visibility::sweep_test_defines(GetParam()));
    kernels.parameters.thresholds.w = float(bias);
    kernels.select(kLayer);
    std::vector<glm::ivec4> list{{0, 0, 0, 0}};
    std::set<std::array<int, 3>> voxels;
    for (int i = 0; i < 150; ++i) {
      const ivec3 v(test::uniform_in(rng_, {{0, 0, 0}, {kVoxels, kVoxels, kLayer + 2}}));
      list.emplace_back(v, 0);
      voxels.insert({v.x, v.y, v.z});
    }
    list[0].x = int(list.size()) - 1;
    const gpu::Buffer list_buffer = gpu::Buffer::of(list);
    kernels.views().bind_storage(shaders::kViewsBinding);
    kernels.depth_maps().splat(context_, list_buffer, list.size() - 1);
    kernels.mark(list_buffer, list.size() - 1);
    const auto scores = kernels.score(
        std::vector<glm::vec4>(kernels.sample_count(), glm::vec4(0.5f, 0.5f, 0.5f, 1)));
    std::vector<std::vector<double>> depths;
    for (std::size_t i = 0; i < 2; ++i) {
      const std::vector<float> map = kernels.depth_maps().download(i);
      depths.emplace_back(map.begin(), map.end());
    }
    for (int i = 0; i < 64; ++i) {
      double expected = 0;
      for (std::size_t v = 0; v < 2; ++v)
        expected += visibility::reference::sweep_visible(
            GetParam(), cameras[v], 2, {8 + i % 8, 8 + i / 8, kLayer}, bias,
            {kernels.depth_maps().infos()[v], depths[v],
             [&](const ivec3& c) {
               return voxels.contains({c.x, c.y, c.z});
             },
             ivec3(kVoxels)});
      all += 2, seen += expected, ++compared;
      different += std::abs(scores[std::size_t(i)].w - expected) > 1e-4;
    }
  }
  EXPECT_EQ(compared, 6 * 64);
  // Single precision decides otherwise at a texel's edge, a voxel's, or the bias.
  EXPECT_LE(different, compared / 50);
  EXPECT_GT(seen, 0.1 * all);
  EXPECT_LT(seen, 0.9 * all);
}

TEST_P(SweepVisibility, NothingPassedHidesNothing) {
  const BitVolume bits = middle_brick();
  SweepKernels kernels(context_, bits, {2, 1, ivec3(kVoxels)}, {camera(bits), camera(bits)},
                       visibility::sweep_test_defines(GetParam()));
  kernels.select(kLayer);
  for (const glm::vec4& score : kernels.score(
           std::vector<glm::vec4>(kernels.sample_count(), glm::vec4(0.5f, 0.5f, 0.5f, 1))))
    EXPECT_EQ(score.w, 2);
}

TEST(SweepTests, NamesAreReadBack) {
  for (const SweepTest test : visibility::kSweepTests)
    EXPECT_EQ(parse_name("--visibility", visibility::to_string(test), visibility::kSweepTests),
              test);
  EXPECT_THROW(parse_name("--visibility", "none", visibility::kSweepTests), UsageError);
}

INSTANTIATE_TEST_SUITE_P(All, SweepVisibility, ::testing::ValuesIn(visibility::kSweepTests),
                         [](const auto& one) {
                           std::string name = visibility::to_string(one.param);
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace photohull::carving
