#include "refine/kernels/label_space.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "core/error.h"
#include "core/grid.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "shared/label.h"

namespace photohull::refine {
namespace {

using gpu::Buffer;

// Both steps' rates: their product times the squared norm of the gradient, 12, is at most 1.
constexpr float kRate = 0.288f;
constexpr std::size_t kGroup = 64;  // threads

}  // namespace

std::vector<int> neighbours_of(std::span<const glm::ivec3> bricks) {
  const auto key = [](const glm::ivec3& b) { return std::tuple(b.z, b.y, b.x); };
  std::map<std::tuple<int, int, int>, int> index;
  for (std::size_t i = 0; i < bricks.size(); ++i) index.emplace(key(bricks[i]), int(i));
  PHOTOHULL_CHECK_OP(index.size(), ==, bricks.size());
  std::vector<int> out;
  out.reserve(6 * bricks.size());
  for (const glm::ivec3& brick : bricks)
    for (const int direction : {1, -1})
      for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 beside = brick;
        beside[axis] += direction;
        const auto at = index.find(key(beside));
        out.push_back(at == index.end() ? -1 : at->second);
      }
  return out;
}

std::vector<float> label_space(gpu::Context& context, std::span<const glm::ivec3> bricks,
                               std::span<const float> evidence, int iterations) {
  PHOTOHULL_CHECK_OP(evidence.size(), ==, bricks.size() * kBrickVoxels);
  if (bricks.empty()) return {};
  const auto dual =
      gpu::Program::compute(context, "refine_label_space.comp.glsl", "#define STEP_DUAL\n");
  const auto primal = gpu::Program::compute(context, "refine_label_space.comp.glsl");
  std::vector<glm::vec2> start(evidence.size());
  std::transform(evidence.begin(), evidence.end(), start.begin(),
                 [](float e) { return glm::vec2(e < 0 ? 1 : 0); });
  const shaders::LabelParameters p{{int(evidence.size()), 0, 0, 0}, {kRate, 0, 0, 0}};
  const Buffer uniforms(sizeof p, &p), neighbours = Buffer::of(neighbours_of(bricks)),
                                       claims = Buffer::of(evidence), labels = Buffer::of(start);
  Buffer flow(evidence.size() * sizeof(glm::vec4));
  flow.fill(0);
  uniforms.bind_uniform(shaders::kLabelParametersBinding);
  neighbours.bind_storage(shaders::kLabelNeighboursBinding);
  claims.bind_storage(shaders::kLabelEvidenceBinding);
  labels.bind_storage(shaders::kLabelsBinding);
  flow.bind_storage(shaders::kLabelFlowBinding);
  const std::size_t groups = gpu::group_count(evidence.size(), kGroup);
  for (int i = 0; i < iterations; ++i) {
    dual->dispatch(context, "refine_label_dual", groups);
    primal->dispatch(context, "refine_label_primal", groups);
  }
  const auto found = labels.download<glm::vec2>(evidence.size());
  std::vector<float> out(found.size());
  std::transform(found.begin(), found.end(), out.begin(), [](const glm::vec2& l) { return l.x; });
  return out;
}

}  // namespace photohull::refine
