// apply_decisions on hand-made outcomes of a sweep.
#include "carving/decisions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace photohull::carving {
namespace {

using glm::ivec2;
using glm::ivec3;

constexpr int kColumns = 16, kLayers = 24, kBare = 4;

/// Solid behind layer kBare of a sweep along `axis`.
BitVolume solid(int axis = 2, int sign = 1) {
  BitVolume bits;
  glm::ivec3 bricks(kColumns / kBrickEdge);
  bricks[axis] = kLayers / kBrickEdge;
  bits.grid = {{0, 0, 0}, 1, bricks};
  for (int z = 0; z < bricks.z; ++z)
    for (int y = 0; y < bricks.y; ++y)
      for (int x = 0; x < bricks.x; ++x) {
        bits.table.push_back(std::uint32_t(bits.bricks.size()));
        bits.bricks.push_back({x, y, z});
      }
  bits.words.assign(bits.bricks.size() * BitVolume::kWords, ~0u);
  for (int layer = 0; layer < kBare; ++layer)
    for (int u = 0; u < kColumns; ++u)
      for (int v = 0; v < kColumns; ++v) {
        ivec3 voxel;
        voxel[(axis + 1) % 3] = u;
        voxel[(axis + 2) % 3] = v;
        voxel[axis] = sign > 0 ? layer : kLayers - 1 - layer;
        bits.clear(voxel);
      }
  return bits;
}

Decision kept(int u, int v, int layer = kBare) {
  return {{u, v}, layer, layer, 0.9f, 0.9f, Outcome::kKept};
}
Decision better(int u, int v, int surface) {
  return {{u, v}, kBare, surface, 0.1f, 0.9f, Outcome::kBetter};
}
Decision undecided(int u, int v) { return {{u, v}, kBare, kBare, 0.1f, 0.2f, Outcome::kUndecided}; }
Decision unseen(int u, int v) { return {{u, v}, kBare, kBare, 0, 0, Outcome::kUnseen}; }

/// One decision for every column.
template <typename F>
std::vector<Decision> plane(F&& decide) {
  std::vector<Decision> out;
  for (int v = 0; v < kColumns; ++v)
    for (int u = 0; u < kColumns; ++u) out.push_back(decide(u, v));
  return out;
}

/// Layers of a column that stand no more (sweep along z).
int carved_layers(const BitVolume& bits, const ivec2& column) {
  int count = 0;
  for (int layer = kBare; layer < kLayers; ++layer)
    count += !bits.standing({column.x, column.y, layer});
  return count;
}

const ivec2 kMiddle(8, 8);

TEST(ApplyDecisions, AFlatSurfaceBehindIsLaidBare) {
  BitVolume bits = solid();
  const auto carved =
      apply_decisions(bits, 2, 1, plane([](int u, int v) { return better(u, v, 10); }));
  EXPECT_EQ(carved.size(), std::size_t(kColumns * kColumns * 6));
  for (int v = 0; v < kColumns; ++v)
    for (int u = 0; u < kColumns; ++u)
      for (int layer = kBare; layer < kLayers; ++layer)
        EXPECT_EQ(bits.standing({u, v, layer}), layer >= 10);
}

TEST(ApplyDecisions, ReturnsExactlyWhatItCleared) {
  const BitVolume before = solid();
  BitVolume bits = before;
  const auto carved =
      apply_decisions(bits, 2, 1, plane([](int u, int v) { return better(u, v, 8 + u / 3); }));
  BitVolume replayed = before;
  for (const ivec3& voxel : carved) {
    EXPECT_TRUE(replayed.standing(voxel));
    replayed.clear(voxel);
  }
  EXPECT_EQ(replayed.words, bits.words);
}

TEST(ApplyDecisions, WorksAlongEveryAxisBothWays) {
  for (int axis = 0; axis < 3; ++axis)
    for (const int sign : {1, -1}) {
      BitVolume bits = solid(axis, sign);
      apply_decisions(bits, axis, sign, plane([](int u, int v) { return better(u, v, 9); }));
      ivec3 voxel(5, 6, 7);
      for (int layer = 0; layer < kLayers; ++layer) {
        voxel[axis] = sign > 0 ? layer : kLayers - 1 - layer;
        EXPECT_EQ(bits.standing(voxel), layer >= 9) << axis << ", " << sign;
      }
    }
}

TEST(ApplyDecisions, ALoneDeepDecisionIsNotCarved) {
  BitVolume bits = solid();
  const auto carved = apply_decisions(
      bits, 2, 1,
      plane([](int u, int v) { return ivec2(u, v) == kMiddle ? better(u, v, 20) : kept(u, v); }));
  EXPECT_TRUE(carved.empty());
}

TEST(ApplyDecisions, ALoneDeepDecisionAmongUndecidedOnesIsNotCarved) {
  BitVolume bits = solid();
  const auto carved =
      apply_decisions(bits, 2, 1, plane([](int u, int v) {
                        return ivec2(u, v) == kMiddle ? better(u, v, 20) : undecided(u, v);
                      }));
  EXPECT_TRUE(carved.empty());
}

TEST(ApplyDecisions, AnIsolatedSpikeIsOverruled) {
  for (const auto& spike : {undecided(8, 8), kept(8, 8), better(8, 8, 22)}) {
    BitVolume bits = solid();
    apply_decisions(bits, 2, 1, plane([&](int u, int v) {
                      return ivec2(u, v) == kMiddle ? spike : better(u, v, 10);
                    }));
    EXPECT_EQ(carved_layers(bits, kMiddle), 10 - kBare) << int(spike.outcome);
  }
}

TEST(ApplyDecisions, ScatteredChanceLayersAreNoSurface) {
  std::mt19937 rng(1);
  BitVolume bits = solid();
  const auto carved =
      apply_decisions(bits, 2, 1, plane([&](int u, int v) {
                        return rng() % 4 ? undecided(u, v) : better(u, v, int(5 + rng() % 17));
                      }));
  EXPECT_TRUE(carved.empty());
}

TEST(ApplyDecisions, SlopesAreFollowed) {
  BitVolume bits = solid();
  apply_decisions(bits, 2, 1, plane([](int u, int v) { return better(u, v, 7 + u); }));
  for (int u = 2; u < kColumns - 2; ++u)
    EXPECT_NEAR(carved_layers(bits, {u, 8}), 7 + u - kBare, 1) << u;
}

TEST(ApplyDecisions, OneLayerOfNoiseIsSmoothed) {
  std::mt19937 rng(2);
  BitVolume bits = solid();
  apply_decisions(bits, 2, 1,
                  plane([&](int u, int v) { return better(u, v, 10 + int(rng() % 3) - 1); }));
  for (int v = 2; v < kColumns - 2; ++v)
    for (int u = 2; u < kColumns - 2; ++u) EXPECT_NEAR(carved_layers(bits, {u, v}), 10 - kBare, 1);
}

TEST(ApplyDecisions, WhatIsConsistentOrUnseenStays) {
  BitVolume bits = solid();
  // Half of the plane is consistent where it is bare, a quarter was not seen.
  const auto carved =
      apply_decisions(bits, 2, 1, plane([](int u, int v) {
                        return u < 8 ? kept(u, v) : v < 8 ? unseen(u, v) : better(u, v, 12);
                      }));
  for (const ivec3& voxel : carved) {
    EXPECT_GE(voxel.x, 8);
    EXPECT_GE(voxel.y, 8);
  }
  EXPECT_EQ(carved_layers(bits, {12, 12}), 12 - kBare);
  EXPECT_FALSE(carved.empty());
}

TEST(ApplyDecisions, ColumnsWithTwoSurfacesKeepThemApart) {
  // A second surface further back, consistent where it is bare.
  BitVolume bits = solid();
  for (int v = 0; v < kColumns; ++v)
    for (int u = 0; u < kColumns; ++u) bits.clear({u, v, 15});
  std::vector<Decision> decisions = plane([](int u, int v) { return better(u, v, 8); });
  const auto behind = plane([](int u, int v) { return kept(u, v, 16); });
  decisions.insert(decisions.end(), behind.begin(), behind.end());
  const auto carved = apply_decisions(bits, 2, 1, decisions);
  EXPECT_EQ(carved.size(), std::size_t(kColumns * kColumns * (8 - kBare)));
  for (const ivec3& voxel : carved) EXPECT_LT(voxel.z, 8);
}

TEST(ApplyDecisions, TheOrderOfDecisionsDoesNotMatter) {
  std::mt19937 rng(3);
  std::vector<Decision> decisions = plane([&](int u, int v) {
    switch (rng() % 5) {
      case 0:
        return kept(u, v);
      case 1:
        return undecided(u, v);
      case 2:
        return unseen(u, v);
      default:
        return better(u, v, 8 + int(rng() % 4));
    }
  });
  BitVolume first = solid();
  const auto carved = apply_decisions(first, 2, 1, decisions);
  EXPECT_FALSE(carved.empty());
  for (int i = 0; i < 5; ++i) {
    std::shuffle(decisions.begin(), decisions.end(), rng);
    BitVolume bits = solid();
    EXPECT_EQ(apply_decisions(bits, 2, 1, decisions), carved);
    EXPECT_EQ(bits.words, first.words);
  }
}

TEST(ApplyDecisions, NoDecisionsCarveNothing) {
  BitVolume bits = solid();
  EXPECT_TRUE(apply_decisions(bits, 2, 1, {}).empty());
  EXPECT_EQ(bits.words, solid().words);
}

}  // namespace
}  // namespace photohull::carving
