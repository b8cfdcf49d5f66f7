// The search of rays as tasks, one a view, that any process can do which has the photographs;
// private to module refine.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/grid.h"
#include "refine/ray_maps.h"
#include "refine/shared_work.h"
#include "refine/vote.h"

namespace photohull::refine {

/// The space that rays are searched in.
struct RaySpace {
  SparseVolume hull;
  std::optional<SparseVolume> surface;  ///< where one is known
  VoteOptions options;
};

/// Throws Error where the file is damaged or gone.
RaySpace read_ray_space(const std::filesystem::path& file);

/// The same, as its owner has it; `surface` is null where none is known.
struct RaySearched {
  const SparseVolume& hull;
  const SparseVolume* surface;
  const VoteOptions& options;
};

/// Maps of so many views, by tasks, on a device of that name.
std::vector<RayMap> map_in_tasks(SharedWork& shared, const std::string& device,
                                 const RaySearched& space, std::size_t views,
                                 const ViewMapper& map_of);

/// What a task of kind kRays asks for, whose head was read.
struct RayTask {
  std::string space;  ///< name of a file in the folder
  std::size_t view = 0;
};
RayTask read_ray_task(ListReader& task);
/// The task's result.
std::string bytes_of(const RayMap& map);

}  // namespace photohull::refine
