// Shadows by maps against shadows by exact rays.
#include "synth/light_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/gl_context.h"
#include "synth/place_cameras.h"
#include "synth/render.h"

namespace photohull::synth {
namespace {

/// Share of the object's pixels that maps light otherwise than rays do, by more than a tenth of a
/// light that meets a surface head on.
double differing(const std::string& light, const std::string& test, int texels) {
  Spec spec = parse_spec(
      R"({"geometry": {"shape": "block"}, "material": {"contrast": 0, "base": [1, 1, 1]},
          "image": {"width": 160, "height": 120, "samples": 2},
          "cameras": {"layout": "arc", "count": 1, "elevation": 30}, "light": {"ambient": [0, 0, 0], )" +
          light + "}}",
      "test", "");
  spec.light.shadow_test = test;
  spec.light.shadow_texels = texels;
  const Surface surface = make_surface(spec.geometry);
  const LensCamera lens = place_cameras(spec, surface)[0];
  const Shading shading(spec, surface, 0.01);
  const Picture exact = render(surface, shading, lens, 0, 2, 1);
  LightMaps maps(test::gl_context(), spec.light, surface, shading.lights());
  const Picture found = render(
      surface, shading, lens, 0, 2, 1, [] {}, &maps);
  EXPECT_EQ(exact.coverage, found.coverage);
  EXPECT_EQ(exact.depth, found.depth);
  int covered = 0, other = 0, lit = 0;
  for (std::size_t i = 0; i < exact.colour.size(); ++i) {
    covered += exact.coverage[i] > 0;
    lit += exact.colour[i].g > 0.1f;
    other += std::abs(exact.colour[i].g - found.colour[i].g) > 0.1f;
  }
  EXPECT_GT(covered, 2000);
  EXPECT_GT(lit, covered / 10);
  EXPECT_LT(lit, covered);
  return double(other) / covered;
}

const std::string kSun = R"("directional": [{"direction": [0.8, -0.4, 0.6], "colour": [1, 1, 1]}])";
// Away from the object, and so near that its maps look all around.
const std::string kLamp =
    R"("directional": [], "point": [{"position": [0.9, -0.5, 0.6], "colour": [1, 1, 1]}])";
const std::string kNearLamp =
    R"("directional": [], "point": [{"position": [0.05, -0.35, 0.2], "colour": [0.1, 0.1, 0.1]}])";

class Technique : public ::testing::TestWithParam<std::string> {};

TEST_P(Technique, LightsAsRaysDo) {
  // A constant bias leaves acne where light grazes the walls.
  const double most = GetParam() == "plain" ? 0.08 : 0.005;
  EXPECT_LT(differing(kSun, GetParam(), 1024), most);
  EXPECT_LT(differing(kLamp, GetParam(), 1024), most);
  EXPECT_LT(differing(kNearLamp, GetParam(), 512), most);
}

INSTANTIATE_TEST_SUITE_P(LightMaps, Technique,
                         ::testing::Values("plain", "slope-bias", "dual-depth", "virtual-normal",
                                           "variance", "pcf3", "general-lispsm", "zp2",
                                           "recommended", "sub-pixel", "coverage", "lists"),
                         [](const auto& one) {
                           std::string name = one.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(LightMaps, ListsAreAsGoodAsRays) {
  EXPECT_LT(differing(kSun, "lists", 256), 0.002);
  EXPECT_LT(differing(kLamp, "lists", 256), 0.002);
  EXPECT_LT(differing(kNearLamp, "lists", 256), 0.002);
}

TEST(LightMaps, CoarseMapsLightOtherwise) {
  EXPECT_GT(differing(kSun, "virtual-normal", 32), 4 * differing(kSun, "virtual-normal", 512));
}

}  // namespace
}  // namespace photohull::synth
