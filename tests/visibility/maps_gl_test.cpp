// Every technique on the device against the reference, on random and on degenerate input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "map_cases.h"
#include "support/filtering.h"
#include "support/gl_context.h"
#include "visibility/reference.h"

namespace photohull::visibility {

void PrintTo(const Technique& technique, std::ostream* out) { *out << technique.name; }

namespace {

using namespace test_cases;

constexpr int kResolution = 24;

std::vector<Technique> all_techniques() {
  std::vector<Technique> out = named_techniques();
  const auto add = [&](const char* name, const std::function<void(Technique&)>& change) {
    Technique t;
    t.name = name;
    change(t);
    out.push_back(t);
  };
  const auto pcf = [](Technique& t, int n) {
    t.filter = Filter::kPcf;
    t.filter_size = n;
    t.virtual_samples = VirtualSamples::kNormal;
    t.bias_texels = 0.3;
  };
  for (int n : {2, 4, 6, 7})
    add(("pcf" + std::to_string(n)).c_str(), [&](Technique& t) { pcf(t, n); });
  add("pcf jittered", [&](Technique& t) { pcf(t, 3), t.kernel = Kernel::kJittered; });
  add("pcf circular", [&](Technique& t) { pcf(t, 4), t.kernel = Kernel::kCircular; });
  add("pcf gaussian", [&](Technique& t) { pcf(t, 5), t.gaussian = true; });
  add("pcf circular adaptive",
      [&](Technique& t) { pcf(t, 4), t.kernel = Kernel::kCircular, t.adaptive = true; });
  add("pcf at its taps", [&](Technique& t) { pcf(t, 3), t.align_to_texels = false; });
  add("pcf on pixels", [&](Technique& t) { pcf(t, 3), t.on_pixels = true; });
  add("pcf by derivatives", [&](Technique& t) {
    pcf(t, 3), t.virtual_samples = VirtualSamples::kDerivatives, t.align_to_texels = false;
  });
  add("variance without bleeding",
      [](Technique& t) { t.filter = Filter::kVariance, t.filter_size = 3, t.bleeding_cut = 0.2; });
  add("fit", [](Technique& t) { t.warp = Warp::kFit; });
  add("zp3", [](Technique& t) { t.warp = Warp::kGeneralLispsm, t.partitions = 3; });
  add("zp4", [](Technique& t) { t.warp = Warp::kLispsm, t.partitions = 4; });
  add("zp2 lists", [](Technique& t) {
    t.warp = Warp::kGeneralLispsm, t.partitions = 2, t.detail = Detail::kLists,
    t.bias_texels = 0.01;
  });
  add("warped second depth",
      [](Technique& t) { t.warp = Warp::kGeneralLispsm, t.bias = Bias::kSecondDepth; });
  for (Technique& t : out) t.resolution = kResolution;
  return out;
}

class EveryTechnique : public ::testing::TestWithParam<Technique> {
 protected:
  void TearDown() override { context_.check_errors("visibility test"); }

  /// Share of the samples on which device and reference differ.
  double differing(const TriMesh& mesh, const Camera& viewpoint, const Camera& eye,
                   const std::vector<Sample>& samples) {
    const VisibilityMap map =
        render_map(context_, viewpoint, Geometry::of_mesh(mesh), GetParam(), eye);
    reference::Map expected(map.layout(), GetParam(), mesh);
    compare_texels(map, expected);
    if (GetParam().filter == Filter::kVariance) {  // keeps no depths: a plain map has them
      Technique plain;
      plain.resolution = kResolution;
      expected.adopt_unsure(render_map(context_, viewpoint, Geometry::of_mesh(mesh), plain));
    } else {
      expected.adopt_unsure(map);
    }
    const std::vector<float> found = visible(context_, map, samples);
    int wrong = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double e = expected.visible(samples[i]);
      wrong += !(std::abs(found[i] - e) <= 2e-3 + 4 * test::filtering_error());
      seen_ += e, ++asked_;
    }
    return double(wrong) / double(samples.size());
  }

