// The choice of views against its reference.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "match_scene.h"
#include "refine/kernels/choose_views.h"
#include "refine/kernels/match_patches.h"
#include "support/gl_context.h"

namespace photohull::refine {
namespace {

using glm::dvec3;
using reference::MatchView;

struct Found {
  Matches matches;
  std::vector<ViewChoice> choices;
};

class ChooseViews : public ::testing::TestWithParam<int> {
 protected:
  Found run(const TriMesh& mesh) {
    Found out;
    gpu::Context& context = test::gl_context();  // before the images need it
    const projtex::ImageSet images(views_);
    const std::vector<Camera> cameras = projtex::cameras_of(views_);
    out.choices =
        choose_views(context, test::kGrid, mesh, {images, cameras, test::kNoise}, options_);
    std::vector<PatchSurfel> surfels;
    for (const auto& point : render::to_voxels(test::kGrid, mesh))
      surfels.push_back({point.position, point.normal});
    out.matches = PatchMatcher(context, images, projtex::to_grid(cameras, test::kGrid),
                               patch_rules(options_, test::kNoise), "choose views test")
                      .match(surfels, {}, out.choices, range_);
    context.check_errors("choose views test");
    expected_ = test::reference_views(views_);
    test::draw(views_, mesh, expected_);
    return out;
  }

  /// Does the kernel's choice for a vertex agree with the reference but for ties?
  bool agrees(const TriMesh& mesh, const Found& found, std::size_t i) const {
    const std::vector<int> chosen = test::views_of(found.choices[i]);
    const auto at = render::to_voxels(test::kGrid, mesh)[i];
    const auto expected =
        reference::choose_views(expected_, dvec3(at.position), dvec3(at.normal), options_, chosen);
    const std::vector<int> hidden(found.choices[i].hidden.begin(), found.choices[i].hidden.end());
    return expected.views == chosen && expected.seen == found.choices[i].seen &&
           expected.hidden == hidden;
  }

  void add_camera(const dvec3& voxel, const dvec3& target, double focal = 300) {
    PreparedView view;
    view.camera = test::look_at(test::kGrid.world(voxel), test::kGrid.world(target), focal,
                                test::kImageEdge, test::kImageEdge, {0, 1, 0});
    view.image = test::random_image(rng_, test::kImageEdge, test::kImageEdge);
    views_.push_back(std::move(view));
  }

  /// A ring of cameras that see a surfel at (24, 24, 24) with normal +z under `angle` degrees.
  void add_ring(int count, double angle) {
    const dvec3 target(24, 24, 24);
    for (int i = 0; i < count; ++i) {
      const double turn = glm::radians(360.0 * i / count), tilt = glm::radians(angle);
      add_camera(target + 200.0 * dvec3(std::sin(tilt) * std::cos(turn),
                                        std::sin(tilt) * std::sin(turn), std::cos(tilt)),
                 target);
    }
  }

