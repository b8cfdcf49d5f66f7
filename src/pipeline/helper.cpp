#include "pipeline/helper.h"

#include <utility>

#include "gpu/context.h"
#include "refine/tile_helper.h"

namespace photohull::pipeline {

struct Helper::Work {
  std::unique_ptr<gpu::Context> context;
  refine::TileHelper tiles;
};

Helper::Helper(std::filesystem::path folder, std::string device, int threads)
    : folder_(std::move(folder)), device_(std::move(device)), threads_(threads) {}
Helper::~Helper() = default;

bool Helper::help() {
  if (!work_) {
    if (!refine::has_tiles(folder_)) return false;
    auto context = gpu::Context::create(device_, threads_);
    gpu::Context& device = *context;
    work_ = std::unique_ptr<Work>(new Work{std::move(context), {device, folder_}});
  }
  return work_->tiles.help();
}

}  // namespace photohull::pipeline
