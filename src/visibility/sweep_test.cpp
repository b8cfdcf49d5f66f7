#include "visibility/sweep_test.h"

#include "core/error.h"

namespace photohull::visibility {

const char* to_string(SweepTest test) {
  switch (test) {
    case SweepTest::kPlain:
      return "plain";
    case SweepTest::kReceiverPlane:
      return "receiver-plane";
    case SweepTest::kVirtual:
      return "virtual-normal";
    case SweepTest::kPcf:
      return "pcf3";
    case SweepTest::kPcfVirtual:
      return "pcf3-virtual";
    case SweepTest::kRays:
      return "rays";
  }
  check_failed(__FILE__, __LINE__, "sweep test");
}

SweepTest parse_sweep_test(std::string_view option, std::string_view name) {
  std::string legal;
  for (const SweepTest test : kSweepTests) {
    if (name == to_string(test)) return test;
    legal += std::string(legal.empty() ? "" : ", ") + to_string(test);
  }
  throw UsageError(concat(option, " ", name, ": expected one of ", legal));
}

std::string sweep_test_defines(SweepTest test) {
  switch (test) {
    case SweepTest::kPlain:
      return "";
    case SweepTest::kReceiverPlane:
      return "#define SWEEP_RECEIVER_PLANE\n";
    case SweepTest::kVirtual:
      return "#define SWEEP_VIRTUAL\n";
    case SweepTest::kPcf:
      return "#define SWEEP_PCF\n";
    case SweepTest::kPcfVirtual:
      return "#define SWEEP_PCF\n#define SWEEP_VIRTUAL\n";
    case SweepTest::kRays:
      return "#define SWEEP_RAYS\n";
  }
  check_failed(__FILE__, __LINE__, "sweep test");
}

}  // namespace photohull::visibility
