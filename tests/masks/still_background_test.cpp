// The background behind a turntable, and masks on a sheet with it.
#include "masks/still_background.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "masks/sheet_mask.h"
#include "support/pictures.h"

namespace photohull {
namespace {

constexpr int kWidth = 240, kHeight = 180, kPageTop = 120, kPhotos = 12;
constexpr double kNoise = 0.006;

/// A shelf of boxes in many colours.
glm::vec3 shelf(double x, double y) {
  const int i = int(std::floor(x / 13)), j = int(std::floor(y / 17));
  const auto tone = [&](int k) { return float(0.12 + 0.07 * ((i * 7 + j * 11 + k * 5) % 9)); };
  return {tone(1), tone(2), tone(3)};
}

glm::vec3 page(double x, double y) {
  const bool ink = int(x / 16) % 2 == 0 && y > kPageTop + 30 && y < kPageTop + 50;
  return glm::vec3(ink ? 0.03f : 0.8f);
}

/// How the k-th photograph differs from the others.
struct Scene {
  std::function<bool(int, double, double)> object;  ///< is it seen there?
  std::function<glm::vec3(int, double, double)> colour = [](int k, double x, double y) {
    return glm::vec3(0.5 + 0.3 * std::sin(0.6 * x + 2.1 * k), 0.3,
                     0.2 + 0.1 * std::cos(0.5 * y + k));
  };
  std::function<glm::vec3(int, double, double)> behind = [](int, double x, double y) {
    return shelf(x, y);
  };
  bool same_exposure = true;
};

ColourImage photograph(const Scene& scene, int k) {
  std::mt19937 random(unsigned(100 + k));
  std::normal_distribution<float> noise(0, float(kNoise));
  const float exposure = scene.same_exposure ? 1 : float(1 + 0.08 * std::sin(2.0 * k));
  return paint_srgb(kWidth, kHeight, [&](double x, double y) {
    const glm::vec3 light = scene.object(k, x, y) ? scene.colour(k, x, y)
                            : y >= kPageTop       ? page(x, y)
                                                  : scene.behind(k, x, y);
    glm::vec3 root = glm::sqrt(exposure * light);
    for (int c = 0; c < 3; ++c) root[c] = std::max(0.0f, root[c] + noise(random));
    return root * root;
  });
}

/// The page fills the frame's lower part, the box its middle.
SheetLook look(int width, int height) {
  SheetLook out;
  out.width = width, out.height = height;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const double x = (u + 0.5) * kWidth / width - 0.5, y = (v + 0.5) * kHeight / height - 0.5;
      out.light.push_back(y >= kPageTop ? (page(x, y).x - 0.03f) / 0.77f : -1);
      out.possible.push_back(x > 60 && x < 180 && y > 30 && y < 150 ? 255 : 0);
    }
  return out;
}

StillPhotographs photographs_of(const Scene& scene, double held = 60e6, int count = kPhotos) {
  StillPhotographs photos;
  photos.count = std::size_t(count);
  photos.width = kWidth, photos.height = kHeight;
  photos.image = [&scene](std::size_t k) { return photograph(scene, int(k)); };
  photos.look = [](std::size_t, int width, int height) { return look(width, height); };
  photos.held = held;
  return photos;
}

StillBackground background_of(const Scene& scene, double held = 60e6, int count = kPhotos) {
  return find_still_background(photographs_of(scene, held, count), true);
}

/// A block that sways about the middle.
bool swaying(int k, double x, double y) {
  return std::abs(x - 120 - 30 * std::cos(2 * std::numbers::pi * k / kPhotos)) < 12 && y > 50 &&
         y < 140;
}

std::size_t at(int x, int y) { return std::size_t(y) * kWidth + std::size_t(x); }

double overlap(const Mask& mask, const Scene& scene, int k) {
  double both = 0, either = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool in = mask.coverage[at(x, y)] >= 128, there = scene.object(k, x, y);
      both += in && there, either += in || there;
    }
  return both / either;
}

/// Root mean square of what differs from the shelf where the background is known.
double light_error(const StillBackground& found) {
  double sum = 0, count = 0;
  for (int y = 2; y < kPageTop - 4; ++y)
    for (int x = 2; x < kWidth - 2; ++x) {
      if (found.level[at(x, y)] != StillBackground::kSure) continue;
      const glm::vec3 root = glm::sqrt(shelf(x, y));
      for (int c = 0; c < 3; ++c) {
        const double code = found.light[3 * at(x, y) + std::size_t(c)] / 65535.0;
        sum += std::pow(code - double(root[c]), 2), ++count;
      }
    }
  return std::sqrt(sum / count);
}

