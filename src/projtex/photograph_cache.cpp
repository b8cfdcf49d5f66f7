#include "projtex/photograph_cache.h"

#include <algorithm>

#include "core/error.h"
#include "projtex/gpu_views.h"

namespace photohull::projtex {

PhotographCache::PhotographCache(std::span<const Camera> cameras, int layers,
                                 ColourImage::Encoding encoding, int cut_at)
    : cameras_(cameras.begin(), cameras.end()),
      held_{ImageSet(array_size(cameras, cut_at), layers, encoding),
            std::vector<Camera>(std::size_t(layers), cameras.front()),
            std::vector<int>(cameras.size(), -1)},
      used_(std::size_t(layers), 0) {}

std::vector<int> PhotographCache::missing(std::span<const int> numbers) {
  PHOTOHULL_CHECK_OP(numbers.size(), <=, used_.size());
  ++turn_;
  std::vector<int> out;
  for (const int n : numbers) {
    const int layer = held_.layers[std::size_t(n)];
    if (layer < 0)
      out.push_back(n);
    else
      used_[std::size_t(layer)] = turn_;
  }
  return out;
}

int PhotographCache::make_room(int number) {
  const auto oldest = std::ranges::min_element(used_);
  const int layer = int(oldest - used_.begin());
  *oldest = turn_;
  std::ranges::replace(held_.layers, layer, -1);
  held_.layers[std::size_t(number)] = layer;
  held_.cameras[std::size_t(layer)] = cameras_[std::size_t(number)];
  return layer;
}

void PhotographCache::put(int number, const PreparedView& view) {
  held_.images.put(make_room(number), view);
}

void PhotographCache::put(int number, const ColourImage& image, double sharpness) {
  held_.images.put(make_room(number), image, sharpness);
}

}  // namespace photohull::projtex
