// What the report's page gets of a result.
#include "pipeline/show_result.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/analytic_volumes.h"
#include "volume/extract_mesh.h"

namespace photohull::pipeline {
namespace {

TriMesh ball(double radius) {
  TriMesh mesh = extract_mesh(sample_volume(
      glm::ivec3(int(radius / 4) + 2),
      [=](const glm::dvec3& p) { return glm::length(p - (radius + 4)) - radius; }, glm::dvec3(0),
      1));
  mesh.confidence.assign(mesh.positions.size(), 0.5f);
  return mesh;
}

/// Photographs of noise, of which little can be made smaller.
std::vector<PreparedView> noisy_views(int count, int width, int height) {
  std::vector<PreparedView> views;
  std::uint32_t state = 1;
  for (int i = 0; i < count; ++i) {
    PreparedView view;
    view.name = std::to_string(i);
    view.camera.intrinsics = {width, height, 100, 100, 0, 50, 50};
    view.image.width = width;
    view.image.height = height;
    for (int p = 0; p < 4 * width * height; ++p)
      view.image.bytes.push_back(std::uint8_t((state = 1664525 * state + 1013904223) >> 24));
    views.push_back(view);
  }
  return views;
}

SeenVertices seen_of(const TriMesh& mesh) {
  return {std::vector<float>(mesh.positions.size(), 3),
          std::vector<float>(mesh.positions.size(), 0.1f)};
}

std::size_t picture_bytes(const page::Shown& shown) {
  std::size_t bytes = 0;
  for (const page::ShownView& view : shown.views) bytes += view.jpeg.size();
  return bytes;
}

TEST(ShowResult, PicturesTakeNoMoreThanTheyMay) {
  const TriMesh mesh = ball(6);
  for (const int count : {1, 3, 60, 150}) {
    const page::Shown shown = show_result(mesh, seen_of(mesh), noisy_views(count, 200, 120));
    ASSERT_EQ(int(shown.views.size()), count);
    EXPECT_LE(picture_bytes(shown), kPictureBytes) << count;
    for (const page::ShownView& view : shown.views) EXPECT_FALSE(view.jpeg.empty());
  }
}

TEST(ShowResult, OfVeryManyViewsSomeHaveNoPicture) {
  const TriMesh mesh = ball(6);
  const page::Shown shown = show_result(mesh, seen_of(mesh), noisy_views(600, 60, 40));
  int pictured = 0;
  for (const page::ShownView& view : shown.views) pictured += !view.jpeg.empty();
  EXPECT_EQ(shown.views.size(), 600u);
  EXPECT_EQ(pictured, kMostPictures);
  EXPECT_FALSE(shown.views.front().jpeg.empty());
}

TEST(ShowResult, ReducesLargeMeshesAndKeepsSmallOnes) {
  const TriMesh small = ball(6), large = ball(110);
  ASSERT_GT(large.triangles.size(), kShownTriangles);
  const auto triangles = [](const TriMesh& mesh) {
    const auto shown = show_result(mesh, seen_of(mesh), {});
    return nlohmann::json::parse(shown.model.table)["triangles"].get<std::size_t>();
  };
  EXPECT_EQ(triangles(small), small.triangles.size());
  EXPECT_LE(triangles(large), kShownTriangles);
  EXPECT_GT(triangles(large), kShownTriangles * 9 / 10);
}

TEST(ShowResult, HasLayersOfVerticesOfWhichLessIsKnown) {
  const TriMesh mesh = ball(6);
  SeenVertices seen = seen_of(mesh);
  seen.views.resize(10);  // the others surround the box
  seen.disagreement.resize(10);
  const auto table = nlohmann::json::parse(show_result(mesh, seen, {}).model.table);
  std::vector<std::string> names;
  for (const auto& stream : table["streams"]) names.push_back(stream["name"]);
  EXPECT_EQ(names, (std::vector<std::string>{"position", "confidence", "views", "disagreement",
                                             "triangles"}));
  EXPECT_EQ(table["streams"][2]["step"], 1.0);
}

/// A mesh with each triangle on its own part of one of three pages of noise.
TexturedMesh with_texture(const TriMesh& mesh) {
  TexturedMesh out{mesh, {}};
  std::uint32_t state = 7;
  for (int p = 0; p < 3; ++p) {
    RgbImage page{1024, 512, {}};
    for (int i = 0; i < 3 * 1024 * 512; ++i)
      page.rgb.push_back(std::uint8_t((state = 1664525 * state + 1013904223) >> 24));
    out.texture.pages.push_back(std::move(page));
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    out.texture.page.push_back(std::uint32_t(t % 3));
    const float x = float(t % 100) / 128, y = float(t / 100 % 100) / 128;
    out.texture.corners.push_back({glm::vec2(x, y), {x + 0.005f, y}, {x, y + 0.005f}});
  }
  return out;
}

TEST(ShowTextured, HasPlacesOnOneImageThatIsNoLargerThanItMay) {
  const TriMesh uniform = ball(6);
  SeenVertices seen = seen_of(uniform);
  seen.views.assign(seen.views.size(), 9);
  const page::Shown shown =
      show_textured(with_texture(uniform), uniform, seen, noisy_views(3, 60, 40));
  EXPECT_LE(shown.texture.size(), kTextureBytes);
  EXPECT_GT(shown.texture.size(), kTextureBytes / 2);
  EXPECT_EQ(shown.views.size(), 3u);
  const auto table = nlohmann::json::parse(shown.model.table);
  std::vector<std::string> names;
  for (const auto& stream : table["streams"]) names.push_back(stream["name"]);
  EXPECT_EQ(names, (std::vector<std::string>{"position", "place", "confidence", "views",
                                             "disagreement", "triangles"}));
  EXPECT_EQ(table["triangles"], uniform.triangles.size());
  EXPECT_EQ(table["vertices"], 3 * uniform.triangles.size()) << "no two corners share a place";
}

}  // namespace
}  // namespace photohull::pipeline
