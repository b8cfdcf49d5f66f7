#include "lab/chart/identity.h"

#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "core/error.h"
#include "lab/chart/json_fields.h"

namespace photohull::chart {
namespace {

namespace fs = std::filesystem;

std::string hex(const XXH128_hash_t& hash) {
  char text[33];
  std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return text;
}

/// A digest that grows, file by file.
class Digest {
 public:
  Digest() : state_(XXH3_createState()) {
    if (!state_) throw std::bad_alloc();
    XXH3_128bits_reset(state_);
  }
  ~Digest() { XXH3_freeState(state_); }
  Digest(const Digest&) = delete;
  Digest& operator=(const Digest&) = delete;

  /// The length goes first, so that "ab" + "c" and "a" + "bc" differ.
  void add(std::string_view text) {
    const std::uint64_t size = text.size();
    XXH3_128bits_update(state_, &size, sizeof size);
    XXH3_128bits_update(state_, text.data(), text.size());
  }
  void add_file(const fs::path& path) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                               std::fclose);
    if (!file) throw Error(concat(path.string(), ": cannot be read: ", std::strerror(errno)));
    std::vector<char> block(1 << 20);
    std::uint64_t size = 0;
    while (const std::size_t count = std::fread(block.data(), 1, block.size(), file.get())) {
      XXH3_128bits_update(state_, block.data(), count);
      size += count;
    }
    if (std::ferror(file.get())) throw Error(concat(path.string(), ": cannot be read in full"));
    XXH3_128bits_update(state_, &size, sizeof size);
  }
  std::string result() const { return hex(XXH3_128bits_digest(state_)); }

 private:
  XXH3_state_t* state_;
};

void add_named_files(const Json& value, const fs::path& folder, Digest& digest) {
  if (value.is_structured()) {
    for (const auto& element : value) add_named_files(element, folder, digest);
    return;
  }
  if (!value.is_string()) return;
  const fs::path named = folder / value.get<std::string>();
  std::error_code status;
  if (fs::is_regular_file(named, status)) digest.add_file(named);
}

}  // namespace

std::string hash_text(std::string_view text) { return hex(XXH3_128bits(text.data(), text.size())); }

std::string hash_file(const fs::path& file) {
  Digest digest;
  digest.add_file(file);
  return digest.result();
}

std::string hash_folder(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  Digest digest;
  for (const fs::path& file : files) {
    digest.add(file.lexically_relative(folder).generic_string());
    digest.add_file(file);
  }
  return digest.result();
}

std::string hash_spec(const fs::path& spec) {
  Digest digest;
  digest.add_file(spec);
  add_named_files(read_json(spec), spec.parent_path(), digest);
  return digest.result();
}

}  // namespace photohull::chart
