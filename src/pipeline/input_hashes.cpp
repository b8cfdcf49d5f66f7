#include "pipeline/input_hashes.h"

#include <tbb/parallel_for.h>
#include <xxhash.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <new>
#include <string_view>

namespace photohull::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlock = std::size_t(1) << 20;  // bytes read at once
constexpr int kDeepest = 1;                           // folders below a scene that is a folder

/// Of the files that cameras come in.
constexpr std::string_view kCameraFiles[] = {".txt", ".bin", ".json",  ".xml", ".ini",
                                             ".out", ".nvm", ".mat",   ".yml", ".yaml",
                                             ".csv", ".sfm", ".camera"};

std::string digits_of(const XXH128_hash_t& hash) {
  char digits[33];
  std::snprintf(digits, sizeof digits, "%016llx%016llx",
                static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return digits;
}

/// False where it cannot be read.
bool hash(InputFile& file) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.path.c_str(), "rb"),
                                                               std::fclose);
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(),
                                                                              XXH3_freeState);
  if (!state) throw std::bad_alloc();
  if (!stream) return false;
  XXH3_128bits_reset(state.get());
  std::vector<char> block(kBlock);
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), stream.get())) {
    XXH3_128bits_update(state.get(), block.data(), count);
    file.bytes += std::int64_t(count);
  }
  if (std::ferror(stream.get())) return false;
  file.xxh3_128 = digits_of(XXH3_128bits_digest(state.get()));
  return true;
}

bool is_camera_file(const fs::path& path) {
  const auto end = std::end(kCameraFiles);
  return std::find(std::begin(kCameraFiles), end, path.extension().string()) != end;
}

std::vector<fs::path> scene_files(const Scene& scene) {
  std::vector<fs::path> files;
  std::error_code ignored;
  if (fs::is_directory(scene.file, ignored)) {
    for (fs::recursive_directory_iterator at(scene.file, ignored), end; at != end;
         at.increment(ignored)) {
      if (at.depth() >= kDeepest) at.disable_recursion_pending();
      if (at->is_regular_file(ignored) && is_camera_file(at->path())) files.push_back(at->path());
    }
    std::sort(files.begin(), files.end());
  } else {
    files.push_back(scene.file);
    // "bbox.txt", say; other sources name no file.
    const fs::path box = scene.file.parent_path() / scene.box_source;
    if (fs::is_regular_file(box, ignored) && box != scene.file) files.push_back(box);
  }
  return files;
}

}  // namespace

std::string digest_of(std::span<const std::uint8_t> bytes) {
  return digits_of(XXH3_128bits(bytes.data(), bytes.size()));
}

std::string digest_of_file(const fs::path& path) {
  InputFile file{"", path, 0, ""};
  return hash(file) ? file.xxh3_128 : "";
}

std::vector<InputFile> hash_inputs(const Scene& scene) {
  std::vector<InputFile> files;
  const auto add = [&](const char* kind, const fs::path& path) {
    if (!path.empty()) files.push_back({kind, path, 0, ""});
  };
  for (const fs::path& path : scene_files(scene)) add("scene", path);
  for (const SourceView& view : scene.views) {
    add("photograph", view.image);
    add("mask", view.mask);
    add("background", view.plate);
  }
  tbb::parallel_for(std::size_t(0), files.size(), [&](std::size_t i) {
    if (!hash(files[i])) files[i].xxh3_128.clear();
  });
  std::erase_if(files, [](const InputFile& file) { return file.xxh3_128.empty(); });
  return files;
}

}  // namespace photohull::pipeline
