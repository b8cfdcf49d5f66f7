// Every seed through its target, in normal builds: what a fuzzer once found stays mended.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "targets.h"

namespace photohull::fuzz {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> seeds_of(const std::string& target) {
  std::vector<fs::path> files;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(fs::path(PHOTOHULL_FUZZ_SEEDS) / target, failure))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Replay, SeedsAreReadOrRefused) {
  for (const Target& target : targets()) {
    const std::vector<fs::path> seeds = seeds_of(target.name);
    EXPECT_FALSE(seeds.empty()) << "give it a seed in tests/fuzz/seeds/" << target.name;
    for (const fs::path& seed : seeds) EXPECT_NO_THROW(target.run(contents(seed))) << seed;
  }
}

// The beginnings of a seed are what a copy that was cut short leaves.
TEST(Replay, SeedsCutShortAreReadOrRefused) {
  constexpr std::size_t kCuts = 10;
  for (const Target& target : targets())
    for (const fs::path& seed : seeds_of(target.name)) {
      const std::string whole = contents(seed);
      for (std::size_t i = 0; i < kCuts; ++i)
        EXPECT_NO_THROW(target.run(whole.substr(0, whole.size() * i / kCuts))) << seed << " " << i;
    }
}

}  // namespace
}  // namespace photohull::fuzz
