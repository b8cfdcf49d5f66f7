#include "io/spread_views.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "io/load_scene.h"
#include "io/write_scene.h"
#include "scene_fixture.h"
#include "support/cameras.h"

namespace photohull::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

const Box kBox{{-1, -1, -1}, {1, 1, 1}};

std::vector<SourceView> views_of(const std::vector<Camera>& cameras) {
  std::vector<SourceView> views;
  for (const Camera& camera : cameras) {
    views.emplace_back();
    views.back().name = concat("v", views.size(), ".png");
    views.back().camera = camera;
  }
  return views;
}

/// A turn around the object of which half the frames are taken within a tenth of the way.
std::vector<SourceView> uneven_turn(int count) {
  std::vector<Camera> cameras;
  for (int i = 0; i < count; ++i) {
    const double share = 2 * i < count ? 0.1 * 2 * i / count : 0.1 + 0.9 * (2.0 * i / count - 1);
    const double angle = 2 * std::numbers::pi * share;
    cameras.push_back(
        test::look_at({4 * std::cos(angle), 4 * std::sin(angle), 1}, {0, 0, 0}, 40, 32, 24));
  }
  return views_of(cameras);
}

/// Degrees between neighbours seen from the middle, greatest.
double widest_gap(const std::vector<SourceView>& views, const std::vector<std::size_t>& chosen) {
  std::vector<double> angles;
  for (const std::size_t i : chosen) {
    const glm::dvec3 c = views[i].camera.center();
    angles.push_back(std::atan2(c.y, c.x) * 180 / std::numbers::pi);
  }
  std::sort(angles.begin(), angles.end());
  double gap = angles.front() + 360 - angles.back();
  for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
  return gap;
}

TEST(ParseSpread, TakesNumbersFromTwo) {
  EXPECT_EQ(parse_spread("spread:40"), 40u);
  EXPECT_EQ(parse_spread("spread"), std::nullopt);
  EXPECT_EQ(parse_spread("0-7"), std::nullopt);
  for (const char* bad : {"spread:", "spread:1", "spread:-3", "spread:many", "spread:4,5"})
    EXPECT_THROW(parse_spread(bad), UsageError) << bad;
}

TEST(SpreadViews, ATurnIsCoveredEvenly) {
  const auto views = uneven_turn(400);
  const auto chosen = spread_views(views, kBox, 16);
  ASSERT_EQ(chosen.size(), 16u);
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  EXPECT_EQ(std::adjacent_find(chosen.begin(), chosen.end()), chosen.end());
  // 16 even steps are 22.5 degrees; farthest points leave at most twice that.
  EXPECT_LT(widest_gap(views, chosen), 45.1);
  std::vector<std::size_t> each_25th;
  for (std::size_t i = 0; i < 400; i += 25) each_25th.push_back(i);
  EXPECT_LT(widest_gap(views, chosen), widest_gap(views, each_25th));
  // The same without a box: the axes meet in the middle.
  EXPECT_LT(widest_gap(views, spread_views(views, std::nullopt, 16)), 45.1);
}

TEST(SpreadViews, DistancesCountToo) {
  std::vector<Camera> cameras;
  for (int i = 0; i < 60; ++i)  // 59 beside each other, and one from near
    cameras.push_back(
        test::look_at({i == 33 ? 2.0 : 8.0, 0.02 * i, 0}, {0, 0.02 * i, 0}, 40, 32, 24));
  EXPECT_THAT(spread_views(views_of(cameras), kBox, 3), testing::Contains(33u));
}

TEST(SpreadViews, DirectionsOfSightCountWhereTheyTurnOnTheSpot) {
  std::vector<Camera> cameras;
  for (int i = 0; i < 36; ++i) {
    const double angle = std::numbers::pi * i / 18;
    const glm::dvec3 eye(3, 2, 1);
    cameras.push_back(
        test::look_at(eye, eye + glm::dvec3(std::cos(angle), std::sin(angle), 0), 40, 32, 24));
  }
  const auto views = views_of(cameras);
  std::vector<double> angles;
  for (const std::size_t i : spread_views(views, std::nullopt, 6))
    angles.push_back(10.0 * double(i));
  for (std::size_t i = 1; i < angles.size(); ++i) EXPECT_GE(angles[i] - angles[i - 1], 20);
  EXPECT_GT(angles.back() - angles.front(), 200);
}

