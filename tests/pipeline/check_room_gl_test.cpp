// Whether a job fits into memory, by its silhouettes.
#include "pipeline/check_room.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "carving/fit_grid.h"
#include "core/error.h"
#include "support/cameras.h"
#include "support/gl_context.h"
#include "support/silhouettes.h"

namespace photohull::pipeline {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr int kSide = 200;

/// A ball in a box of 1.4 units, with 1200 voxels along it.
Subject ball(double radius) {
  Subject subject;
  subject.box = {glm::dvec3(-0.7), glm::dvec3(0.7)};
  subject.grid = carving::fit_grid(subject.box, 1.4 / 1200);
  for (const Camera& camera : test::cameras_around(glm::dvec3(0), 6, 12, 700, kSide, kSide)) {
    PreparedView view;
    view.camera = camera;
    test::Outline outline = test::sphere_outline(camera, glm::dvec3(0), radius);
    view.mask = std::move(outline.mask);
    view.silhouette.distance = std::move(outline.distance);
    subject.views.push_back(std::move(view));
  }
  return subject;
}

void check(double radius, std::int64_t limit) {
  ReconstructOptions options;
  options.box.exact = true;
  options.max_memory = limit;
  Progress silent;
  const Subject subject = ball(radius);
  Hull hull(options, subject, test::gl_context(), silent);
  check_room(options, subject, hull);
}

constexpr std::int64_t kGibi = std::int64_t(1) << 30;

TEST(CheckRoom, GoesByTheSurfaceOfWhatIsInTheBox) {
  EXPECT_NO_THROW(check(0.15, kGibi));
  EXPECT_THAT([] { check(0.6, kGibi); },
              ThrowsMessage<Error>(HasSubstr("of memory, but may take 1 GiB (max_memory)")));
  EXPECT_NO_THROW(check(0.6, 4 * kGibi));
}

}  // namespace
}  // namespace photohull::pipeline