  test::Rng rng_{7};
  std::vector<PreparedView> views_;
  std::vector<MatchView> expected_;
  OffsetRange range_{-1, 1, 3};
  MatchOptions options_;
};

TEST_P(ChooseViews, AgreesOnRandomPoints) {
  views_ = test::random_views(rng_, GetParam());
  for (PreparedView& view : views_)
    if (std::uniform_int_distribution(0, 1)(rng_))
      view.sharpness = std::uniform_real_distribution(0.5, 1.3)(rng_);
  const TriMesh mesh = test::random_points(rng_, 2000);
  const Found found = run(mesh);
  ASSERT_EQ(found.choices.size(), mesh.positions.size());
  int wrong = 0, seen = 0, several = 0, hidden = 0;
  for (std::size_t i = 0; i < found.choices.size(); ++i) {
    wrong += !agrees(mesh, found, i);
    seen += found.choices[i].seen > 0;
    several += found.choices[i].views.size() > 2;
    hidden += !found.choices[i].hidden.empty();
    if (i % 10 == 0) {
      EXPECT_EQ(found.choices[i].seen, 0) << "without a normal";
    }
    for (const float score : found.matches.of(i)) {
      if (found.choices[i].views.size() < 2) {
        EXPECT_EQ(score, kNoScore);
      } else {
        EXPECT_LE(std::abs(score), 1.001f);
      }
    }
  }
  // A point on the border of a texel or of an image may fall either way.
  EXPECT_LE(wrong, 20);
  EXPECT_GT(seen, 500);
  EXPECT_GT(hidden, 50);
  if (GetParam() >= 20) {
    EXPECT_GT(several, 300);
  }
}

INSTANTIATE_TEST_SUITE_P(Views, ChooseViews, ::testing::Values(2, 3, 7, 20, 60));

using ChooseViewsOf = ChooseViews;

TEST_F(ChooseViewsOf, OneCameraSeesButNothingIsCompared) {
  add_camera({24, 24, 200}, {24, 24, 24});
  TriMesh mesh;
  test::add_vertex({24, 24, 24}, {0, 0, 1}, mesh);
  const Found found = run(mesh);
  EXPECT_EQ(test::views_of(found.choices[0]), std::vector<int>{0});
  EXPECT_GT(found.choices[0].seen, 0);
  for (const float score : found.matches.of(0)) EXPECT_EQ(score, kNoScore);
  EXPECT_EQ(found.matches.samples, 0);
}

TEST_F(ChooseViewsOf, NobodySeesWhatLiesBehindOrLooksAway) {
  for (const double x : {0.0, 24.0, 48.0}) add_camera({x, 24, 40}, {x, 24, 0});
  TriMesh mesh;
  test::add_vertex({24, 24, 60}, {0, 0, -1}, mesh);  // faces the cameras from behind them
  test::add_vertex({24, 24, 20}, {0, 0, -1}, mesh);  // before them, back turned
  test::add_vertex({24, 24, 40}, {0, 0, 1}, mesh);   // in one of the optical centres
  test::add_vertex({24, 24, 20}, {0, 0, 0}, mesh);
  const Found found = run(mesh);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(found.choices[i].views.size(), 0) << i;
    EXPECT_EQ(found.choices[i].seen, 0) << i;
    for (const float score : found.matches.of(i)) EXPECT_EQ(score, kNoScore);
  }
}

TEST_F(ChooseViewsOf, ImageEndsHalfAPixelBeyondTheLastCentre) {
  add_camera({24, 24, 224}, {24, 24, 24}, 100);
  // At this depth a pixel is two voxels; the image's borders are 64 voxels from its middle.
  const double depth = 200, reach = 0.5 * test::kImageEdge * depth / 100;
  TriMesh mesh;
  for (const double beyond : {-0.1, 0.1})
    for (const auto& side : {dvec3(1, 0, 0), dvec3(-1, 0, 0), dvec3(0, 1, 0), dvec3(0, -1, 0)}) {
      options_.shift = 0;
      test::add_vertex(dvec3(24, 24, 24) + (reach + beyond) * side, {0, 0, 1}, mesh);
    }
  const Found found = run(mesh);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(found.choices[i].seen > 0, i < 4) << i;
    EXPECT_TRUE(agrees(mesh, found, i)) << i;
  }
}

TEST_F(ChooseViewsOf, FlatViewsSeeButAreNotMatched) {
  add_ring(4, 85);  // cosine 0.09
  TriMesh mesh;
  test::add_vertex({24, 24, 24}, {0, 0, 1}, mesh);
  const Found found = run(mesh);
  EXPECT_EQ(found.choices[0].seen, 4);
  EXPECT_EQ(found.choices[0].views.size(), 0);
  EXPECT_GT(found.choices[0].seen, 0);
}

TEST_F(ChooseViewsOf, HiddenSurfelIsUnseen) {
  add_ring(8, 20);
  TriMesh mesh;
  test::add_vertex({24, 24, 24}, {0, 0, 1}, mesh);
  for (int x = 10; x < 38; ++x)
    for (int y = 10; y < 38; ++y) test::add_vertex({x, y, 34}, {0, 0, 1}, mesh);
  const Found found = run(mesh);
  EXPECT_EQ(found.choices[0].seen, 0);
  const auto& hidden = found.choices[0].hidden;
  EXPECT_EQ(std::set<int>(hidden.begin(), hidden.end()).size(), 4u);
  for (const int view : hidden) EXPECT_TRUE(view >= 0 && view < 8);
}

