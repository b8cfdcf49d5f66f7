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
  options.scene = folder / "scene";
  options.output = folder / "out";
  options.resolution = 32;
  options.method = Method::kHull;
  options.device = "software";
  options.refine_cameras = RefineCameras::kPoses;
  const Report report = reconstruct(options, silent);
  EXPECT_THAT(report.masks_left_out, testing::UnorderedElementsAre("0000.png", "0007.png"));
  EXPECT_TRUE(report.left_out.empty());
}

}  // namespace
}  // namespace photohull::pipeline
