#include "texture/texture_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <bit>

#include "core/error.h"
#include "scenes.h"
#include "texture/surface.h"

namespace photohull::texture {
namespace {

const glm::dvec3 kMagenta(1, 0, 1), kGreen(0.2, 0.6, 0.15), kRed(0.7, 0.05, 0.02),
    kBlue(0.02, 0.1, 0.7);

std::vector<PreparedView> photographs(const std::vector<Sphere>& spheres,
                                      const std::vector<Camera>& cameras,
                                      const std::vector<double>& gains = {1}) {
  std::vector<PreparedView> views;
  for (std::size_t i = 0; i < cameras.size(); ++i)
    views.push_back(photograph(spheres, cameras[i], kMagenta, gains[i % gains.size()]));
  return views;
}

std::vector<Camera> cameras(int count = 12, int size = 120) {
  return test::cameras_around({0, 0, 0}, 5, count, 2.2 * size, size, size);
}

Sphere noisy() {
  return {{0, 0, 0}, 1, [](const glm::dvec3& p) { return 0.6 * test::noise_colour(p, 0.25); }};
}

TextureResult textured(const TriMesh& mesh, const std::vector<PreparedView>& views, int edge = 0) {
  Progress progress;
  return texture_mesh(mesh, mesh, views, {.edge = edge}, progress);
}

/// Of all texels of all pages, also of those beyond charts.
double most_apart(const MeshTexture& texture, const glm::dvec3& colour) {
  double most = 0;
  for (const RgbImage& page : texture.pages)
    for (std::size_t i = 0; i < page.rgb.size(); i += 3)
      for (std::size_t c = 0; c < 3; ++c)
        most = std::max(
            most, std::abs(page.rgb[i + c] - 255 * srgb_from_linear(colour[glm::length_t(c)])));
  return most;
}

TEST(TextureMesh, NoTexelHasTheBackgroundsColour) {
  const Sphere sphere{{0, 0, 0}, 1, plain(kGreen)};
  const auto views = photographs({sphere}, cameras());
  // The mesh is right, or larger than the object by half a pixel.
  for (const double grown : {1.0, 1.01}) {
    const TextureResult made = textured(mesh_of(sphere, 4, grown), views);
    EXPECT_LT(most_apart(made.texture, kGreen), 2) << grown;
    EXPECT_LT(made.report.filled, made.report.texels / 50) << grown;
    EXPECT_EQ(made.report.unseen_share, 0) << grown;
  }
}

TEST(TextureMesh, WhatStandsBeforeDoesNotShowOnWhatIsBehind) {
  const Sphere near{{0, 0, 1.8}, 0.35, plain(kRed)}, far{{0, 0, 0}, 1, plain(kBlue)};
  std::vector<Camera> from;
  for (int i = 0; i < 7; ++i)
    from.push_back(test::look_at({1.5 * std::sin(i), 1.5 * std::cos(2.0 * i), 6}, {0, 0, 0.5}, 250,
                                 140, 140, {0, -1, 0}));
  const TriMesh mesh = joined(mesh_of(far, 4), mesh_of(near, 3));
  const TextureResult made = textured(mesh, photographs({near, far}, from));
  const std::size_t first_near = mesh_of(far, 4).triangles.size();
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (const glm::dvec3& w : {glm::dvec3(1, 0, 0), glm::dvec3(0.2, 0.4, 0.4)})
      ASSERT_LT(codes_apart(colour_at(made.texture, f, w), f < first_near ? kBlue : kRed), 3) << f;
  EXPECT_GT(made.report.unseen_share, 0.3);  // the far sides
  EXPECT_LT(made.report.unseen_share, 0.7);
}

TEST(TextureMesh, TexelsAreThePhotographsPixels) {
  const Sphere sphere = noisy();
  const TriMesh mesh = mesh_of(sphere, 4);
  const TextureResult made = textured(mesh, photographs({sphere}, cameras(20, 200)));
  double squared = 0, of_vertices = 0, count = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto& [a, b, c] = mesh.triangles[f];
    const glm::dvec3 truth = sphere.colour(
        glm::normalize(glm::dvec3(mesh.positions[a] + mesh.positions[b] + mesh.positions[c])));
    const glm::vec3 mean = (mesh.colours[a] + mesh.colours[b] + mesh.colours[c]) / 3.0f;
    squared += std::pow(codes_apart(colour_at(made.texture, f, glm::dvec3(1.0 / 3)), truth), 2);
    of_vertices += std::pow(codes_apart(mean, truth), 2);
    ++count;
  }
  EXPECT_LT(std::sqrt(squared / count), 4);
  EXPECT_LT(squared, of_vertices);
  EXPECT_EQ(made.report.scale, 1);
}

/// Root mean squares of what colours differ by over a texel: across the borders of charts, and
/// beside them.
std::pair<double, double> steps(const TriMesh& mesh, const MeshTexture& texture) {
  const auto neighbours = neighbours_of(mesh);
  double across = 0, beside = 0;
  const auto squared = [](const glm::vec3& a, const glm::vec3& b) {
    return std::pow(codes_apart(a, b), 2);
  };
  const auto corner = [&](std::size_t face, std::uint32_t vertex) {
    const auto& t = mesh.triangles[face];
    return int(std::find(t.begin(), t.end(), vertex) - t.begin());
  };
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t other = neighbours[f][std::size_t(i)];
      const std::uint32_t a = mesh.triangles[f][std::size_t(i)],
                          b = mesh.triangles[f][std::size_t((i + 1) % 3)];
      const int oa = corner(other, a), ob = corner(other, b);
      const bool border = glm::distance(texture.corners[f][std::size_t(i)],
                                        texture.corners[other][std::size_t(oa)]) > 1e-6f;
      if (!border || other < f) continue;
      // Colours at 0.1 and 0.3 of both triangles' heights over the middle of the side.
      const auto at = [&](std::size_t face, int u, int v, double h) {
        glm::dvec3 w(h);
        w[u] = w[v] = 0.5 * (1 - h);
        return colour_at(texture, face, w);
      };
      const int j = (i + 1) % 3;
      across += squared(at(f, i, j, 0.1), at(other, oa, ob, 0.1));
      beside += 0.5 * (squared(at(f, i, j, 0.1), at(f, i, j, 0.3)) +
                       squared(at(other, oa, ob, 0.1), at(other, oa, ob, 0.3)));
    }
  return {std::sqrt(across), std::sqrt(beside)};
}

