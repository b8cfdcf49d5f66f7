// What is free, as the kernel and control groups tell it.
#include "pipeline/memory.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/scratch_folder.h"

namespace photohull::pipeline {
namespace {

namespace fs = std::filesystem;

class AvailableMemory : public testing::Test {
 protected:
  void put(const std::string& name, const std::string& text) {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text;
  }
  std::optional<std::int64_t> found() { return available_memory(root_ / ""); }

  ScratchFolder root_;
};

TEST_F(AvailableMemory, IsNotKnownWithoutTheKernelsFiles) { EXPECT_EQ(found(), std::nullopt); }

TEST_F(AvailableMemory, IsWhatTheKernelCallsAvailable) {
  put("proc/meminfo", "MemTotal: 900 kB\nMemFree: 100 kB\nMemAvailable:  500 kB\n");
  EXPECT_EQ(found(), 500 * 1024);
}

TEST_F(AvailableMemory, GroupsOfVersionTwoLeaveLess) {
  put("proc/meminfo", "MemAvailable: 500 kB\n");
  put("proc/self/cgroup", "0::/a/b\n");
  put("sys/fs/cgroup/a/memory.max", "300000\n");
  put("sys/fs/cgroup/a/memory.current", "200000\n");
  put("sys/fs/cgroup/a/memory.stat", "anon 150000\ninactive_file 50000\n");
  put("sys/fs/cgroup/a/b/memory.max", "max\n");
  put("sys/fs/cgroup/a/b/memory.current", "1\n");
  EXPECT_EQ(found(), 150000) << "of the group above; cached files give way";
  put("sys/fs/cgroup/a/b/memory.max", "1000\n");
  EXPECT_EQ(found(), 999);
}

TEST_F(AvailableMemory, GroupsOfVersionOneLeaveLess) {
  put("proc/meminfo", "MemAvailable: 500 kB\n");
  put("proc/self/cgroup", "9:cpu,memory:/outside\n1:name=systemd:/x\n");
  put("sys/fs/cgroup/memory/memory.limit_in_bytes", "4000\n");
  put("sys/fs/cgroup/memory/memory.usage_in_bytes", "3000\n");
  EXPECT_EQ(found(), 1000) << "in a container the root is what is seen";
}

TEST(ParseMaxMemory, ASizeWithItsUnit) {
  EXPECT_EQ(parse_max_memory("512M"), std::int64_t(512) << 20);
  EXPECT_EQ(parse_max_memory("1.5GiB"), std::int64_t(3) << 29);
  EXPECT_EQ(parse_max_memory("2GB"), std::int64_t(2) << 30);
  for (const char* bad : {"", "2", "-1G", "0G", "2X", "2Gi", "G", "1e30T", "nanG", "2G "})
    EXPECT_EQ(parse_max_memory(bad), std::nullopt) << bad;
}

TEST(MemoryText, ReadsWell) {
  EXPECT_EQ(memory_text(300 << 20), "300 MiB");
  EXPECT_EQ(memory_text(std::int64_t(3) << 29), "1.5 GiB");
}

}  // namespace
}  // namespace photohull::pipeline