  /// Texels whose content is beyond doubt hold what the reference says; most are.
  void compare_texels(const VisibilityMap& map, const reference::Map& expected) {
    const std::vector<float> first = map.depths(), second = map.depths(true);
    const std::vector<std::uint32_t> ids = map.ids();
    const glm::ivec2 size = map.layout().size;
    int sure = 0, slivers = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
      const reference::Texel& t =
          expected.texel(int(i) / (size.x * size.y), int(i) % size.x, int(i) / size.x % size.y);
      if (t.unsure) continue;
      ++sure;
      if (std::isinf(t.first)) {
        slivers += !std::isinf(first[i]);
        continue;
      }
      const double slope = GetParam().bias == Bias::kSlope ? t.slope : 0;
      // Corners are rounded to a 256th of a texel, which hardware carries into depths.
      const double rounding = 2e-4 * t.first + 0.02 * t.slope;
      EXPECT_NEAR(first[i], t.first + GetParam().slope_factor * slope, rounding + 0.5 * slope);
      if (!second.empty() && std::isfinite(t.second)) {
        EXPECT_NEAR(second[i], t.second, rounding + 1e-3 * t.first);
      }
      if (!ids.empty()) {
        EXPECT_EQ(ids[i], t.id);
      }
    }
    EXPECT_LE(slivers, 2);  // thinner than what corners are rounded to
    EXPECT_GE(sure, 0.8 * double(first.size()));
  }

  gpu::Context& context_ = test::gl_context();
  test::Rng rng_{6};
  double seen_ = 0;
  int asked_ = 0;
};

TEST_P(EveryTechnique, AgreesOnRandomTriangles) {
  for (int trial = 0; trial < 4; ++trial) {
    const TriMesh mesh = random_triangles(rng_, 60);
    const Camera viewpoint = test::random_camera(rng_, kBox, 64, 56);
    const Camera eye = test::look_at({-3, 0.5 * trial, 1.5}, {0, 0, 0}, 60, 64, 48);
    // Single precision decides a test at the threshold otherwise now and then.
    EXPECT_LE(differing(mesh, viewpoint, eye, random_samples(rng_, mesh, 400)), 0.01)
        << GetParam().name;
  }
  EXPECT_GT(seen_ / asked_, 0.1);
  EXPECT_LT(seen_ / asked_, 0.99);
}

TEST_P(EveryTechnique, AgreesFromWithinTheGeometry) {
  const TriMesh mesh = random_triangles(rng_, 40);
  const Camera viewpoint = test::look_at({0.1, 0.05, -0.1}, {1, 0.2, 0.1}, 20, 48, 48);
  const Camera eye = test::look_at({-2, 1, 2}, {0.5, 0, 0}, 60, 64, 48);
  EXPECT_LE(differing(mesh, viewpoint, eye, random_samples(rng_, mesh, 300)), 0.02);
}

TEST_P(EveryTechnique, NothingHidesInEmptyGeometry) {
  const TriMesh mesh;
  const Camera viewpoint = test::look_at({-3, 0, 0}, {0, 0, 0}, 60, 64, 64);
  const Camera eye = test::look_at({0, -3, 1}, {0, 0, 0}, 60, 64, 64);
  const VisibilityMap map =
      render_map(context_, viewpoint, Geometry::of_mesh(mesh), GetParam(), eye);
  const std::vector<Sample> samples{{{0, 0, 0}, {-1, 0, 0}},
                                    {{5, 1, 0}, {-1, 0, 0}},
                                    {{-9, 0, 0}, {-1, 0, 0}},
                                    {{0, 9, 0}, {-1, 0, 0}}};
  // Behind the viewpoint and off its image nothing is seen all the same.
  EXPECT_THAT(visible(context_, map, samples), ::testing::ElementsAre(1, 1, 0, 0));
  EXPECT_TRUE(visible(context_, map, {}).empty());
}

TEST_P(EveryTechnique, GeometryBehindTheViewpointHidesNothing) {
  const TriMesh mesh = random_triangles(rng_, 20);
  const Camera viewpoint = test::look_at({4, 0, 0}, {9, 0, 0}, 60, 64, 64);
  const Camera eye = test::look_at({0, -3, 1}, {0, 0, 0}, 60, 64, 64);
  const VisibilityMap map =
      render_map(context_, viewpoint, Geometry::of_mesh(mesh), GetParam(), eye);
  const std::vector<Sample> samples{{{6, 0, 0}, {-1, 0, 0}}, {{0, 0, 0}, {-1, 0, 0}}};
  EXPECT_THAT(visible(context_, map, samples), ::testing::ElementsAre(1, 0));
}

