// Where maps' texels lie: warps, partitions, and their falling back.
#include "visibility/layout.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/cameras.h"

namespace photohull::visibility {
namespace {

const Box kFloor{{-10, -10, 0}, {10, 10, 1}};

struct Place {
  glm::dvec2 at;
  double w, z;
};

Place locate(const PartLayout& part, const glm::dvec3& p) {
  const glm::dvec4 h(p, 1);
  const double w = glm::dot(part.row_w, h);
  return {glm::dvec2(glm::dot(part.row_x, h), glm::dot(part.row_y, h)) / w, w,
          glm::dot(part.row_z, h)};
}

Technique warp(Warp kind, int partitions = 1) {
  Technique t;
  t.resolution = 512;
  t.warp = kind;
  t.partitions = partitions;
  return t;
}

class MapLayouts : public ::testing::Test {
 protected:
  MapLayout lay(const Technique& t, const Camera& eye) const {
    return lay_out(light_, kFloor, {0, 0, 0}, t, eye);
  }
  const PartLayout& part_for(const MapLayout& layout, const glm::dvec3& p) const {
    const double depth = glm::dot(layout.eye_row, glm::dvec4(p, 1));
    std::size_t i = 0;
    while (i + 1 < layout.parts.size() && depth > layout.parts[i].end) ++i;
    return layout.parts[i];
  }
  /// Texels a unit along the map around a point of the floor, in the direction where they are
  /// fewest.
  double density(const MapLayout& layout, const glm::dvec3& p) const {
    const PartLayout& part = part_for(layout, p);
    const double step = 1e-4;
    const glm::dvec2 o = locate(part, p).at;
    return std::min(glm::length(locate(part, p + glm::dvec3(step, 0, 0)).at - o),
                    glm::length(locate(part, p + glm::dvec3(0, step, 0)).at - o)) /
           step;
  }

  Camera light_ = test::look_at({0, 0, 25}, {0, 0, 0}, 300, 400, 400, {0, -1, 0});
  // Low over the floor, looking along it; the light's rays come at right angles.
  Camera across_ = test::look_at({-10, 0, 2}, {0, 0, 1.2}, 300, 400, 300);
  // From beside the light.
  Camera beside_ = test::look_at({0, 0.5, 24}, {0, 0.5, 0}, 300, 400, 300, {0, -1, 0});
};

TEST_F(MapLayouts, TheRegionLiesOnTheMapAndDepthIsNotWarped) {
  test::Rng rng(3);
  for (const Warp kind : {Warp::kFit, Warp::kLispsm, Warp::kGeneralLispsm})
    for (int partitions = 1; partitions <= 4; ++partitions) {
      const MapLayout layout = lay(warp(kind, partitions), across_);
      ASSERT_EQ(int(layout.parts.size()), partitions);
      int tried = 0;
      for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 p = test::uniform_in(rng, kFloor);
        const auto eye = across_.project(p), on_light = light_.project(p);
        if (!eye || !across_.on_image(*eye) || !light_.on_image(*on_light)) continue;
        ++tried;
        const PartLayout& part = part_for(layout, p);
        const Place place = locate(part, p);
        EXPECT_GT(place.w, part.nearest_w);
        EXPECT_GE(std::min(place.at.x, place.at.y), 0) << int(kind) << " " << partitions;
        EXPECT_LE(place.at.x, layout.size.x);
        EXPECT_LE(place.at.y, layout.size.y);
        EXPECT_NEAR(place.z, light_.to_camera(p).z, 1e-9);
        EXPECT_NEAR(place.z, place.w * glm::dot(part.depth_of_w, glm::dvec3(place.at, 1)), 1e-6);
      }
      EXPECT_GT(tried, 200);
    }
}

TEST_F(MapLayouts, AWarpGivesNearReceiversMoreTexels) {
  const glm::dvec3 near(-7, 0, 0), far(9, 0, 0);
  const MapLayout plain = lay(warp(Warp::kNone), across_), fit = lay(warp(Warp::kFit), across_);
  EXPECT_NEAR(density(plain, near), density(plain, far), 1e-3);
  for (const Warp kind : {Warp::kLispsm, Warp::kGeneralLispsm}) {
    const MapLayout layout = lay(warp(kind), across_);
    EXPECT_TRUE(layout.warped);
    EXPECT_GT(density(layout, near), 1.5 * density(fit, near));
    EXPECT_GT(density(layout, near), 2 * density(layout, far));
  }
  // Partitions share one map's texels and still have more near by.
  const MapLayout two = lay(warp(Warp::kGeneralLispsm, 2), across_);
  EXPECT_LT(two.size.x, 512);
  EXPECT_GT(density(two, near), density(fit, near));
}

TEST_F(MapLayouts, ParallelDirectionsFallBackToNoWarp) {
  Camera same = light_;
  same.intrinsics.fx = same.intrinsics.fy = 900;
  for (const Warp kind : {Warp::kLispsm, Warp::kGeneralLispsm}) {
    const MapLayout layout = lay(warp(kind), same);
    EXPECT_FALSE(layout.warped);
    EXPECT_NEAR(density(layout, {0.5, 0, 0}), density(layout, {-0.5, 0, 0}), 1e-6);
  }
  // Nearly parallel: the general form fades, and never opens beyond its limit.
  const MapLayout general = lay(warp(Warp::kGeneralLispsm), beside_);
  for (const PartLayout& part : general.parts) EXPECT_GT(locate(part, {0, 0, 0.5}).w, 0);
}

TEST_F(MapLayouts, WithoutReceiversThePlainMapIsDrawn) {
  const Camera away = test::look_at({-20, 0, 2}, {-90, 0, 2}, 300, 400, 300);
  const MapLayout layout = lay(warp(Warp::kGeneralLispsm, 3), away);
  EXPECT_EQ(layout.parts.size(), 1u);
  EXPECT_EQ(layout.size, glm::ivec2(512));
  EXPECT_FALSE(layout.warped);
}

TEST_F(MapLayouts, NearAndFarFitTheGeometry) {
  const MapLayout layout = lay(warp(Warp::kNone), across_);
  EXPECT_NEAR(layout.near, 24, 0.03);
  EXPECT_NEAR(layout.far, 25, 0.03);
  const Camera inside = test::look_at({0, 0, 0.5}, {5, 0, 0.5}, 300, 400, 400);
  const MapLayout within = lay_out(inside, kFloor, {0, 0, 0}, warp(Warp::kNone), {});
  EXPECT_NEAR(within.far, 10, 0.02);
  EXPECT_NEAR(within.near, 1e-3, 1e-5);
  const MapLayout flat =
      lay_out(light_, {{-1, -1, 0}, {1, 1, 0}}, {0, 0, 0}, warp(Warp::kNone), {});
  EXPECT_GT(flat.far, flat.near);
  const Camera away = test::look_at({0, 0, 5}, {0, 0.01, 50}, 300, 400, 400);
  const MapLayout behind = lay_out(away, kFloor, {0, 0, 0}, warp(Warp::kNone), {});
  EXPECT_LE(behind.far, behind.near);
}

}  // namespace
}  // namespace photohull::visibility
