// The splatting kernel against its reference.
#include "visibility/kernels/depth_maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/cameras.h"
#include "support/gl_context.h"

namespace photohull::visibility {
namespace {

using glm::ivec3;
using projtex::GridCamera;

class DepthMapsTest : public ::testing::Test {
 protected:
  void TearDown() override { context_.check_errors("depth maps test"); }

  std::vector<GridCamera> random_cameras(int count) {
    std::vector<GridCamera> cameras;
    for (int i = 0; i < count; ++i)
      cameras.push_back(projtex::to_grid(
          test::random_camera(rng_, grid_.bounds(), 60 + 10 * i, 40 + 7 * i), grid_));
    return cameras;
  }

  GridCamera look(const glm::dvec3& eye, const glm::dvec3& target, double focal = 60) const {
    return projtex::to_grid(test::look_at(grid_.world(eye), grid_.world(target), focal, 80, 64),
                            grid_);
  }

  /// Is it certain which texels the voxel touches, in single precision too?
  static bool decidable(const GridCamera& camera, const shaders::DepthMapInfo& info,
                        const ivec3& voxel) {
    const glm::dvec3 p = camera.projection * glm::dvec4(voxel, 1);
    if (std::abs(p.z - 1) < 1e-3) return false;
    if (p.z < 1) return true;
    const double half = 0.5 * camera.focal / p.z * info.scale.x;
    for (int i = 0; i < 2; ++i)
      for (const double side : {-half, half}) {
        const double edge = (p[i] / p.z + 0.5) * info.scale.x + side;
        if (std::abs(edge - std::round(edge)) < 1e-3) return false;
      }
    return true;
  }

  std::vector<ivec3> random_voxels(int count, const std::vector<GridCamera>& cameras) {
    const DepthMaps maps(cameras, grid_);
    std::vector<ivec3> voxels;
    while (int(voxels.size()) < count) {
      const ivec3 voxel(test::uniform_in(rng_, {glm::dvec3(0), glm::dvec3(grid_.voxels())}));
      bool ok = true;
      for (std::size_t i = 0; i < cameras.size(); ++i)
        ok = ok && decidable(cameras[i], maps.infos()[i], voxel);
      if (ok) voxels.push_back(voxel);
    }
    return voxels;
  }

  void splat(DepthMaps& maps, const std::vector<GridCamera>& cameras,
             const std::vector<ivec3>& voxels) {
    glm::ivec2 size(1);
    std::vector<shaders::GpuView> views;
    for (const GridCamera& c : cameras) views.push_back(to_gpu_view(c, size));
    std::vector<glm::ivec4> list{{int(voxels.size()), 0, 0, 0}};
    for (const ivec3& voxel : voxels) list.emplace_back(voxel, 0);
    const gpu::Buffer view_buffer = gpu::Buffer::of(views), list_buffer = gpu::Buffer::of(list);
    view_buffer.bind_storage(shaders::kViewsBinding);
    maps.splat(context_, list_buffer, voxels.size());
  }

  /// Draws the voxels both ways and compares every texel; returns how many texels were drawn.
  int compare(const std::vector<GridCamera>& cameras, const std::vector<ivec3>& voxels) {
    DepthMaps maps(cameras, grid_);
    splat(maps, cameras, voxels);
    int drawn = 0;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const std::vector<float> found = maps.download(i);
      std::vector<double> expected(found.size(), std::numeric_limits<double>::infinity());
      for (const ivec3& voxel : voxels)
        reference::splat_voxel(cameras[i], maps.infos()[i], voxel, expected);
      for (std::size_t texel = 0; texel < found.size(); ++texel) {
        if (std::isinf(expected[texel])) {
          EXPECT_TRUE(std::isinf(found[texel])) << "map " << i << ", texel " << texel;
          continue;
        }
        ++drawn;
        EXPECT_NEAR(found[texel], expected[texel], 1e-5 * (64 + expected[texel]))
            << "map " << i << ", texel " << texel;
      }
    }
    return drawn;
  }

