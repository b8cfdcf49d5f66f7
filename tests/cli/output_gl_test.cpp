// Where results cannot be put, runs that are stopped, and what the terminal shows meanwhile.
#include <sys/mount.h>

#include <csignal>

#include "core/folder_lock.h"
#include "sphere_scene.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class Output : public SphereScene {
 protected:
  /// Results of an earlier run that a failing one must not touch.
  void put_earlier_results() const {
    fs::create_directories(out());
    for (const char* name : {"mesh.ply", "preview.png", "report.html", "report.json", "volume.vdb"})
      write_bytes(fs::path(out()) / name, "earlier");
  }
  void expect_earlier_results() const {
    for (const char* name : {"mesh.ply", "preview.png", "report.html", "report.json", "volume.vdb"})
      EXPECT_EQ(read_bytes(fs::path(out()) / name), "earlier") << name;
    std::vector<std::string> files = listing(out());
    std::erase(files, ".photohull-checkpoint");  // for a rerun to go on from
    EXPECT_EQ(files.size(), 5u);
  }
  /// A job of several seconds.
  Arguments long_job() const { return reconstruct({"--resolution", "160"}); }
};

TEST_F(Output, FolderThatCannotBeMade) {
  write_bytes(path("file"), "x");
  for (const char* name : {"file", "file/below"})
    fail(1, {"reconstruct", scene(), "--out", path(name)}, {"--out " + path(name), "cannot make"});
  EXPECT_EQ(read_bytes(path("file")), "x");
  fail(1, {"reconstruct", scene(), "--out", "/proc/photohull"}, {"--out /proc/photohull"});
  fs::create_directories(path("out/mesh.ply"));
  fail(1, reconstruct(), {path("out/mesh.ply"), "folder"});
}

TEST_F(Output, FileSizeLimitLeavesEarlierResults) {
  put_earlier_results();
  for (const rlim_t limit : {0, 1000, 100000}) {
    RunOptions limited;
    limited.file_size_limit = limit;
    fail(1, reconstruct({"--method", "hull"}), {"cannot write", out(), "too large"}, limited);
    expect_earlier_results();
  }
}

TEST_F(Output, FullDiskLeavesEarlierResults) {
  fs::create_directories(out());
  if (::mount("tmpfs", out().c_str(), "tmpfs", 0, "size=200k") != 0)
    GTEST_SKIP() << "this needs the right to mount a small file system";
  put_earlier_results();
  fail(1, reconstruct({"--method", "hull"}), {"cannot write", out(), "No space left", "free some"});
  expect_earlier_results();
  ::umount(out().c_str());
}

TEST_F(Output, SignalsStopTheJobAndLeaveEarlierResults) {
  put_earlier_results();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    RunOptions stopped;
    stopped.signal = signal;
    stopped.signal_after = " refine\n";
    stopped.timeout_seconds = 60;
    const Finished run = fail(130, long_job(), {"cancelled"}, stopped);
    EXPECT_THAT(run.err, Not(HasSubstr(" mesh\n")));
    expect_earlier_results();
  }
}

TEST_F(Output, CheckpointGoesWhenTheJobHasEnded) {
  succeed(reconstruct({"--method", "refine", "--resolution", "48"}));
  EXPECT_FALSE(fs::exists(fs::path(out()) / ".photohull-checkpoint"));
  write_bytes(fs::path(out()) / ".photohull-checkpoint", "damaged");
  const Finished run = succeed(reconstruct({"--method", "refine", "--resolution", "48"}));
  EXPECT_THAT(run.err, HasSubstr("starting afresh"));
  write_bytes(fs::path(out()) / ".photohull-checkpoint", "damaged");
  const Finished fresh =
      succeed(reconstruct({"--method", "refine", "--resolution", "48", "--fresh"}));
  EXPECT_THAT(fresh.err, Not(HasSubstr("starting afresh")));
}

TEST_F(Output, PlainLinesWithoutATerminal) {
  const Finished run = succeed(reconstruct({"--method", "hull"}));
  EXPECT_THAT(run.err, AllOf(Not(HasSubstr("\033")), Not(HasSubstr("\r"))));
  for (const std::string& line : run.error_lines())
    EXPECT_THAT(line, AnyOf(ContainsRegex("^\\[ *[0-9.]+ s\\] [a-z]+$"), StartsWith("warning: ")));
  EXPECT_THAT(run.err, HasSubstr("] hull\n"));
}

TEST_F(Output, ABarOnATerminal) {
  RunOptions terminal;
  terminal.error_terminal = true;
  const Finished run = succeed(reconstruct({"--resolution", "96", "--json"}), terminal);
  EXPECT_THAT(run.out, StartsWith("{"));
  EXPECT_THAT(run.err, ContainsRegex("\\[#*\\.*\\] +[0-9]+ % refine, [0-9]+ s left"));
  EXPECT_THAT(run.err, testing::EndsWith("\r\033[K"));  // the line is given back clean
}

TEST_F(Output, PlainLinesOnATerminalThatTakesNoEscapeSequences) {
  for (const char* plain : {"TERM=dumb", "NO_COLOR=1"}) {
    RunOptions terminal;
    terminal.error_terminal = true;
    terminal.environment = {"TERM=xterm", plain};
    const Finished run = succeed(reconstruct({"--method", "hull"}), terminal);
    EXPECT_THAT(run.err, AllOf(Not(HasSubstr("\033")), HasSubstr("] hull"))) << plain;
  }
}

TEST_F(Output, ASecondJobIntoTheSameFolderIsRefused) {
  put_earlier_results();
  {
    const FolderLock first(out(), "out");
    fail(1, reconstruct({"--method", "hull"}),
         {"--out " + out(), "another photohull is at work there"});
    expect_earlier_results();
    succeed({"reconstruct", scene(), "--out", path("other"), "--method", "hull"});
  }
  succeed(reconstruct({"--method", "hull"}));
}

TEST_F(Output, AJobThatGoesOnSaysSo) {
  RunOptions stopped;
  stopped.signal = SIGINT;
  stopped.signal_after = " refine\n";
  const fs::path checkpoint = fs::path(out()) / ".photohull-checkpoint";
  for (double delay = 0.5; !fs::exists(checkpoint) && delay < 60; delay *= 1.5) {
    stopped.signal_delay_seconds = delay;
    stopped.may_end_before_signal = true;
    ASSERT_EQ(run_photohull(long_job(), stopped).code, 130);
  }
  EXPECT_THAT(succeed(long_job()).err, HasSubstr("note: an interrupted run of this job had done"));
}

TEST_F(Output, AnErrorOnATerminalStandsOnALineOfItsOwn) {
  fs::remove(image(2));
  RunOptions terminal;
  terminal.error_terminal = true;
  const Finished run = run_photohull(reconstruct({"--strict"}), terminal);
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("\r\033[Kphotohull: "));
}

}  // namespace
}  // namespace photohull::test
