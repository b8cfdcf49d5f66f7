// Patches on tangent planes [Montenegro03], scored by correlation with a reference view
// [Goesele07].
#include "refine/kernels/match_patches.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "gpu/program.h"
#include "projtex/photographs.h"
#include "refine/kernels/device_choice.h"

namespace photohull::refine {
namespace {

using gpu::Buffer;

constexpr std::size_t kBatch = std::size_t(1) << 18;        // surfels on the device at once
constexpr std::size_t kMostThreads = std::size_t(1) << 21;  // of a dispatch

static_assert(kNoScore == shaders::kNoScore);
static_assert(kPatchRadius == shaders::kMatchRadius);
static_assert(kPatchTaps == shaders::kMatchTaps);

/// As patch.glsl has them.
int taps_of(int radius) {
  const int edge = 2 * radius + 1;
  return radius > 1 ? (edge * edge + 1) / 2 : edge * edge;
}

Buffer surfels_at(std::span<const PatchSurfel> surfels, std::span<const std::uint32_t> indices) {
  std::vector<shaders::MatchSurfel> out;
  out.reserve(indices.size());
  for (const std::uint32_t i : indices)
    out.push_back(
        {glm::vec4(surfels[i].position, surfels[i].offset_scale), glm::vec4(surfels[i].normal, 0)});
  return Buffer::of(out);
}

Buffer bends_at(std::span<const glm::vec3> bends, std::span<const std::uint32_t> indices) {
  std::vector<glm::vec4> out;
  out.reserve(indices.size());
  for (const std::uint32_t i : indices) out.emplace_back(bends[i], 0);
  return Buffer::of(out);
}

}  // namespace

PatchRules patch_rules(const MatchOptions& options, double noise_sigma) {
  return {kPatchRadius, options.least_spacing, options.pixel_spacing, options.best_pairs,
          noise_sigma};
}

/// Some of the surfels: those at the indices.
struct PatchMatcher::Batch {
  std::span<const PatchSurfel> surfels;
  std::span<const glm::vec3> bends;
  std::span<const ViewChoice> choices;
  std::span<const std::uint32_t> indices;
};

PatchMatcher::PatchMatcher(gpu::Context& context, const projtex::ImageSet& images,
                           std::span<const projtex::GridCamera> cameras, const PatchRules& rules,
                           const char* launch)
    : context_(context),
      images_(images),
      views_(Buffer::of(projtex::to_gpu_views(cameras, images))),
      rules_(rules),
      launch_(launch) {}

Matches PatchMatcher::match(std::span<const PatchSurfel> surfels, std::span<const glm::vec3> bends,
                            std::span<const ViewChoice> choices, const OffsetRange& range) const {
  PHOTOHULL_CHECK_OP(surfels.size(), ==, choices.size());
  const std::size_t offsets = std::size_t(range.count);
  Matches out;
  out.range = range;
  out.scores.assign(surfels.size() * offsets, kNoScore);
  out.texture.assign(surfels.size(), 1);
  const std::vector<std::uint32_t> matched = comparable(choices);
  const std::size_t most = std::clamp<std::size_t>(kMostThreads / offsets, 1, kBatch);
  const std::size_t batch =
      gpu::batch_size(std::max(sizeof(shaders::MatchChoice), offsets * sizeof(float)), most);
  for (std::size_t first = 0; first < matched.size(); first += batch)
    match({surfels, bends, choices,
           std::span(matched).subspan(first, std::min(batch, matched.size() - first))},
          out);
  return out;
}

void PatchMatcher::match(const Batch& batch, Matches& out) const {
  const bool bent = !batch.bends.empty();
  const auto program = gpu::Program::compute(
      context_, "refine_match_patches.comp.glsl",
      concat("#define PATCH_RADIUS ", rules_.radius, "\n", bent ? "#define PATCH_BENT\n" : ""));
  const std::size_t count = batch.indices.size(), offsets = std::size_t(out.range.count);
  const double variance = rules_.noise_sigma * rules_.noise_sigma;
  const shaders::MatchParameters parameters{
      {int(count), 0, out.range.count, 0},
      {float(out.range.first), float(out.range.step), float(rules_.least_spacing),
       float(rules_.pixel_spacing)},
      {float(variance), float(rules_.best_pairs), float(variance_floor(rules_.noise_sigma)), 0}};
  const Buffer uniforms(sizeof parameters, &parameters);
  const Buffer surfels = surfels_at(batch.surfels, batch.indices);
  const Buffer choices = to_device(batch.choices, batch.indices);
  const Buffer bends = bent ? bends_at(batch.bends, batch.indices) : Buffer();
  const Buffer scores(count * offsets * sizeof(float)), textures(count * sizeof(float));
  uniforms.bind_uniform(shaders::kMatchParametersBinding);
  views_.bind_storage(shaders::kViewsBinding);
  surfels.bind_storage(shaders::kMatchSurfelsBinding);
  choices.bind_storage(shaders::kMatchChoicesBinding);
  if (bent) bends.bind_storage(shaders::kMatchBendsBinding);
  scores.bind_storage(shaders::kMatchScoresBinding);
  textures.bind_storage(shaders::kMatchTexturesBinding);
  images_.texture().bind(shaders::kImagesUnit);
  program->dispatch(context_, launch_, gpu::group_count(count * offsets, shaders::kPatchGroup));
  const auto score = scores.download<float>(count * offsets);
  const auto texture = textures.download<float>(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = batch.indices[k];
    std::copy_n(score.begin() + std::ptrdiff_t(k * offsets), offsets,
                out.scores.begin() + std::ptrdiff_t(i * offsets));
    out.texture[i] = texture[k];
    out.samples += std::int64_t(offsets) * batch.choices[i].views.size() * taps_of(rules_.radius);
  }
}

}  // namespace photohull::refine
