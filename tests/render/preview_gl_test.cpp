#include "render/preview.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "render/bake_colour.h"
#include "render/meshes.h"
#include "render/rasterizer.h"
#include "support/gl_context.h"
#include "support/ray_cast.h"
#include "support/silhouettes.h"

namespace photohull {
namespace {

constexpr double kRadius = 1.0;
const glm::dvec3 kCentre{100, -40, 250};
const GridSpec kGrid{kCentre - 1.2, 0.025, {12, 12, 12}};

glm::dvec3 surface_colour(const glm::dvec3& p) { return test::noise_colour(p - kCentre, 0.3); }

/// A textured sphere before black.
glm::dvec3 trace(const glm::dvec3& eye, const glm::dvec3& ray) {
  const glm::dvec3 offset = eye - kCentre;
  const double b = glm::dot(offset, ray);
  const double d = b * b - glm::dot(offset, offset) + kRadius * kRadius;
  return d < 0 ? glm::dvec3(0) : surface_colour(eye + (-b - std::sqrt(d)) * ray);
}

std::vector<PreparedView> sphere_views(int count, int width, int height) {
  std::vector<PreparedView> views;
  for (const Camera& camera : test::cameras_around(kCentre, 5, count, 1.9 * height, width, height))
    views.push_back({"view", camera, test::ray_cast(camera, trace), {}});
  return views;
}

TriMesh baked_sphere(const std::vector<PreparedView>& views) {
  TriMesh mesh = test::sphere_mesh(kCentre, kRadius, 120);
  Progress silent;
  gpu::Context& context = test::gl_context();  // before the images need it
  const projtex::ImageSet images(views);
  const std::vector<Camera> cameras = projtex::cameras_of(views);
  bake_colour(context, kGrid, {images, cameras, 0.01}, render::Shaping::kPhotographs, mesh, silent);
  return mesh;
}

render::Window whole(const Camera& camera) {
  return {-0.5, -0.5, double(camera.intrinsics.width), double(camera.intrinsics.height), 3.5, 6.5};
}

TEST(Rasterizer, SilhouetteOfASphereIsItsProjection) {
  test::Rng rng(5);
  const TriMesh mesh = test::sphere_mesh(kCentre, kRadius, 200);
  render::Rasterizer rasterizer(test::gl_context(), mesh);
  for (int round = 0; round < 4; ++round) {
    const Box box{kCentre - kRadius, kCentre + kRadius};
    const Camera camera = test::random_camera(rng, box, 200, 150);
    render::Window window = whole(camera);
    window.near = 0.1;
    window.far = 30;
    const auto clay = rasterizer.draw(camera, window, 200, 150).clay;
    const test::Outline outline = test::sphere_outline(camera, kCentre, kRadius);
    int inside = 0;
    for (std::size_t i = 0; i < outline.distance.pixels.size(); ++i) {
      const float distance = outline.distance.pixels[i];
      if (std::abs(distance) < 1) continue;
      const std::uint8_t* p = &clay.rgb[3 * i];
      const bool background = p[0] == render::kBackground && p[1] == p[0] && p[2] == p[0];
      EXPECT_EQ(background, distance > 0) << "pixel " << i % 200 << ", " << i / 200;
      inside += distance < 0;
    }
    EXPECT_GT(inside, 100);
  }
}

TEST(Rasterizer, SideLightCastsShadowsOntoClay) {
  const glm::dvec3 light = glm::normalize(glm::dvec3(-0.66, -0.56, -0.5));
  const glm::dvec3 normal = glm::normalize(light - glm::dvec3(0, 0, 1));
  Camera camera;  // axes as the world's
  camera.intrinsics = {200, 200, 300, 300, 0, 99.5, 99.5};
  camera.cam_from_world.translation = glm::dvec3(0, 0, 6) - kCentre;
  render::Window window = whole(camera);
  window.near = 3, window.far = 9;
  const TriMesh ball = test::sphere_mesh(kCentre, kRadius, 100);
  TriMesh both = ball;
  const glm::dvec3 above = kRadius * normal + 0.5 * light;
  const TriMesh small = test::sphere_mesh(kCentre, 0.12, 30);
  const auto first = std::uint32_t(both.positions.size());
  for (const glm::vec3& p : small.positions) both.positions.push_back(p + glm::vec3(above));
  both.normals.insert(both.normals.end(), small.normals.begin(), small.normals.end());
  for (const auto& t : small.triangles)
    both.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const auto clay = [&](const TriMesh& mesh, const glm::dvec3& at) {
    const auto drawn =
        render::Rasterizer(test::gl_context(), mesh).draw(camera, window, 200, 200).clay;
    const glm::dvec3 h = camera.projection() * glm::dvec4(at, 1);
    const auto x = std::size_t(h.x / h.z + 0.5), y = std::size_t(h.y / h.z + 0.5);
    return double(drawn.rgb[3 * (200 * y + x)]);
  };
  const glm::dvec3 shaded = kCentre + kRadius * normal;
  EXPECT_LT(clay(both, shaded), 0.8 * clay(ball, shaded));
  const glm::dvec3 beside =
      kCentre + kRadius * glm::normalize(normal + 0.4 * glm::normalize(glm::cross(light, normal)));
  EXPECT_NEAR(clay(both, beside), clay(ball, beside), 2);
  EXPECT_GT(clay(ball, shaded), 150) << "a body does not shade itself where it faces the light";
}

/// A square of two triangles before the camera, each on a page of its own that is red or green in
/// its left half.
TexturedMesh square_of_two_pages() {
  TexturedMesh out;
  out.mesh.origin = kCentre;
  out.mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  out.mesh.normals.assign(4, {0, 0, -1});
  out.mesh.triangles = {{0, 3, 2}, {0, 2, 1}};
  for (const glm::ivec3& left : {glm::ivec3(255, 0, 0), glm::ivec3(0, 200, 0)}) {
    RgbImage page{64, 32, {}};
    for (int i = 0; i < 64 * 32; ++i)
      for (int c = 0; c < 3; ++c) page.rgb.push_back(std::uint8_t(i % 64 < 32 ? left[c] : 0));
    out.texture.pages.push_back(page);
  }
  const glm::vec2 places[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (std::size_t t = 0; t < 2; ++t) {
    out.texture.page.push_back(std::uint32_t(t));
    auto& corners = out.texture.corners.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) corners[c] = places[out.mesh.triangles[t][c]];
  }
  return out;
}

TEST(Rasterizer, ColoursAreTheTexturesWhereThereIsOne) {
  Camera camera;  // axes as the world's
  camera.intrinsics = {100, 100, 200, 200, 0, 49.5, 49.5};
  camera.cam_from_world.translation = glm::dvec3(0, 0, 6) - kCentre;
  render::Window window = whole(camera);
  window.near = 3, window.far = 9;
  render::Rasterizer rasterizer(test::gl_context(), square_of_two_pages());
  const RgbImage drawn =
      rasterizer.draw(camera, window, 100, 100, render::Look::kColours, {10, 20, 30});
  const auto at = [&](int x, int y) {
    const std::uint8_t* p = &drawn.rgb[3 * std::size_t(100 * y + x)];
    return std::array<int, 3>{p[0], p[1], p[2]};
  };
  using Pixel = std::array<int, 3>;
  // Below the diagonal from the first corner the first page, above it the second.
  EXPECT_EQ(at(25, 70), (Pixel{255, 0, 0}));
  EXPECT_EQ(at(40, 25), (Pixel{0, 200, 0}));
  EXPECT_EQ(at(75, 40), (Pixel{0, 0, 0})) << "the right half of both pages is black";
  EXPECT_EQ(at(5, 5), (Pixel{10, 20, 30})) << "the background";
  const RgbImage clay =
      rasterizer.draw(camera, window, 100, 100, render::Look::kClay, {10, 20, 30});
  EXPECT_NE(clay.rgb, drawn.rgb);
  EXPECT_EQ(rasterizer.draw(camera, window, 100, 100, render::Look::kClay, {10, 20, 30}).rgb,
            clay.rgb);
}

TEST(Preview, HasTheTexturesColours) {
  std::vector<PreparedView> views = sphere_views(1, 80, 60);
  views[0].camera.cam_from_world = {};
  views[0].camera.cam_from_world.translation = glm::dvec3(0, 0, 6) - kCentre;
  const RgbImage page = render_preview(test::gl_context(), square_of_two_pages(), views);
  std::size_t red = 0;
  for (std::size_t i = 0; i < page.rgb.size(); i += 3)
    red += page.rgb[i] == 255 && page.rgb[i + 1] == 0 && page.rgb[i + 2] == 0;
  EXPECT_GT(red, page.rgb.size() / 3 / 40);
}

/// Root mean square of the difference in bytes between a rendering and a photograph that is moved
/// by `dx` pixels, well inside the sphere.
double difference(const RgbImage& rendering, const PreparedView& view, int dx) {
  const test::Outline outline = test::sphere_outline(view.camera, kCentre, kRadius);
  double sum = 0;
  int count = 0;
  for (int y = 0; y < rendering.height; ++y)
    for (int x = 2; x < rendering.width - 2; ++x) {
      const std::size_t i = std::size_t(y) * rendering.width + x;
      if (outline.distance.pixels[i] > -12) continue;
      for (int c = 0; c < 3; ++c) {
        const double d = double(rendering.rgb[3 * i + c]) - view.image.bytes[4 * (i + dx) + c];
        sum += d * d;
        ++count;
      }
    }
  return std::sqrt(sum / count);
}

TEST(Rasterizer, BakedColoursLieWhereThePhotographsHaveThem) {
  const std::vector<PreparedView> views = sphere_views(12, 240, 180);
  const TriMesh mesh = baked_sphere(views);
  render::Rasterizer rasterizer(test::gl_context(), mesh);
  for (const PreparedView& view : views) {
    const auto drawn = rasterizer.draw(view.camera, whole(view.camera), 240, 180).coloured;
    const double aligned = difference(drawn, view, 0);
    EXPECT_LT(aligned, 8);
    EXPECT_LT(aligned, 0.7 * difference(drawn, view, 1));
    EXPECT_LT(aligned, 0.7 * difference(drawn, view, -1));
  }
}

TEST(Preview, ShowsPhotographColourAndClayThenOtherViews) {
  const std::vector<PreparedView> views = sphere_views(12, 120, 90);
  const TriMesh mesh = baked_sphere(views);
  PreviewOptions options;
  options.panel_edge = 90;
  const RgbImage page = render_preview(test::gl_context(), mesh, views, options);
  ASSERT_EQ(page.rgb.size(), std::size_t(page.width) * page.height * 3);
  EXPECT_GT(page.width, 200);
  EXPECT_LE(page.width, 3 * 90 + 16);
  EXPECT_GT(page.height, 90);
  // The middles of the first two panels show the same point of the sphere.
  const int panel = (page.width - 16) / 3;
  double photograph = 0, coloured = 0;
  for (int dy = -3; dy <= 3; ++dy)
    for (int dx = -3; dx <= 3; ++dx) {
      const std::size_t at = std::size_t(panel / 2 + dy) * page.width + panel / 2 + dx;
      photograph += page.rgb[3 * at] / 49.0;
      coloured += page.rgb[3 * (at + panel + 8)] / 49.0;
    }
  EXPECT_NEAR(photograph, coloured, 8);
}

TEST(Preview, OfAnEmptyMeshIsThePhotograph) {
  const std::vector<PreparedView> views = sphere_views(1, 80, 60);
  PreviewOptions options;
  options.panel_edge = 80;
  const RgbImage page = render_preview(test::gl_context(), TriMesh{}, views, options);
  ASSERT_EQ(page.width, 80);
  ASSERT_EQ(page.height, 60);
  for (std::size_t i = 0; i < 80 * 60; ++i)
    for (int c = 0; c < 3; ++c) ASSERT_EQ(page.rgb[3 * i + c], views[0].image.bytes[4 * i + c]);
}

TEST(Preview, OneViewAndNoColours) {
  const std::vector<PreparedView> views = sphere_views(1, 80, 60);
  const TriMesh mesh = test::sphere_mesh(kCentre, kRadius, 20);
  const RgbImage page = render_preview(test::gl_context(), mesh, views);
  EXPECT_LE(page.height, 120) << "there is no other viewpoint to show";
  EXPECT_GT(page.width, page.height);
}

TEST(Preview, CameraInsideTheMesh) {
  std::vector<PreparedView> views = sphere_views(1, 80, 60);
  views[0].camera = test::look_at(kCentre, kCentre + glm::dvec3(1, 0, 0), 50, 80, 60);
  const TriMesh mesh = test::sphere_mesh(kCentre, kRadius, 20);
  const RgbImage page = render_preview(test::gl_context(), mesh, views);
  EXPECT_GT(page.width, 0);
}

}  // namespace
}  // namespace photohull
