#include "visibility/technique.h"

#include <cmath>
#include <functional>

#include "core/parse_name.h"

namespace photohull::visibility {
namespace {

Technique made(const char* name, const std::function<void(Technique&)>& change) {
  Technique t;
  t.name = name;
  change(t);
  return t;
}

void virtual_normal(Technique& t) {
  t.virtual_samples = VirtualSamples::kNormal;
  t.bias_texels = 0.25;
}

void pcf(Technique& t, int size) {
  virtual_normal(t);
  t.filter = Filter::kPcf;
  t.filter_size = size;
}

void adaptive_pcf(Technique& t, int size) {
  pcf(t, size);
  t.adaptive = true;
}

void variance(Technique& t, int size) {
  t.filter = Filter::kVariance;
  t.filter_size = size;
}

void warp(Technique& t, Warp warp, int partitions = 1) {
  virtual_normal(t);
  t.warp = warp;
  t.partitions = partitions;
}

void detailed(Technique& t, Detail detail) {
  t.detail = detail;
  t.bias_texels = 0.01;
}

std::vector<Technique> make_techniques() {
  using T = Technique;
  return {
      made("plain", [](T&) {}),
      made("slope-bias",
           [](T& t) {
             t.bias = Bias::kSlope;
             t.bias_texels = 0.1;
           }),
      made("second-depth", [](T& t) { t.bias = Bias::kSecondDepth; }),
      made("midpoint", [](T& t) { t.bias = Bias::kMidpoint; }),
      made("dual-depth", [](T& t) { t.bias = Bias::kDualDepth; }),
      made("receiver-plane",
           [](T& t) {
             t.bias = Bias::kReceiverPlane;
             t.bias_texels = 0.1;
           }),
      made("ids", [](T& t) { t.bias = Bias::kIds; }),
      made("virtual-normal", virtual_normal),
      made("virtual-derivatives",
           [](T& t) {
             t.virtual_samples = VirtualSamples::kDerivatives;
             t.bias_texels = 0.25;
           }),
      made("variance3", [](T& t) { variance(t, 3); }),
      made("variance", [](T& t) { variance(t, 5); }),
      made("pcf3", [](T& t) { pcf(t, 3); }),
      made("pcf3-adaptive", [](T& t) { adaptive_pcf(t, 3); }),
      made("pcf5", [](T& t) { pcf(t, 5); }),
      made("pcf5-adaptive", [](T& t) { adaptive_pcf(t, 5); }),
      made("pcf5-circular",
           [](T& t) {
             pcf(t, 5);
             t.kernel = Kernel::kCircularJittered;
           }),
      made("lispsm", [](T& t) { warp(t, Warp::kLispsm); }),
      made("general-lispsm", [](T& t) { warp(t, Warp::kGeneralLispsm); }),
      made("zp2", [](T& t) { warp(t, Warp::kGeneralLispsm, 2); }),
      made("recommended",
           [](T& t) {
             pcf(t, 5);
             t.warp = Warp::kGeneralLispsm;
             t.partitions = 2;
           }),
      made("sub-pixel", [](T& t) { detailed(t, Detail::kSubPixel); }),
      made("coverage", [](T& t) { detailed(t, Detail::kCoverage); }),
      made("lists", [](T& t) { detailed(t, Detail::kLists); }),
  };
}

const char* detail_define(Detail detail) {
  switch (detail) {
    case Detail::kNone:
      return "";
    case Detail::kSubPixel:
      return "#define DETAIL_SUB_PIXEL\n";
    case Detail::kCoverage:
      return "#define DETAIL_COVERAGE\n";
    case Detail::kLists:
      return "#define DETAIL_LISTS\n";
  }
  check_failed(__FILE__, __LINE__, "detail");
}

const char* bias_define(Bias bias) {
  switch (bias) {
    case Bias::kConstant:
    case Bias::kSlope:
      return "";
    case Bias::kSecondDepth:
      return "#define BIAS_SECOND_DEPTH\n";
    case Bias::kMidpoint:
      return "#define BIAS_MIDPOINT\n";
    case Bias::kDualDepth:
      return "#define BIAS_DUAL_DEPTH\n";
    case Bias::kReceiverPlane:
      return "#define BIAS_RECEIVER_PLANE\n";
    case Bias::kIds:
      return "#define COMPARE_IDS\n";
  }
  check_failed(__FILE__, __LINE__, "bias");
}

const char* kernel_define(Kernel kernel) {
  switch (kernel) {
    case Kernel::kRegular:
      return "";
    case Kernel::kJittered:
      return "#define PCF_JITTERED\n";
    case Kernel::kCircular:
      return "#define PCF_CIRCULAR\n";
    case Kernel::kCircularJittered:
      return "#define PCF_CIRCULAR_JITTERED\n";
  }
  check_failed(__FILE__, __LINE__, "kernel");
}

}  // namespace

void Technique::validate() const {
  const auto require = [](bool ok, const char* what) {
    if (!ok) throw UsageError(what);
  };
  require(resolution >= 1 && resolution <= 8192, "resolution must be 1 to 8192 texels");
  require(bias_texels >= 0 && std::isfinite(bias_texels), "bias_texels must not be negative");
  require(slope_factor >= 0 && std::isfinite(slope_factor), "slope_factor must not be negative");
  require(z_max_texels >= 0 && std::isfinite(z_max_texels), "z_max_texels must not be negative");
  require(filter != Filter::kPcf || (filter_size >= 2 && filter_size <= 7),
          "filter_size of percentage-closer filtering must be 2 to 7");
  require(filter != Filter::kVariance ||
              (filter_size >= 3 && filter_size <= 15 && filter_size % 2 == 1),
          "filter_size of variance maps must be odd, 3 to 15");
  require(bleeding_cut >= 0 && bleeding_cut < 1, "bleeding_cut must lie in [0, 1)");
  require(partitions >= 1 && partitions <= 4, "partitions must be 1 to 4");
  require(partitions == 1 || warp != Warp::kNone, "partitions need a warp (fit, or a perspective)");
  require(!march || (warp == Warp::kNone && detail == Detail::kNone && bias != Bias::kSlope &&
                     !needs_second_depth()),
          "march gives the nearest depth of an unwarped map only");
  require(list_block >= 1, "list_block must not be 0");
  require(detail == Detail::kNone || filter == Filter::kNone,
          "sub-pixel maps decide exactly where they know; no filter applies");
}

const std::vector<Technique>& named_techniques() {
  static const std::vector<Technique> all = make_techniques();
  return all;
}

Technique parse_technique(const std::string& option, const std::string& name) {
  return parse_name(option, name, named_techniques());
}

std::string technique_defines(const Technique& t) {
  std::string out = bias_define(t.bias);
  out += detail_define(t.detail);
  if (t.virtual_samples == VirtualSamples::kNormal) out += "#define VIRTUAL_NORMAL\n";
  if (t.virtual_samples == VirtualSamples::kDerivatives) out += "#define VIRTUAL_DERIVATIVES\n";
  if (t.align_to_texels) out += "#define ALIGN_TEXEL\n";
  if (t.filter == Filter::kVariance) out += "#define FILTER_VARIANCE\n";
  if (t.filter == Filter::kPcf) out += "#define FILTER_PCF\n";
  if (t.filter != Filter::kNone) out += concat("#define FILTER_SIZE ", t.filter_size, "\n");
  out += kernel_define(t.kernel);
  if (t.gaussian) out += "#define PCF_GAUSSIAN\n";
  if (t.adaptive) out += "#define PCF_ADAPTIVE\n";
  if (t.on_pixels) out += "#define PCF_ON_PIXELS\n";
  return out;
}

}  // namespace photohull::visibility
