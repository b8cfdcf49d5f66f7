#include "carving/search_disc.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "carving/photo.h"
#include "carving/photo_reference.h"
#include "core/error.h"
#include "support/cameras.h"

namespace photohull::carving {
namespace {

TEST(SearchDisc, NoRadiusIsTheProjectionAndNoDefines) {
  const auto offsets = search_disc(0);
  ASSERT_EQ(offsets.size(), 1u);
  EXPECT_EQ(offsets[0], glm::dvec2(0));
  EXPECT_EQ(search_defines(offsets), "");
}

TEST(SearchDisc, EveryPlaceInTheDiscIsNearAnOffset) {
  // Half the diagonal of a cell: rings are at most a pixel apart, offsets on a ring pi / 3 along
  // it.
  const double farthest = std::hypot(0.5, std::numbers::pi / 6);
  test::Rng rng(5);
  for (const double radius : {0.3, 0.5, 1.0, 1.7, 2.0, 4.0}) {
    const auto offsets = search_disc(radius);
    EXPECT_EQ(offsets[0], glm::dvec2(0));
    for (std::size_t i = 1; i < offsets.size(); ++i) {
      EXPECT_LE(glm::length(offsets[i]), radius + 1e-9);
      EXPECT_GE(glm::length(offsets[i]), glm::length(offsets[i - 1]) - 1e-9);
    }
    for (int i = 0; i < 200; ++i) {
      const glm::dvec2 place(test::uniform(rng, -radius, radius),
                             test::uniform(rng, -radius, radius));
      if (glm::length(place) > radius) continue;
      double nearest = 1e9;
      for (const glm::dvec2& o : offsets) nearest = std::min(nearest, glm::length(place - o));
      EXPECT_LE(nearest, farthest);
    }
  }
}

TEST(SearchDisc, RadiusIsChecked) {
  PhotoOptions options;
  for (const double radius : {-1.0, 4.5, double(NAN)}) {
    options.search_radius = radius;
    EXPECT_THROW(options.validate(), UsageError) << radius;
  }
}

// Views that show one pattern, each moved by a shift of its own, are brought together.
TEST(SearchDisc, ReferenceFindsTheShiftsOfOnePattern) {
  test::Rng rng(7);
  const auto random_patch = [&] {
    reference::ShownPatch patch;
    for (glm::dvec4& tap : patch)
      tap = {test::uniform(rng, 0, 1), test::uniform(rng, 0, 1), test::uniform(rng, 0, 1), 1};
    return patch;
  };
  for (int trial = 0; trial < 20; ++trial) {
    const reference::ShownPatch pattern = random_patch();
    std::vector<std::vector<reference::ShownPatch>> views(5);
    std::vector<int> truth;
    for (int v = 0; v < 5; ++v) {
      for (int shift = 0; shift < 7; ++shift) views[v].push_back(random_patch());
      // Two views show it where they should: where none does, any shift is as good as another.
      truth.push_back(v < 2 ? 0 : int(test::uniform(rng, 0, 7)));
      views[v][truth[v]] = pattern;
    }
    EXPECT_EQ(reference::choose_shifts(views, 1e-4, false).shifts, truth);
  }
}

TEST(SearchDisc, ReferenceLeavesOutWhatNoShiftShows) {
  reference::ShownPatch shown, hidden;
  for (std::size_t k = 0; k < shown.size(); ++k)
    shown[k] = {0.1 * double(k % 7), 0.5, 0.2, 1}, hidden[k] = {0, 0, 0, -1};
  const auto found =
      reference::choose_shifts({{shown, shown}, {hidden, shown}, {hidden, hidden}}, 1e-4, false);
  EXPECT_EQ(found.shifts, (std::vector<int>{0, 1, -1}));
}

}  // namespace
}  // namespace photohull::carving
