// What sub-pixel maps hold, against exact clipping; volumes, marched and rasterised, against rays.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/error.h"
#include "map_cases.h"
#include "support/gl_context.h"
#include "visibility/reference.h"
#include "visibility/truth.h"

namespace photohull::visibility {
namespace {

using namespace test_cases;
using ::testing::IsSupersetOf;

Technique named(const char* name, int resolution) {
  Technique t = parse_technique("technique", name);
  t.resolution = resolution;
  return t;
}

class DetailMaps : public ::testing::Test {
 protected:
  void TearDown() override { context_.check_errors("details test"); }
  gpu::Context& context_ = test::gl_context();
  test::Rng rng_{9};
};

TEST_F(DetailMaps, ListsHoldEveryTriangleThatIsSeenInATexelAndNoneThatIsNotThere) {
  for (const int count : {30, 400}) {  // many texels a triangle, many triangles a texel
    const TriMesh mesh = random_triangles(rng_, count, count > 100 ? 0.2 : 1);
    const Camera viewpoint = test::random_camera(rng_, kBox, 40, 40);
    const Technique t = named("lists", 16);
    const VisibilityMap map = render_map(context_, viewpoint, Geometry::of_mesh(mesh), t);
    const reference::Map expected(map.layout(), t, mesh);
    std::size_t seen = 0, all = 0, strangers = 0;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        const auto found = map.triangles_at(context_, 0, {x, y});
        EXPECT_THAT(found, IsSupersetOf(expected.seen_in(0, {x, y}))) << x << ", " << y;
        const auto there = expected.triangles_in(0, {x, y});
        for (const std::uint32_t i : found) strangers += !std::count(there.begin(), there.end(), i);
        seen += expected.seen_in(0, {x, y}).size();
        all += found.size();
      }
    EXPECT_EQ(map.linked(), all);
    EXPECT_GT(seen, 80u);
    // Corners that touch a texel's border may round to either side.
    EXPECT_LE(strangers, 1 + all / 200);
  }
}

TEST_F(DetailMaps, MoreThanFourTrianglesATexelAreAllKept) {
  TriMesh mesh;  // a fan of 64 about the middle of the image
  mesh.positions.emplace_back(0, 0.01f, 0.01f);
  for (int i = 0; i < 64; ++i) {
    const float a = float(i) * 0.0981747704f;
    mesh.positions.emplace_back(0, std::cos(a), std::sin(a));
    mesh.triangles.push_back({0, std::uint32_t(1 + i), std::uint32_t(1 + (i + 1) % 64)});
  }
  const Camera viewpoint = test::look_at({-4, 0, 0}, {0, 0, 0}, 30, 16, 16);
  const VisibilityMap lists =
      render_map(context_, viewpoint, Geometry::of_mesh(mesh), named("lists", 16));
  std::size_t most = 0;
  for (int y = 7; y <= 8; ++y)
    for (int x = 7; x <= 8; ++x)
      most = std::max(most, lists.triangles_at(context_, 0, {x, y}).size());
  EXPECT_EQ(most, 64u);
  const VisibilityMap links =
      render_map(context_, viewpoint, Geometry::of_mesh(mesh), named("coverage", 16));
  EXPECT_LE(links.triangles_at(context_, 0, {8, 8}).size(), 4u);
}

TEST_F(DetailMaps, ListsMayReachOverTwoStorageBlocks) {
  const TriMesh mesh = random_triangles(rng_, 200, 0.4);
  const Camera viewpoint = test::random_camera(rng_, kBox, 40, 40);
  Technique t = named("lists", 24);
  const Geometry geometry = Geometry::of_mesh(mesh);
  const VisibilityMap whole = render_map(context_, viewpoint, geometry, t);
  t.list_block = std::uint32_t(whole.linked() / 2 + 1);
  const VisibilityMap halves = render_map(context_, viewpoint, geometry, t);
  EXPECT_EQ(halves.linked(), whole.linked());
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x)
      EXPECT_EQ(halves.triangles_at(context_, 0, {x, y}), whole.triangles_at(context_, 0, {x, y}))
          << x << ", " << y;
  const std::vector<Sample> samples = random_samples(rng_, mesh, 500);
  EXPECT_EQ(visible(context_, halves, samples), visible(context_, whole, samples));
}

TEST_F(DetailMaps, NearestTrianglesAndLinksAreTheReferences) {
  const TriMesh mesh = random_triangles(rng_, 60);
  const Camera viewpoint = test::random_camera(rng_, kBox, 40, 40);
  const Technique t = named("coverage", 20);
  const VisibilityMap map = render_map(context_, viewpoint, Geometry::of_mesh(mesh), t);
  const reference::Map expected(map.layout(), t, mesh);
  int different = 0, linked = 0;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) {
      auto links = expected.links_of(0, {x, y});
      linked += links.size() > 1;
      std::sort(links.begin(), links.end());
      different += links != map.triangles_at(context_, 0, {x, y});
    }
  EXPECT_GT(linked, 20);
  EXPECT_LE(different, 4);  // of 400: corners on a texel's border
}