TEST(TextureMesh, StepsAcrossSeamsAreThoseBesideThem) {
  const Sphere sphere = noisy();
  const TriMesh mesh = mesh_of(sphere, 4);
  // Exposures differ by a tenth.
  const TextureResult made =
      textured(mesh, photographs({sphere}, cameras(14, 160), {0.95, 1.05, 1, 0.97}));
  const auto [across, beside] = steps(mesh, made.texture);
  EXPECT_GT(beside, 0);
  EXPECT_LT(across, 1.3 * beside);
  RecordProperty("across", std::to_string(across));
  RecordProperty("beside", std::to_string(beside));
}

/// Sum of squared differences between texels side by side, codes.
double sharpness(const MeshTexture& texture) {
  double sum = 0;
  for (const RgbImage& page : texture.pages)
    for (std::size_t i = 3; i < page.rgb.size(); ++i)
      if (i % (3 * std::size_t(page.width)) >= 3)
        sum += std::pow(double(page.rgb[i]) - page.rgb[i - 3], 2);
  return sum;
}

Sphere fine_noise() {
  return {{0, 0, 0}, 1, [](const glm::dvec3& p) { return 0.6 * test::noise_colour(p, 0.04); }};
}

TEST(TextureMesh, DetailIsMultiplied) {
  const Sphere sphere = fine_noise();
  const TriMesh mesh = mesh_of(sphere, 4);
  const auto views = photographs({sphere}, cameras(8, 120));
  const auto sharpness_at = [&](double detail) {
    Progress progress;
    return sharpness(texture_mesh(mesh, mesh, views, {.detail = detail}, progress).texture);
  };
  const double none = sharpness_at(0), plain = sharpness_at(1), more = sharpness_at(1.5);
  EXPECT_LT(none, 0.5 * plain);
  EXPECT_GT(more, 1.5 * plain);
  EXPECT_LT(more, 2.25 * plain);
}

