// Which surfels are matched together where the device does not hold all photographs.
#include "refine/view_groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace photohull::refine {
namespace {

constexpr int kViews = 30;

/// Surfels around a ring of cameras, each with views near its reference; some have none.
std::vector<ViewChoice> ring(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<ViewChoice> out(count);
  for (ViewChoice& choice : out) {
    if (random() % 7 == 0) continue;
    const int reference = int(random() % kViews), others = 1 + int(random() % 5);
    choice.views.push_back(reference);
    for (int k = 1; k <= others; ++k)
      choice.views.push_back((reference + (k % 2 ? k : kViews - k)) % kViews);
  }
  return out;
}

/// Every comparable surfel is in one group, which has its views, and not too many.
void check(const std::vector<ViewGroup>& groups, const std::vector<ViewChoice>& choices, int most) {
  std::vector<int> times(choices.size(), 0);
  for (const ViewGroup& group : groups) {
    EXPECT_LE(int(group.views.size()), most);
    EXPECT_TRUE(std::ranges::is_sorted(group.views));
    EXPECT_TRUE(std::ranges::is_sorted(group.surfels));
    const std::set<int> views(group.views.begin(), group.views.end());
    EXPECT_EQ(views.size(), group.views.size());
    std::set<int> used;
    for (const std::uint32_t i : group.surfels) {
      ++times[i];
      for (const int view : choices[i].views) {
        EXPECT_TRUE(views.contains(view));
        used.insert(view);
      }
    }
    EXPECT_EQ(used, views) << "no photograph is held for nothing";
  }
  for (std::size_t i = 0; i < choices.size(); ++i)
    EXPECT_EQ(times[i], choices[i].comparable() ? 1 : 0) << i;
}

TEST(ViewGroups, AllViewsThatFitAreOneGroup) {
  const std::vector<ViewChoice> choices = ring(500, 1);
  const std::vector<ViewGroup> groups = group_by_views(choices, kViews, kViews);
  EXPECT_EQ(groups.size(), 1u);
  check(groups, choices, kViews);
}

TEST(ViewGroups, HoldEverySurfelOnceAndNotTooManyViews) {
  for (const int most : {6, 7, 9, 12, 20, 29})
    for (const std::uint32_t seed : {2u, 3u}) {
      const std::vector<ViewChoice> choices = ring(800, seed);
      check(group_by_views(choices, kViews, most), choices, most);
    }
}

TEST(ViewGroups, NeighboursStayTogether) {
  // References reach over ten views, so that 20 neighbours serve eleven of them: three groups.
  const std::vector<ViewGroup> groups = group_by_views(ring(5000, 4), kViews, 20);
  std::size_t loaded = 0;
  for (const ViewGroup& group : groups) loaded += group.views.size();
  EXPECT_LE(loaded, 2.2 * kViews);
}

TEST(ViewGroups, SurfelsInAnyOrderAreFewPieces) {
  // Two kinds of surfels of one reference, which do not fit together, by turns.
  std::vector<ViewChoice> choices(1000);
  for (std::size_t i = 0; i < choices.size(); ++i)
    for (int k = 0; k < 6; ++k) choices[i].views.push_back(k == 0 ? 9 : k + (i % 2 ? 9 : 19));
  const std::vector<ViewGroup> groups = group_by_views(choices, kViews, 8);
  EXPECT_EQ(groups.size(), 2u);
  check(groups, choices, 8);
}

TEST(ViewGroups, NothingToMatchIsNoGroup) {
  EXPECT_TRUE(group_by_views(std::vector<ViewChoice>(10), kViews, 6).empty());
  EXPECT_TRUE(group_by_views({}, kViews, 6).empty());
}

TEST(ViewGroups, ASurfelOfMoreViewsThanFitIsAMistake) {
  EXPECT_DEATH(group_by_views(ring(10, 5), kViews, ViewChoice::kMostViews - 1), "");
}

}  // namespace
}  // namespace photohull::refine
