// A process that helps another one with its refinement.
#pragma once

#include <filesystem>
#include <memory>

#include "gpu/context.h"

namespace photohull::refine {

/// Are there tasks in the folder that nobody has done yet?
bool has_tiles(const std::filesystem::path& folder);

/// Does tasks of one job (SharedWork) in its folder.
class TileHelper {
 public:
  TileHelper(gpu::Context& context, const std::filesystem::path& folder);
  ~TileHelper();

  /// Does one that nobody is at. False: there is none. Throws Error where the job was begun on a
  /// device that rounds differently, where files are damaged or gone, and where the device cannot
  /// hold what is needed.
  bool help();

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace photohull::refine
