// The patch scores against their reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "match_scene.h"
#include "refine/kernels/match_patches.h"
#include "support/gl_context.h"

namespace photohull::refine {
namespace {

using glm::dvec3;
using reference::MatchView;

/// Texture units weigh texels with 8 bits, and mip levels of 8-bit images are rounded.
constexpr double kBound = 0.01;

struct Probe {
  dvec3 position{0}, normal{0};  // voxels
  double scale = 1;              // of the offsets
  std::vector<int> views;
  dvec3 bend{0};  // curvature, 1 / voxel
};

class MatchPatches : public ::testing::Test {
 protected:
  /// Scores of the probes, range.count each.
  std::vector<float> run(const std::vector<Probe>& probes, int radius = kPatchRadius) {
    gpu::Context& context = test::gl_context();  // before the images need it
    const projtex::ImageSet images(views_);
    std::vector<PatchSurfel> surfels;
    std::vector<ViewChoice> choices;
    std::vector<glm::vec3> bends;
    for (const Probe& probe : probes) {
      surfels.push_back({glm::vec3(probe.position), glm::vec3(probe.normal), float(probe.scale)});
      choices.push_back(test::choice_of(probe.views));
      bends.emplace_back(probe.bend);
    }
    PatchRules rules = patch_rules(options_, noise_);
    rules.radius = radius;
    const PatchMatcher matcher(context, images,
                               projtex::to_grid(projtex::cameras_of(views_), test::kGrid), rules,
                               "match patches test");
    Matches matches = matcher.match(surfels, bends, choices, range_);
    context.check_errors("match patches test");
    textures_ = std::move(matches.texture);
    return std::move(matches.scores);
  }

  /// Compares with the reference; returns how many scores are off by more than the bound.
  int compare(const std::vector<Probe>& probes, const std::vector<float>& scores,
              int radius = kPatchRadius) {
    const std::vector<MatchView> views = test::reference_views(views_);
    int wrong = 0;
    for (std::size_t i = 0; i < scores.size(); ++i) {
      const Probe& probe = probes[i / std::size_t(range_.count)];
      const double offset = range_.at(double(i % std::size_t(range_.count))) * probe.scale;
      const double expected = reference::match_patch(
          views, probe.views,
          {probe.position + offset * probe.normal, probe.normal, radius, probe.bend}, noise_,
          options_);
      const double error = std::abs(scores[i] - expected);
      wrong += !(error < bound_);
      worst_ = std::max(worst_, error);
      greatest_ = std::max(greatest_, double(scores[i]));
    }
    for (std::size_t i = 0; i < probes.size(); ++i) {
      const Probe& probe = probes[i];
      const double offset = range_.at(range_.count / 2) * probe.scale;
      const double expected = reference::texture_of(
          views, probe.views,
          {probe.position + offset * probe.normal, probe.normal, radius, probe.bend}, noise_,
          options_);
      wrong += !(std::abs(textures_[i] - expected) < bound_);
    }
    return wrong;
  }

  /// Probes amid the grid with up to `most` random views each, whose normals face the first.
  std::vector<Probe> random_probes(int count, int most) {
    std::vector<Probe> probes;
    for (int i = 0; i < count; ++i) {
      Probe probe;
      probe.position = test::uniform_in(rng_, {dvec3(8), dvec3(40)});
      probe.views = random_choice(i % (most + 1));
      probe.normal = test::random_direction(rng_);
      if (!probe.views.empty()) {
        const dvec3 centre =
            projtex::to_grid(views_[std::size_t(probe.views[0])].camera, test::kGrid).centre;
        if (glm::dot(probe.normal, centre - probe.position) < 0) probe.normal = -probe.normal;
      }
      if (i % 2) probe.bend = 0.4 * test::random_direction(rng_);
      probes.push_back(probe);
    }
    return probes;
  }

