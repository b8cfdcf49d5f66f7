#include "refine/ray_partners.h"

#include <gtest/gtest.h>

namespace photohull::refine {
namespace {

constexpr int kWidth = 80, kHeight = 40;
constexpr double kFocal = 60;  // pixels
const Box kWall{{0, 0, 50}, {300, 40, 60}};

/// At (x, y, z), looking along +z.
projtex::GridCamera camera_at(double x, double y, double z) {
  projtex::GridCamera c;
  c.centre = {x, y, z};
  c.focal = kFocal;
  c.width = kWidth, c.height = kHeight;
  const glm::dmat3 k(kFocal, 0, 0, 0, kFocal, 0, 0.5 * (kWidth - 1), 0.5 * (kHeight - 1), 1);
  const glm::dvec3 t = -(k * c.centre);
  c.projection = glm::dmat4x3(k[0], k[1], k[2], t);
  return c;
}

/// Along a wall that is much wider than what each of them sees, about 72 voxels.
std::vector<projtex::GridCamera> along_the_wall() {
  std::vector<projtex::GridCamera> cameras;
  for (int i = 0; i < 15; ++i) cameras.push_back(camera_at(10 + 20 * i, 20, 0));
  return cameras;
}

/// Partners of a choice, without the view itself.
std::vector<int> partners(const ViewChoice& c) { return {c.others().begin(), c.others().end()}; }

TEST(RayPartners, OfATileHaveOnTheirImagesWhatItLooksAt) {
  const auto cameras = along_the_wall();
  constexpr int kTiles = 4;
  const std::vector<ViewPartners> all = choose_partners(cameras, kWall, 4, kTiles);
  int matched = 0;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    ASSERT_EQ(all[i].tiles.size(), std::size_t(kTiles * kTiles));
    for (int tile = 0; tile < kTiles * kTiles; ++tile) {
      const ViewChoice& choice = all[i].tiles[std::size_t(tile)];
      EXPECT_EQ(choice.reference(), int(i));
      const double column = (tile % kTiles + 0.5) / kTiles * kWidth - 0.5;
      const double depth = 55;
      const double x = cameras[i].centre.x + depth * (column - 0.5 * (kWidth - 1)) / kFocal;
      if (x < 0 || x > 300) continue;  // beside the wall
      for (const int j : partners(choice)) {
        const double seen_at = kFocal * (x - cameras[std::size_t(j)].centre.x) / depth;
        EXPECT_LE(std::abs(seen_at), 0.5 * kWidth) << "view " << i << ", tile " << tile;
      }
      matched += !partners(choice).empty();
    }
  }
  EXPECT_GT(matched, int(cameras.size()) * kTiles * kTiles * 9 / 10);
}

TEST(RayPartners, OfOneTileAreThoseNearTheViewAboutTheMiddle) {
  const auto cameras = along_the_wall();
  const std::vector<ViewPartners> all = choose_partners(cameras, kWall, 4, 1);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    ASSERT_EQ(all[i].tiles.size(), 1u);
    for (const int j : partners(all[i].tiles[0])) {
      const auto from_middle = [&](int k) {
        return glm::normalize(cameras[std::size_t(k)].centre - kWall.center());
      };
      const double angle = glm::degrees(std::acos(glm::dot(from_middle(int(i)), from_middle(j))));
      EXPECT_GE(angle, 4);
      EXPECT_LE(angle, 60);
    }
  }
}

TEST(RayPartners, WithinABoxLookAtItsFarSide) {
  const Box room{{0, 0, 0}, {100, 40, 60}};
  std::vector<projtex::GridCamera> cameras;
  for (int i = 0; i < 10; ++i) cameras.push_back(camera_at(10 + 9 * i, 20, 20));
  const std::vector<ViewPartners> all = choose_partners(cameras, room, 4, 2);
  for (const int j : partners(all[0].tiles[1]))  // upper right: about x = 23 at the far side
    EXPECT_LE(std::abs(kFocal * (23.3 - cameras[std::size_t(j)].centre.x) / 40), 0.5 * kWidth + 1);
  EXPECT_FALSE(partners(all[0].tiles[1]).empty());
}

TEST(RayPartners, TilesCoverTheLattice) {
  ViewPartners p;
  p.across = 3;
  EXPECT_EQ(p.tile(0, 0, 10, 7), 0);
  EXPECT_EQ(p.tile(9, 0, 10, 7), 2);
  EXPECT_EQ(p.tile(0, 6, 10, 7), 6);
  EXPECT_EQ(p.tile(9, 6, 10, 7), 8);
  EXPECT_EQ(p.tile(0, 0, 1, 1), 0);
}

}  // namespace
}  // namespace photohull::refine
