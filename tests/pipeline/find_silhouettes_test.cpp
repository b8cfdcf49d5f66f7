// What masks that were made are worth.
#include "pipeline/find_silhouettes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "masks/drawn_masks.h"
#include "support/cameras.h"

namespace photohull::pipeline {
namespace {

constexpr int kSide = 200, kViews = 12;
constexpr double kDistance = 6, kFocal = 700, kRadius = 0.6;

/// A ball seen from all around.
std::vector<PreparedView> views_of_ball() {
  std::vector<PreparedView> views;
  for (const Camera& camera :
       test::cameras_around(glm::dvec3(0), kDistance, kViews, kFocal, kSide, kSide)) {
    PreparedView view;
    view.name = std::to_string(views.size());
    view.camera = camera;
    const double middle = 0.5 * (kSide - 1);
    const double radius = kFocal * kRadius / std::sqrt(kDistance * kDistance - kRadius * kRadius);
    test::Drawing drawing(kSide, kSide);
    drawing.add_disc({middle, middle}, radius);
    view.mask = drawing.mask();
    view.image.width = view.image.height = kSide;
    view.image.bytes.assign(std::size_t(4) * kSide * kSide, 128);
    views.push_back(view);
  }
  return views;
}

double full_evidence(double confidence, bool made, std::optional<int> views_may_miss = {}) {
  ReconstructOptions options;
  options.views_may_miss = views_may_miss;
  options.mask_offset = 0;
  ViewFindings photographs;
  photographs.mask_confidence = confidence;
  std::vector<PreparedView> views = views_of_ball();
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
TEST(FullEvidence, IsNotTogetherWithViewsThatMayMiss) { EXPECT_EQ(full_evidence(0.9, true, 1), 0); }

}  // namespace
}  // namespace photohull::pipeline
