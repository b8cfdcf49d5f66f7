#include "carving/kernels/read_decisions.h"

#include "shared/sweep.h"

namespace photohull::carving {
namespace {

static_assert(int(Outcome::kKept) == shaders::kKept);
static_assert(int(Outcome::kBetter) == shaders::kBetter);
static_assert(int(Outcome::kUndecided) == shaders::kUndecided);
static_assert(int(Outcome::kUnseen) == shaders::kUnseen);

constexpr std::size_t kHeader = 16;  // bytes: the list's length, and voxels judged

}  // namespace

std::uint32_t read_decisions(const gpu::Buffer& list, std::vector<Decision>& out) {
  const auto header = list.download<std::uint32_t>(2);
  std::vector<shaders::Decision> found(header[0]);
  list.read(kHeader, found.size() * sizeof(shaders::Decision), found.data());
  for (const shaders::Decision& d : found)
    out.push_back({glm::ivec2(d.place), d.place.z, d.place.w, d.scores.x, d.scores.y,
                   Outcome(int(d.scores.z))});
  return header[1];
}

}  // namespace photohull::carving