  std::vector<int> random_choice(int count) {
    std::vector<int> all(views_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = int(i);
    std::shuffle(all.begin(), all.end(), rng_);
    all.resize(std::size_t(count));
    return all;
  }

  /// Cameras from z > 0, `spread` degrees apart, that see a textured plane z = 24 (voxels).
  void add_plane_views(int count, double spread, double focal) {
    const dvec3 target = test::kGrid.world({24, 24, 24});
    for (int i = 0; i < count; ++i) {
      const double angle = glm::radians(spread * (i - 0.5 * (count - 1)));
      PreparedView view;
      view.camera = test::look_at(target + 10.0 * dvec3(std::sin(angle), 0, std::cos(angle)),
                                  target, focal, test::kImageEdge, test::kImageEdge, {0, 1, 0});
      view.image = test::ray_cast(
          view.camera,
          [&](const dvec3& eye, const dvec3& ray) {
            return test::noise_colour(eye + (target.z - eye.z) / ray.z * ray, 0.15);
          },
          2);
      views_.push_back(std::move(view));
    }
  }

  test::Rng rng_{11};
  std::vector<PreparedView> views_;
  OffsetRange range_{-1, 0.5, 5};
  MatchOptions options_;
  double noise_ = test::kNoise;
  double bound_ = kBound;
  std::vector<float> textures_;
  double worst_ = 0, greatest_ = -1;
  int shared_ = 0;
};

TEST_F(MatchPatches, AgreesOnRandomImages) {
  views_ = test::random_views(rng_, 9);
  views_.pop_back();  // the one amid the points
  const std::vector<Probe> probes = random_probes(250, ViewChoice::kMostViews);
  // A footprint between two mip levels may fall either way.
  EXPECT_LE(compare(probes, run(probes)), 6) << worst_;
}

TEST_F(MatchPatches, AgreesOnHalfFloatImages) {
  views_ = test::random_views(rng_, 7);
  views_.pop_back();
  for (PreparedView& view : views_) view.image = test::to_half(view.image);
  const std::vector<Probe> probes = random_probes(100, ViewChoice::kMostViews);
  EXPECT_LE(compare(probes, run(probes)), 4) << worst_;
}

TEST_F(MatchPatches, SmallPatchesAlongRays) {
  // As the free-space voting does: offsets from the first sample on a ray away from the camera.
  views_ = test::random_views(rng_, 9);
  views_.pop_back();
  range_ = {0, -1, 8};
  options_.least_spacing = 0.7;
  std::vector<Probe> probes = random_probes(120, ViewChoice::kMostViews);
  for (Probe& probe : probes) probe.scale = test::uniform(rng_, 1, 3);
  EXPECT_LE(compare(probes, run(probes, 1), 1), 6) << worst_;
}

TEST_F(MatchPatches, MoreViewsThanUniformBlocksHold) {
  views_ = test::random_views(rng_, 190);
  views_.pop_back();
  const std::vector<Probe> probes = random_probes(140, ViewChoice::kMostViews);
  EXPECT_LE(compare(probes, run(probes)), 4) << worst_;
}

TEST_F(MatchPatches, SharedChoicesAreTheSameAsOneEach) {
  views_ = test::random_views(rng_, 9);
  views_.pop_back();
  range_ = {0, -1, 3};
  const std::vector<Probe> probes = random_probes(90, ViewChoice::kMostViews);
  gpu::Context& context = test::gl_context();
  const projtex::ImageSet images(views_);
  for (const int radius : {1, kPatchRadius}) {
    PatchRules rules = patch_rules(options_, noise_);
    rules.radius = radius;
    const PatchMatcher matcher(context, images,
                               projtex::to_grid(projtex::cameras_of(views_), test::kGrid), rules,
                               "match patches test");
    // Two views of a choice, three, and so on, alone; then several choices, one of which is empty.
    for (std::size_t kinds : {1, 1, 1, 1, 1, 1, 4}) {
      std::vector<ViewChoice> choices, each;
      for (std::size_t k = 0; k < kinds; ++k)
        choices.push_back(test::choice_of(random_choice(kinds > 1 ? int(2 * k) : shared_++ % 7)));
      std::vector<PatchSurfel> surfels;
      std::vector<std::uint32_t> choice_of;
      for (std::size_t i = 0; i < probes.size(); ++i) {
        surfels.push_back({glm::vec3(probes[i].position), glm::vec3(probes[i].normal), 1.5f});
        choice_of.push_back(std::uint32_t(i % kinds));
        each.push_back(choices[i % kinds]);
      }
      const Matches alike = matcher.match_alike(surfels, choices, choice_of, range_);
      const Matches usual = matcher.match(surfels, {}, each, range_);
      ASSERT_EQ(alike.scores.size(), usual.scores.size());
      for (std::size_t i = 0; i < usual.scores.size(); ++i)
        EXPECT_NEAR(alike.scores[i], usual.scores[i], 1e-5) << choices[0].views.size();
      for (std::size_t i = 0; i < usual.texture.size(); ++i)
        EXPECT_NEAR(alike.texture[i], usual.texture[i], 1e-6);
      EXPECT_EQ(alike.samples, usual.samples);
    }
  }
}

TEST_F(MatchPatches, TexturesAloneAreTheSame) {
  views_ = test::random_views(rng_, 9);
  views_.pop_back();
  const std::vector<Probe> probes = random_probes(100, ViewChoice::kMostViews);
  gpu::Context& context = test::gl_context();
  const projtex::ImageSet images(views_);
  const PatchMatcher matcher(context, images,
                             projtex::to_grid(projtex::cameras_of(views_), test::kGrid),
                             patch_rules(options_, noise_), "match patches test");
  std::vector<PatchSurfel> surfels;
  std::vector<ViewChoice> choices;
  for (const Probe& probe : probes) {
    surfels.push_back({glm::vec3(probe.position), glm::vec3(probe.normal)});
    choices.push_back(test::choice_of(probe.views));
  }
  const Matches usual = matcher.match(surfels, {}, choices, {});
  const Matches alone = matcher.textures(surfels, choices);
  EXPECT_TRUE(alone.scores.empty());
  EXPECT_LT(alone.samples, usual.samples);
  ASSERT_EQ(alone.texture.size(), usual.texture.size());
  for (std::size_t i = 0; i < usual.texture.size(); ++i)
    EXPECT_NEAR(alone.texture[i], usual.texture[i], 1e-6);
  const std::vector<ViewChoice> one{test::choice_of({3, 1, 2})};
  const std::vector<ViewChoice> each(surfels.size(), one[0]);
  const std::vector<std::uint32_t> choice_of(surfels.size(), 0);
  const Matches shared = matcher.textures_alike(surfels, one, choice_of);
  const Matches compared = matcher.match(surfels, {}, each, {});
  for (std::size_t i = 0; i < compared.texture.size(); ++i)
    EXPECT_NEAR(shared.texture[i], compared.texture[i], 1e-6);
}

TEST_F(MatchPatches, BestShareOfThePairs) {
  views_ = test::random_views(rng_, 9);
  views_.pop_back();
  range_ = {0, 1, 1};
  const std::vector<Probe> probes = random_probes(140, ViewChoice::kMostViews);
  for (const double share : {0.01, 0.2, 0.4, 0.5, 0.75, 1.0}) {
    options_.best_pairs = share;
    EXPECT_LE(compare(probes, run(probes)), 2) << share << ": " << worst_;
  }
}

TEST_F(MatchPatches, TrueSurfaceScoresBest) {
  add_plane_views(5, 12, 400);
  range_ = {-3, 1, 7};
  options_.best_pairs = 0.6;  // fewer pairs agree by chance now and then
  std::vector<Probe> probes;
  for (int i = 0; i < 40; ++i)
    probes.push_back({{test::uniform(rng_, 14, 34), test::uniform(rng_, 14, 34), 24},
                      {0, 0, 1},
                      1,
                      {2, 1, 3, 0, 4}});
  const std::vector<float> scores = run(probes);
  EXPECT_LE(compare(probes, scores), 3) << worst_;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const float* s = scores.data() + i * 7;
    EXPECT_EQ(std::max_element(s, s + 7) - s, 3);
    EXPECT_GT(s[3], 0.7f);
  }
}

TEST_F(MatchPatches, EveryMinification) {
  options_.pixel_spacing = 0;
  bound_ = 3 * kBound;  // the smallest levels have next to no contrast left
  for (const double magnify : {0.1, 1.0, 5.0, 20.0, 300.0, 1e5}) {
    views_.clear();
    add_plane_views(4, 15, 400);
    for (PreparedView& view : views_) {
      view.camera.intrinsics.fx *= magnify;
      view.camera.intrinsics.fy *= magnify;
    }
    std::vector<Probe> probes;
    for (int i = 0; i < 20; ++i)
      probes.push_back({dvec3(24 + test::uniform(rng_, -3, 3), 24, 24),
                        glm::normalize(dvec3(0.1 * i, 0.3, 1)),
                        1,
                        {0, 1, 2, 3}});
    const std::vector<float> scores = run(probes);
    EXPECT_LE(compare(probes, scores), 3) << magnify << ": " << worst_;
  }
}

TEST_F(MatchPatches, PlainImagesNeverAgree) {
  views_ = test::random_views(rng_, 7);
  views_.pop_back();
  for (PreparedView& view : views_)
    std::fill(view.image.bytes.begin(), view.image.bytes.end(), 130);
  const std::vector<Probe> probes = random_probes(60, ViewChoice::kMostViews);
  const std::vector<float> scores = run(probes);
  EXPECT_EQ(compare(probes, scores), 0) << worst_;
  EXPECT_LT(greatest_, 1e-3);
}

TEST_F(MatchPatches, PatchesSeenEdgeOn) {
  add_plane_views(3, 15, 400);
  std::vector<Probe> probes;
  for (const dvec3& normal : {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(-1, 0, 0)})
    probes.push_back({{24, 24, 24}, normal, 1, {1, 0, 2}});
  EXPECT_LE(compare(probes, run(probes)), 1) << worst_;
}

TEST_F(MatchPatches, PatchesOnAndBeyondTheImagesBorder) {
  add_plane_views(3, 15, 400);
  std::vector<Probe> probes;
  for (int x = -60; x <= 108; x += 4) probes.push_back({{x, 20, 24}, {0, 0, 1}, 1, {1, 0, 2}});
  EXPECT_LE(compare(probes, run(probes)), 4) << worst_;
}

TEST_F(MatchPatches, BehindACameraTheScoreIsANumber) {
  views_ = test::random_views(rng_, 4);  // the last amid the grid
  range_ = {-40, 7.3, 11};
  std::vector<Probe> probes;
  for (int i = 0; i < 50; ++i)
    probes.push_back({test::uniform_in(rng_, {dvec3(0), dvec3(48)}),
                      test::random_direction(rng_),
                      1,
                      {3, 0, 1, 2}});
  for (const float score : run(probes)) EXPECT_LE(std::abs(score), 1.001f);
}

}  // namespace
}  // namespace photohull::refine
