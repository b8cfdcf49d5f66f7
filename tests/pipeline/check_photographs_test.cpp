#include "pipeline/check_photographs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/error.h"
#include "pipeline/coverage_picture.h"
#include "support/ray_cast.h"

namespace photohull::pipeline {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
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
  return check_photographs({}, find_coverage(views, kMiddle, up ? *up : level_up(views, kMiddle)),
                           "");
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
    EXPECT_THAT(
        of_sides(around({0, 40, 80, 120, 160, 200, 240}), up),
        ElementsAre(AllOf(HasSubstr("over 120 degrees"), HasSubstr("between at240 and at0"))));
}

TEST(CheckPhotographs, ViewsFromOneSideAreToldWithWhatTheySpan) {
  EXPECT_THAT(of_sides(around({10, 30, 50, 70, 90})),
              ElementsAre(AllOf(HasSubstr("from one side"), HasSubstr("they span 80 degrees"),
                                HasSubstr("from at10 to at90"))));
}

TEST(CheckPhotographs, AllWideGapsAreNamedAndTheirPicture) {
  const Coverage coverage = find_coverage(around({0, 20, 40, 160, 180, 200, 300}), kMiddle, kUp);
  EXPECT_THAT(check_photographs({}, coverage, "scene/coverage.png"),
              ElementsAre(AllOf(HasSubstr("over 120 degrees, between at40 and at160, and over 100 "
                                          "degrees, between at200 and at300"),
                                EndsWith("; scene/coverage.png shows where"))));
  ASSERT_EQ(coverage.places.size(), 7u);
  EXPECT_NEAR(coverage.places[3].azimuth, 160 * M_PI / 180, 1e-9);
  EXPECT_NEAR(coverage.places[3].elevation, 30 * M_PI / 180, 1e-9);
  // Views in one direction leave the whole circle.
  EXPECT_EQ(find_coverage(around({70, 70, 70}), kMiddle, kUp).gaps.at(0).degrees(), 360);
}

/// Cameras on one side that look down: the mean of their upright axes leans by as much as they do.
TEST(CheckPhotographs, TheWayUpIsToldByCamerasOnOneSide) {
  for (const double elevation : {10.0, 30.0, 55.0}) {
    std::vector<SourceView> views = around({0, 20, 40, 60, 80, 100}, elevation);
    EXPECT_NEAR(glm::dot(level_up(views, kMiddle), kUp), 1, 1e-9) << elevation;
    // Some turned on their sides.
    for (const std::size_t i : {1u, 4u}) {
      glm::dmat3& r = views[i].camera.cam_from_world.rotation;
      r = glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1) * r;
    }
    EXPECT_NEAR(glm::dot(level_up(views, kMiddle), kUp), 1, 1e-9) << elevation;
  }
  // Held by hand: rolled by some degrees.
  std::vector<SourceView> views = around({0, 20, 40, 60, 80, 100, 120, 140});
  for (std::size_t i = 0; i < views.size(); ++i) {
    const double roll = (i % 2 ? 4 : -4) * M_PI / 180;
    glm::dmat3& r = views[i].camera.cam_from_world.rotation;
    r = glm::dmat3(std::cos(roll), std::sin(roll), 0, -std::sin(roll), std::cos(roll), 0, 0, 0, 1) *
        r;
  }
  EXPECT_GT(glm::dot(level_up(views, kMiddle), kUp), std::cos(3 * M_PI / 180));
}

