// The fit of patches against its reference, and on surfaces that are known.
#include "refine/fit_patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "match_scene.h"
#include "refine/fit_patches_reference.h"
#include "refine/kernels/fit_patches.h"
#include "support/filtering.h"
#include "support/gl_context.h"

namespace photohull::refine {
namespace {

using glm::dvec3;
using reference::FitSurfel;
using reference::FittedPatch;

struct Probe {
  dvec3 position{0}, normal{0};  // voxels
  std::vector<int> views;
};

/// Differences from the reference that a probe may have.
struct Bounds {
  double offset = 0.02, normal = 0.02;
  double score = 0.01 + 8 * test::filtering_error();
  double information = 0.05 + 8 * test::filtering_error();  // of its size
};

/// A view's linear colour of the point of a surface that a ray meets; grey where it misses.
using Surface = std::function<std::optional<dvec3>(const dvec3& eye, const dvec3& ray)>;

class FitPatches : public ::testing::Test {
 protected:
  std::vector<PatchFit> run(const std::vector<Probe>& probes) {
    gpu::Context& context = test::gl_context();  // before the images need it
    mesh_ = TriMesh();
    std::vector<ViewChoice> choices;
    for (const Probe& probe : probes) {
      test::add_vertex(probe.position, probe.normal, mesh_);
      choices.push_back(test::choice_of(probe.views));
    }
    auto out = fit(context, mesh_, choices);
    context.check_errors("fit patches test");
    return out;
  }

  std::vector<PatchFit> fit(gpu::Context& context, const TriMesh& mesh,
                            const std::vector<ViewChoice>& choices) const {
    const projtex::ImageSet images(views_);
    const std::vector<Camera> cameras = projtex::cameras_of(views_);
    const VertexGraph graph = make_graph(mesh);
    return fit_patches(context, {test::kGrid, mesh, graph, {}}, {images, cameras, noise_}, choices,
                       options_);
  }

  /// How many results are not the reference's.
  int compare(const std::vector<Probe>& probes, const std::vector<PatchFit>& results,
              const Bounds& bounds = {}) {
    const auto views = test::reference_views(views_);
    const auto vertices = render::to_voxels(test::kGrid, mesh_);
    int wrong = 0;
    for (std::size_t i = 0; i < probes.size(); ++i) {
      FitSurfel surfel{dvec3(vertices[i].position), dvec3(vertices[i].normal)};
      surfel.hold_out = holds_out(glm::vec3(vertices[i].position), options_.hold_out);
      const FittedPatch expected =
          reference::fit_patch(views, probes[i].views, surfel, noise_, options_);
      const PatchFit& r = results[i];
      const auto near = [](double a, double b, double bound) { return std::abs(a - b) < bound; };
      const bool ok = near(r.offset, expected.offset, bounds.offset) &&
                      glm::distance(dvec3(r.normal), expected.normal) < bounds.normal &&
                      near(r.information, expected.information,
                           bounds.information * (expected.information + 1)) &&
                      near(r.score, expected.score, bounds.score) &&
                      near(r.held_before, expected.held_before, bounds.score) &&
                      near(r.held_after, expected.held_after, bounds.score);
      wrong += !ok;
      informed_ += expected.information > 1;
      held_ += expected.held_before > -1;
      if (!ok && wrong == 1) tell(i, r, expected);
    }
    return wrong;
  }

  static void tell(std::size_t i, const PatchFit& r, const FittedPatch& e) {
    std::cout << "first that differs: probe " << i << ", offset " << r.offset << " / " << e.offset
              << ", information " << r.information << " / " << e.information << ", score "
              << r.score << " / " << e.score << ", held out " << r.held_before << ' '
              << r.held_after << " / " << e.held_before << ' ' << e.held_after << '\n';
  }

  /// Cameras on the side z > 24, a cross of `count` steps of `spread` degrees.
  void add_views(int count, double spread, double focal, const Surface& surface) {
    const dvec3 target = test::kGrid.world({24, 24, 24});
    for (int i = 0; i < count; ++i) {
      const double turn = 2.4 * i, tilt = glm::radians(spread * std::sqrt(double(i)));
      const dvec3 to(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn),
                     std::cos(tilt));
      PreparedView view;
      view.camera = test::look_at(target + 10.0 * to, target, focal, test::kImageEdge,
                                  test::kImageEdge, {0, 1, 0});
      view.image = test::ray_cast(
          view.camera,
          [&](const dvec3& eye, const dvec3& ray) {
            const auto at = surface(eye, ray);
            return at ? test::noise_colour(*at, texture_) : dvec3(0.2);
          },
          4);
      views_.push_back(std::move(view));
    }
  }

