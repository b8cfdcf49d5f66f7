// Reconstructions of photographs whose masks are found, or that have none.
#include <gmock/gmock.h>

#include "reconstruct_fixture.h"
#include "support/analytic_volumes.h"

namespace photohull::test {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;

class ReconstructWithoutMasks : public Reconstruct {};

TEST_F(ReconstructWithoutMasks, MasksMayBeFoundOrLeftOut) {
  const Finished none = run_photohull(reconstruct({"--masks", "none", "--method", "hull"}));
  EXPECT_EQ(none.code, 3);
  EXPECT_THAT(none.err, HasSubstr("no view has a mask"));
  EXPECT_EQ(report()["verdict"]["level"], "failed");
  EXPECT_EQ(report()["masks"]["source"], "none");
  EXPECT_THAT(none.err, HasSubstr("warning: without masks the hull is the box"));
  EXPECT_GT(signed_volume(mesh()), 1.5 * kSphereVolume);
  succeed(reconstruct({"--masks", "auto", "--method", "hull"}));
  EXPECT_EQ(report()["masks"]["source"], "background model");
  EXPECT_NEAR(signed_volume(mesh()), 1.05 * kSphereVolume, 0.15 * kSphereVolume);
  EXPECT_EQ(open_edges(mesh()), 0u);
}

TEST_F(ReconstructWithoutMasks, WithoutMasksColoursCarve) {
  succeed(reconstruct({"--masks", "none", "--method", "space-carving"}));
  EXPECT_GT(report()["photo"]["voxels_carved"], 100);
  EXPECT_EQ(open_edges(mesh()), 0u);
}

TEST_F(ReconstructWithoutMasks, WithoutMasksPhotographsFindTheSurface) {
  run_photohull(reconstruct({"--masks", "none", "--method", "hull"}));  // fails its own checks
  const double hull = signed_volume(mesh());
  succeed(reconstruct({"--masks", "none"}));
  EXPECT_GT(open_edges(mesh()), 0u);  // nothing bounds what no photograph tells
  succeed(reconstruct({"--masks", "none", "--unseen", "closed"}));
  EXPECT_FALSE(report()["refine"].empty());
  // Sixteen small pictures 50 degrees apart tell of part of the ball only.
  EXPECT_NEAR(signed_volume(mesh()), kSphereVolume, 0.4 * kSphereVolume);
  EXPECT_LT(signed_volume(mesh()), 0.8 * hull);
  EXPECT_EQ(open_edges(mesh()), 0u);
}

TEST_F(ReconstructWithoutMasks, WithoutMasksTheVerdictSaysWhatIsExplained) {
  const Finished run = succeed(reconstruct({"--masks", "none", "--evidence"}));
  EXPECT_THAT(run.out, HasSubstr("of the texture that the photographs show in the box"));
  EXPECT_THAT(listing(out()), Contains("explained.png"));
  EXPECT_THAT(listing(out()), testing::Not(Contains("missing.png")));
  const json verdict = report()["verdict"], photographs = verdict["photographs"];
  EXPECT_EQ(photographs["views"].size(), std::size_t(kViews));
  EXPECT_GT(photographs["explained"], 0.5);
  EXPECT_EQ(verdict["explained_png_shows"].get<std::string>().rfind("view", 0), 0u);
  succeed(reconstruct({"--evidence"}));
  EXPECT_FALSE(report()["verdict"].contains("photographs"));
  EXPECT_THAT(listing(out()), Contains("missing.png"));
}

TEST_F(ReconstructWithoutMasks, PhotographsOfOtherViewsAreNeverGood) {
  for (int i = 0; i < kViews / 2; ++i) {
    const std::string bytes = read_bytes(image(i));
    write_bytes(image(i), read_bytes(image(i + kViews / 2)));
    write_bytes(image(i + kViews / 2), bytes);
  }
  const Finished run = run_photohull(reconstruct({"--masks", "none"}));
  if (run.code == 0) {
    EXPECT_NE(report()["verdict"]["level"], "good");
  }
}

}  // namespace
}  // namespace photohull::test
