#include "core/child_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "core/error.h"
#include "support/scratch_folder.h"

namespace photohull {
namespace {

using testing::HasSubstr;

const Progress kSilent;

Finished shell(const std::string& script, double limit = 60) {
  return run_child("/bin/sh", {"-c", script}, limit, kSilent);
}

TEST(RunChild, GivesOutputErrorsAndCode) {
  const Finished f = shell("echo out; echo err >&2; exit 7");
  EXPECT_EQ(f.out, "out\n");
  EXPECT_EQ(f.err, "err\n");
  EXPECT_EQ(f.exit_code, 7);
  EXPECT_EQ(f.signal, 0);
  EXPECT_FALSE(f.ok());
  EXPECT_TRUE(shell("true").ok());
}

TEST(RunChild, TellsSignals) {
  const Finished f = shell("kill -SEGV $$");
  EXPECT_EQ(f.signal, SIGSEGV);
  EXPECT_EQ(f.exit_code, -1);
  EXPECT_FALSE(f.ok());
}

TEST(RunChild, MeasuresTimeAndMemory) {
  // A buffer of 60 MiB, filled and written again and again.
  const Finished f = shell("exec dd if=/dev/zero of=/dev/null bs=60M count=10");
  ASSERT_TRUE(f.ok()) << f.err;
  EXPECT_GT(f.cpu_seconds(), 0);
  EXPECT_GE(f.wall_seconds, 0.5 * f.user_seconds);
  EXPECT_GT(f.peak_memory_bytes, 50'000'000);
  const Finished idle = shell("sleep 0.2");
  EXPECT_GE(idle.wall_seconds, 0.2);
  EXPECT_LT(idle.cpu_seconds(), idle.wall_seconds);
}

TEST(RunChild, KillsTheWholeGroupAtTheLimit) {
  const ScratchFolder folder;
  const std::string pid_file = (folder / "pid").string();
  const Finished f = shell("sleep 1000 & echo $! > " + pid_file + "; wait", 2);
  EXPECT_TRUE(f.timed_out);
  EXPECT_FALSE(f.ok());
  EXPECT_GE(f.wall_seconds, 2);
  EXPECT_LT(f.wall_seconds, 60);
  const pid_t grandchild = std::stoi(read_text(pid_file));
  // Gone, or a zombie that nobody has waited for.
  for (int i = 0; i < 100 && ::kill(grandchild, 0) == 0; ++i) {
    const std::string state = read_text("/proc/" + std::to_string(grandchild) + "/stat");
    if (state.find(" Z ") != std::string::npos) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_NE(::kill(grandchild, 0), 0) << "the child's own child lives on";
}

TEST(RunChild, CancellationKillsIt) {
  process_cancellation().reset();
  std::thread user([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    process_cancellation().cancel();
  });
  EXPECT_THROW(shell("sleep 1000"), Cancelled);
  user.join();
  process_cancellation().reset();
}

TEST(RunChild, KeepsTheEndOfManyErrors) {
  const Finished f = shell(
      "i=0; while [ $i -lt 3000 ]; do echo 'noise noise noise' >&2; i=$((i+1)); done; echo last "
      ">&2");
  EXPECT_LE(f.err.size(), 4096u);
  EXPECT_TRUE(f.err.ends_with("noise\nlast\n"));
}

TEST(RunChild, TellsWhatIsPrintedWhileItIs) {
  std::string heard;
  std::size_t pieces = 0;
  const Finished f = run_child("sh", {"-c", "echo one; sleep 0.3; echo two >&2"}, 60, kSilent,
                               [&](std::string_view text) { heard += text, ++pieces; });
  EXPECT_TRUE(f.ok());
  EXPECT_EQ(heard, "one\ntwo\n");
  EXPECT_EQ(pieces, 2u);
}

TEST(RunChild, KnowsWhatIsOnThePath) {
  EXPECT_TRUE(is_on_path("sh"));
  EXPECT_FALSE(is_on_path("no_program_is_called_so"));
}

TEST(RunChild, NamesAProgramThatCannotBeStarted) {
  std::string message;
  try {
    run_child("/nowhere/program", {}, 1, kSilent);
  } catch (const Error& failure) {
    message = failure.what();
  }
  EXPECT_THAT(message, HasSubstr("/nowhere/program"));
  EXPECT_THAT(message, HasSubstr("cannot be started"));
}

}  // namespace
}  // namespace photohull