  void add_plane_views(int count, double spread, double focal) {
    const double z = test::kGrid.world({24, 24, 24}).z;
    add_views(count, spread, focal, [&](const dvec3& eye, const dvec3& ray) {
      return std::optional(eye + (z - eye.z) / ray.z * ray);
    });
  }

  /// Probes about (24, 24, 24) off the plane z = 24 by up to `off` voxels and `tilt` degrees.
  std::vector<Probe> plane_probes(int count, double off, double tilt) {
    std::vector<Probe> probes;
    for (int i = 0; i < count; ++i) {
      const double turn = test::uniform(rng_, 0, 6.28), t = glm::radians(tilt);
      probes.push_back({{test::uniform(rng_, 16, 32), test::uniform(rng_, 16, 32),
                         24 + test::uniform(rng_, -off, off)},
                        {std::sin(t) * std::cos(turn), std::sin(t) * std::sin(turn), std::cos(t)},
                        {0, 1, 2, 3, 4, 5}});
    }
    return probes;
  }

  std::vector<Probe> random_probes(int count) {
    std::vector<Probe> probes;
    for (int i = 0; i < count; ++i) {
      Probe probe;
      probe.position = test::uniform_in(rng_, {dvec3(8), dvec3(40)});
      for (int v = 0; v < int(views_.size()); ++v) probe.views.push_back(v);
      std::shuffle(probe.views.begin(), probe.views.end(), rng_);
      probe.views.resize(std::min(std::size_t(i % (ViewChoice::kMostViews + 1)), views_.size()));
      probe.normal = test::random_direction(rng_);
      if (!probe.views.empty()) {
        const dvec3 centre =
            projtex::to_grid(views_[std::size_t(probe.views[0])].camera, test::kGrid).centre;
        if (glm::dot(probe.normal, centre - probe.position) < 0) probe.normal = -probe.normal;
      }
      probes.push_back(probe);
    }
    return probes;
  }

