#include "pipeline/memory.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

#include "core/error.h"

namespace photohull::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr double kShare = 0.75;  // of what is available

/// The number in a file of one number; nothing for "max" and where there is no such file.
std::optional<std::int64_t> number_in(const fs::path& path) {
  std::ifstream in(path);
  std::int64_t value = 0;
  if (in >> value) return value;
  return std::nullopt;
}

/// The value after `name` in a file of lines "name value", in the value's own unit.
std::optional<std::int64_t> value_of(const fs::path& path, const std::string& name) {
  std::ifstream in(path);
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string key;
    std::int64_t value = 0;
    if (words >> key >> value && key == name) return value;
  }
  return std::nullopt;
}

/// What one control group leaves. Cached files count as used there, but give way.
std::optional<std::int64_t> left_by(const fs::path& group, const char* limit, const char* usage,
                                    const char* cache) {
  const auto most = number_in(group / limit), used = number_in(group / usage);
  if (!most || !used) return std::nullopt;
  return std::max<std::int64_t>(0,
                                *most - *used + value_of(group / "memory.stat", cache).value_or(0));
}

/// The least that the groups from `path` (as proc/self/cgroup tells it) up to the root leave. In a
/// container the path may be one of outside: the root is what is seen there.
std::optional<std::int64_t> left_by_groups(const fs::path& mount, fs::path path, const char* limit,
                                           const char* usage, const char* cache) {
  std::optional<std::int64_t> least;
  for (path = path.relative_path();; path = path.parent_path()) {
    if (const auto left = left_by(mount / path, limit, usage, cache))
      least = std::min(least.value_or(*left), *left);
    if (path.empty()) return least;
  }
}

}  // namespace

std::optional<std::int64_t> parse_max_memory(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const std::string unit = end;
  const std::string letters = "KMGT";
  const std::size_t power = unit.empty() ? std::string::npos : letters.find(unit[0]);
  const bool known = end != text.c_str() && power != std::string::npos &&
                     (unit.size() == 1 || unit.substr(1) == "iB" || unit.substr(1) == "B");
  const double bytes = known ? std::ldexp(value, 10 * (int(power) + 1)) : 0;
  if (!(bytes >= 1 && bytes < 9e18)) return std::nullopt;
  return std::int64_t(bytes);
}

std::optional<std::int64_t> available_memory(const fs::path& root) {
  std::optional<std::int64_t> least;
  const auto take = [&](std::optional<std::int64_t> bytes) {
    if (bytes) least = std::min(least.value_or(*bytes), *bytes);
  };
  if (const auto kibibytes = value_of(root / "proc/meminfo", "MemAvailable:"))
    take(*kibibytes * 1024);
  std::ifstream groups(root / "proc/self/cgroup");
  std::string line;
  while (std::getline(groups, line)) {  // "0::/path", or "9:memory:/path" of version 1
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const fs::path path = line.substr(second + 1);
    if (controllers.empty())
      take(left_by_groups(root / "sys/fs/cgroup", path, "memory.max", "memory.current",
                          "inactive_file"));
    else if (("," + controllers + ",").find(",memory,") != std::string::npos)
      take(left_by_groups(root / "sys/fs/cgroup/memory", path, "memory.limit_in_bytes",
                          "memory.usage_in_bytes", "total_inactive_file"));
  }
  return least;
}

std::int64_t default_max_memory() {
  const auto available = available_memory();
  return available ? std::int64_t(kShare * double(*available))
                   : std::numeric_limits<std::int64_t>::max();
}

std::string memory_text(std::int64_t bytes) {
  const double mebibytes = std::ldexp(double(bytes), -20);
  if (mebibytes < 1024) return concat(std::lround(mebibytes), " MiB");
  return concat(std::round(mebibytes / 1024 * 10) / 10, " GiB");
}

}  // namespace photohull::pipeline
