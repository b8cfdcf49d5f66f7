#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/reconstruct.h"
#include "support/scratch_folder.h"
#include "synth/synthesize.h"

namespace photohull::pipeline {
namespace {

TEST(WrongMask, IsLeftOutAloneWhereFeaturesConfirmTheCamera) {
  const ScratchFolder folder;
  Progress silent;
  synth::Spec spec = synth::parse_spec(R"({"geometry": {"shape": "block"}, "truth_samples": 100,
      "material": {"faces": true, "contrast": 0.6}, "degradations": {"mask_wrong": [0, 7]},
      "cameras": {"rings": [{"count": 12, "elevation": 10},
                            {"count": 12, "elevation": 40, "phase": 0.5}]}})",
                                       "test", "");
  spec.image = {240, 180, 2};
  synth::synthesize(spec, folder / "scene", silent);
  ReconstructOptions options;
  options.resolution = 32;
  options.method = Method::kHull;
  options.device = "software";
  options.refine_cameras = RefineCameras::kPoses;
  const Report report =
      Reconstructor(options).run(load_photographs(folder / "scene"), silent).report;
  EXPECT_THAT(report.silhouettes.masks_left_out,
              testing::UnorderedElementsAre("0000.png", "0007.png"));
  EXPECT_TRUE(report.silhouettes.left_out.empty());
}

/// A block with 2 of 24 principal points 1.2 pixels off.
class ViewsThatAreOff : public testing::Test {
 protected:
  Report run(std::optional<RefineCameras> refine) {
    Progress silent;
    synth::Spec spec = synth::parse_spec(R"({"geometry": {"shape": "block"}, "truth_samples": 100,
        "material": {"faces": true, "contrast": 0.6},
        "degradations": {"view_shift": 1.2, "view_shift_views": 0.1},
        "cameras": {"rings": [{"count": 12, "elevation": 10},
                              {"count": 12, "elevation": 40, "phase": 0.5}]}})",
                                         "test", "");
    spec.image = {240, 180, 3};
    synth::synthesize(spec, folder_ / "scene", silent);
    ReconstructOptions options;
    options.resolution = 48;
    options.method = Method::kHull;
    options.device = "software";
    options.refine_cameras = refine;
    return Reconstructor(options).run(load_photographs(folder_ / "scene"), silent).report;
  }

  ScratchFolder folder_;
};

TEST_F(ViewsThatAreOff, GetCamerasThatAgree) {
  const Report report = run(std::nullopt);
  EXPECT_THAT(report.warnings,
              testing::Contains(testing::HasSubstr("the cameras of these were refined")));
  EXPECT_TRUE(report.silhouettes.outline_room.empty());
  EXPECT_TRUE(report.silhouettes.left_out.empty());
}

TEST_F(ViewsThatAreOff, CarveWithAsMuchRoomWhereCamerasStay) {
  const Report report = run(RefineCameras::kOff);
  ASSERT_EQ(report.silhouettes.outline_room.size(), 2u);
  for (const OutlineRoom& room : report.silhouettes.outline_room)
    EXPECT_NEAR(room.pixels, 1.2, 0.5);
  EXPECT_THAT(report.warnings, testing::Contains(testing::HasSubstr("carve with as much room")));
}

}  // namespace
}  // namespace photohull::pipeline
