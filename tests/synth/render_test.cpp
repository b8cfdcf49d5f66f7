#include "synth/render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "synth/place_cameras.h"

namespace photohull::synth {
namespace {

/// A small scene ready to be rendered.
struct Small {
  Spec spec;
  Surface surface;
  std::vector<LensCamera> cameras;

  explicit Small(const std::string& text) : spec(parse_spec(text, "test", "")) {
    spec.image.width = 96, spec.image.height = 72;
    surface = make_surface(spec.geometry);
    cameras = place_cameras(spec, surface);
  }
  Picture picture(std::size_t view) const {
    const Shading shading(spec, surface, 0.01);
    return render(surface, shading, cameras[view], view, spec.image.samples, spec.seed);
  }
};

/// Does the ray through a pixel position of an ideal camera meet a ball?
bool meets_ball(const Camera& camera, const glm::dvec2& pixel, const glm::dvec3& center,
                double radius) {
  const glm::dvec3 d = camera.ray(pixel), to = center - camera.center();
  const double along = dot(d, to);
  return along > 0 && dot(to, to) - along * along < radius * radius;
}

constexpr const char* kBall = R"({"geometry": {"shape": "sphere", "parameters": {"radius": 2},
    "translate": [5, -3, 1]}, "image": {"samples": 8},
    "cameras": {"layout": "arc", "count": 3, "arc": 140, "roll": 30, "elevation": 25}})";

TEST(Render, DepthPixelsLieOnTheBall) {
  const Small scene(kBall);
  for (std::size_t view = 0; view < 3; ++view) {
    const Picture picture = scene.picture(view);
    const Camera& camera = scene.cameras[view].camera;
    int seen = 0;
    for (int y = 0; y < 72; ++y)
      for (int x = 0; x < 96; ++x) {
        const std::size_t i = std::size_t(y) * 96 + x;
        const glm::dvec3 ray = camera.ray({x, y});
        if (picture.depth[i] == 0) continue;
        ++seen;
        const glm::dvec3 p =
            camera.center() + double(picture.depth[i]) / dot(ray, camera.forward()) * ray;
        const glm::dvec3 out = p - glm::dvec3(5, -3, 1);
        ASSERT_NEAR(length(out) / 2, 1, 1e-4);
        ASSERT_GT(dot(normalize(out), glm::dvec3(picture.normal[i])), 0.9999);
      }
    EXPECT_GT(seen, 1500);
  }
}

TEST(Render, CoverageHasTheBallsAreaAndCentroid) {
  const Small scene(kBall);
  constexpr int kFine = 24;
  for (std::size_t view = 0; view < 3; ++view) {
    const Picture picture = scene.picture(view);
    double area = 0, exact = 0;
    glm::dvec2 middle(0), exact_middle(0);
    for (int y = 0; y < 72; ++y)
      for (int x = 0; x < 96; ++x) {
        const double share = picture.coverage[std::size_t(y) * 96 + x];
        area += share, middle += share * glm::dvec2(x, y);
        for (int k = 0; k < kFine * kFine; ++k) {
          const glm::dvec2 p(x - 0.5 + (k % kFine + 0.5) / kFine,
                             y - 0.5 + (k / kFine + 0.5) / kFine);
          if (!meets_ball(scene.cameras[view].camera, p, {5, -3, 1}, 2)) continue;
          exact += 1.0 / (kFine * kFine), exact_middle += p / double(kFine * kFine);
        }
      }
    EXPECT_NEAR(area / exact, 1, 1e-3);
    EXPECT_LT(length(middle / area - exact_middle / exact), 0.01);
  }
}

