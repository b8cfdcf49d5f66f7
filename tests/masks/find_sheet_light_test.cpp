// Light and shadow on a sheet, told by photographs from all around.
#include "masks/find_sheet_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>

#include "support/pictures.h"

namespace photohull {
namespace {

constexpr int kWidth = 320, kHeight = 240, kPhotos = 12;
constexpr double kFocal = 300, kNoise = 0.005;
constexpr double kPageX = 160, kPageY = 120;           // mm, about the origin
constexpr double kRadius = 14, kTall = 40, kBox = 30;  // of a pillar at the origin, and its box
constexpr double kRootOfShadow = 0.7;

struct Eye {
  glm::dvec3 place;
  glm::dmat3 turn;  ///< columns: the camera's axes in the sheet's frame
};

Eye eye(std::size_t k) {
  const double azimuth = 2 * glm::pi<double>() * double(k) / kPhotos;
  const double height = k % 2 ? 0.45 : 0.8;
  const glm::dvec3 place =
      260.0 * glm::dvec3(std::cos(height) * std::cos(azimuth), std::cos(height) * std::sin(azimuth),
                         std::sin(height));
  const glm::dvec3 forward = glm::normalize(glm::dvec3(0, 0, 8) - place);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, 1)));
  return {place, glm::dmat3(right, glm::cross(forward, right), forward)};
}

/// Where the ray first meets a pillar that stands on the sheet.
std::optional<glm::dvec3> meet_pillar(const glm::dvec3& o, const glm::dvec3& d, double radius) {
  const double top = (kTall - o.z) / d.z;
  const glm::dvec3 at_top = o + top * d;
  if (d.z < 0 && std::hypot(at_top.x, at_top.y) <= radius) return at_top;
  const double a = d.x * d.x + d.y * d.y, b = o.x * d.x + o.y * d.y,
               c = o.x * o.x + o.y * o.y - radius * radius;
  if (b * b - a * c < 0) return std::nullopt;
  const glm::dvec3 p = o + (-b - std::sqrt(b * b - a * c)) / a * d;
  return p.z >= 0 && p.z <= kTall ? std::optional(p) : std::nullopt;
}

/// A shadow with a sharp edge to the right of the pillar, and further on in `away`.
bool in_shadow(const glm::dvec2& p) { return p.x > 0 && p.x < 60 && std::abs(p.y) < kRadius; }

struct Table {
  std::function<glm::vec3(const glm::dvec3&)> pillar = [](const glm::dvec3& p) {
    const double angle = std::atan2(p.y, p.x);
    return glm::vec3(0.4 + 0.3 * std::sin(9 * angle + 0.3 * p.z), 0.3 + 0.2 * std::cos(0.9 * p.z),
                     0.2);
  };
  std::function<bool(std::size_t, const glm::dvec2&)> shadow =
      [](std::size_t, const glm::dvec2& p) { return in_shadow(p); };
  bool same_exposure = true;
};

glm::dvec3 ray(const Eye& e, double x, double y) {
  return e.turn *
         glm::dvec3((x - (kWidth - 1) / 2.0) / kFocal, (y - (kHeight - 1) / 2.0) / kFocal, 1);
}

ColourImage photograph(const Table& table, std::size_t k) {
  std::mt19937 random(unsigned(7 + k));
  std::normal_distribution<float> noise(0, float(kNoise));
  const Eye e = eye(k);
  const double gain = table.same_exposure ? 1 : 1 + 0.1 * std::sin(3.0 * double(k));
  return paint_srgb(kWidth, kHeight, [&](double x, double y) {
    const glm::dvec3 d = ray(e, x, y);
    glm::vec3 light(0.1f);
    if (const auto p = meet_pillar(e.place, d, kRadius)) {
      light = table.pillar(*p);
    } else if (d.z < 0) {
      const glm::dvec2 at(e.place - e.place.z / d.z * d);
      if (std::abs(at.x) < kPageX / 2 && std::abs(at.y) < kPageY / 2)
        light = glm::vec3(table.shadow(k, at) ? 0.8 * kRootOfShadow * kRootOfShadow : 0.8);
    }
    const double r2 = (std::pow(x - 159.5, 2) + std::pow(y - 119.5, 2)) / 40000;
    if (!table.same_exposure) light *= float(gain * (1 - 0.15 * r2));
    glm::vec3 root = glm::sqrt(light);
    for (int c = 0; c < 3; ++c) root[c] = std::max(0.0f, root[c] + noise(random));
    return root * root;
  });
}