double share_of_level(const StillBackground& found, StillBackground::Level level) {
  double there = 0;
  for (int y = 0; y < kPageTop - 4; ++y)
    for (int x = 0; x < kWidth; ++x) there += found.level[at(x, y)] == level;
  return there / (kWidth * (kPageTop - 4.0));
}

TEST(StillBackgroundTest, IsFoundBehindWhatMoves) {
  const Scene scene{swaying};
  const StillBackground found = background_of(scene);
  EXPECT_EQ(found.stillness, Stillness::kStill);
  EXPECT_GT(found.edges_kept, 0.95);
  EXPECT_LT(light_error(found), kNoise);
  EXPECT_GT(share_of_level(found, StillBackground::kSure), 0.8);
  // Nothing is told of what the page hides.
  EXPECT_EQ(found.level[at(120, kPageTop + 10)], StillBackground::kUnknown);
}

TEST(StillBackgroundTest, ExposuresMayDiffer) {
  Scene scene{swaying};
  scene.same_exposure = false;
  const StillBackground found = background_of(scene);
  EXPECT_EQ(found.stillness, Stillness::kStill);
  EXPECT_LT(light_error(found), 2 * kNoise);
}

TEST(StillBackgroundTest, SmallerSamplesGiveTheSameLight) {
  const Scene scene{swaying};
  const StillBackground found = background_of(scene, 0.25 * kPhotos * kWidth * kHeight);
  EXPECT_EQ(found.stillness, Stillness::kStill);
  EXPECT_EQ(found.width, kWidth);
  EXPECT_LT(light_error(found), 2 * kNoise);
  EXPECT_GT(share_of_level(found, StillBackground::kSure), 0.6);
  const SheetMask mask = mask_from_sheet(photograph(scene, 3), look(kWidth, kHeight), found);
  EXPECT_GT(overlap(mask.mask, scene, 3), 0.85);
}

TEST(StillBackgroundTest, ACameraThatMovesIsTold) {
  Scene scene{swaying};
  scene.behind = [](int k, double x, double y) { return shelf(x + 29 * k, y + 5 * k); };
  const StillBackground found = background_of(scene);
  EXPECT_EQ(found.stillness, Stillness::kChanges);
  EXPECT_LT(found.edges_kept, 0.3);
  EXPECT_TRUE(found.empty());
}

TEST(StillBackgroundTest, APlainWallTellsNothing) {
  Scene scene{swaying};
  scene.behind = [](int, double, double) { return glm::vec3(0.3f); };
  EXPECT_EQ(background_of(scene).stillness, Stillness::kPlain);
}

TEST(StillBackgroundTest, MasksAreTighterThanTheSheetAloneMakesThem) {
  const Scene scene{swaying};
  const StillBackground found = background_of(scene);
  for (const int k : {0, 3, 8}) {
    const ColourImage image = photograph(scene, k);
    const SheetMask alone = mask_from_sheet(image, look(kWidth, kHeight)),
                    both = mask_from_sheet(image, look(kWidth, kHeight), found);
    EXPECT_LT(overlap(alone.mask, scene, k), 0.5);
    EXPECT_GT(overlap(both.mask, scene, k), 0.93);
    EXPECT_LT(both.undecided, alone.undecided);
  }
}

TEST(StillBackgroundTest, AnObjectThatLooksAlikeFromAllSidesIsKept) {
  Scene scene;
  scene.object = [](int, double x, double y) {
    return std::abs(x - 120) < 18 && y > 50 && y < 140;
  };
  scene.colour = [](int, double, double) { return glm::vec3(0.6f, 0.2f, 0.1f); };
  const StillBackground found = background_of(scene);
  ASSERT_EQ(found.stillness, Stillness::kStill);
  EXPECT_EQ(found.level[at(120, 80)], StillBackground::kDoubtful);
  const SheetMask mask = mask_from_sheet(photograph(scene, 2), look(kWidth, kHeight), found);
  for (int y = 54; y < 136; ++y) EXPECT_GE(mask.mask.coverage[at(120, y)], 128) << y;
}

/// Two posts that sway about the middle, with a beam on them.
bool gate(int k, double x, double y) {
  const double off = std::abs(x - 120 - 30 * std::cos(2 * std::numbers::pi * k / kPhotos));
  return y > 50 && y < 146 && off < 8 && (off > 2.6 || y < 70);
}

