#include "eval/predict_photo.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "photo_scenes.h"
#include "shapes.h"

namespace photohull::eval {
namespace {

using test::photograph;
using test::plane_views;

Prediction predict(const TriMesh& mesh, const Camera& camera,
                   const std::vector<PreparedView>& views, const std::vector<std::size_t>& lenders,
                   const PredictOptions& options = {}) {
  return predict_photo(mesh, RayScene(mesh), camera, views, lenders, options, [] {});
}

/// Index of the pixel in the middle.
std::size_t middle(const Prediction& p) {
  return std::size_t(p.height / 2) * std::size_t(p.width) + std::size_t(p.width / 2);
}

TEST(PredictPhoto, InterpolatesThePhotographsToTheirOwnPixels) {
  const std::vector<PreparedView> views = plane_views(5);
  const Prediction p = predict(test::plate(-5, -5, 0, 10, 4), views[2].camera, views, {1, 3});
  double sum = 0;
  for (int y = 8; y < 72; ++y)
    for (int x = 8; x < 88; ++x) {
      const std::size_t i = std::size_t(y) * 96 + std::size_t(x);
      ASSERT_EQ(p.state[i], PixelState::kLit);
      sum += glm::length(p.colour[i] - glm::vec3(views[2].image.linear(x, y)));
    }
  EXPECT_LT(sum / (64 * 80), 0.02);
}

// Views of one colour each tell the weights that they got.
TEST(PredictPhoto, WeighsByAngle) {
  std::vector<PreparedView> views = plane_views(
      7, [](const glm::dvec3& eye, const glm::dvec3&) { return glm::dvec3(0.05 + 0.1 * eye.x); });
  for (int i = 0; i < 7; ++i)
    views[i] = photograph(views[i].camera, [i](const glm::dvec3&, const glm::dvec3&) {
      return glm::dvec3(0.1 * (i + 1));
    });
  const TriMesh plane = test::plate(-50, -50, 0, 100, 1);
  const auto value = [&](const std::vector<std::size_t>& lenders, PredictOptions options) {
    const Prediction p = predict(plane, views[3].camera, views, lenders, options);
    EXPECT_EQ(p.state[middle(p)], PixelState::kLit);
    return double(p.colour[middle(p)].r);
  };
  const double tolerance = 0.004;  // of the angle half a pixel off the axis, and of 8 bits
  EXPECT_NEAR(value({4}, {}), 0.5, tolerance);
  // 15 and 30 degrees, no next one: limit 60, weights (1 - 1/4) / 15 and (1 - 1/2) / 30: 3 to 1.
  EXPECT_NEAR(value({4, 5}, {}), (3 * 0.5 + 0.6) / 4, tolerance);
  // Two blended of three: the third, at 45 degrees, is the limit: (1 - 1/3) / 15, (1 - 2/3) / 30.
  EXPECT_NEAR(value({4, 5, 6}, {2, 0, 60}), (4 * 0.5 + 0.6) / 5, tolerance);
  EXPECT_NEAR(value({4, 5}, {4, 20, 60}), 0.6, tolerance);
  EXPECT_NEAR(value({4, 5, 6}, {4, 0, 20}), 0.5, tolerance);
  const Prediction none = predict(plane, views[3].camera, views, {4}, {4, 20, 60});
  EXPECT_EQ(none.state[middle(none)], PixelState::kUnlit);
}

// A plate hides a part of the plane from the first lender, which is nearer in angle, and not from
// the second: its red must not come through.
TEST(PredictPhoto, HiddenViewsLendNothing) {
  const auto hidden = [](const glm::dvec3& eye, const glm::dvec3& ray) {
    const glm::dvec3 at = eye - (eye.z - 1) / ray.z * ray;
    const bool plate = at.x > 0.2 && at.x < 0.6 && std::abs(at.y) < 0.5;
    return plate ? glm::dvec3(0.9, 0, 0) : glm::dvec3(0, 0.2, 0.6);
  };
  const std::vector<PreparedView> views = plane_views(5, hidden);
  const TriMesh scene =
      test::together(test::plate(-20, -20, 0, 40, 1), test::box({0.2, -0.5, 0.999}, {0.6, 0.5, 1}));
  // From straight above, the middle pixel sees the plane at the origin; the view at 15 degrees has
  // the plate in its way there, the one at -15 has not.
  const Prediction blocked = predict(scene, views[2].camera, views, {3});
  EXPECT_EQ(blocked.state[middle(blocked)], PixelState::kUnlit);
  const Prediction free = predict(scene, views[2].camera, views, {1, 3});
  ASSERT_EQ(free.state[middle(free)], PixelState::kLit);
  EXPECT_LT(free.colour[middle(free)].r, 0.01);
  // Without the plate in the mesh the red comes through: the test would tell.
  const Prediction wrong = predict(test::plate(-20, -20, 0, 40, 1), views[2].camera, views, {1, 3});
  EXPECT_GT(wrong.colour[middle(wrong)].r, 0.3);
}

TEST(PredictPhoto, KnowsFrontFromBackAndWhatWasPhotographed) {
  std::vector<PreparedView> views = plane_views(5);
  // An open plate seen from above gets nothing from below.
  views.push_back(
      photograph(test::look_at({0, 0, -4}, {0, 0, 0}, 160, 96, 80, {0, -1, 0}), test::trace_plane));
  PredictOptions wide;
  wide.most_angle = 90;
  const TriMesh plane = test::plate(-5, -5, 0, 10, 1);
  const Prediction below = predict(plane, views[4].camera, views, {5}, wide);
  EXPECT_EQ(below.state[middle(below)], PixelState::kUnlit);
  // Which way round the face is does not matter.
  const TriMesh turned = test::turned_inside_out(plane);
  EXPECT_EQ(predict(turned, views[2].camera, views, {1, 3}).colour,
            predict(plane, views[2].camera, views, {1, 3}).colour);
  // Unknown pixels lend nothing.
  for (std::size_t i = 3; i < views[3].image.bytes.size(); i += 4) views[3].image.bytes[i] = 0;
  const Prediction unknown = predict(plane, views[2].camera, views, {3});
  EXPECT_EQ(unknown.state[middle(unknown)], PixelState::kUnlit);
  const Prediction miss = predict(test::plate(3, 3, 0, 1, 1), views[2].camera, views, {3});
  EXPECT_EQ(miss.state[middle(miss)], PixelState::kMiss);
}

TEST(PredictPhoto, OptionsAreChecked) {
  for (const PredictOptions bad :
       {PredictOptions{0, 0, 60}, PredictOptions{17, 0, 60}, PredictOptions{4, -1, 60},
        PredictOptions{4, 60, 60}, PredictOptions{4, 0, 91}, PredictOptions{4, NAN, 60}})
    EXPECT_THROW(bad.validate(), UsageError);
  EXPECT_NO_THROW(PredictOptions{}.validate());
}

}  // namespace
}  // namespace photohull::eval
