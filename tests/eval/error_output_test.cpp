#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/image.h"
#include "eval/error_image.h"
#include "eval/error_mesh.h"
#include "io/mesh/write_mesh.h"
#include "shapes.h"
#include "support/scratch_folder.h"

namespace photohull::eval {
namespace {

TEST(ErrorColour, DivergesFromWhite) {
  EXPECT_EQ(error_colour(0, 2), glm::dvec3(250));
  EXPECT_EQ(error_colour(2, 2), error_colour(1e9, 2));
  EXPECT_EQ(error_colour(-2, 2), error_colour(-1e9, 2));
  EXPECT_GT(error_colour(1, 2).r, error_colour(1, 2).b + 100);
  EXPECT_GT(error_colour(-1, 2).b, error_colour(-1, 2).r + 100);
  EXPECT_NEAR(error_colour(0.5, 2).g, 0.5 * (250 + 138), 1e-9);
}

TEST(ErrorMesh, CarriesSignedDistancesAndTheirColours) {
  const ScratchFolder folder;
  Progress progress;
  TriMesh result = test::sphere({0, 0, 0}, 1, 3);
  for (glm::vec3& p : result.positions) p *= p.z > 0 ? 1.5f : 0.75f;
  const Truth truth(test::sphere({0, 0, 0}, 1, 3));
  AtomicFile file(folder / "e.ply");
  write_error_mesh(file, result, truth.surface(), 0.5, progress);
  file.commit();
  VertexScalars scalars;
  const TriMesh back = read_ply(folder / "e.ply", scalars);
  EXPECT_EQ(back.triangles, result.triangles);
  const std::vector<double>& distance = scalars.at("distance");
  ASSERT_EQ(distance.size(), result.positions.size());
  for (std::size_t i = 0; i < distance.size(); ++i) {
    const bool out = result.positions[i].z > 0;
    ASSERT_NEAR(distance[i], out ? 0.5 : -0.25, 0.02);
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(255 * srgb_from_linear(back.colours[i][c]), error_colour(distance[i], 0.5)[c], 1);
  }
}

TEST(ErrorMesh, AFullDiskIsAnError) {
  const ScratchFolder folder;
  Progress progress;
  const TriMesh mesh = test::sphere({0, 0, 0}, 1, 4);
  {
    AtomicFile file(folder / "e.ply");
    const FileSizeLimit limit(5000);
    EXPECT_THROW(write_error_mesh(file, mesh, SignedDistance(mesh), 0.5, progress), Error);
  }
  EXPECT_EQ(folder.file_count(), 0u);
}

glm::ivec3 pixel(const RgbImage& image, int x, int y) {
  const std::uint8_t* p = &image.rgb[3 * (std::size_t(y) * image.width + x)];
  return {p[0], p[1], p[2]};
}

TEST(ErrorImage, PanelsShowTheSidesOfTheResult) {
  Progress progress;
  // Too thick towards +x, too thin towards -x, right along y and z.
  const TriMesh truth = test::box({-1, -1, -1}, {1, 1, 1});
  const TriMesh result = test::box({-0.9, -1, -1}, {1.1, 1, 1});
  const int n = 64;
  const RgbImage image = draw_error_image(result, Truth(truth), {0.1, n, "a box"}, progress);
  ASSERT_EQ(image.width, 3 * n);
  ASSERT_EQ(image.rgb.size(), std::size_t(3 * image.width) * image.height);
  const auto middle = [&](int column, int row) {
    return pixel(image, column * n + n / 2, 40 + row * n + n / 2 + 5);
  };
  const auto near = [](const glm::ivec3& a, const glm::dvec3& b) {
    return glm::all(glm::lessThan(glm::abs(glm::dvec3(a) - b), glm::dvec3(4)));
  };
  EXPECT_TRUE(near(middle(0, 0), error_colour(0.1, 0.1)));   // from +x
  EXPECT_TRUE(near(middle(0, 1), error_colour(-0.1, 0.1)));  // from -x
  for (int row = 0; row < 2; ++row)
    for (int column = 1; column < 3; ++column)
      EXPECT_TRUE(near(middle(column, row), error_colour(0, 0.1))) << row << column;
  EXPECT_EQ(pixel(image, 2 * n - 1, 40 + 1), glm::ivec3(38));  // beside the box
}

}  // namespace
}  // namespace photohull::eval
