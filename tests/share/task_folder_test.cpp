#include "share/task_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <thread>
#include <vector>

#include "core/error.h"
#include "core/file_lock.h"
#include "support/scratch_folder.h"

namespace photohull::share {
namespace {

namespace fs = std::filesystem;

std::string twice(const std::string& text) { return text + text; }

class TaskFolderTest : public ::testing::Test {
 protected:
  TaskFolderTest() : folder_(scratch_.path() / "tasks") {}

  /// Twenty tasks; a result has to be twice its task.
  Tasks tasks() {
    results_.assign(20, "");
    return {"step", results_.size(), [](std::size_t i) { return concat("<", i, ">"); },
            [this](std::size_t i, const std::string& result) {
              if (result != twice(concat("<", i, ">"))) throw Error("it is another one's");
              results_[i] = result;
            }};
  }
  void expect_all() const {
    for (std::size_t i = 0; i < results_.size(); ++i)
      EXPECT_EQ(results_[i], twice(concat("<", i, ">"))) << i;
    EXPECT_TRUE(fs::is_empty(folder_.folder())) << "files are left";
  }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_.folder() / name) << bytes;
  }

  struct Warnings : Progress {
    void warn(const std::string& message) override { texts.push_back(message); }
    std::vector<std::string> texts;
  };

  ScratchFolder scratch_;
  TaskFolder folder_;
  std::vector<std::string> results_;
  Warnings progress_;
};

TEST_F(TaskFolderTest, WhoIsAloneDoesAll) {
  int done = 0;
  const auto perform = [&](const std::string& task) {
    ++done;
    return twice(task);
  };
  EXPECT_TRUE(folder_.do_all(tasks(), perform, progress_));
  expect_all();
  EXPECT_EQ(done, 20);
  EXPECT_FALSE(folder_.help(perform)) << "nothing is left";
  EXPECT_FALSE(has_tasks(folder_.folder()));
  EXPECT_TRUE(progress_.texts.empty());
}

TEST_F(TaskFolderTest, HelpersDoWhatNobodyIsAtAndEachTaskIsDoneOnce) {
  std::atomic<int> mine = 0, theirs = 0;
  std::atomic<bool> ended = false;
  const auto slow = [](std::atomic<int>& count) {
    return [&count](const std::string& task) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      ++count;
      return twice(task);
    };
  };
  std::vector<std::thread> helpers;
  for (int i = 0; i < 3; ++i)
    helpers.emplace_back([&] {
      while (!ended)
        if (!folder_.help(slow(theirs))) std::this_thread::yield();
    });
  folder_.do_all(tasks(), slow(mine), progress_);
  ended = true;
  for (std::thread& helper : helpers) helper.join();
  expect_all();
  EXPECT_GT(theirs, 0);
  EXPECT_EQ(mine + theirs, 20);
}

TEST_F(TaskFolderTest, TheTaskOfAHelperThatWasKilledIsDoneAnew) {
  write("step-3.task", "<3>");
  const pid_t helper = ::fork();
  if (helper == 0) {
    folder_.help([](const std::string&) -> std::string {
      for (;;) ::pause();
    });
    ::_exit(0);
  }
  while (FileLock::if_free(folder_.folder() / "step-3.lock"))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::thread killer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ::kill(helper, SIGKILL);
    ::waitpid(helper, nullptr, 0);
  });
  folder_.do_all(tasks(), twice, progress_);
  killer.join();
  expect_all();
}

TEST_F(TaskFolderTest, WhatAHelperLeftIsTakenAndDamageIsMadeAnew) {
  write("step-0.result", "<0><0>");  // of a process that was killed before it took it
  write("step-1.result", "<1><");
  write("step-2.result", "");
  int done = 0;
  folder_.do_all(
      tasks(),
      [&](const std::string& task) {
        ++done;
        return twice(task);
      },
      progress_);
  expect_all();
  EXPECT_EQ(done, 19);
}

TEST_F(TaskFolderTest, WithoutItsFolderAProcessDoesAllByItself) {
  fs::remove_all(folder_.folder());
  folder_.do_all(tasks(), twice, progress_);
  EXPECT_EQ(results_[19], "<19><19>");
  ASSERT_EQ(progress_.texts.size(), 1u);
  EXPECT_THAT(progress_.texts[0], testing::HasSubstr("other processes cannot help: "));
  EXPECT_FALSE(folder_.help(twice));
}

TEST_F(TaskFolderTest, OnAFullDiskAProcessDoesAllByItself) {
  {
    const FileSizeLimit full(2);
    EXPECT_FALSE(folder_.do_all(tasks(), twice, progress_));
  }
  EXPECT_EQ(results_[0], "<0><0>");
  EXPECT_EQ(results_[19], "<19><19>");
  ASSERT_EQ(progress_.texts.size(), 1u);
  EXPECT_THAT(progress_.texts[0], testing::HasSubstr("other processes cannot help: "));
  write("step-0.task", "<0>");
  const FileSizeLimit full(2);
  EXPECT_THROW(folder_.help(twice), Error);
}

TEST_F(TaskFolderTest, TasksAreOpenUntilTheyHaveAResult) {
  EXPECT_FALSE(has_tasks(scratch_ / "nowhere"));
  write("job.photographs", "no task");
  EXPECT_FALSE(has_tasks(folder_.folder()));
  write("step-0.task", "<0>");
  EXPECT_TRUE(has_tasks(folder_.folder()));
  EXPECT_TRUE(folder_.help(twice));
  EXPECT_FALSE(has_tasks(folder_.folder()));
}

TEST_F(TaskFolderTest, WhatATaskNeedsMayBeGoneWhenItIs) {
  write("step-0.task", "<0>");
  const auto gone = [&](const std::string&) -> std::string {
    fs::remove(folder_.folder() / "step-0.task");  // done by somebody else
    throw Error("its files are gone");
  };
  EXPECT_FALSE(folder_.help(gone));
  write("step-0.task", "<0>");
  EXPECT_THROW(folder_.help([](const std::string&) -> std::string { throw Error("it cannot"); }),
               Error);
}

TEST_F(TaskFolderTest, StopsWhenItIsCancelled) {
  const auto held = FileLock::if_free(folder_.folder() / "step-7.lock");  // who never ends
  ASSERT_TRUE(held);
  const CancellationToken token;
  Progress progress(token);
  std::thread user([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    token.cancel();
  });
  EXPECT_THROW(folder_.do_all(tasks(), twice, progress), Cancelled);
  user.join();
}

}  // namespace
}  // namespace photohull::share
