// Whole reconstructions on devices that take little at once.
#include "sphere_scene.h"

namespace photohull::test {
namespace {

using testing::HasSubstr;

class DeviceLimits : public SphereScene {
 protected:
  static RunOptions limited(const std::string& limits) {
    RunOptions options;
    options.environment = {"PHOTOHULL_DEVICE_LIMITS=" + limits};
    return options;
  }
  struct Files {
    std::string mesh, volume;
  };
  Files results(const Arguments& more, const std::string& limits) const {
    succeed(reconstruct(more), limited(limits));
    return {read_bytes(path("out/mesh.ply")), read_bytes(path("out/volume.vdb"))};
  }
  void expect_same(const Arguments& more, std::initializer_list<const char*> all_limits) const {
    const Files whole = results(more, "groups=65535");
    for (const char* limits : all_limits) {
      const Files parts = results(more, limits);
      EXPECT_TRUE(whole.mesh == parts.mesh) << limits;
      EXPECT_TRUE(whole.volume == parts.volume) << limits;
    }
  }
};

// A row of bricks in the sweep's plane takes 16 KiB a brick: the blocks hold one or two rows, so
// that a plane is worked on in bands, and depth maps lie in images.
TEST_F(DeviceLimits, EveryMethodWritesTheSameBytes) {
  for (const std::string method : {"hull", "voxel-coloring", "space-carving", "refine"})
    expect_same({"--method", method, "--resolution", "56"},
                {"groups=3", "block=200000", "groups=5,block=300000"});
}

TEST_F(DeviceLimits, OtherStepsOfTheSweepsDoToo) {
  expect_same({"--method", "voxel-coloring", "--resolution", "56", "--sampler", "ewa",
               "--r-consistency", "1", "--visibility", "pcf3-virtual"},
              {"groups=3,block=200000"});
  expect_same({"--method", "voxel-coloring", "--resolution", "56", "--visibility", "rays"},
              {"groups=3,block=200000"});
}

TEST_F(DeviceLimits, WithoutMasksToo) {
  expect_same({"--method", "refine", "--resolution", "40", "--masks", "none"},
              {"groups=3,block=4000000"});
}

TEST_F(DeviceLimits, DriversHaveNothingToComplainOf) {
  RunOptions debug;
  debug.environment = {"PHOTOHULL_GL_DEBUG=1"};
  for (const std::string method : {"hull", "voxel-coloring", "space-carving", "refine"})
    EXPECT_THAT(
        succeed(reconstruct({"--method", method, "--resolution", "40", "--export", "glb"}), debug)
            .err,
        testing::Not(HasSubstr("OpenGL: ")))
        << method;
  EXPECT_THAT(succeed({"render", path("out"), "--picture", path("still.png")}, debug).err,
              testing::Not(HasSubstr("OpenGL: ")));
}

TEST_F(DeviceLimits, WhatCannotBeSplitIsRefusedInASentence) {
  fail(1, reconstruct(), {"3 images at once", "16 were given", "--views"}, limited("layers=3"));
  fail(1, reconstruct(), {"no images of", "--image-scale"}, limited("size=40"));
  fail(1, reconstruct({"--method", "voxel-coloring"}), {"in one block", "lower --resolution"},
       limited("block=20000"));
  fail(2, reconstruct(), {"PHOTOHULL_DEVICE_LIMITS", "groups="}, limited("cores=3"));
}

}  // namespace
}  // namespace photohull::test