TEST(SpreadViews, ParallelAxesHaveAMiddle) {
  std::vector<Camera> cameras;
  for (int i = 0; i < 50; ++i)
    cameras.push_back(test::look_at({0.1 * i, -5, 0}, {0.1 * i, 0, 0}, 40, 32, 24));
  const auto chosen = spread_views(views_of(cameras), std::nullopt, 5);
  EXPECT_EQ(chosen.front(), 0u);
  EXPECT_EQ(chosen.back(), 49u);
  for (std::size_t i = 1; i < chosen.size(); ++i) EXPECT_GE(chosen[i] - chosen[i - 1], 5u);
}

TEST(SpreadViews, ViewsThatLookAwayComeLast) {
  std::vector<Camera> cameras;
  for (int i = 0; i < 20; ++i) {
    const double angle = 2 * std::numbers::pi * i / 20;
    const glm::dvec3 eye(4 * std::cos(angle), 4 * std::sin(angle), 0);
    cameras.push_back(test::look_at(eye, i % 4 == 0 ? 2.0 * eye : glm::dvec3(0), 40, 32, 24));
  }
  const auto views = views_of(cameras);
  for (const std::size_t i : spread_views(views, kBox, 15)) EXPECT_NE(i % 4, 0u);
  EXPECT_EQ(spread_views(views, kBox, 18).size(), 18u);
  EXPECT_EQ(spread_views(views, kBox, 99).size(), 20u);
}

TEST(SpreadViews, TheOrderOfTheViewsDoesNotMatter) {
  auto views = uneven_turn(90);
  const auto names = [&] {
    std::vector<std::string> list;
    for (const std::size_t i : spread_views(views, std::nullopt, 12)) list.push_back(views[i].name);
    std::sort(list.begin(), list.end());
    return list;
  };
  const auto before = names();
  std::mt19937 generator(7);
  std::shuffle(views.begin(), views.end(), generator);
  EXPECT_EQ(names(), before);
}

/// A video's frames, all links to one tiny file.
class ManyViews : public TemporaryFolder {
 protected:
  ManyViews() {
    Scene scene;
    scene.box = kBox;
    const fs::path first = put_image("images/v1.png", 32, 24);
    scene.views = uneven_turn(2000);
    for (SourceView& view : scene.views) {
      view.image = folder_ / "images" / view.name;
      if (view.image != first) fs::create_hard_link(first, view.image);
    }
    write_transforms(scene, folder_);
  }
};

TEST_F(ManyViews, AVideoIsThinnedOutUnlessToldOtherwise) {
  LoadSceneOptions options;
  EXPECT_EQ(load_scene(folder_, options).views.size(), 2000u);  // the library takes all
  options.most_views = 40;
  const Scene scene = load_scene(folder_, options);
  EXPECT_EQ(scene.views.size(), 40u);
  EXPECT_EQ(scene.passed_over, 1960);
  EXPECT_EQ(scene.listed.size(), 2000u);
  EXPECT_THAT(scene.warnings, testing::ElementsAre(HasSubstr("40 of 2000 photographs are used")));
  EXPECT_THAT(scene.left_out, IsEmpty());
  std::vector<std::size_t> all(40);
  std::iota(all.begin(), all.end(), std::size_t(0));
  EXPECT_LT(widest_gap(scene.views, all), 18.1);
  options.views = "all";
  EXPECT_EQ(load_scene(folder_, options).views.size(), 2000u);
  options.views = "0-99";
  EXPECT_EQ(load_scene(folder_, options).views.size(), 100u);
  options.views = "spread:60";
  EXPECT_EQ(load_scene(folder_, options).views.size(), 60u);
  options.hold_out = "0-999";
  for (const SourceView& view : load_scene(folder_, options).views)
    EXPECT_GT(std::stoi(view.name.substr(1)), 1000);
  options.views = "spread:x";
  EXPECT_THROW(load_scene(folder_, options), UsageError);
}

/// Those that are missing are left out first: the others fill up the number.
TEST_F(ManyViews, MissingFramesAreReplaced) {
  for (int i = 500; i < 1000; ++i) fs::remove(folder_ / concat("images/v", i, ".png"));
  LoadSceneOptions options;
  options.views = "spread:50";
  const Scene scene = load_scene(folder_, options);
  EXPECT_EQ(scene.views.size(), 50u);
  EXPECT_EQ(scene.left_out.size(), 500u);
  EXPECT_EQ(scene.passed_over, 1450);
}

}  // namespace
}  // namespace photohull::io
