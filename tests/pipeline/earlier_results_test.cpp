#include "pipeline/earlier_results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/error.h"
#include "support/scratch_folder.h"

namespace photohull::pipeline {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr double kFocal = 100;

Camera camera(int width, int height) {
  Camera out;
  out.intrinsics = {width, height, kFocal, kFocal, 0, 0.5 * (width - 1), 0.5 * (height - 1)};
  out.cam_from_world.translation = {0, 0, 3};
  return out;
}

PreparedView view_called(const std::string& name, int width = 40, int height = 30) {
  PreparedView out;
  out.name = name;
  out.camera = out.source.camera = camera(width, height);
  // What undistortion made of it.
  out.camera.intrinsics.fx = out.camera.intrinsics.fy = 0.9 * kFocal;
  out.camera.intrinsics.cx -= 2;
  return out;
}

/// A camera as report.json has it: 80 x 60 pixels, moved along x.
json told(const std::string& name, double along_x) {
  return {{"name", name},
          {"size", {80, 60}},
          {"focal", {2.2 * kFocal, 2.2 * kFocal}},
          {"principal", {39.5 + 2, 29.5}},
          {"skew", 0},
          {"rotation", {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
          {"centre", {along_x, 0, -3}}};
}

class EarlierResultsTest : public testing::Test {
 protected:
  EarlierResultsTest() {
    report_ = {{"cameras", {told("a", 0.25), told("b", 0.5)}},
               {"up", {0, 0, 1}},
               {"up_axis", {0, 0, 1}},
               {"preview_png_shows", "a"}};
  }
  ResultRig rig() const {
    write_atomically(folder_ / "report.json", report_.dump());
    return read_rig(folder_.path());
  }

  const ScratchFolder folder_;
  json report_;
  Progress progress_;
};

TEST_F(EarlierResultsTest, CamerasAreThoseOfTheRigAtTheSizeOfThePhotographs) {
  const std::vector<PreparedView> views =
      with_cameras_of(rig(), {view_called("b"), view_called("new")}, progress_);
  const Camera& source = views[0].source.camera;
  EXPECT_EQ(source.intrinsics.width, 40);
  EXPECT_NEAR(source.intrinsics.fx, 1.1 * kFocal, 1e-9);
  EXPECT_NEAR(source.intrinsics.cx, 19.5 + 1, 1e-9);
  EXPECT_NEAR(source.cam_from_world.translation.x, -0.5, 1e-12);
  const Camera& pinhole = views[0].camera;
  EXPECT_NEAR(pinhole.intrinsics.fx, 1.1 * 0.9 * kFocal, 1e-9);
  EXPECT_NEAR(pinhole.intrinsics.cx, 19.5 - 2 + 1, 1e-9);
  EXPECT_NEAR(pinhole.cam_from_world.translation.x, -0.5, 1e-12);
  EXPECT_EQ(views[1].source.camera.intrinsics.fx, kFocal) << "the rig has no such view";
  try {
    with_cameras_of(rig(), {view_called("a", 40, 40)}, progress_);
    ADD_FAILURE() << "other proportions";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("a has 80 x 60 pixels there and 40 x 40 here"));
  }
}

TEST_F(EarlierResultsTest, GainsAreThoseOfTheRigByName) {
  report_["photometric"] = {
      {"used", true},
      {"lenses", {{{"vignetting", 0.25}, {"sigma", 0.01}}}},
      {"views",
       {{{"name", "a"}, {"gain", {0.5, 0.6, 0.7}}, {"solved", true}, {"lens", 0}},
        {{"name", "b"}, {"gain", {1.5, 1.6, 1.7}}, {"solved", true}, {"lens", 0}}}}};
  const MeasuredGains found = gains_of(rig(), {view_called("b"), view_called("new")});
  ASSERT_TRUE(found.gains);
  EXPECT_EQ(found.gains->views[0].gain, glm::dvec3(1.5, 1.6, 1.7));
  EXPECT_EQ(found.gains->views[1].gain, glm::dvec3(1));
  EXPECT_FALSE(found.gains->views[1].solved);
  EXPECT_THAT(found.gains->vignetting, testing::ElementsAre(0.25));
  const json told = json::parse(found.findings.json);
  EXPECT_EQ(told.at("taken_from"), folder_.path().string());
  EXPECT_EQ(told.at("views").size(), 2u) << "so that the next one can go by this one";

  report_["photometric"]["views"][0]["gain"][1] = -1;
  EXPECT_THROW(gains_of(rig(), {view_called("a")}), Error);
  report_["photometric"]["views"][0]["gain"][1] = 1;
  report_["photometric"]["lenses"][0]["vignetting"] = 1.5;
  EXPECT_THROW(gains_of(rig(), {view_called("a")}), Error);
  report_["photometric"].erase("views");
  EXPECT_THROW(gains_of(rig(), {view_called("a")}), Error);
}

TEST_F(EarlierResultsTest, WhereNothingWasCorrectedNothingIs) {
  EXPECT_FALSE(gains_of(rig(), {view_called("a")}).gains) << "it was not asked for";
  report_["photometric"] = {{"used", false}, {"checked", {{"points", 7}}}};
  EXPECT_FALSE(gains_of(rig(), {view_called("a")}).gains);
}

TEST_F(EarlierResultsTest, DigestsTellRigsApart) {
  const std::string usual = digest_of(rig());
  report_["wall_seconds"] = 7;
  EXPECT_EQ(digest_of(rig()), usual);
  report_["cameras"][1]["centre"][0] = 0.5000001;
  EXPECT_NE(digest_of(rig()), usual);
}

TEST_F(EarlierResultsTest, CamerasOfARigHoldUnlessARefinementIsAskedFor) {
  ReconstructOptions options;
  EXPECT_FALSE(options.takes_rig_cameras());
  options.follow = "before";
  EXPECT_TRUE(options.takes_rig_cameras());
  options.refine_cameras = RefineCameras::kOff;
  EXPECT_TRUE(options.takes_rig_cameras());
  options.refine_cameras = RefineCameras::kAuto;
  EXPECT_FALSE(options.takes_rig_cameras());
}

TEST_F(EarlierResultsTest, WhatIsNotThereIsNamed) {
  const auto message = [&](const ReconstructOptions& options) -> std::string {
    try {
      read_earlier(options);
    } catch (const Error& e) {
      return e.what();
    }
    return "nothing thrown";
  };
  ReconstructOptions options;
  EXPECT_EQ(message(options), "nothing thrown");
  options.follow = folder_ / "nowhere";
  EXPECT_THAT(message(options), HasSubstr("nowhere: there is no such folder"));
  options.follow = folder_.path();
  EXPECT_THAT(message(options), HasSubstr("has no report.json"));
  rig();
  EXPECT_THAT(message(options), HasSubstr("volume.vdb"));
  options.rig = options.follow;
  options.follow.clear();
  EXPECT_EQ(message(options), "nothing thrown");
}

}  // namespace
}  // namespace photohull::pipeline