SheetLight light_of(const Table& table) {
  SheetPhotographs photos;
  photos.count = kPhotos;
  photos.image = [&](std::size_t k) { return photograph(table, k); };
  photos.pixel = [](std::size_t k, const glm::dvec2& place) -> std::optional<glm::dvec2> {
    const Eye e = eye(k);
    const glm::dvec3 p = glm::transpose(e.turn) * (glm::dvec3(place, 0) - e.place);
    return glm::dvec2(kFocal * p.x / p.z + (kWidth - 1) / 2.0,
                      kFocal * p.y / p.z + (kHeight - 1) / 2.0);
  };
  photos.possible = [](std::size_t k, const glm::dvec2& place, const glm::dvec2&,
                       const glm::ivec2&) {
    const Eye e = eye(k);
    return std::hypot(place.x, place.y) < kBox ||
           meet_pillar(e.place, glm::dvec3(place, 0) - e.place, kBox).has_value();
  };
  photos.eye = [](std::size_t k) { return eye(k).place; };
  photos.print = [](const glm::dvec2&) { return 1.0f; };
  photos.finest = 0.45;
  photos.lower_left = -0.5 * glm::dvec2(kPageX, kPageY), photos.page = {kPageX, kPageY};
  return find_sheet_light(photos);
}

TEST(SheetLightTest, AShadowThatStandsStillIsKnownUpToTheObject) {
  for (const bool same_exposure : {true, false}) {
    Table table;
    table.same_exposure = same_exposure;
    const SheetLight light = light_of(table);
    ASSERT_FALSE(light.empty());
    EXPECT_TRUE(light.steady);
    const double paper = double(light.at({-60, 40}).paper.y);
    int known = 0, all = 0;
    for (double x = -70; x <= 70; x += 1)
      for (double y = -50; y <= 50; y += 1) {
        const double r = std::hypot(x, y);
        const bool edge = in_shadow({x - 1, y - 1}) != in_shadow({x + 1, y + 1}) ||
                          in_shadow({x - 1, y + 1}) != in_shadow({x + 1, y - 1});
        if (r < kRadius + 2 || edge) continue;
        const SheetLight::Texel texel = light.at({x, y});
        ++all, known += texel.agreed;
        EXPECT_NEAR(double(texel.paper.y) / paper, in_shadow({x, y}) ? kRootOfShadow : 1, 0.04)
            << x << " " << y;
      }
    EXPECT_GT(known, 0.97 * all);
  }
}

TEST(SheetLightTest, UnderTheObjectNothingIsAgreedOn) {
  for (const bool plain : {false, true}) {
    Table table;
    if (plain) table.pillar = [](const glm::dvec3&) { return glm::vec3(0.5f, 0.2f, 0.1f); };
    const SheetLight light = light_of(table);
    for (double x = -10; x <= 10; x += 2)
      for (double y = -8; y <= 8; y += 2) EXPECT_FALSE(light.at({x, y}).agreed) << x << " " << y;
  }
}

TEST(SheetLightTest, ShadowsThatMoveAreTold) {
  Table table;
  table.shadow = [](std::size_t k, const glm::dvec2& p) {
    const double turn = 0.5 * double(k);
    const glm::dvec2 q(std::cos(turn) * p.x + std::sin(turn) * p.y,
                       std::cos(turn) * p.y - std::sin(turn) * p.x);
    return in_shadow(q);
  };
  const SheetLight light = light_of(table);
  ASSERT_FALSE(light.empty());
  EXPECT_FALSE(light.steady);
  EXPECT_NEAR(double(light.at({50, 5}).paper.y / light.at({-60, 40}).paper.y), 1, 0.03);
}

TEST(SheetLightTest, WithoutBareSheetThereIsNone) {
  SheetPhotographs photos;
  EXPECT_TRUE(find_sheet_light(photos).empty());
}

}  // namespace
}  // namespace photohull
