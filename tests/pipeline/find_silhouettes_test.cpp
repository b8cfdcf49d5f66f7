// What masks that were made are worth.
#include "pipeline/find_silhouettes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "support/cameras.h"

namespace photohull::pipeline {
namespace {

constexpr int kSide = 200, kViews = 12;
constexpr double kDistance = 6, kFocal = 700, kRadius = 0.6;

/// A ball seen from all around; its outlines have bumps and bites of so many pixels, in each view
/// elsewhere.
std::vector<PreparedView> views_of_ball(double waves = 0) {
  std::vector<PreparedView> views;
  for (const Camera& camera :
       test::cameras_around(glm::dvec3(0), kDistance, kViews, kFocal, kSide, kSide)) {
    PreparedView view;
    view.name = std::to_string(views.size());
    view.camera = camera;
    const double middle = 0.5 * (kSide - 1);
    const double radius = kFocal * kRadius / std::sqrt(kDistance * kDistance - kRadius * kRadius);
    view.mask = {kSide, kSide, {}};
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const double angle = std::atan2(y - middle, x - middle);
        const double wave = waves * std::pow(std::sin(3 * angle + 2.4 * double(views.size())), 41);
        const double inside = radius + wave - std::hypot(x - middle, y - middle);
        view.mask.coverage.push_back(
            std::uint8_t(std::lround(255 * std::clamp(0.5 + inside, 0.0, 1.0))));
      }
    view.image.width = view.image.height = kSide;
    view.image.bytes.assign(std::size_t(4) * kSide * kSide, 128);
    views.push_back(view);
  }
  return views;
}

double full_evidence(double confidence, bool made, std::optional<int> views_may_miss = {},
                     double waves = 0) {
  ReconstructOptions options;
  options.views_may_miss = views_may_miss;
  options.mask_offset = 0;
  ViewFindings photographs;
  photographs.mask_confidence = confidence;
  std::vector<PreparedView> views = views_of_ball(waves);
  views[3].source.mask_made = made;
  const Box box{glm::dvec3(-0.7), glm::dvec3(0.7)};
  Progress progress;
  const FoundSilhouettes found = find_silhouettes({options, box, {}, photographs}, views, progress);
  EXPECT_EQ(int(found.views.size()), kViews);
  return found.full_evidence;
}

TEST(FullEvidence, OneMaskIsEnoughWhereMasksWereGiven) { EXPECT_EQ(full_evidence(1, false), 0); }
TEST(FullEvidence, NoMaskIsBelievedAloneWhereMasksAreMade) {
  EXPECT_EQ(full_evidence(0.9, false), 1);
}
TEST(FullEvidence, NoMaskIsBelievedAloneWhereTheSceneSaysThatTheyWereMade) {
  EXPECT_EQ(full_evidence(1, true), 1);
}
TEST(FullEvidence, NoMaskIsBelievedAloneWhereOutlinesContradictEachOther) {
  EXPECT_EQ(full_evidence(1, false, {}, 0.2), 0);
  EXPECT_GE(full_evidence(1, false, {}, 1.5), 1);
}
TEST(FullEvidence, IsNotTogetherWithViewsThatMayMiss) { EXPECT_EQ(full_evidence(0.9, true, 1), 0); }

}  // namespace
}  // namespace photohull::pipeline
