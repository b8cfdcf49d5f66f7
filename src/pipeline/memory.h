// How much memory a job may take.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace photohull::pipeline {

/// Reads a size such as 512M, 1.5GiB or 2G (K, M, G and T are powers of 1024); nothing for others.
std::optional<std::int64_t> parse_max_memory(const std::string& text);

/// Bytes that this process can still take without swapping or being killed: what the kernel calls
/// available (proc/meminfo), or what the limits of the process's control groups (versions 1 and 2)
/// leave, if that is less; nothing where the system does not tell. `root` stands for the root of
/// the file system.
std::optional<std::int64_t> available_memory(const std::filesystem::path& root = "/");

/// What a job takes when nothing else is said: three quarters of what is available, so that other
/// programs and the files' cache have room; without limit where the system does not tell.
std::int64_t default_max_memory();

/// "1.5 GiB" or "300 MiB".
std::string memory_text(std::int64_t bytes);

}  // namespace photohull::pipeline
