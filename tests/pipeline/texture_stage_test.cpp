#include "pipeline/texture_stage.h"

#include <gtest/gtest.h>

#include "support/cameras.h"

namespace photohull::pipeline {
namespace {

/// Views from all around the z axis, whose images point down along `down`.
std::vector<PreparedView> ring(const glm::dvec3& down) {
  std::vector<PreparedView> views;
  for (int i = 0; i < 8; ++i) {
    PreparedView view;
    view.camera =
        test::look_at({5 * std::cos(i), 5 * std::sin(i), 2}, {0, 0, 0}, 100, 64, 64, down);
    views.push_back(view);
  }
  return views;
}

TEST(UpwardAxis, IsWhereImagesPointUp) {
  EXPECT_EQ(upward_axis(ring({0, 0, -1})), glm::dvec3(0, 0, 1));
  EXPECT_EQ(upward_axis(ring({0, 0, 1})), glm::dvec3(0, 0, -1));
  PreparedView usual;  // the world is the first camera's frame, whose y axis points down
  EXPECT_EQ(upward_axis(std::vector{usual}), glm::dvec3(0, -1, 0));
}

TEST(UpwardAxis, IsZWherePhotographsAreTurnedAnyhow) {
  std::vector<PreparedView> views = ring({0, 0, -1});
  for (const PreparedView& view : ring({0, 0, 1})) views.push_back(view);
  EXPECT_EQ(upward_axis(views), glm::dvec3(0, 0, 1));
}

TEST(MakesTexture, WhereAFileHoldsOne) {
  ReconstructOptions options;
  EXPECT_FALSE(makes_texture(options));
  options.exports = {"stl"};
  EXPECT_FALSE(makes_texture(options));
  options.exports = {"stl", "glb"};
  EXPECT_TRUE(makes_texture(options));
  options.texture.off = true;
  EXPECT_FALSE(makes_texture(options));
}

}  // namespace
}  // namespace photohull::pipeline