TEST(CheckPhotographs, TheMiddleIsWhatViewsLookAtNotWhatTheySee) {
  // Points lie on the side of the object that faces the cameras.
  const std::vector<glm::dvec3> near(9, kMiddle + glm::dvec3(0.8, 0.5, 0.2));
  std::vector<SourceView> views = around({0, 30, 60, 90, 120});
  EXPECT_NEAR(glm::distance(find_middle(views, near), kMiddle), 0, 1e-6);
  // One that looks elsewhere moves it little.
  views.push_back(around({150})[0]);
  views.back().camera =
      test::look_at(views.back().camera.center(), kMiddle + glm::dvec3(1, 1, 0), 300, 200, 200);
  EXPECT_LT(glm::distance(find_middle(views, near), kMiddle), 0.05);
  // Axes that are parallel, and those of a room, do not tell it.
  std::vector<SourceView> facade;
  for (int i = 0; i < 5; ++i) {
    facade.push_back(around({0})[0]);
    const glm::dvec3 place = facade.back().camera.center() + glm::dvec3(0, i, 0);
    facade.back().camera =
        test::look_at(place, place + kMiddle - facade[0].camera.center(), 300, 200, 200);
  }
  EXPECT_EQ(find_middle(facade, near), near[0]);
  std::vector<SourceView> room = around({0, 90, 180, 270});
  for (SourceView& view : room)
    view.camera =
        test::look_at(view.camera.center(), 2.0 * view.camera.center() - kMiddle, 300, 200, 200);
  EXPECT_EQ(find_middle(room, near), near[0]);
}

/// What lies at a direction of the sky, in the picture of 1000 x 900 pixels.
std::array<int, 3> colour_at(const RgbImage& picture, double azimuth, double elevation) {
  const double a = azimuth * M_PI / 180, r = 310 * (90 - elevation) / 90;
  const int x = int(std::lround(500 + r * std::cos(a))),
            y = int(std::lround(450 - r * std::sin(a)));
  const std::uint8_t* p = &picture.rgb[3 * (std::size_t(y) * std::size_t(picture.width) + x)];
  return {p[0], p[1], p[2]};
}

TEST(CheckPhotographs, PictureShowsPlacesGapsAndWhatIsLeftOut) {
  const std::vector<SourceView> views = around({0, 40, 80, 120, 160, 200, 240});
  const Coverage coverage = find_coverage(views, kMiddle, kUp);
  SkyPlace lost = coverage.places[0];
  lost.azimuth = 100 * M_PI / 180;
  const RgbImage picture =
      draw_coverage(coverage, std::vector<LeftOutPhoto>{{"lost", lost}, {"no", std::nullopt}});
  ASSERT_EQ(picture.width, 1000);
  ASSERT_EQ(picture.rgb.size(), std::size_t(3) * 1000 * 900);
  for (const double azimuth : {40, 80, 120, 160, 200}) {
    const auto dot = colour_at(picture, azimuth, 30);
    EXPECT_GT(dot[1], dot[0] + 60) << azimuth;  // green
  }
  const auto cross = colour_at(picture, 100, 30);
  EXPECT_GT(cross[0], cross[1] + 60);  // red
  const auto shaded = colour_at(picture, 310, 20), bare = colour_at(picture, 140, 20);
  EXPECT_GT(shaded[0], shaded[2] + 40);  // orange
  EXPECT_EQ(bare[0], bare[2]);
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
  EXPECT_THAT(check_photographs(looks({1, 1.1, 0.9, 0.3, 1, 0.7}, {0, 0, 0, 0, 0, 0}), {}, ""),
              ElementsAre(AllOf(HasSubstr("a photograph is much less sharp"), HasSubstr("(p3)"))));
  // What is not known, and what four photographs alone show, counts for nothing.
  EXPECT_THAT(check_photographs(looks({1, 1, 0, 1, 1, 1}, {0, 0, 0, 0, 0, 0}), {}, ""), IsEmpty());
  EXPECT_THAT(check_photographs(looks({1, 1, 0.2, 1}, {0, 0, 0, 0}), {}, ""), IsEmpty());
}

TEST(CheckPhotographs, AnExposureThatChangesByAStopIsTold) {
  EXPECT_THAT(check_photographs(looks({0, 0, 0}, {0.01, 0.025, 0}), {}, ""),
              ElementsAre(AllOf(HasSubstr("factor of 2.5 between p0 and p1"),
                                HasSubstr("lock the exposure"))));
  EXPECT_THAT(check_photographs(looks({0, 0, 0}, {0.01, 0.015, 0}), {}, ""), IsEmpty());
}

}  // namespace
}  // namespace photohull::pipeline
