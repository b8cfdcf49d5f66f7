#include "projtex/photographs.h"

namespace photohull::projtex {

std::vector<GridCamera> to_grid(std::span<const Camera> cameras, const GridSpec& grid) {
  std::vector<GridCamera> out;
  out.reserve(cameras.size());
  for (const Camera& camera : cameras) out.push_back(to_grid(camera, grid));
  return out;
}

std::vector<shaders::GpuView> to_gpu_views(std::span<const GridCamera> cameras,
                                           const ImageSet& images) {
  const glm::ivec2 size(images.texture().width(), images.texture().height());
  std::vector<shaders::GpuView> out;
  out.reserve(cameras.size());
  for (std::size_t i = 0; i < cameras.size(); ++i)
    out.push_back(to_gpu_view(cameras[i], size, images.sharpness()[i]));
  return out;
}

}  // namespace photohull::projtex
