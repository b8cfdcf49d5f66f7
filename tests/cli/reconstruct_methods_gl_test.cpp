// What the methods and their options make of the same photographs.
#include <gmock/gmock.h>

#include "reconstruct_fixture.h"
#include "support/analytic_volumes.h"

namespace photohull::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ReconstructMethods : public Reconstruct {};

TEST_F(ReconstructMethods, MethodsDifferAsTheyShould) {
  double volumes[3] = {};
  int sweeps[3] = {};
  int i = 0;
  for (const char* method : {"hull", "voxel-coloring", "space-carving"}) {
    succeed(reconstruct({"--method", method}));
    volumes[i] = signed_volume(mesh());
    sweeps[i++] = report()["photo"]["sweeps"];
    EXPECT_EQ(report()["options"]["method"], method);
  }
  EXPECT_LE(volumes[2], volumes[0] * 1.001);
  EXPECT_LE(volumes[1], volumes[0] * 1.001);
  EXPECT_THAT(sweeps, ElementsAre(0, 1, testing::Ge(6)));
}

TEST_F(ReconstructMethods, DraftTakesLargerVoxelsAndOnlyTheHull) {
  succeed(reconstruct({"--quality", "draft"}));
  const double draft = report()["grid"]["voxel_size"];
  EXPECT_EQ(report()["options"]["method"], "hull");
  succeed(reconstruct({"--quality", "normal", "--method", "hull"}));
  EXPECT_GT(draft, 2 * report()["grid"]["voxel_size"].get<double>());
}

TEST_F(ReconstructMethods, SweepsSampleAndCompareAsTold) {
  succeed(reconstruct({"--method", "voxel-coloring", "--sampler", "ewa", "--supersample", "2",
                       "--consistency", "robust-variance"}));
  EXPECT_EQ(report()["photo"]["sampler"], "ewa");
  EXPECT_EQ(report()["photo"]["r_consistency"], 0.0);
  EXPECT_EQ(report()["photo"]["supersample"], 2);
  EXPECT_EQ(report()["photo"]["consistency"], "robust-variance");
  EXPECT_NEAR(signed_volume(mesh()), kSphereVolume, 0.1 * kSphereVolume);
  succeed(reconstruct({"--method", "voxel-coloring"}));
  EXPECT_EQ(report()["photo"]["sampler"], "anisotropic");
  EXPECT_EQ(report()["photo"]["consistency"], "zncc");
}

TEST_F(ReconstructMethods, SweepsSearchAsFarAsTold) {
  succeed(reconstruct({"--method", "voxel-coloring", "--r-consistency", "0.5"}));
  EXPECT_EQ(report()["photo"]["r_consistency"], 0.5);
  EXPECT_NEAR(signed_volume(mesh()), kSphereVolume, 0.1 * kSphereVolume);
  fail(2, reconstruct({"--method", "voxel-coloring", "--r-consistency", "9"}),
       {"--r-consistency 9", "0 to 4 pixels"});
  fail(2, reconstruct({"--r-consistency", "1"}), {"--r-consistency", "no plane sweep"});
}

TEST_F(ReconstructMethods, ADraftSaysWhatAHullIs) {
  const Finished run = succeed(reconstruct({"--quality", "draft", "--resolution", "32"}));
  EXPECT_THAT(run.out, HasSubstr("verdict: good"));
  EXPECT_THAT(run.out, HasSubstr("a visual hull is an outer bound"));
  EXPECT_EQ(report()["verdict"]["notes"].size(), 1u);
  succeed(reconstruct());
  EXPECT_EQ(report()["verdict"]["notes"].size(), 0u);
}

}  // namespace
}  // namespace photohull::test
