#include "core/atomic_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/error.h"
#include "support/scratch_folder.h"

namespace photohull {
namespace {

using testing::AllOf;
using testing::HasSubstr;

template <typename Function>
std::string error_of(Function function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
  const ScratchFolder folder;
  {
    AtomicFile file(folder / "a.bin");
    file.write("abc", 3);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.bin"));
    EXPECT_EQ(file.temporary().parent_path(), (folder / "a.bin").parent_path());
    file.write("def", 3);
    file.commit();
  }
  EXPECT_EQ(read_text(folder / "a.bin"), "abcdef");
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicFile, AbandonedLeavesTheOldFile) {
  const ScratchFolder folder;
  write_text(folder / "a.bin", "old");
  { AtomicFile(folder / "a.bin").write("new", 3); }
  EXPECT_EQ(read_text(folder / "a.bin"), "old");
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicFile, TakesAwayWhatKilledProcessesLeft) {
  const ScratchFolder folder;
  for (const char* name : {"a.bin.partial-1-0", "b.bin.partial-77-12", "b.bin.partial-7-x",
                           "b.bin.partial-", ".partial-1-1", "live.partial-1-2"})
    write_text(folder / name, "half of it");
  const int live = ::open((folder / "live.partial-1-2").c_str(), O_RDONLY | O_CLOEXEC);
  ::flock(live, LOCK_EX);
  write_atomically(folder / "a.bin", "new");
  for (const char* name : {"a.bin.partial-1-0", "b.bin.partial-77-12"})
    EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
  for (const char* name :
       {"b.bin.partial-7-x", "b.bin.partial-", ".partial-1-1", "live.partial-1-2"})
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  ::close(live);
}

TEST(AtomicFile, ReplacesTheOldFileWhole) {
  const ScratchFolder folder;
  write_text(folder / "a.bin", "a longer old text");
  AtomicFile file(folder / "a.bin");
  file.write("new", 3);
  file.commit();
  EXPECT_EQ(read_text(folder / "a.bin"), "new");
}

TEST(AtomicFile, WritesThroughLinks) {
  const ScratchFolder folder;
  write_text(folder / "real.bin", "old");
  std::filesystem::create_symlink(folder / "real.bin", folder / "link.bin");
  AtomicFile file(folder / "link.bin");
  file.write("new", 3);
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.bin"));
  EXPECT_EQ(read_text(folder / "real.bin"), "new");
}

TEST(AtomicFile, TwoWritersOfOneTargetDoNotMix) {
  const ScratchFolder folder;
  AtomicFile first(folder / "a.bin"), second(folder / "a.bin");
  first.write("first", 5);
  second.write("second", 6);
  first.commit();
  EXPECT_EQ(read_text(folder / "a.bin"), "first");
  second.commit();
  EXPECT_EQ(read_text(folder / "a.bin"), "second");
  EXPECT_EQ(folder.file_count(), 1u);
}

TEST(AtomicFile, NamesTheMissingFolder) {
  const ScratchFolder folder;
  EXPECT_THAT(error_of([&] { AtomicFile(folder / "missing/a.bin"); }),
              AllOf(HasSubstr("missing/a.bin"), HasSubstr("create the folder")));
}

TEST(AtomicFile, NamesAParentThatIsAFile) {
  const ScratchFolder folder;
  write_text(folder / "file", "");
  EXPECT_THAT(error_of([&] { AtomicFile(folder / "file/a.bin"); }),
              AllOf(HasSubstr("file/a.bin"), HasSubstr("a part of the path is a file")));
}

TEST(AtomicFile, RefusesFoldersAndPipes) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "sub");
  EXPECT_THAT(error_of([&] { AtomicFile(folder / "sub"); }), HasSubstr("a folder"));
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(error_of([&] { AtomicFile(folder / "pipe"); }), HasSubstr("not a regular file"));
  EXPECT_EQ(folder.file_count(), 2u);
}

TEST(AtomicFile, FullDiskIsAnErrorAndLeavesNothing) {
  const ScratchFolder folder;
  const std::string bytes(100000, 'x');
  const FileSizeLimit limit(4096);
  EXPECT_THAT(error_of([&] { AtomicFile(folder / "a.bin").write(bytes.data(), bytes.size()); }),
              AllOf(HasSubstr("a.bin"), HasSubstr("raise the limit")));
  EXPECT_EQ(folder.file_count(), 0u);
}

TEST(AtomicFile, FailedRenameLeavesNothing) {
  const ScratchFolder folder;
  EXPECT_THAT(error_of([&] {
                AtomicFile file(folder / "a.bin");
                std::filesystem::create_directory(folder / "a.bin");
                file.commit();
              }),
              HasSubstr("a.bin"));
  EXPECT_EQ(folder.file_count(), 1u);
}

}  // namespace
}  // namespace photohull