  gpu::Context& context_ = test::gl_context();
  test::Rng rng_{21};
  GridSpec grid_{{3, 4, -5}, 0.1, {4, 3, 2}};
};

TEST_F(DepthMapsTest, WhatOtherMapsHoldIsDrawnInTheirUnit) {
  const std::vector<GridCamera> cameras = random_cameras(3);
  std::vector<DepthMap> others;
  for (const GridCamera& camera : cameras) {
    DepthMap& map = others.emplace_back();
    map.size = {camera.width / 3 + 1, camera.height / 3 + 1};  // coarser texels
    map.texels_per_pixel = 1 / 3.0f;
    for (int i = 0; i < map.size.x * map.size.y; ++i)
      map.depths.push_back(i % 5 == 0 ? std::numeric_limits<float>::infinity()
                                      : 1 + 0.125f * float(i % 97));
  }
  DepthMaps maps(cameras, grid_);
  maps.draw(others, 4);
  for (std::size_t v = 0; v < cameras.size(); ++v) {
    const DepthMap drawn = maps.map(v);
    for (int y = 0; y < drawn.size.y; ++y)
      for (int x = 0; x < drawn.size.x; ++x) {
        const glm::dvec2 pixel = (glm::dvec2(x, y) + 0.5) / double(drawn.texels_per_pixel) - 0.5;
        ASSERT_EQ(drawn.at(pixel), 4 * others[v].at(pixel)) << v << ' ' << x << ' ' << y;
      }
  }
  // What is drawn later lies before it, or behind.
  const std::vector<ivec3> voxels = random_voxels(200, cameras);
  DepthMaps alone(cameras, grid_), both(cameras, grid_);
  alone.draw(context_, cameras, voxels);
  both.draw(others, 4);
  both.draw(context_, cameras, voxels);
  for (std::size_t v = 0; v < cameras.size(); ++v) {
    const std::vector<float> under = maps.download(v), over = alone.download(v),
                             found = both.download(v);
    for (std::size_t i = 0; i < found.size(); ++i) ASSERT_EQ(found[i], std::min(under[i], over[i]));
  }
}

TEST_F(DepthMapsTest, RandomVoxelsFromRandomCameras) {
  for (int trial = 0; trial < 5; ++trial) {
    const std::vector<GridCamera> cameras = random_cameras(6);
    EXPECT_GT(compare(cameras, random_voxels(300, cameras)), 1000);
  }
}

TEST_F(DepthMapsTest, MapsThatNoStorageBlockHoldsAreTheSameInAnImage) {
  gpu::Limits low = context_.limits();
  low.ssbo_bytes = 8192;
  const std::vector<GridCamera> cameras = random_cameras(6);
  const std::vector<ivec3> voxels = random_voxels(300, cameras);
  DepthMaps buffer(cameras, grid_);
  splat(buffer, cameras, voxels);
  gpu::set_current_limits(&low);
  EXPECT_GT(compare(cameras, voxels), 1000);
  DepthMaps image(cameras, grid_);
  splat(image, cameras, voxels);
  gpu::set_current_limits(&context_.limits());
  EXPECT_STREQ(buffer.defines(), "");
  EXPECT_STREQ(image.defines(), "#define DEPTH_MAPS_LAYERED\n");
  for (std::size_t i = 0; i < cameras.size(); ++i) EXPECT_EQ(image.download(i), buffer.download(i));
  image.clear();
  for (const float depth : image.download(2)) EXPECT_TRUE(std::isinf(depth));
}

/// As many voxels as several work groups take, by cameras in a storage block and as uniforms.
TEST_F(DepthMapsTest, CamerasAsUniformsDrawTheSame) {
  const std::vector<GridCamera> cameras = random_cameras(6);
  const std::vector<ivec3> voxels = random_voxels(2500, cameras);
  EXPECT_GT(compare(cameras, voxels), 1000);
  DepthMaps stored(cameras, grid_), uniform(cameras, grid_);
  splat(stored, cameras, voxels);
  uniform.draw(context_, cameras, voxels);
  for (std::size_t i = 0; i < cameras.size(); ++i)
    EXPECT_EQ(uniform.download(i), stored.download(i));
}

TEST_F(DepthMapsTest, AnEmptyListDrawsNothing) { EXPECT_EQ(compare(random_cameras(3), {}), 0); }

TEST_F(DepthMapsTest, ASingleVoxel) {
  const std::vector<GridCamera> cameras = random_cameras(6);
  EXPECT_GE(compare(cameras, random_voxels(1, cameras)), 6);
}

TEST_F(DepthMapsTest, VoxelsBehindTheCameraOrOffItsMapDrawNothing) {
  const std::vector<GridCamera> cameras{look({-20, 12, 8}, {-60, 12, 8}),
                                        look({-20, 12, 8}, {-20, 12, 900})};
  EXPECT_EQ(compare(cameras, random_voxels(100, cameras)), 0);
}

TEST_F(DepthMapsTest, ViewpointsInsideTheVolume) {
  const std::vector<GridCamera> cameras{look({16.3, 12.2, 8.1}, {30, 13, 9}),
                                        look({2.2, 20.4, 3.3}, {31, 3, 14}, 20),
                                        look({12.5, 12.5, 8.5}, {12.5, 2, 8.4}, 300)};
  EXPECT_GT(compare(cameras, random_voxels(400, cameras)), 1000);
}

TEST_F(DepthMapsTest, ClearForgetsEverything) {
  const std::vector<GridCamera> cameras = random_cameras(2);
  DepthMaps maps(cameras, grid_);
  splat(maps, cameras, random_voxels(50, cameras));
  maps.clear();
  for (std::size_t i = 0; i < 2; ++i)
    for (const float depth : maps.download(i)) EXPECT_TRUE(std::isinf(depth));
}

TEST_F(DepthMapsTest, TexelsAreAboutAVoxelAndNeverFinerThanPixels) {
  // From very close, from afar, and from behind the grid's centre.
  const std::vector<GridCamera> cameras{look({-100, 12, 8}, {16, 12, 8}, 4000),
                                        look({-100, 12, 8}, {16, 12, 8}, 30),
                                        look({-100, 12, 8}, {-300, 12, 8})};
  const DepthMaps maps(cameras, grid_);
  EXPECT_NEAR(maps.infos()[0].scale.x, 115.5 / 4000, 1e-3);
  EXPECT_EQ(maps.infos()[1].scale.x, 1);
  EXPECT_EQ(maps.infos()[2].scale.x, 1);
  int texels = 0;
  for (const shaders::DepthMapInfo& info : maps.infos()) {
    EXPECT_EQ(info.size.z, texels);
    EXPECT_GE(info.size.x * info.size.y, 1);
    texels += info.size.x * info.size.y;
  }
}

TEST_F(DepthMapsTest, TexelsAreTheSameWhereverPhotographsAreCut) {
  constexpr int kCut = 32;
  const GridCamera camera = look({-40, 12, 8}, {16, 12, 8}, 300);
  GridCamera cut = camera;  // without its first columns
  cut.width -= kCut;
  for (int column = 0; column < 4; ++column)
    cut.projection[column].x -= kCut * cut.projection[column].z;
  std::vector<ivec3> voxels;
  for (int y = 0; y < 24; ++y)
    for (int z = 0; z < 16; ++z) voxels.push_back({10 + y / 3, y, z});
  const auto drawn = [&](const GridCamera& c) {
    DepthMaps maps(std::span(&c, 1), grid_, kCut);
    maps.draw(context_, std::span(&c, 1), voxels);
    return maps.map(0);
  };
  const DepthMap whole = drawn(camera), part = drawn(cut);
  const double plain = double(DepthMaps(std::span(&camera, 1), grid_).infos()[0].scale.x);
  EXPECT_LT(double(whole.texels_per_pixel), plain);
  EXPECT_GT(double(whole.texels_per_pixel), plain - 1.0 / kCut);
  EXPECT_EQ(part.texels_per_pixel, whole.texels_per_pixel);
  const int gone = int(std::lround(kCut * whole.texels_per_pixel));
  EXPECT_NEAR(gone, kCut * double(whole.texels_per_pixel), 1e-6);
  int seen = 0;
  for (int y = 0; y < part.size.y; ++y)
    for (int x = 0; x < part.size.x; ++x) {
      const float a = part.depths[std::size_t(y * part.size.x + x)],
                  b = whole.depths[std::size_t(y * whole.size.x + x + gone)];
      seen += std::isfinite(b);
      EXPECT_TRUE(a == b || std::abs(a - b) < 1e-4f) << x << ' ' << y;
    }
  EXPECT_GT(seen, 20);
}

TEST_F(DepthMapsTest, AWallHidesWhatIsBehindIt) {
  const std::vector<GridCamera> cameras{look({-40, 12, 8}, {16, 12, 8}, 70)};
  std::vector<ivec3> wall;
  for (int y = 0; y < 24; ++y)
    for (int z = 0; z < 16; ++z) wall.push_back({10, y, z});
  DepthMaps maps(cameras, grid_);
  splat(maps, cameras, wall);
  const std::vector<float> map = maps.download(0);
  const std::vector<double> depths(map.begin(), map.end());
  const auto sees = [&](const glm::dvec3& point) {
    return reference::visible(cameras[0], maps.infos()[0], point, 2.5, depths);
  };
  for (int y = 4; y < 20; ++y)
    for (int z = 4; z < 12; ++z) {
      EXPECT_TRUE(sees({10, y, z}));
      EXPECT_TRUE(sees({2, y, z}));
      EXPECT_FALSE(sees({15, y, z}));
    }
}

}  // namespace
}  // namespace photohull::visibility