TEST(TextureMesh, WhatPhotographsDoNotAgreeOnIsTheirMean) {
  const Sphere sphere = fine_noise();
  const TriMesh mesh = mesh_of(sphere, 4);
  const std::vector<Camera> around = cameras(16, 120);
  std::vector<PreparedView> views;
  for (const Camera& camera : around) {
    const glm::dvec3 elsewhere(10.0 * double(views.size()));
    const auto noise = [&](const glm::dvec3& p) {
      return 0.6 * test::noise_colour(p + elsewhere, 0.04);
    };
    views.push_back(photograph({{{0, 0, 0}, 1, noise}}, camera, kMagenta));
  }
  const double agreeing = sharpness(textured(mesh, photographs({sphere}, around)).texture);
  const double apart = sharpness(textured(mesh, views).texture);
  RecordProperty("share", std::to_string(apart / agreeing));
  EXPECT_LT(apart, 0.6 * agreeing);
}

TEST(TextureMesh, TheSameBytesFromAnyNumberOfThreads) {
  const Sphere sphere = noisy();
  const TriMesh mesh = mesh_of(sphere, 3);
  const auto views = photographs({sphere}, cameras(8, 80));
  const TextureResult many = textured(mesh, views);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const TextureResult single = textured(mesh, views);
  ASSERT_EQ(many.texture.pages.size(), single.texture.pages.size());
  EXPECT_EQ(many.texture.pages[0].rgb, single.texture.pages[0].rgb);
  EXPECT_EQ(many.texture.corners, single.texture.corners);
}

TEST(TextureMesh, AnEdgeMakesOnePageWithCoarserTexels) {
  const Sphere sphere = noisy();
  const TriMesh mesh = mesh_of(sphere, 3);
  const auto views = photographs({sphere}, cameras(8, 160));
  const TextureReport fine = textured(mesh, views).report;
  const TextureResult coarse = textured(mesh, views, 128);
  EXPECT_EQ(coarse.report.pages, 1);
  EXPECT_LE(std::max(coarse.report.width, coarse.report.height), 128);
  EXPECT_LT(coarse.report.scale, fine.scale);
  EXPECT_LT(coarse.report.texels, fine.texels);
  double squared = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto& [a, b, c] = mesh.triangles[f];
    squared += std::pow(
        codes_apart(colour_at(coarse.texture, f, glm::dvec3(1.0 / 3)),
                    sphere.colour(glm::normalize(
                        glm::dvec3(mesh.positions[a] + mesh.positions[b] + mesh.positions[c])))),
        2);
  }
  EXPECT_LT(std::sqrt(squared / double(mesh.triangles.size())), 20);
}

TEST(TextureMesh, ManyTexelsTakeManyPages) {
  const Sphere sphere{{0, 0, 0}, 1, plain(kGreen)};
  const TriMesh mesh = mesh_of(sphere, 3);
  Progress progress;
  const TextureResult made = texture_mesh(mesh, mesh, photographs({sphere}, cameras(10, 160)),
                                          {.page_edge = 128}, progress);
  EXPECT_GT(made.report.pages, 1);
  EXPECT_EQ(made.report.pages, std::int64_t(made.texture.pages.size()));
  EXPECT_EQ(made.report.width, 128);
  EXPECT_EQ(made.report.scale, 1);
  EXPECT_LT(most_apart(made.texture, kGreen), 2);
  std::vector<int> used(made.texture.pages.size());
  for (const std::uint32_t page : made.texture.page) ++used.at(page);
  EXPECT_THAT(used, testing::Each(testing::Gt(0)));
}