TEST_P(EveryTechnique, ATriangleLargerThanTheMapHidesAllBehindIt) {
  TriMesh mesh;
  mesh.positions = {{0, -90, -80},
                    {0, 90, -80},
                    {0, 0, 120},
                    // a second wall, so that the techniques of two surfaces have one
                    {0.2f, -90, -80},
                    {0.2f, 90, -80},
                    {0.2f, 0, 120}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  const Camera viewpoint = test::look_at({-3, 0, 0}, {0, 0, 0}, 60, 64, 64);
  const VisibilityMap map =
      render_map(context_, viewpoint, Geometry::of_mesh(mesh), GetParam(), viewpoint);
  std::vector<Sample> behind, before;
  for (int i = 0; i < 50; ++i) {
    const glm::dvec3 p(0, test::uniform(rng_, -1, 1), test::uniform(rng_, -1, 1));
    behind.push_back({p + glm::dvec3(2.5, 0, 0), {-1, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}});
    before.push_back({p - glm::dvec3(1, 0, 0), {-1, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}});
  }
  const std::vector<float> hidden = visible(context_, map, behind);
  const std::vector<float> seen = visible(context_, map, before);
  // Chebyshev's bound is one from above and never quite 0.
  const float most = GetParam().filter == Filter::kVariance ? 1e-3f : 0;
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    EXPECT_LE(hidden[i], most) << i;
    EXPECT_EQ(seen[i], 1) << i;
  }
}

TEST_P(EveryTechnique, CoplanarFacesAndSliversStayDefined) {
  // Two sheets in one plane, triangles of no area, and thousands within a texel.
  TriMesh mesh;
  mesh.positions = {{0, -4, -3}, {0, 4, -3}, {0, 0, 4}, {0, -3, -2},
                    {0, 3, -2},  {0, 0, 3},  {0, 0, 0}, {0, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 6}, {0, 0, 1}, {0, 1, 0}};
  for (int i = 0; i < 300; ++i) {
    const glm::vec3 p(0.3f, float(test::uniform(rng_, 0, 0.01)),
                      float(test::uniform(rng_, 0, 0.01)));
    const auto n = std::uint32_t(mesh.positions.size());
    for (const glm::vec3& d : {glm::vec3(0), glm::vec3(0, 1e-3, 0), glm::vec3(0, 0, 1e-3)})
      mesh.positions.push_back(p + d);
    mesh.triangles.push_back({n, n + 1, n + 2});
  }
  const Camera viewpoint = test::look_at({-3, 0, 0}, {0, 0, 0}, 40, 64, 64);
  const VisibilityMap map =
      render_map(context_, viewpoint, Geometry::of_mesh(mesh), GetParam(), viewpoint);
  std::vector<Sample> samples;
  for (int i = 0; i < 60; ++i)
    samples.push_back(
        {{test::uniform(rng_, -1, 2), 0.2, 0.1}, {-1, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}});
  const std::vector<float> found = visible(context_, map, samples);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_GE(found[i], 0);
    EXPECT_LE(found[i], 1);
    const double x = samples[i].position.x;
    const bool open = GetParam().bias == Bias::kSecondDepth || GetParam().bias == Bias::kMidpoint ||
                      GetParam().filter == Filter::kVariance;  // one surface hides nothing there
    if (x < -0.3) {
      EXPECT_EQ(found[i], 1) << x;
    }
    if (x > 1 && !open) {
      EXPECT_EQ(found[i], 0) << x;
    }
  }
}

std::string test_name(const ::testing::TestParamInfo<Technique>& info) {
  std::string out = info.param.name;
  for (char& c : out)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return out;
}

INSTANTIATE_TEST_SUITE_P(Visibility, EveryTechnique, ::testing::ValuesIn(all_techniques()),
                         test_name);

}  // namespace
}  // namespace photohull::visibility
