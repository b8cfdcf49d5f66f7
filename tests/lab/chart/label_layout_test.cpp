#include "lab/chart/label_layout.h"

#include <gtest/gtest.h>

#include <random>

namespace photohull::chart {
namespace {

Rect box(const glm::dvec2& centre, const glm::dvec2& size) {
  return {centre.x - size.x / 2, centre.y - size.y / 2, centre.x + size.x / 2,
          centre.y + size.y / 2};
}

TEST(PlaceLabels, NoneCoversAnotherOrAMarker) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(0, 400);
  const Rect area{0, 0, 400, 400};
  std::vector<LabelRequest> requests;
  for (int i = 0; i < 30; ++i) requests.push_back({{at(random), at(random)}, {70, 14}});
  const auto places = place_labels(requests, area, 11);
  ASSERT_EQ(places.size(), requests.size());
  int placed = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!places[i]) continue;
    ++placed;
    const Rect label = box(*places[i], requests[i].size);
    EXPECT_TRUE(area.holds(label)) << i;
    for (std::size_t k = 0; k < places.size(); ++k) {
      EXPECT_FALSE(label.overlaps(box(requests[k].anchor, {11, 11}))) << i << " on marker " << k;
      if (k == i || !places[k]) continue;
      EXPECT_FALSE(label.overlaps(box(*places[k], requests[k].size))) << i << " on label " << k;
    }
  }
  EXPECT_GT(placed, 20);
}

TEST(PlaceLabels, PrefersTheRightSide) {
  const auto places = place_labels({{{50, 50}, {40, 14}}}, {0, 0, 200, 100}, 10);
  ASSERT_TRUE(places[0]);
  EXPECT_GT(places[0]->x, 50 + 20);
  EXPECT_EQ(places[0]->y, 50);
}

TEST(PlaceLabels, LeavesOutWhatHasNoRoom) {
  const auto places = place_labels({{{10, 10}, {400, 14}}}, {0, 0, 200, 100}, 10);
  EXPECT_FALSE(places[0]);
}

TEST(TextSize, CountsCharactersAndNotBytes) {
  EXPECT_EQ(text_size("∝", 10).x, text_size("x", 10).x);
  EXPECT_EQ(text_size("xx", 10).x, 2 * text_size("x", 10).x);
}

}  // namespace
}  // namespace photohull::chart