TEST(Render, WithALensPointsAppearWhereTheLensPutsThem) {
  const Small scene(R"({"geometry": {"shape": "block"}, "cameras": {"layout": "arc", "count": 2,
      "distance": 0.9}, "degradations": {"k1": -0.25, "k2": 0.08, "p1": 0.01, "p2": -0.008}})");
  for (std::size_t view = 0; view < 2; ++view) {
    const Picture picture = scene.picture(view);
    const LensCamera& lens = scene.cameras[view];
    const Pose& pose = lens.camera.cam_from_world;
    double farthest = 0;
    int seen = 0;
    for (int y = 0; y < 72; ++y)
      for (int x = 0; x < 96; ++x) {
        const double depth = picture.depth[std::size_t(y) * 96 + x];
        if (depth == 0) continue;
        ++seen;
        // The point on the block along the ray that undistortion gives, put through the lens.
        const glm::dvec3 local = depth * glm::dvec3(*lens.undistorted({x, y}), 1.0);
        const glm::dvec3 world = transpose(pose.rotation) * (local - pose.translation);
        const auto pixel = lens.project(world);
        ASSERT_TRUE(pixel);
        ASSERT_LT(length(*pixel - glm::dvec2(x, y)), 0.01);
        farthest = std::max(farthest, length(*lens.camera.project(world) - glm::dvec2(x, y)));
        // On a plane of the block or in its hole.
        const glm::dvec3 p = world;
        const double planes =
            std::min({std::abs(std::abs(p.x) - 1), std::abs(std::abs(p.y) - 0.6), std::abs(p.z),
                      std::abs(p.z - 1.3), std::abs(p.z - 0.65), std::abs(p.x),
                      std::abs(std::hypot(p.x + 0.5, p.y) - 0.275)});
        ASSERT_LT(planes, 1e-4);
      }
    EXPECT_GT(seen, 500);
    EXPECT_GT(farthest, 0.3);  // the lens did something
  }
}

TEST(Render, PlainSurfaceInAmbientLightHasItsColour) {
  const Small scene(R"({"material": {"contrast": 0, "base": [0.5, 0.25, 0.125]},
      "light": {"ambient": [0.5, 0.5, 0.5], "directional": []},
      "cameras": {"layout": "arc", "count": 1}})");
  const Picture picture = scene.picture(0);
  int inside = 0;
  for (std::size_t i = 0; i < picture.colour.size(); ++i) {
    if (picture.coverage[i] < 1) {
      if (picture.coverage[i] == 0) {
        ASSERT_EQ(picture.colour[i], glm::vec3(0));
      }
      continue;
    }
    ++inside;
    // Ambient light is brighter from above: 0.8 + 0.2 n_z.
    const float expected = 0.5f * (0.8f + 0.2f * picture.normal[i].z);
    ASSERT_NEAR(picture.colour[i].r, 0.5f * expected, 0.004f);
    ASSERT_NEAR(picture.colour[i].b, 0.125f * expected, 0.001f);
  }
  EXPECT_GT(inside, 1000);
}

TEST(Render, ShadowsDarken) {
  const std::string light = R"("light": {"directional": [{"direction": [0, 0, 1]}], "shadows": )";
  const std::string rest = R"(}, "geometry": {"shape": "leaves"}, "material": {"contrast": 0},
      "cameras": {"layout": "arc", "count": 1}})";
  const auto sum = [](const Picture& p) {
    double total = 0;
    for (const glm::vec3& c : p.colour) total += c.r;
    return total;
  };
  const double with = sum(Small("{" + light + "true" + rest).picture(0));
  const double without = sum(Small("{" + light + "false" + rest).picture(0));
  EXPECT_LT(with, 0.95 * without);
  EXPECT_GT(with, 0.3 * without);
}

TEST(Render, HazeShowsThePatternBelowTheSurface) {
  const auto picture = [](const std::string& material) {
    return Small(R"({"light": {"directional": []}, "cameras": {"layout": "arc", "count": 2},
                     "material": {"size": 0.3, "octaves": 2)" +
                 material + "}}")
        .picture(0);
  };
  const auto difference = [](const Picture& a, const Picture& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.colour.size(); ++i)
      sum += std::abs(a.colour[i].g - b.colour[i].g);
    return sum / double(a.colour.size());
  };
  const Picture plain = picture("");
  EXPECT_LT(difference(plain, picture(R"(, "haze": 0.7, "haze_depth": 0)")), 1e-6);
  const double half = difference(plain, picture(R"(, "haze": 0.5, "haze_depth": 0.1)"));
  const double full = difference(plain, picture(R"(, "haze": 1, "haze_depth": 0.1)"));
  EXPECT_GT(half, 0.003);
  EXPECT_NEAR(half, full / 2, 0.1 * full);
}