TEST(StillBackgroundTest, GapsOverBarePaperStayOpen) {
  Scene scene{gate};
  scene.colour = [](int, double, double) { return glm::vec3(0.1f, 0.25f, 0.1f); };
  const StillBackground found = background_of(scene);
  for (const int k : {0, 3, 8}) {
    const SheetMask mask = mask_from_sheet(photograph(scene, k), look(kWidth, kHeight), found);
    const double middle = 120 + 30 * std::cos(2 * std::numbers::pi * k / kPhotos);
    int closed = 0, posts = 0, kept = 0;
    for (int y = kPageTop + 5; y < 144; ++y)
      for (int x = int(middle) - 12; x <= int(middle) + 12; ++x) {
        const bool in = mask.mask.coverage[at(x, y)] >= 128;
        closed += in && std::abs(x - middle) < 1.6;
        if (gate(k, x, y)) ++posts, kept += in;
      }
    EXPECT_LE(closed, 5) << k;
    EXPECT_GT(kept, 0.95 * posts) << k;
  }
}

/// A block that most photographs show before the same place.
bool mostly_there(int k, double x, double y) {
  return k % 3 != 0 && std::abs(x - 120) < 40 && y > 50 && y < 140;
}

TEST(StillBackgroundTest, IsFoundWhereAThirdOfThePhotographsShowIt) {
  Scene scene{mostly_there};
  scene.colour = [](int k, double x, double y) {  // never twice the same
    return glm::vec3(0.5 + 0.3 * std::sin(0.6 * x + 1.7 * k), 0.3,
                     0.2 + 0.1 * std::cos(0.5 * y + k));
  };
  const StillBackground found = background_of(scene);
  EXPECT_EQ(found.level[at(120, 80)], StillBackground::kSure);
  EXPECT_LT(share_of_level(found, StillBackground::kUnknown), 0.03);
  EXPECT_LT(light_error(found), kNoise);
  const SheetMask mask = mask_from_sheet(photograph(scene, 0), look(kWidth, kHeight), found);
  EXPECT_LT(mask.undecided, 0.05);
}

TEST(StillBackgroundTest, APlainObjectThatMostPhotographsShowIsNotTakenForIt) {
  Scene scene{mostly_there};
  scene.colour = [](int, double, double) { return glm::vec3(0.6f, 0.2f, 0.1f); };
  const StillBackground found = background_of(scene);
  EXPECT_EQ(found.level[at(120, 80)], StillBackground::kUnknown);
  const SheetMask mask = mask_from_sheet(photograph(scene, 1), look(kWidth, kHeight), found);
  for (int y = 54; y < 136; ++y) EXPECT_GE(mask.mask.coverage[at(120, y)], 128) << y;
}

/// Photographs 0, 3, 6 and 9 alone show what is behind; masks say where the object stands.
TEST(StillBackgroundTest, WhatMasksHaveForTheObjectDoesNotCount) {
  Scene scene{mostly_there};
  scene.colour = [](int, double, double) { return glm::vec3(0.6f, 0.2f, 0.1f); };
  StillPhotographs photos = photographs_of(scene);
  photos.mask = [&](std::size_t k) {
    Mask mask{kWidth / 2, kHeight / 2, {}};
    for (int y = 0; y < kHeight; y += 2)
      for (int x = 0; x < kWidth; x += 2)
        mask.coverage.push_back(mostly_there(int(k), x, y) ? 255 : 0);
    return mask;
  };
  const StillBackground found = find_still_background(photos, true);
  EXPECT_NE(found.level[at(120, 80)], StillBackground::kUnknown);
  EXPECT_LT(light_error(found), kNoise);
}

/// What is behind, exactly, also behind the page, but for where nothing is known of it.
StillBackground known_but(const std::function<bool(double, double)>& unknown) {
  StillBackground out;
  out.stillness = Stillness::kStill;
  out.width = kWidth, out.height = kHeight;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool known = !unknown(x, y);
      const glm::vec3 root = known ? glm::sqrt(shelf(x, y)) : glm::vec3(0);
      for (int c = 0; c < 3; ++c) out.light.push_back(std::uint16_t(std::lround(65535 * root[c])));
      out.deviation.push_back(std::uint8_t(1000 * kNoise));
      out.level.push_back(known ? StillBackground::kSure : StillBackground::kUnknown);
    }
  return out;
}

