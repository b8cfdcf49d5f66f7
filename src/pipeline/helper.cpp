#include "pipeline/helper.h"

#include "gpu/context.h"
#include "refine/tile_helper.h"

namespace photohull::pipeline {

struct Helper::Work {
  Work(const std::filesystem::path& folder, const std::string& device, int threads)
      : context(gpu::Context::create(device, threads)), tiles(*context, folder) {}
  std::unique_ptr<gpu::Context> context;
  refine::TileHelper tiles;
};

bool can_be_helped(const std::filesystem::path& folder) { return refine::has_tiles(folder); }

Helper::Helper(const std::filesystem::path& folder, const std::string& device, int threads)
    : work_(std::make_unique<Work>(folder, device, threads)) {}
Helper::~Helper() = default;

bool Helper::help() { return work_->tiles.help(); }

}  // namespace photohull::pipeline
