// Photographs as the device has them in a file, for other processes that work at the same job.
#pragma once

#include <filesystem>
#include <memory>

#include "projtex/out_of_core.h"
#include "projtex/photographs.h"

namespace photohull::projtex {

/// The file appears whole or not at all. Throws Error where it cannot be written.
void write_photographs(const std::filesystem::path& file, const Photographs& all);
/// Holds them one after the other.
void write_photographs(const std::filesystem::path& file, OutOfCorePhotographs& some);

/// Those of a file, byte by byte, as many held at once as where they come from. Where that is all
/// of them, they are held in their order. Throws Error where the file is no such file or ends too
/// early, and where the device cannot hold them.
std::unique_ptr<OutOfCorePhotographs> open_photographs(const std::filesystem::path& file);

}  // namespace photohull::projtex