TEST_F(DetailMaps, ListsAgreeWithRaysOnADenseMesh) {
  TriMesh mesh;  // a wavy sheet of triangles far smaller than a texel, before a plane
  const int n = 150;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k <= n; ++k) {
      const double y = 1.6 * i / n - 0.8, z = 1.6 * k / n - 0.8;
      mesh.positions.emplace_back(0.1 * std::sin(9 * y) * std::cos(7 * z), y, z);
    }
  for (std::uint32_t i = 0; i < std::uint32_t(n); ++i)
    for (std::uint32_t k = 0; k < std::uint32_t(n); ++k) {
      const std::uint32_t a = i * (n + 1) + k, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({b, d, c});
    }
  const Camera viewpoint = test::look_at({-3, 1, 0.5}, {0, 0, 0}, 70, 64, 64);
  const VisibilityMap map =
      render_map(context_, viewpoint, Geometry::of_mesh(mesh), named("lists", 48));
  const std::vector<Sample> samples = random_samples(rng_, mesh, 3000);
  const std::vector<float> found = visible(context_, map, samples);
  const RayScene rays(mesh);
  const std::vector<std::uint8_t> truth = visible_by_rays(rays, viewpoint, samples);
  int wrong = 0, seen = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    wrong += found[i] != float(truth[i]);
    seen += truth[i];
  }
  EXPECT_GT(seen, 800);
  EXPECT_LT(seen, 2800);
  EXPECT_LE(wrong, 9);  // 0.3 %
}

/// Voxels of random blobs, some bricks wholly inside.
SparseVolume random_volume(test::Rng& rng, double fill) {
  SparseVolume volume;
  volume.grid = {{0.5, -0.3, 0.2}, 0.05, {4, 3, 3}};
  const glm::ivec3 bricks = volume.grid.bricks;
  for (int z = 0; z < bricks.z; ++z)
    for (int y = 0; y < bricks.y; ++y)
      for (int x = 0; x < bricks.x; ++x) {
        const double kind = test::uniform(rng, 0, 1);
        if (kind < 0.3 || kind > 0.9) {
          volume.table.push_back(kind < 0.3 ? SparseVolume::kOutside : SparseVolume::kInside);
          continue;
        }
        volume.table.push_back(std::uint32_t(volume.bricks.size()));
        volume.bricks.emplace_back(x, y, z);
        for (int i = 0; i < kBrickVoxels; ++i)
          volume.distance.push_back(test::uniform(rng, 0, 1) < fill ? -1.0f : 1.0f);
      }
  return volume;
}

TEST_F(DetailMaps, MarchedAndRasterisedVoxelsAgreeWithTheVoxelWalk) {
  for (const double fill : {0.01, 0.1, 0.7}) {
    const SparseVolume volume = random_volume(rng_, fill);
    const Geometry geometry = Geometry::of_volume(volume);
    const VoxelRays rays(volume);
    for (const glm::dvec3& eye : {glm::dvec3(-1, 0.4, 0.9), glm::dvec3(1.3, 0.3, 0.8)}) {
      // From outside, and from within the volume.
      const Camera viewpoint = test::look_at(eye, {1.31, 0.32, 0.83}, 40, 32, 32);
      Technique t;
      t.resolution = 32;
      const std::vector<float> faces = render_map(context_, viewpoint, geometry, t).depths();
      t.march = true;
      const VisibilityMap marched = render_map(context_, viewpoint, geometry, t);
      const std::vector<float> march = marched.depths();
      int differ_march = 0, differ_faces = 0, hits = 0;
      for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) {
          const glm::dvec3 ray = viewpoint.ray({x, y});
          const auto t0 = rays.first(viewpoint.center(), ray, 1e9);
          const double z = t0 ? *t0 * glm::dot(ray, viewpoint.forward()) : INFINITY;
          const auto same = [&](float found, double bound) {
            return std::isinf(z) ? std::isinf(found) : std::abs(found - z) < bound;
          };
          hits += std::isfinite(z);
          differ_march += !same(march[std::size_t(y) * 32 + x], 1e-4);
          differ_faces += z > 1e-3 && !same(faces[std::size_t(y) * 32 + x], 1e-3);
        }
      EXPECT_GT(hits, 60);
      EXPECT_LE(differ_march, 5) << fill;
      EXPECT_LE(differ_faces, 12) << fill;
    }
  }
}

