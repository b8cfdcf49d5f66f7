// Candidates of a thin rod that no mask holds, and of textures.
#include "carving/confirm_lines.h"

#include <gtest/gtest.h>

#include "carving/rods.h"
#include "masks/mask_lines.h"
#include "masks/silhouette.h"

namespace photohull::carving {
namespace {

using glm::dvec3;
using test::Rod;

constexpr int kWidth = 256;
constexpr double kDistance = 6, kFocal = 700;
constexpr double kPixel = kDistance / kFocal;  ///< world size of a pixel at the rod
const Box kBox{dvec3(-0.8), dvec3(0.8)};
const Rod kRod = test::straight_rod({-0.55, -0.45, -0.5}, {0.5, 0.6, 0.4}, 0.6 * kPixel);

using Lines = std::vector<std::vector<LinePoint>>;

struct Scene {
  explicit Scene(int views, const Rod& rod = kRod)
      : cameras(test::cameras_around(dvec3(0), kDistance, views, kFocal, kWidth, kWidth)) {
    for (const Camera& camera : cameras) {
      test::Drawing drawing(kWidth, kWidth);
      draw(rod, camera, drawing);
      candidates.push_back(find_lines(drawing.mask()));
      masks.push_back({kWidth, kWidth, std::vector<std::uint8_t>(kWidth * kWidth)});
      distances.push_back(silhouette_distance(masks.back()));
    }
  }
  /// The view's mask holds the rod, and the photograph shows no line.
  void hold(std::size_t view) {
    test::Drawing drawing(kWidth, kWidth);
    draw(test::straight_rod(kRod.axis[0], kRod.axis[1], 4 * kPixel), cameras[view], drawing);
    masks[view] = drawing.mask();
    distances[view] = silhouette_distance(masks[view]);
    candidates[view].clear();
  }
  ConfirmedLines confirm(const ConfirmOptions& options = {}, const Box& box = kBox) const {
    std::vector<Silhouette> silhouettes;
    for (std::size_t v = 0; v < cameras.size(); ++v)
      silhouettes.push_back({&masks[v], known(v) ? &distances[v] : nullptr});
    return confirm_lines(box, cameras, silhouettes, candidates, options);
  }
  bool known(std::size_t view) const { return int(view) < first_unknown; }

  std::vector<Camera> cameras;
  std::vector<Mask> masks;
  std::vector<SilhouetteDistance> distances;
  Lines candidates;
  int first_unknown = 1000;
};

std::size_t count(const Lines& lines) {
  std::size_t sum = 0;
  for (const auto& list : lines) sum += list.size();
  return sum;
}

double share_confirmed(const Scene& scene, const ConfirmOptions& options = {}) {
  return double(count(scene.confirm(options).lines)) / double(count(scene.candidates));
}

TEST(ConfirmLines, ARodThatAllViewsShowStandsWhereItIs) {
  const Scene scene(12);
  const ConfirmedLines found = scene.confirm();
  EXPECT_GT(count(found.lines), 0.97 * double(count(scene.candidates)));
  ASSERT_EQ(found.places.size(), count(found.lines));
  std::vector<double> pixels;
  for (const dvec3& p : found.places) pixels.push_back(kRod.distance(p) / kPixel);
  std::sort(pixels.begin(), pixels.end());
  EXPECT_LT(pixels[pixels.size() / 2], 2);
  EXPECT_LT(pixels.back(), 6);
}

TEST(ConfirmLines, AThirdOfTheViewsMayNotShowIt) {
  Scene scene(12);
  for (const std::size_t v : {1u, 4u, 8u}) scene.candidates[v].clear();
  EXPECT_GT(share_confirmed(scene), 0.9);
  for (const std::size_t v : {2u, 5u, 7u}) scene.candidates[v].clear();
  EXPECT_LT(share_confirmed(scene), 0.02);
}

TEST(ConfirmLines, LinesMustRunAlongOneDirection) {
  Scene scene(12);
  ConfirmOptions all;
  all.least_support = 10;
  EXPECT_GT(share_confirmed(scene, all), 0.9);
  test::Rng rng(5);
  for (std::size_t v = 1; v < 12; ++v)
    for (LinePoint& p : scene.candidates[v]) {
      const double angle = test::uniform(rng, 0, 3.14159);
      p.normal_x = float(std::cos(angle)), p.normal_y = float(std::sin(angle));
    }
  EXPECT_EQ(scene.confirm(all).lines[0].size(), 0u);
}

TEST(ConfirmLines, TexturesThatFollowNoPlaceInSpaceAreRefused) {
  Scene scene(12);
  test::Rng rng(11);
  for (std::size_t v = 0; v < 12; ++v) {
    test::Drawing drawing(kWidth, kWidth);
    for (int i = 0; i < 40; ++i) {
      const glm::dvec2 at(test::uniform(rng, 20, 236), test::uniform(rng, 20, 236));
      const double angle = test::uniform(rng, 0, 3.14);
      drawing.add_band(at, at + 20.0 * glm::dvec2(std::cos(angle), std::sin(angle)), 1);
    }
    const std::vector<LinePoint> texture = find_lines(drawing.mask());
    EXPECT_GT(texture.size(), 400u);
    scene.candidates[v] = texture;
  }
  EXPECT_LT(count(scene.confirm().lines), 0.01 * double(count(scene.candidates)));
}

TEST(ConfirmLines, MasksBearALineButDoNotMakeOne) {
  Scene scene(12);
  for (std::size_t v = 4; v < 12; ++v) scene.hold(v);
  EXPECT_GT(share_confirmed(scene), 0.9);
  scene.hold(3);
  EXPECT_EQ(count(scene.confirm().lines), 0u);  // three lines are too few
  ConfirmOptions beside;
  beside.continues_mask = 1e6;
  EXPECT_GT(share_confirmed(scene, beside), 0.9);
}

TEST(ConfirmLines, OnlyInTheBoxAndOnlyWhereViewsKnowSomething) {
  EXPECT_EQ(count(Scene(12).confirm({}, {dvec3(1.5), dvec3(2)}).lines), 0u);
  Scene few(12);
  few.first_unknown = 3;
  EXPECT_EQ(count(few.confirm().lines), 0u);
  Scene some(12);
  for (std::size_t v = 8; v < 12; ++v) some.candidates[v].clear();
  some.first_unknown = 8;
  EXPECT_GT(share_confirmed(some), 0.9);
}

}  // namespace
}  // namespace photohull::carving
