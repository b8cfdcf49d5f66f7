#include "core/folder_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "core/error.h"
#include "support/scratch_folder.h"

namespace photohull {
namespace {

TEST(FolderLock, HoldsTheFolderWhileItLives) {
  const ScratchFolder folder;
  const std::filesystem::path path = folder / "results";
  std::filesystem::create_directory(path);
  std::optional<FolderLock> first(std::in_place, path, "out");
  try {
    FolderLock second(path, "out");
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::AllOf(testing::HasSubstr("out=" + path.string()),
                                         testing::HasSubstr("another photohull")));
  }
  first.reset();
  EXPECT_NO_THROW(FolderLock(path, "out"));
  EXPECT_TRUE(std::filesystem::is_empty(path));
}

TEST(FolderLock, OtherFoldersAreFree) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "a");
  std::filesystem::create_directory(folder / "b");
  const FolderLock a(folder / "a", "out");
  EXPECT_NO_THROW(FolderLock(folder / "b", "out"));
}

}  // namespace
}  // namespace photohull