TEST_F(DetailMaps, VolumesThatAreEmptyOrBehindHideNothing) {
  SparseVolume empty;
  empty.grid = {{0, 0, 0}, 0.1, {2, 1, 1}};
  empty.table = {SparseVolume::kOutside, SparseVolume::kOutside};
  SparseVolume solid = empty;
  solid.table = {SparseVolume::kInside, SparseVolume::kInside};
  const Camera towards = test::look_at({-2, 0.3, 0.4}, {0, 0.3, 0.4}, 60, 64, 64);
  const Camera away = test::look_at({-2, 0.3, 0.4}, {-4, 0.3, 0.4}, 60, 64, 64);
  const auto seen = [&](const SparseVolume& volume, const Camera& viewpoint, bool march, double x) {
    Technique t;
    t.resolution = 32;
    t.march = march;
    const VisibilityMap map = render_map(context_, viewpoint, Geometry::of_volume(volume), t);
    const Sample sample{{x, 0.35, 0.35}, {-1, 0, 0}};
    return visible(context_, map, std::vector{sample})[0];
  };
  for (const bool march : {false, true}) {
    EXPECT_EQ(seen(empty, towards, march, 3), 1) << march;
    EXPECT_EQ(seen(solid, towards, march, 3), 0) << march;
    EXPECT_EQ(seen(solid, away, march, -3), 1) << march;
    EXPECT_EQ(seen(solid, away, march, 3), 0) << march;  // behind the viewpoint
  }
}

TEST_F(DetailMaps, ASingleVoxel) {
  SparseVolume volume;
  volume.grid = {{0, 0, 0}, 0.1, {1, 1, 1}};
  volume.table = {0};
  volume.bricks = {{0, 0, 0}};
  volume.distance.assign(kBrickVoxels, 1.0f);
  volume.distance[std::size_t(voxel_offset({3, 4, 5}))] = -1;
  const glm::dvec3 centre = volume.grid.world({3, 4, 5});
  const Geometry geometry = Geometry::of_volume(volume);
  EXPECT_EQ(geometry.triangles(), 12u);
  const Camera viewpoint = test::look_at(centre - glm::dvec3(2, 0, 0), centre, 300, 64, 64);
  for (Technique t : named_techniques()) {
    t.resolution = 64;
    t.bias_texels = std::min(t.bias_texels, 0.5);
    const VisibilityMap map = render_map(context_, viewpoint, geometry, t, viewpoint);
    const std::vector<Sample> samples{{centre - glm::dvec3(0.3, 0, 0), {-1, 0, 0}},
                                      {centre + glm::dvec3(0.3, 0, 0), {-1, 0, 0}},
                                      {centre + glm::dvec3(0.3, 0.19, 0), {-1, 0, 0}}};
    const std::vector<float> found = visible(context_, map, samples);
    EXPECT_EQ(found[0], 1) << t.name;
    EXPECT_LT(found[1], 1e-3) << t.name;  // variance bounds the share from above
    EXPECT_EQ(found[2], 1) << t.name;
  }
  Technique march;
  march.march = true;
  march.resolution = 64;
  for (const Bias bias : {Bias::kConstant, Bias::kIds}) {
    march.bias = bias;
    const VisibilityMap map = render_map(context_, viewpoint, geometry, march);
    const std::vector<Sample> samples{{centre - glm::dvec3(0.05, 0, 0), {-1, 0, 0}, {}, {}, 0},
                                      {centre + glm::dvec3(0.3, 0, 0), {-1, 0, 0}, {}, {}, 9}};
    EXPECT_THAT(visible(context_, map, samples), ::testing::ElementsAre(1, 0));
  }
}

TEST_F(DetailMaps, OptionsThatDoNotGoTogetherAreRefused) {
  const Geometry mesh = Geometry::of_mesh(random_triangles(rng_, 3));
  const Camera viewpoint = test::look_at({-3, 0, 0}, {0, 0, 0}, 60, 64, 64);
  const auto refuses = [&](const std::function<void(Technique&)>& change) {
    Technique t;
    change(t);
    EXPECT_THROW(render_map(context_, viewpoint, mesh, t), UsageError);
  };
  refuses([](Technique& t) { t.resolution = 0; });
  refuses([](Technique& t) { t.resolution = 100000; });
  refuses([](Technique& t) { t.bias_texels = -1; });
  refuses([](Technique& t) { t.filter = Filter::kPcf, t.filter_size = 8; });
  refuses([](Technique& t) { t.filter = Filter::kVariance, t.filter_size = 4; });
  refuses([](Technique& t) { t.partitions = 2; });
  refuses([](Technique& t) { t.march = true; });
  refuses([](Technique& t) { t.detail = Detail::kLists, t.filter = Filter::kPcf; });
  EXPECT_THROW(parse_technique("--visibility", "shadow"), UsageError);
}

}  // namespace
}  // namespace photohull::visibility
