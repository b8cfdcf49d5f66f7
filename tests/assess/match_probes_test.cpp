#include "assess/match_probes.h"

#include <gtest/gtest.h>

#include "meshes.h"
#include "support/ray_cast.h"
#include "support/silhouettes.h"

namespace photohull::assess {
namespace {

constexpr double kRadius = 1;

/// A textured sphere from cameras around its equator, about 12 degrees apart.
std::vector<PreparedView> photographs(double texture = 0.15) {
  std::vector<PreparedView> views;
  for (int i = 0; i < 30; ++i) {
    const double a = 0.2094 * i;
    PreparedView view;
    view.camera = test::look_at({6 * std::cos(a), 6 * std::sin(a), 0}, {0, 0, 0}, 300, 160, 160);
    view.image = test::ray_cast(view.camera, [&](const glm::dvec3& eye, const glm::dvec3& ray) {
      const double b = glm::dot(eye, ray), c = glm::dot(eye, eye) - kRadius * kRadius;
      if (b * b < c) return glm::dvec3(0.1);
      return texture > 0 ? test::noise_colour(eye + (-b - std::sqrt(b * b - c)) * ray, texture)
                         : glm::dvec3(0.4);
    });
    views.push_back(std::move(view));
  }
  return views;
}

MatchEvidence match(const std::vector<PreparedView>& views, double radius = kRadius,
                    double coarsest = 0.05) {
  TriMesh mesh = test::sphere_mesh({0, 0, 0}, radius, 90);
  mesh.confidence.assign(mesh.positions.size(), 1.0f);
  std::vector<Camera> cameras;
  std::vector<test::Outline> outlines;
  std::vector<const SilhouetteDistance*> silhouettes;
  for (const PreparedView& view : views) cameras.push_back(view.camera);
  for (const PreparedView& view : views)
    outlines.push_back(test::sphere_outline(view.camera, {0, 0, 0}, kRadius));
  for (const test::Outline& o : outlines) silhouettes.push_back(&o.distance);
  MatchOptions options;
  options.near = 0.02, options.far = 0.04, options.coarsest = coarsest;
  return match_probes(probe_surface(mesh, RayScene(mesh), cameras, 400, 0.02), views, silhouettes,
                      options);
}

TEST(MatchProbes, TheRightSurfaceIsFoundWhereItIs) {
  const MatchEvidence e = match(photographs());
  EXPECT_GT(e.seen, 0.8);
  EXPECT_GT(e.textured, 0.6);
  EXPECT_GT(e.matched, 0.9);
  EXPECT_LT(e.offset, 0.004);  // a pixel is 0.02 large
  EXPECT_LT(e.beyond_near, 0.05);
  EXPECT_LT(e.residual, 0.1);
  EXPECT_NEAR(e.pixel_size, 0.02, 0.004);
  EXPECT_LT(e.unconfirmed_patches, 0.02);
}

TEST(MatchProbes, ViewsThatAreTooCoarseTellOfNoDistances) {
  const MatchEvidence e = match(photographs(), kRadius + 0.05, 0.01);
  EXPECT_GT(e.matched, 0.9);
  EXPECT_EQ(e.offset, 0);
  EXPECT_EQ(e.beyond_far, 0);
  for (const ViewResidual& view : e.views) EXPECT_EQ(view.matches, 0);
}

TEST(MatchProbes, PatchesThatAreNotConfirmedCountTogether) {
  std::vector<PreparedView> views = photographs();
  const MatchEvidence off = match(views, kRadius + 0.06);
  EXPECT_GT(off.unconfirmed_patches, 0.8 * off.textured);
}

TEST(MatchProbes, OffsetsTellHowFarOffTheSurfaceIs) {
  const std::vector<PreparedView> views = photographs();
  for (const double off : {-0.05, 0.05}) {
    const MatchEvidence e = match(views, kRadius + off);
    EXPECT_NEAR(e.offset, 0.05, 0.012) << off;
    EXPECT_GT(e.beyond_near, 0.9) << off;
    EXPECT_GT(e.beyond_far, 0.6) << off;
    EXPECT_LT(e.residual, 0.2) << off;  // the cameras agree all the same
  }
}

TEST(MatchProbes, ResidualsNameTheViewThatIsOff) {
  std::vector<PreparedView> views = photographs();
  views[7].camera.intrinsics.cy += 1.5;  // across the epipolar lines of the equator
  const MatchEvidence e = match(views);
  EXPECT_NEAR(e.views[7].pixels, 1.5, 0.3);
  EXPECT_GT(e.views[7].matches, 5);
  EXPECT_LT(e.views[20].pixels, 0.15);
  EXPECT_LT(e.residual, 0.2);
}

TEST(MatchProbes, PlainSurfaceIsNotTextured) {
  const MatchEvidence e = match(photographs(0));
  EXPECT_GT(e.seen, 0.8);
  EXPECT_LT(e.textured, 0.02);
}

TEST(MatchProbes, PhotographsOfSomethingElseAreNotMatched) {
  std::vector<PreparedView> views = photographs();
  test::Rng rng(1);
  for (PreparedView& view : views) view.image = test::random_image(rng, 160, 160);
  const MatchEvidence e = match(views);
  EXPECT_GT(e.textured, 0.5);
  EXPECT_LT(e.matched, 0.05);
}

}  // namespace
}  // namespace photohull::assess
