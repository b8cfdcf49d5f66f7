// Space on a disk that nobody else sees.
#include "core/scratch_file.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "support/scratch_folder.h"

namespace photohull {
namespace {

TEST(ScratchFile, KeepsWhatIsWrittenAnywhereInIt) {
  const ScratchFolder folder;
  ScratchFile file(folder.path());
  const std::string far = "far", near = "near";
  EXPECT_TRUE(file.write(std::int64_t(5) << 30, far.data(), far.size()));
  EXPECT_TRUE(file.write(0, near.data(), near.size()));
  std::array<char, 3> bytes{};
  ASSERT_TRUE(file.read(std::int64_t(5) << 30, bytes.data(), bytes.size()));
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "far");
  ASSERT_TRUE(file.read(1, bytes.data(), bytes.size()));
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), "ear");
  EXPECT_FALSE(file.read(std::int64_t(6) << 30, bytes.data(), bytes.size())) << "beyond its end";
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "it has no name";
}

TEST(ScratchFile, WithoutAFolderThereIsNone) {
  for (const std::filesystem::path& path : {std::filesystem::path(), ScratchFolder() / "none"}) {
    ScratchFile file(path);
    char byte = 1;
    EXPECT_FALSE(file.write(0, &byte, 1));
    EXPECT_FALSE(file.read(0, &byte, 1));
  }
}

}  // namespace
}  // namespace photohull