TEST_F(ChooseViewsOf, BlurredViewsGiveWayToSharpOnesThatSeeTheSame) {
  add_ring(10, 20);
  add_ring(10, 35);
  for (std::size_t i = 0; i < 10; ++i) views_[i].sharpness = 0.8;
  TriMesh mesh;
  test::add_vertex({24, 24, 24}, {0, 0, 1}, mesh);
  const Found found = run(mesh);
  const std::vector<int> chosen = test::views_of(found.choices[0]);
  EXPECT_EQ(chosen.size(), std::size_t(ViewChoice::kMostViews));
  for (const int view : chosen) EXPECT_GE(view, 10);  // cos 20 x 0.62 < cos 35
  EXPECT_TRUE(agrees(mesh, found, 0));
}

TEST_F(ChooseViewsOf, BlurredViewsServeWhereThereAreNoOthersAndSharperOnesAreWorthNoMore) {
  add_ring(10, 20);
  TriMesh mesh;
  test::add_vertex({24, 24, 24}, {0, 0, 1}, mesh);
  const std::vector<int> plain = test::views_of(run(mesh).choices[0]);
  for (PreparedView& view : views_) view.sharpness = 2;
  EXPECT_EQ(test::views_of(run(mesh).choices[0]), plain);
  for (PreparedView& view : views_) view.sharpness = 0.5;
  EXPECT_EQ(run(mesh).choices[0].views.size(), int(plain.size()));
}

TEST_F(ChooseViewsOf, TiesAreSettledOneWayOrTheOther) {
  add_ring(14, 20);  // neighbours stand 8.7 degrees apart
  TriMesh mesh;
  test::add_vertex({24, 24, 24}, {0, 0, 1}, mesh);
  const Found found = run(mesh);
  EXPECT_EQ(found.choices[0].views.size(), ViewChoice::kMostViews);
  EXPECT_TRUE(agrees(mesh, found, 0));
}

TEST_F(ChooseViewsOf, MoreEqualViewsThanCandidates) {
  add_ring(50, 20);
  TriMesh mesh;
  test::add_vertex({24, 24, 24}, {0, 0, 1}, mesh);
  const Found found = run(mesh);
  const std::vector<int> chosen = test::views_of(found.choices[0]);
  EXPECT_EQ(found.choices[0].seen, 50);
  EXPECT_EQ(std::set<int>(chosen.begin(), chosen.end()).size(), chosen.size());
  ASSERT_GE(chosen.size(), 2u);
  for (std::size_t k = 1; k < chosen.size(); ++k) {
    // Views of a ring: the angle between two is known.
    const double turn = glm::radians(360.0 * (chosen[k] - chosen[0]) / 50);
    const double angle =
        glm::degrees(2 * std::asin(std::abs(std::sin(0.5 * turn)) * std::sin(glm::radians(20.0))));
    EXPECT_GE(angle, options_.nearest_angle - 0.01);
    EXPECT_LE(angle, options_.farthest_angle);
  }
}

TEST_F(ChooseViewsOf, OnlyTheMostFrontalAreCandidates) {
  // As many cameras as there are candidates, too near each other to be compared, and better ones.
  add_ring(ViewChoice::kCandidates, 2);
  add_ring(5, 25);
  TriMesh mesh;
  test::add_vertex({24, 24, 24}, {0, 0, 1}, mesh);
  const Found found = run(mesh);
  EXPECT_EQ(found.choices[0].seen, ViewChoice::kCandidates + 5);
  EXPECT_EQ(found.choices[0].views.size(), 1);
  EXPECT_TRUE(agrees(mesh, found, 0));
}

TEST_F(ChooseViewsOf, EmptyMesh) {
  add_camera({24, 24, 200}, {24, 24, 24});
  const Found found = run({});
  EXPECT_TRUE(found.matches.scores.empty());
  EXPECT_TRUE(found.choices.empty());
}

}  // namespace
}  // namespace photohull::refine