TEST(StillBackgroundTest, WhereNothingIsKnownColoursTell) {
  // Red before a shelf that has none of it, half over the page.
  Scene scene{[](int, double x, double y) { return std::abs(x - 105) < 15 && y > 60 && y < 140; }};
  scene.colour = [](int, double, double) { return glm::vec3(0.7f, 0.02f, 0.02f); };
  const auto block = [](double x, double y) { return x > 95 && x < 150 && y > 50 && y < 110; };
  const SheetMask mask =
      mask_from_sheet(photograph(scene, 0), look(kWidth, kHeight), known_but(block));
  EXPECT_GT(overlap(mask.mask, scene, 0), 0.95);
}

TEST(StillBackgroundTest, WhereColoursAreBothSidesTheObjectIsKept) {
  // A grey shelf, and a body whose shading has the same greys, the lighter ones more often.
  const auto grey = [](double x, double y) { return glm::vec3(shelf(x, y).x); };
  Scene scene{[](int, double x, double y) { return std::abs(x - 105) < 15 && y > 60 && y < 140; }};
  scene.behind = [&](int, double x, double y) { return grey(x, y); };
  scene.colour = [](int, double x, double) {
    return glm::vec3(float(0.15 + 0.5 * std::sqrt(std::max(0.0, 1 - std::pow((x - 105) / 15, 2)))));
  };
  StillBackground found =
      known_but([](double x, double y) { return x > 95 && x < 150 && y > 50 && y < 110; });
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if (found.level[at(x, y)] == StillBackground::kSure)
        for (std::size_t c = 0; c < 3; ++c)
          found.light[3 * at(x, y) + c] =
              std::uint16_t(std::lround(65535 * std::sqrt(grey(x, y).x)));
  const SheetMask mask = mask_from_sheet(photograph(scene, 0), look(kWidth, kHeight), found);
  int missed = 0, all = 0;
  for (int y = 61; y < kPageTop - 4; ++y)
    for (int x = 97; x < 119; ++x) ++all, missed += mask.mask.coverage[at(x, y)] < 128;
  EXPECT_LT(missed, 0.01 * all);
}

TEST(StillBackgroundTest, PrintNearThePagesEdgeLeavesItsRimBare) {
  const auto printed = [](double y) { return y >= kPageTop + 6 && y < kPageTop + 14; };
  SheetLook sheet = look(kWidth, kHeight);
  sheet.mixed = 6;
  for (int y = kPageTop; y < kPageTop + 14; ++y)
    for (int x = 0; x < kWidth; ++x)
      sheet.light[at(x, y)] = y < kPageTop + 3 ? -1.0f : printed(y) ? 0.0f : 1.0f;
  Scene scene{[](int, double x, double y) { return std::abs(x - 120) < 8 && y > 50 && y < 140; }};
  scene.behind = [](int, double x, double y) { return shelf(x, y); };
  const auto colour = scene.colour;
  Scene with_print = scene;  // the print is drawn as what stands before the page
  with_print.object = [&](int k, double x, double y) {
    return scene.object(k, x, y) || (y >= kPageTop && y < kPageTop + 14);
  };
  with_print.colour = [&](int k, double x, double y) {
    if (scene.object(k, x, y)) return colour(k, x, y);
    return glm::vec3(printed(y) ? 0.03f : 0.8f);
  };
  const SheetMask mask = mask_from_sheet(photograph(with_print, 0), sheet,
                                         known_but([](double, double) { return false; }));
  EXPECT_GT(overlap(mask.mask, scene, 0), 0.9);
}

/// A frame around a patch of itself that looks the same in all photographs.
bool framed(int, double x, double y) { return std::abs(x - 120) < 45 && y > 45 && y < 140; }
bool patch(double x, double y) { return std::abs(x - 120) < 25 && y > 62 && y < 105; }

TEST(StillBackgroundTest, BackgroundThatTheObjectEnclosesIsNotBelieved) {
  Scene scene{framed};
  const auto changing = scene.colour;
  scene.colour = [&](int k, double x, double y) {
    return patch(x, y) ? glm::vec3(0.6f, 0.2f, 0.1f) : changing(k, x, y);
  };
  const StillBackground found = background_of(scene);
  ASSERT_EQ(found.stillness, Stillness::kStill);
  ASSERT_EQ(found.level[at(120, 80)], StillBackground::kDoubtful);
  const SheetMask mask = mask_from_sheet(photograph(scene, 2), look(kWidth, kHeight), found);
  for (int y = 66; y < 102; ++y)
    for (int x = 98; x < 143; x += 4) EXPECT_GE(mask.mask.coverage[at(x, y)], 128) << x << " " << y;
}

}  // namespace
}  // namespace photohull