TEST(PlaceCameras, CrowdingGathersTheFirstViewsOfARing) {
  const auto azimuths = [](const std::string& crowding) {
    const Small scene(R"({"cameras": {"rings": [{"count": 4, "elevation": 0}], "crowding": )" +
                      crowding + "}}");
    std::vector<double> turns;
    for (const LensCamera& lens : scene.cameras) {
      const glm::dvec3 c = lens.camera.center();
      double turn = std::atan2(c.x, -c.y) / (2 * std::numbers::pi);
      turns.push_back(turn < -1e-9 ? turn + 1 : turn);
    }
    return turns;
  };
  const std::vector<double> even = azimuths("1"), crowded = azimuths("2");
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(even[std::size_t(i)], i / 4.0, 1e-9);
    EXPECT_NEAR(crowded[std::size_t(i)], i * i / 16.0, 1e-9);
  }
}

TEST(PlaceCameras, ObjectFillsTheFrameAndStaysInside) {
  const Small scene(R"({"geometry": {"shape": "rods"}, "cameras": {"layout": "hemisphere",
      "count": 12, "lowest": -40, "highest": 90, "distances": [1, 2], "focals": [1, 0.6],
      "fill": 0.7, "principal_offset": [0, 0]}})");
  double largest = 0;
  for (const LensCamera& lens : scene.cameras)
    for (std::size_t i = 0; i < scene.surface.mesh.positions.size(); ++i) {
      const glm::dvec2 p = *lens.project(scene.surface.mesh.world(i)) - glm::dvec2(47.5, 35.5);
      largest = std::max({largest, std::abs(p.x) / 48, std::abs(p.y) / 36});
    }
  EXPECT_NEAR(largest, 0.7, 1e-9);
}

TEST(PlaceCameras, RefusesCamerasInsideOrTooNear) {
  EXPECT_THROW(Small(R"({"cameras": {"distance": 0.1}})"), Error);
  EXPECT_THROW(Small(R"({"geometry": {"shape": "torus"}, "cameras": {"distance": 0.2}})"), Error);
  EXPECT_THROW(Small(R"({"cameras": {"distance": 0.8, "distances": [1, 0.2]}})"), Error);
  EXPECT_THROW(Small(R"({"degradations": {"k1": -5}, "cameras": {"distance": 0.6}})"), Error);
}

TEST(Render, StemsThinnerThanAPixelCoverTheirShare) {
  // The bare stem of a seedling, from 1.2 pixels at the ground to 0.3 at the top.
  Spec spec = parse_spec(R"({"geometry": {"shape": "seedling", "parameters": {"shoots": 0}},
      "image": {"width": 400, "height": 400, "samples": 8},
      "cameras": {"layout": "arc", "count": 1, "elevation": 0}})",
                         "test", "");
  auto& stem = spec.geometry.parameters.at("stem");
  const auto camera = [&] { return place_cameras(spec, make_surface(spec.geometry))[0]; };
  stem = 0.6 / 2 * length(camera().camera.center() - glm::dvec3(0, 0, 1)) /
         camera().camera.intrinsics.fx;
  const Surface surface = make_surface(spec.geometry);
  const LensCamera lens = camera();
  const Shading shading(spec, surface, 0.01);
  const Picture picture = render(surface, shading, lens, 0, spec.image.samples, 1);
  for (const double height : {0.1, 0.5, 0.95}) {
    const glm::dvec3 middle(0, 0, 2 * height);
    const double pixel = lens.camera.to_camera(middle).z / lens.camera.intrinsics.fx;
    const int row = int(std::lround(lens.project(middle)->y));
    double width = 0;
    for (int y = row - 7; y <= row + 7; ++y)
      for (int x = 0; x < 400; ++x) width += picture.coverage[std::size_t(y) * 400 + x] / 15;
    const double exact = 2 * 2 * stem * (1 - 0.75 * height) / pixel;
    EXPECT_NEAR(width, exact, 0.05 * exact) << height;
  }
}

}  // namespace
}  // namespace photohull::synth
