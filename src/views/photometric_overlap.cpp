#include "views/photometric_overlap.h"

#include <map>
#include <numeric>
#include <utility>

namespace photohull {

std::vector<bool> connected_views(const std::vector<PhotometricPoint>& points, std::size_t count,
                                  int least_samples) {
  std::vector<int> samples(count, 0), parent(count);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[std::size_t(i)] != i) i = parent[std::size_t(i)];
    return i;
  };
  for (const PhotometricPoint& p : points)
    for (const PhotometricSample& s : p.samples) ++samples[std::size_t(s.view)];
  for (const PhotometricPoint& p : points) {
    int first = -1;
    for (const PhotometricSample& s : p.samples) {
      if (samples[std::size_t(s.view)] < least_samples) continue;
      if (first < 0)
        first = root(s.view);
      else
        parent[std::size_t(root(s.view))] = first;
    }
  }
  std::map<int, int> sizes;
  for (std::size_t i = 0; i < count; ++i)
    if (samples[i] >= least_samples) ++sizes[root(int(i))];
  int best = -1;
  for (const auto& [group, size] : sizes)
    if (best < 0 || size > sizes[best]) best = group;
  std::vector<bool> used(count, false);
  if (best < 0 || sizes[best] < 2) return used;
  for (std::size_t i = 0; i < count; ++i)
    used[i] = samples[i] >= least_samples && root(int(i)) == best;
  return used;
}

std::vector<PhotometricPoint> keep_used(const std::vector<PhotometricPoint>& points,
                                        const std::vector<bool>& used) {
  std::vector<PhotometricPoint> out;
  for (const PhotometricPoint& p : points) {
    PhotometricPoint kept{p.cluster, {}};
    for (const PhotometricSample& s : p.samples)
      if (used[std::size_t(s.view)]) kept.samples.push_back(s);
    if (kept.samples.size() >= 2) out.push_back(std::move(kept));
  }
  return out;
}

}  // namespace photohull
