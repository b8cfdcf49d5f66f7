// The techniques of visibility maps and their options.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace photohull::visibility {

/// What is added to a map's depth before the test, z_map = z1 + z_bias(z1, z2) [BarrosoCeles07].
enum class Bias {
  kConstant,
  kSlope,          ///< constant, and the depth's greatest change from texel to texel
  kSecondDepth,    ///< z2 - z1
  kMidpoint,       ///< (z2 - z1) / 2
  kDualDepth,      ///< min((z2 - z1) / 2, z_max)
  kReceiverPlane,  ///< constant, and the change of the receiver's plane within a texel
  kIds             ///< none: identity of triangles or bricks is compared first
};

/// At which depth a receiver is compared away from its own position.
enum class VirtualSamples { kNone, kNormal, kDerivatives };

enum class Filter { kNone, kPcf, kVariance };
enum class Kernel { kRegular, kJittered, kCircular, kCircularJittered };

/// How the map's texels are spread over what the receivers' camera sees.
enum class Warp {
  kNone,          ///< evenly over the viewpoint's image
  kFit,           ///< evenly over the region that the receivers' camera sees
  kLispsm,        ///< over its trapezoid, n' of light-space perspective maps [Wimmer04]
  kGeneralLispsm  ///< the same, n' for any angle between the two cameras
};

/// What a texel knows beyond depths.
enum class Detail {
  kNone,
  kSubPixel,  ///< one triangle [Lecocq14]
  kCoverage,  ///< up to four, found in the neighbours [Li17]
  kLists      ///< all that can be seen within it
};

struct Technique {
  std::string name = "plain";
  int resolution = 1024;  ///< texels along the image's longer side, of all partitions; 1 to 8192
  Bias bias = Bias::kConstant;
  double bias_texels = 1;   ///< constant bias, widths of a texel at mid depth; finite, >= 0
  double slope_factor = 1;  ///< of Bias::kSlope; >= 0
  double z_max_texels = 4;  ///< limit of dual depth, widths of a texel at mid depth; >= 0
  VirtualSamples virtual_samples = VirtualSamples::kNone;
  bool align_to_texels =
      true;  ///< virtual samples lie at texels' centres, not at the kernel's taps
  Filter filter = Filter::kNone;
  int filter_size = 3;  ///< taps along a side: 2 to 7; variance: odd, 3 to 15
  Kernel kernel = Kernel::kRegular;
  bool gaussian = false;          ///< Gaussian weights
  bool adaptive = false;          ///< outer taps first
  bool on_pixels = false;         ///< the kernel lies on the receivers' neighbours, not on texels
  double bleeding_cut = 0;        ///< variance: fractions below count as none; in [0, 1)
  Warp warp = Warp::kNone;        ///< other than kNone: render_map needs the receivers' camera
  int partitions = 1;             ///< in the receivers' depth; 1 to 4
  Detail detail = Detail::kNone;  ///< other than kNone: triangles decide, filters do not apply
  std::uint32_t list_block = 1u << 25;  ///< kLists: words in the first of two storage blocks; every
                                        ///< device has room for 2^25
  bool march = false;  ///< volumes: rays through bricks instead of rasterised faces; needs constant
                       ///< bias or ids, no warp and no detail

  void validate() const;  ///< throws UsageError naming the field
  bool needs_second_depth() const {
    return bias == Bias::kSecondDepth || bias == Bias::kMidpoint || bias == Bias::kDualDepth;
  }
  bool needs_ids() const { return bias == Bias::kIds; }
};

/// The techniques that have names, with their default options.
const std::vector<Technique>& named_techniques();
inline const std::string& to_string(const Technique& technique) { return technique.name; }
/// Throws UsageError naming `option` and listing the names.
Technique parse_technique(const std::string& option, const std::string& name);

/// Lines of "#define" that make include/visibility_test.glsl this technique.
std::string technique_defines(const Technique& technique);

}  // namespace photohull::visibility
