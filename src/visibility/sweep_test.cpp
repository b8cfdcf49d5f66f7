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
