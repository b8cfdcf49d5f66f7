// Jobs that are killed at random moments, as by power loss or for want of memory.
#include <csignal>
#include <random>

#include "fault_runs.h"
#include "support/effort.h"
#include "support/places.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;

class Killed : public FaultScene {
 protected:
  /// Kills the job at random moments of its stages; after each, a rerun must give the right files.
  void expect_rerun_is_right(const Arguments& job, const std::vector<std::string>& stages,
                             double longest_delay, int times) const {
    const Files right = run_without(job, {"open", 0, scene()}).files;
    std::mt19937 random(1);
    for (int i = 0; i < times; ++i) {
      RunOptions options;
      options.signal = SIGKILL;
      options.signal_after = stages[std::size_t(i) % stages.size()];
      options.signal_delay_seconds = longest_delay * double(random()) / double(random.max());
      options.may_end_before_signal = true;
      SCOPED_TRACE(options.signal_after + std::to_string(options.signal_delay_seconds));
      Arguments command = {test::program()};
      command.insert(command.end(), job.begin(), job.end());
      run_program(command, options);
      for (const auto& [name, bytes] : contents(out()))
        EXPECT_TRUE(name == "report.json" || name == "report.html" || !right.contains(name) ||
                    right.at(name) == bytes)
            << name << " is torn";
      succeed(job);
      expect_all_files(right);
      fs::remove_all(out());
    }
  }
};

TEST_F(Killed, RefinementGoesOn) {
  expect_rerun_is_right(reconstruct({"--resolution", "40"}),
                        {" refine\n", " colour\n", " files\n", " preview\n"}, 0.4, 3 * effort());
}

TEST_F(Killed, SynthesisStartsClean) {
  write_bytes(path("spec.json"),
              R"({"image": {"width": 64, "height": 48},
                  "cameras": {"layout": "hemisphere", "count": 8}, "truth_samples": 2000})");
  expect_rerun_is_right({"synthesize", path("spec.json"), "--out", out()}, {""}, 0.5, 2 * effort());
}

}  // namespace
}  // namespace photohull::test
