#include "pipeline/refine_cameras.h"

#include <gtest/gtest.h>

namespace photohull::pipeline {
namespace {

CameraRefinement refinement(double before, double after) {
  CameraRefinement r;
  r.changed = true;
  r.all = {before, after, 100};
  return r;
}

TEST(RefinementPays, WhereCamerasWereOffAndAgreeClearlyBetter) {
  EXPECT_TRUE(pays(refinement(0.9, 0.06)));    // a pixel of pose noise
  EXPECT_FALSE(pays(refinement(0.07, 0.05)));  // clean: what matching leaves
  EXPECT_FALSE(pays(refinement(0.9, 0.8)));    // no gain that is worth it
  CameraRefinement unchanged = refinement(0.9, 0.06);
  unchanged.changed = false;
  EXPECT_FALSE(pays(unchanged));
}

TEST(RefinementPays, TangentsJudgeWhereThereAreNoTracks) {
  CameraRefinement r;
  r.changed = true;
  r.tangents_before = 1.2, r.tangents_after = 0.4;
  EXPECT_TRUE(pays(r));
  r.tangents_before = 0.15, r.tangents_after = 0.1;
  EXPECT_FALSE(pays(r));
}

}  // namespace
}  // namespace photohull::pipeline