TEST(TextureMesh, ATriangleLargerThanAPageMakesTexelsCoarser) {
  TriMesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  mesh.normals.assign(3, glm::vec3(0, 0, 1));
  mesh.colours.assign(3, glm::vec3(kGreen));
  mesh.triangles = {{0, 1, 2}};
  PreparedView view;
  view.camera = test::look_at({0, 0, 5}, {0, 0, 0}, 500, 240, 240, {0, -1, 0});
  view.image = test::ray_cast(
      view.camera, [](const glm::dvec3&, const glm::dvec3&) { return kGreen; }, 1);
  Progress progress;
  const TextureResult made =
      texture_mesh(mesh, mesh, std::vector{view}, {.page_edge = 128}, progress);
  EXPECT_LT(made.report.scale, 1);
  EXPECT_EQ(made.report.pages, 1);
  EXPECT_LT(most_apart(made.texture, kGreen), 2);
}

TEST(TextureMesh, CornersLieOnTheirPages) {
  const Sphere sphere = noisy();
  const TriMesh mesh = mesh_of(sphere, 3);
  const MeshTexture texture = textured(mesh, photographs({sphere}, cameras(8, 80))).texture;
  ASSERT_EQ(texture.corners.size(), mesh.triangles.size());
  for (const auto& corners : texture.corners)
    for (const glm::vec2& at : corners) {
      EXPECT_TRUE(glm::all(glm::greaterThan(at, glm::vec2(0))));
      EXPECT_TRUE(glm::all(glm::lessThan(at, glm::vec2(1))));
    }
  for (const RgbImage& page : texture.pages) {
    EXPECT_TRUE(std::has_single_bit(unsigned(page.width)));
    EXPECT_TRUE(std::has_single_bit(unsigned(page.height)));
  }
}

TEST(TextureMesh, WhatNoPhotographShowsHasTheVerticesColours) {
  const Sphere sphere{{0, 0, 0}, 1, plain(kGreen)};
  const TriMesh mesh = mesh_of(sphere, 2);
  const Camera away = test::look_at({5, 0, 0}, {10, 0, 0}, 100, 50, 50);
  const TextureResult made = textured(mesh, photographs({sphere}, {away}));
  EXPECT_EQ(made.report.unseen_share, 1);
  EXPECT_EQ(made.report.filled, made.report.texels);
  EXPECT_EQ(made.report.views, 0);
  EXPECT_LT(most_apart(made.texture, kGreen), 2);
}

TEST(TextureMesh, BearsDegenerateTriangles) {
  const Sphere sphere{{0, 0, 0}, 1, plain(kGreen)};
  TriMesh mesh = mesh_of(sphere, 2);
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({2, 2, 2});
  mesh.triangles.push_back(mesh.triangles[5]);
  const auto views = photographs({sphere}, cameras(8, 80));
  EXPECT_LT(most_apart(textured(mesh, views).texture, kGreen), 2);
  TriMesh one = mesh;
  one.triangles.resize(1);
  EXPECT_LT(most_apart(textured(one, views).texture, kGreen), 2);
}

TEST(TextureMesh, RefusesWhatCannotBe) {
  const Sphere sphere{{0, 0, 0}, 1, plain(kGreen)};
  const auto views = photographs({sphere}, cameras(2, 40));
  EXPECT_THROW(textured({}, views), Error);
  for (const int edge : {-4, 1, 100, 64, 300})
    EXPECT_THAT([&] { textured(mesh_of(sphere, 1), views, edge); },
                testing::ThrowsMessage<UsageError>(testing::HasSubstr("a power of two")))
        << edge;
}

}  // namespace
}  // namespace photohull::texture
