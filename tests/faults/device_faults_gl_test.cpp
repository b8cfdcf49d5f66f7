// A graphics device that runs out of memory, or that is lost, at any moment of a job.
#include "fault_runs.h"
#include "support/effort.h"

namespace photohull::test {
namespace {

constexpr long kOutOfMemory = 0x0505, kContextLost = 0x0507, kUnknownReset = 0x8255;

class DeviceFaults : public FaultScene {
 protected:
  /// Fails some of the calls, and expects exit code 4, a sentence that says so and what to do, and
  /// no file.
  void expect_told(const Fault& fault, long calls, const std::string& what) const {
    for (const long number : spread(calls, 2 * effort())) {
      SCOPED_TRACE(number);
      const Finished run = run_with(hull(), fault, number);
      EXPECT_EQ(run.code, 4) << run.err;
      const std::vector<std::string> lines = run.error_lines();
      ASSERT_FALSE(lines.empty());
      EXPECT_THAT(lines.back(), testing::StartsWith("photohull: the graphics device"));
      EXPECT_THAT(lines.back(), testing::HasSubstr(what));
      EXPECT_THAT(lines.back(), testing::HasSubstr("--device"));
      EXPECT_TRUE(contents(out()).empty());
    }
  }
  Arguments hull() const { return reconstruct({"--method", "hull"}); }
};

TEST_F(DeviceFaults, AreToldWithWhatToDo) {
  const Fault memory{"gl", kOutOfMemory}, lost{"gl", kContextLost, "", true};
  const long calls = run_without(hull(), memory).calls;
  expect_told(memory, calls, "out of memory");
  expect_told(lost, calls, "was lost");
  EXPECT_THAT(run_with(hull(), memory, 1).err, testing::ContainsRegex("--resolution|--views"));
}

TEST_F(DeviceFaults, AResetIsALostDevice) {
  const Fault reset{"reset", kUnknownReset, "", true};
  expect_told(reset, run_without(hull(), reset).calls, "was lost");
}

}  // namespace
}  // namespace photohull::test