  test::Rng rng_{23};
  std::vector<PreparedView> views_;
  TriMesh mesh_;
  FitOptions options_;
  double noise_ = test::kNoise;
  double texture_ = 0.07;  // world units
  int informed_ = 0, held_ = 0;
};

TEST_F(FitPatches, AgreesWithoutSteps) {
  // Everything that one look at the images gives, on images without any order.
  views_ = test::random_views(rng_, 9);
  views_.pop_back();  // the one amid the points
  options_.steps = 0;
  options_.least_score = -0.9, options_.full_score = 0.3;  // all take part
  options_.slope = 0.02;
  const std::vector<Probe> probes = random_probes(250);
  // A footprint between two mip levels may fall either way; hardware rounds the level itself.
  EXPECT_LE(compare(probes, run(probes)), test::filtering_error() > 1e-3 ? 16 : 6);
  EXPECT_GT(informed_, 50);
}

TEST_F(FitPatches, AgreesStepByStep) {
  add_plane_views(7, 11, 400);
  const std::vector<Probe> probes = plane_probes(60, 0.4, 6);
  for (const int steps : {1, 2, 4}) {
    options_.steps = steps;
    options_.hold_out = steps;
    EXPECT_LE(compare(probes, run(probes)), 4) << steps;
  }
  EXPECT_GT(informed_, 100);
  EXPECT_GT(held_, 60);
}

TEST_F(FitPatches, AgreesOnEveryMinification) {
  options_.pixel_spacing = 0;
  for (const double magnify : {0.2, 5.0, 40.0, 1e4}) {
    views_.clear();
    add_plane_views(5, 12, 400);
    for (PreparedView& view : views_) {
      view.camera.intrinsics.fx *= magnify;
      view.camera.intrinsics.fy *= magnify;
    }
    options_.steps = 0;
    std::vector<Probe> probes = plane_probes(20, 0.3, 5);
    for (Probe& probe : probes) {
      probe.position = dvec3(24) + 0.2 * (probe.position - 24.0);
      probe.views = {0, 1, 2, 3};
    }
    EXPECT_LE(compare(probes, run(probes),
                      {.score = 0.03 + 8 * test::filtering_error(), .information = 0.15}),
              2)
        << magnify;
  }
}

TEST_F(FitPatches, ComesBackToAPlane) {
  add_plane_views(6, 11, 400);
  for (PreparedView& view : views_) view.image = test::to_half(view.image);
  options_.steps = 5;
  options_.largest_offset = 1;
  options_.slope = 1;
  std::vector<Probe> probes = plane_probes(60, 0, 10);
  for (std::size_t i = 0; i < probes.size(); ++i) probes[i].position.z += i % 2 ? 0.5 : -0.5;
  std::vector<double> off, angle;
  for (std::size_t i = 0; const PatchFit& r : run(probes)) {
    const Probe& probe = probes[i++];
    off.push_back(std::abs((probe.position + double(r.offset) * probe.normal).z - 24));
    angle.push_back(glm::degrees(std::acos(std::min(1.0f, r.normal.z))));
    EXPECT_GT(r.information, 30);
  }
  std::sort(off.begin(), off.end());
  std::sort(angle.begin(), angle.end());
  EXPECT_LT(off[30], 0.02);
  EXPECT_LT(off[54], 0.05);
  EXPECT_LT(angle[30], 2);
}

TEST_F(FitPatches, ComesBackToASphereWithItsCurvature) {
  // A sphere's mesh that is half a voxel too large: the fit finds the sphere, the patches bent.
  const double radius = 14;  // voxels
  const dvec3 middle = test::kGrid.world({24, 24, 10});
  add_views(6, 11, 400, [&](const dvec3& eye, const dvec3& ray) -> std::optional<dvec3> {
    const double r = radius * test::kGrid.voxel_size, b = glm::dot(ray, eye - middle);
    const double under = b * b - glm::dot(eye - middle, eye - middle) + r * r;
    if (under < 0) return std::nullopt;
    return eye + (-b - std::sqrt(under)) * ray;
  });
  for (PreparedView& view : views_) view.image = test::to_half(view.image);
  TriMesh mesh;  // a net over the cap that faces the cameras
  constexpr int kEdge = 13;
  for (int j = 0; j < kEdge; ++j)
    for (int i = 0; i < kEdge; ++i) {
      const dvec3 n = glm::normalize(dvec3(0.05 * (i - 6), 0.05 * (j - 6), 1));
      test::add_vertex(dvec3(24, 24, 10) + (radius + 0.5) * n, n, mesh);
      const auto at = [&](int a, int b) { return std::uint32_t(b * kEdge + a); };
      if (!i || !j) continue;
      mesh.triangles.push_back({at(i - 1, j - 1), at(i, j - 1), at(i, j)});
      mesh.triangles.push_back({at(i - 1, j - 1), at(i, j), at(i - 1, j)});
    }
  const std::vector<ViewChoice> choices(mesh.positions.size(), test::choice_of({0, 1, 2, 3, 4, 5}));
  options_.steps = 5;
  options_.largest_offset = 1;
  gpu::Context& context = test::gl_context();  // before the images need it
  const auto error = [&] {
    double sum = 0;
    for (const auto& r : fit(context, mesh, choices)) sum += r.offset + 0.5;
    return std::abs(sum / double(mesh.positions.size()));
  };
  const double bent = error();
  options_.most_bend = 0;
  EXPECT_LT(bent, 0.02);
  EXPECT_GT(error(), 2 * bent) << "flat patches lie below what they stand for";
}

TEST_F(FitPatches, LessNoiseMoreInformation) {
  add_plane_views(6, 11, 400);
  const std::vector<Probe> probes = plane_probes(40, 0.1, 2);
  double previous = std::numeric_limits<double>::max();
  for (const double sigma : {0.0, 6.0, 30.0}) {
    std::normal_distribution<double> noise(0, sigma);
    auto clean = views_;
    if (sigma > 0)
      for (PreparedView& view : views_)
        for (std::uint8_t& byte : view.image.bytes)
          byte = std::uint8_t(std::clamp(byte + noise(rng_), 0.0, 255.0));
    std::vector<double> information;
    for (const auto& r : run(probes)) information.push_back(r.information);
    std::sort(information.begin(), information.end());
    EXPECT_LT(information[20], 0.7 * previous) << sigma;
    previous = information[20];
    views_ = clean;
  }
}

TEST_F(FitPatches, AViewThatDisagreesHasNoWeight) {
  add_plane_views(6, 11, 400);
  const std::vector<Probe> probes = plane_probes(40, 0.3, 4);
  options_.hold_out = 0;
  views_[3].image = test::random_image(rng_, test::kImageEdge, test::kImageEdge);
  double sum = 0;
  const auto results = run(probes);
  EXPECT_LE(compare(probes, results), 3);
  for (std::size_t i = 0; i < probes.size(); ++i)
    sum += std::abs((probes[i].position + double(results[i].offset) * probes[i].normal).z - 24);
  EXPECT_LT(sum / 40, 0.05);
}

TEST_F(FitPatches, PlainImagesSayNothing) {
  views_ = test::random_views(rng_, 7);
  views_.pop_back();
  for (PreparedView& view : views_)
    std::fill(view.image.bytes.begin(), view.image.bytes.end(), 130);
  const std::vector<Probe> probes = random_probes(60);
  for (const auto& r : run(probes)) {
    EXPECT_LT(std::abs(r.offset), 1e-3);
    EXPECT_LT(r.information, 1e-2);
  }
}

TEST_F(FitPatches, PeaksWeighInformationByPixel) {
  const auto fit_of = [](float offset, float information, float score) {
    return PatchFit{{0, 0, 1}, offset, information, score, 0, 0};
  };
  options_.largest_offset = 0.5;
  options_.unit_deviation = 0.1, options_.most_weight = 4;
  options_.least_score = 0.1, options_.full_score = 0.9;
  const std::vector<Peak> peaks = peaks_of(
      std::vector{fit_of(0.25f, 100, 0.9f), fit_of(0.25f, 100, 0.9f), fit_of(0.25f, 1e6, 0.9f),
                  fit_of(0.25f, 0, 0.9f), fit_of(0.25f, 100, 0.5f), fit_of(0.5f, 100, 0.9f)},
      std::vector<float>{1, 2, 0.5, 1, 1, 1}, options_);
  EXPECT_FLOAT_EQ(peaks[0].weight, 1);
  EXPECT_FLOAT_EQ(peaks[0].offset, 0.25);
  EXPECT_FLOAT_EQ(peaks[1].weight, 1.0 / 16);
  EXPECT_FLOAT_EQ(peaks[2].weight, 4 * 16);
  EXPECT_EQ(peaks[3].weight, 0);
  EXPECT_FLOAT_EQ(peaks[4].weight, 0.5);
  EXPECT_EQ(peaks[5].weight, 0) << "at the limit";
}

TEST_F(FitPatches, SpacingIsAPixelOrTheLeast) {
  add_plane_views(2, 11, 400);  // 10 world units, 200 voxels away
  const std::vector<glm::vec3> positions(3, glm::vec3(24));
  const std::vector<ViewChoice> choices{test::choice_of({0, 1}), test::choice_of({}),
                                        test::choice_of({1})};
  options_.least_spacing = 0.1, options_.pixel_spacing = 2;
  const auto spacings =
      tap_spacings(test::kGrid, positions, projtex::cameras_of(views_), choices, options_);
  EXPECT_NEAR(spacings[0], 1, 1e-3);
  EXPECT_FLOAT_EQ(spacings[1], 0.1f);
  EXPECT_NEAR(spacings[2], 1, 1e-3);
}

TEST_F(FitPatches, TooFewViewsLeaveTheSurfel) {
  add_plane_views(2, 11, 400);
  std::vector<Probe> probes = plane_probes(2, 0.3, 4);
  probes[0].views = {};
  probes[1].views = {1};
  const auto results = run(probes);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(results[i].offset, 0);
    EXPECT_EQ(results[i].information, 0);
    EXPECT_EQ(results[i].score, kNoScore);
    EXPECT_EQ(results[i].held_before, kNoScore);
    EXPECT_EQ(results[i].held_after, kNoScore);
    EXPECT_LT(glm::distance(dvec3(results[i].normal), probes[i].normal), 1e-6);
  }
  EXPECT_EQ(peaks_of(results, std::vector<float>{1, 1}, options_)[1].weight, 0);
  EXPECT_EQ(held_out(results).surfels, 0u);
}

TEST_F(FitPatches, BorderEdgeOnAndBehindStayFinite) {
  views_ = test::random_views(rng_, 5);  // the last amid the points
  std::vector<Probe> probes;
  for (int i = 0; i < 60; ++i)
    probes.push_back({test::uniform_in(rng_, {dvec3(0), dvec3(48)}),
                      test::random_direction(rng_),
                      {4, 0, 1, 2, 3}});
  const dvec3 behind = projtex::to_grid(views_[4].camera, test::kGrid).centre;
  probes.push_back({behind, {0, 0, 1}, {4, 0, 1, 2}});  // at the very camera
  for (int x = -60; x <= 108; x += 8) probes.push_back({{x, 20, 24}, {0, 0, 1}, {0, 1, 2}});
  const auto results = run(probes);
  for (const auto& r : results) {
    EXPECT_LE(std::abs(r.offset), options_.largest_offset + 1e-6);
    EXPECT_NEAR(glm::length(r.normal), 1, 1e-4);
    EXPECT_GE(r.information, 0);
    EXPECT_LT(r.information, 1e9);
    EXPECT_LE(r.score, 1.001);
  }
}

}  // namespace
}  // namespace photohull::refine
