// A job that fails, or is killed, while its results take the places of an earlier run's.
#include <cerrno>

#include "core/error.h"
#include "fault_runs.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReport = "report.json";
constexpr const char* kPage = "report.html";

class Rerun : public FaultScene {
 protected:
  Rerun() {
    const Fault none = writing("rename", 0);
    older_ = run_without(reconstruct({"--method", "hull", "--resolution", "24"}), none).files;
    newer_ = run_without(rerun(), none).files;
  }

  Arguments rerun() const { return reconstruct({"--method", "hull", "--resolution", "28"}); }
  Fault writing(const std::string& call, long what) const { return {call, what, out()}; }

  void put_older() const {
    fs::remove_all(out());
    fs::create_directories(out());
    for (const auto& [name, bytes] : older_) write_bytes(fs::path(out()) / name, bytes);
  }

  /// How many calls of that kind the rerun makes.
  long calls(const std::string& call) const { return run_without(rerun(), writing(call, 0)).calls; }

  /// Every file is of one of the runs, and where there is a report all are of the run that it tells
  /// of. Temporaries of a process that was killed do not count.
  void expect_one_run_or_no_report() const {
    const Files now = contents(out());
    const auto report = now.find(kReport);
    const bool old_report = report != now.end() && report->second == older_.at(kReport);
    for (const auto& [name, bytes] : now) {
      if (name == kReport || name.find(".partial-") != std::string::npos) continue;
      if (name == kPage) {  // two runs never take the same time
        EXPECT_THAT(bytes, testing::EndsWith("</html>\n")) << "torn";
        continue;
      }
      const bool is_old = bytes == older_.at(name), is_new = bytes == newer_.at(name);
      EXPECT_TRUE(is_old || is_new) << name << " is torn";
      if (report != now.end()) EXPECT_TRUE(old_report ? is_old : is_new) << name;
    }
  }

  Files older_, newer_;
};

TEST_F(Rerun, KilledLeavesOneRunOrNoReport) {
  for (const char* call : {"unlink", "rename"})
    for (long number = calls(call); number > 0; --number) {
      SCOPED_TRACE(concat(call, " ", number));
      put_older();
      kill_at(rerun(), call, number);
      expect_one_run_or_no_report();
      succeed(rerun());
      expect_all_files(newer_);
    }
}

TEST_F(Rerun, FailedLeavesTheOlderRunOrNoReport) {
  for (const char* call : {"sync", "rename"})
    for (long number = calls(call); number > 0; --number) {
      SCOPED_TRACE(concat(call, " ", number));
      put_older();
      const Finished run = run_with(rerun(), writing(call, EIO), number);
      expect_one_run_or_no_report();
      if (run.code == 0) continue;  // a folder that cannot be synced
      EXPECT_EQ(run.code, 1) << run.err;
      const Files left = contents(out());
      const bool report = left.contains(kReport);
      EXPECT_EQ(left.size(), older_.size() - (report ? 0 : 1));
      EXPECT_EQ(run.err.find("has no report.json") == std::string::npos, report) << run.err;
    }
}

TEST_F(Rerun, KeepsTheOlderRunWhereItsReportStays) {
  const long last = calls("unlink");  // of the report
  put_older();
  const Finished run = run_with(rerun(), writing("unlink", EIO), last);
  EXPECT_EQ(run.code, 1) << run.err;
  EXPECT_THAT(run.err, testing::HasSubstr("cannot remove"));
  EXPECT_TRUE(contents(out()) == older_);
}

}  // namespace
}  // namespace photohull::test
