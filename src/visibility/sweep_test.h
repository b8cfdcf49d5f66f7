// How the plane sweep tells which cameras see a voxel, among what it has passed already.
#pragma once

#include <string>

namespace photohull::visibility {

enum class SweepTest {
  kPlain,          ///< depth map, constant bias
  kReceiverPlane,  ///< and as much bias as the layer's depth changes within a texel
  kVirtual,        ///< virtual sample of the layer at the texel's centre
  kPcf,            ///< share of 3 x 3 texels, as the view's weight
  kPcfVirtual,     ///< the same with a virtual sample at each
  kRays            ///< exact walk through the voxels passed, beyond the bias
};

inline constexpr SweepTest kSweepTests[] = {SweepTest::kPlain,      SweepTest::kReceiverPlane,
                                            SweepTest::kVirtual,    SweepTest::kPcf,
                                            SweepTest::kPcfVirtual, SweepTest::kRays};
inline constexpr SweepTest kDefaultSweepTest = SweepTest::kPlain;

/// Name on the command line: "plain", "receiver-plane", ...
const char* to_string(SweepTest test);
/// Line of "#define" for include/sweep_visibility.glsl.
std::string sweep_test_defines(SweepTest test);

}  // namespace photohull::visibility
