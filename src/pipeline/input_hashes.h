// Digests of what a job read, so that its figures can be traced to their inputs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/scene.h"

namespace photohull::pipeline {

struct InputFile {
  std::string kind;  ///< "scene", "photograph", "mask" or "background"
  std::filesystem::path path;
  std::int64_t bytes = 0;
  std::string xxh3_128;  ///< 32 hexadecimal digits, as `xxhsum -H2` prints
};

/// XXH3 of 128 bits as 32 hexadecimal digits.
std::string digest_of(std::span<const std::uint8_t> bytes);

/// The same of a file's bytes; empty where it cannot be read.
std::string digest_of_file(const std::filesystem::path& path);

/// The scene's files (cameras, and the box where a file beside them has it), then each view's
/// photograph, mask and photograph of the background. Files that cannot be read are left out: the
/// job itself says what it needs of them.
std::vector<InputFile> hash_inputs(const Scene& scene);

}  // namespace photohull::pipeline
