#include "archive.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/image_file.h"

namespace photohull::fuzz {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kHeading = "=== ";
constexpr std::size_t kMostFiles = 32, kLongestName = 64;

bool is_name(std::string_view name) {
  const auto legal = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-' || c == '/';
  };
  return !name.empty() && name.size() <= kLongestName && name.front() != '/' &&
         name.back() != '/' && name.find("..") == std::string_view::npos &&
         std::all_of(name.begin(), name.end(), legal);
}

/// The name that the line at `position` announces.
std::optional<std::string_view> heading_at(std::string_view archive, std::size_t position) {
  if (!archive.substr(position).starts_with(kHeading)) return std::nullopt;
  const std::size_t begin = position + kHeading.size();
  const std::size_t end = std::min(archive.find('\n', begin), archive.size());
  const std::string_view name = archive.substr(begin, end - begin);
  return is_name(name) ? std::optional(name) : std::nullopt;
}

struct Entry {
  std::string_view name, bytes;
};

std::vector<Entry> entries(std::string_view archive) {
  std::vector<Entry> found;
  std::size_t begin = 0;  // of the last entry's bytes
  for (std::size_t line = 0; line < archive.size();) {
    const std::size_t end = std::min(archive.find('\n', line), archive.size() - 1) + 1;
    if (const auto name = heading_at(archive, line)) {
      if (!found.empty() && line > begin)
        found.back().bytes = archive.substr(begin, line - 1 - begin);
      if (found.size() == kMostFiles) return found;
      found.push_back({*name, {}});
      begin = end;
    }
    line = end;
  }
  if (!found.empty()) found.back().bytes = archive.substr(begin);
  return found;
}

const std::string& grey_picture(const fs::path& scratch) {
  static const std::string bytes = [&] {
    const fs::path file = scratch / "grey.png";
    const std::vector<std::uint8_t> pixels(8 * 6 * 3, 100);
    io::write_png(file, 8, 6, 3, pixels);
    std::ifstream in(file, std::ios::binary);
    std::string contents{std::istreambuf_iterator<char>(in), {}};
    fs::remove(file);
    return contents;
  }();
  return bytes;
}

struct Scratch {
  Scratch() {
    std::error_code ignored;
    const fs::path memory = "/dev/shm";
    fs::path parent = fs::is_directory(memory, ignored) && ::access(memory.c_str(), W_OK) == 0
                          ? memory
                          : fs::temp_directory_path();
    folder = parent / concat("photohull_fuzz_", ::getpid());
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }
  fs::path folder;
};

}  // namespace

void unpack(std::string_view archive, const fs::path& folder) {
  for (const Entry& entry : entries(archive)) {
    const fs::path path = folder / entry.name;
    std::error_code failure;  // a name may also be another's folder
    fs::create_directories(path.parent_path(), failure);
    std::ofstream out(path, std::ios::binary);
    out << (entry.bytes.empty() && entry.name.ends_with(".png") ? grey_picture(folder)
                                                                : entry.bytes);
  }
}

const fs::path& empty_folder() {
  static const Scratch scratch;
  fs::remove_all(scratch.folder);
  fs::create_directories(scratch.folder);
  return scratch.folder;
}

}  // namespace photohull::fuzz
