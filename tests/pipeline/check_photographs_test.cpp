#include "pipeline/check_photographs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "support/ray_cast.h"

namespace photohull::pipeline {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const glm::dvec3 kMiddle(1, 2, 3), kUp(0, 0, 1);

/// Views at these azimuths about the middle, at so many degrees above the horizon.
std::vector<SourceView> around(const std::vector<double>& azimuths, double elevation = 30) {
  std::vector<SourceView> views;
  for (const double degrees : azimuths) {
    const double a = degrees * M_PI / 180, e = elevation * M_PI / 180;
    SourceView view;
    view.name = concat("at", degrees);
    view.camera = test::look_at(kMiddle + 4.0 * glm::dvec3(std::cos(e) * std::cos(a),
                                                           std::cos(e) * std::sin(a), std::sin(e)),
                                kMiddle, 300, 200, 200);
    views.push_back(view);
  }
  return views;
}

std::vector<std::string> of_sides(const std::vector<SourceView>& views,
                                  const std::optional<glm::dvec3>& up = kUp) {
  return check_photographs({}, views, kMiddle, up);
}

std::vector<PhotoLook> looks(const std::vector<double>& sharpness,
                             const std::vector<double>& exposures) {
  std::vector<PhotoLook> list;
  for (std::size_t i = 0; i < sharpness.size(); ++i)
    list.push_back({concat("p", i), sharpness[i], exposures[i]});
  return list;
}

TEST(CheckPhotographs, NothingIsSaidOfViewsAllAround) {
  EXPECT_THAT(of_sides(around({0, 50, 100, 150, 200, 250, 300})), IsEmpty());
  // Whether the way up is given or told by the cameras.
  EXPECT_THAT(of_sides(around({0, 50, 100, 150, 200, 250, 300}), std::nullopt), IsEmpty());
}

TEST(CheckPhotographs, AGapIsNamedByTheViewsBesideIt) {
  for (const auto& up : {std::optional(kUp), std::optional<glm::dvec3>()})
    EXPECT_THAT(of_sides(around({0, 40, 80, 120, 160, 200, 240}), up),
                ElementsAre(AllOf(HasSubstr(up ? "over 120 degrees" : "over 1"), HasSubstr("at240"),
                                  HasSubstr("at0"))));
}

TEST(CheckPhotographs, ViewsFromOneSideAreToldWithWhatTheySpan) {
  EXPECT_THAT(of_sides(around({10, 30, 50, 70, 90})),
              ElementsAre(AllOf(HasSubstr("from one side"), HasSubstr("they span 80 degrees"),
                                HasSubstr("from at10 to at90"))));
}

TEST(CheckPhotographs, NothingIsSaidWhereSidesMeanNothing) {
  // From above.
  EXPECT_THAT(of_sides(around({10, 30, 50, 70, 90}, 85)), IsEmpty());
  // A room: the same places, and the views look away from the middle.
  std::vector<SourceView> room = around({10, 30, 50, 70, 90});
  for (SourceView& view : room)
    view.camera =
        test::look_at(view.camera.center(), 2.0 * view.camera.center() - kMiddle, 300, 200, 200);
  EXPECT_THAT(of_sides(room), IsEmpty());
}

TEST(CheckPhotographs, PhotographsThatAreMuchLessSharpAreNamed) {
  EXPECT_THAT(
      check_photographs(looks({1, 1.1, 0.9, 0.3, 1, 0.7}, {0, 0, 0, 0, 0, 0}), {}, kMiddle, kUp),
      ElementsAre(AllOf(HasSubstr("a photograph is much less sharp"), HasSubstr("(p3)"))));
  // What is not known, and what four photographs alone show, counts for nothing.
  EXPECT_THAT(check_photographs(looks({1, 1, 0, 1, 1, 1}, {0, 0, 0, 0, 0, 0}), {}, kMiddle, kUp),
              IsEmpty());
  EXPECT_THAT(check_photographs(looks({1, 1, 0.2, 1}, {0, 0, 0, 0}), {}, kMiddle, kUp), IsEmpty());
}

TEST(CheckPhotographs, AnExposureThatChangesByAStopIsTold) {
  EXPECT_THAT(check_photographs(looks({0, 0, 0}, {0.01, 0.025, 0}), {}, kMiddle, kUp),
              ElementsAre(AllOf(HasSubstr("factor of 2.5 between p0 and p1"),
                                HasSubstr("lock the exposure"))));
  EXPECT_THAT(check_photographs(looks({0, 0, 0}, {0.01, 0.015, 0}), {}, kMiddle, kUp), IsEmpty());
}

}  // namespace
}  // namespace photohull::pipeline
