#include "pipeline/view_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace photohull::pipeline {
namespace {

SourceView view(const std::string& name) {
  SourceView result;
  result.name = name;
  return result;
}

TEST(ViewOrder, IsThatOfNamesWithNumbersAndTracksFollow) {
  Scene scene;
  for (const char* name : {"v10.png", "v2.png", "a.png"}) scene.views.push_back(view(name));
  scene.tracks.push_back({{{0, {10, 10}}, {1, {2, 2}}, {2, {1, 1}}}});
  sort_views_by_name(scene);
  std::vector<std::string> names;
  for (const SourceView& v : scene.views) names.push_back(v.name);
  EXPECT_THAT(names, testing::ElementsAre("a.png", "v2.png", "v10.png"));
  const auto& seen = scene.tracks[0].observations;
  ASSERT_EQ(seen.size(), 3u);
  const double pixels[] = {1, 2, 10};  // of a, v2 and v10
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(seen[std::size_t(i)].view, i);
    EXPECT_EQ(seen[std::size_t(i)].pixel.x, pixels[i]);
  }
}

}  // namespace
}  // namespace photohull::pipeline
