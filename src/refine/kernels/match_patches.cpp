// Patches on tangent planes [Montenegro03], scored by correlation with a reference view
// [Goesele07].
#include "refine/kernels/match_patches.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "gpu/buffer.h"
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

/// Those at the indices; the k-th is matched in the choice that choice_of(k) numbers.
template <typename ChoiceOf>
Buffer surfels_at(std::span<const PatchSurfel> surfels, std::span<const std::uint32_t> indices,
                  const ChoiceOf& choice_of) {
  std::vector<shaders::MatchSurfel> out(indices.size());
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const PatchSurfel& surfel = surfels[indices[k]];
    out[k] = {glm::vec4(surfel.position, surfel.offset_scale),
              glm::vec4(surfel.normal, float(choice_of(k)))};
  }
  return Buffer::of(out);
}

/// The views of a choice that all surfels have.
Buffer share(const ViewChoice& choice, std::span<const shaders::GpuView> views) {
  shaders::SharedViews out{};
  for (int k = 0; k < choice.views.size(); ++k) {
    out.views[k] = views[std::size_t(choice.views[k])];
    out.layers[k].x = choice.views[k];
  }
  return Buffer(sizeof out, &out);
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
  std::span<const std::uint32_t> choice_of;  // empty: one choice a surfel
  std::span<const std::uint32_t> indices;
  bool textures_alone = false;

  const ViewChoice& choice(std::size_t surfel) const {
    return choices[choice_of.empty() ? surfel : choice_of[surfel]];
  }
};

PatchMatcher::PatchMatcher(gpu::Context& context, const projtex::ImageSet& images,
                           std::span<const projtex::GridCamera> cameras, const PatchRules& rules,
                           const char* launch)
    : context_(context),
      images_(images),
      gpu_views_(projtex::to_gpu_views(cameras, images)),
      views_(gpu_views_),
      rules_(rules),
      launch_(launch) {}

Matches PatchMatcher::match(std::span<const PatchSurfel> surfels, std::span<const glm::vec3> bends,
                            std::span<const ViewChoice> choices, const OffsetRange& range) const {
  PHOTOHULL_CHECK_OP(surfels.size(), ==, choices.size());
  return match_all({surfels, bends, choices, {}, {}, false}, range);
}

Matches PatchMatcher::match_alike(std::span<const PatchSurfel> surfels,
                                  std::span<const ViewChoice> choices,
                                  std::span<const std::uint32_t> choice_of,
                                  const OffsetRange& range) const {
  PHOTOHULL_CHECK_OP(surfels.size(), ==, choice_of.size());
  PHOTOHULL_CHECK_OP(choices.size(), <=, kMostAlike);
  return match_all({surfels, {}, choices, choice_of, {}, false}, range);
}

Matches PatchMatcher::textures(std::span<const PatchSurfel> surfels,
                               std::span<const ViewChoice> choices) const {
  PHOTOHULL_CHECK_OP(surfels.size(), ==, choices.size());
  return match_all({surfels, {}, choices, {}, {}, true}, {});
}

Matches PatchMatcher::textures_alike(std::span<const PatchSurfel> surfels,
                                     std::span<const ViewChoice> choices,
                                     std::span<const std::uint32_t> choice_of) const {
  PHOTOHULL_CHECK_OP(surfels.size(), ==, choice_of.size());
  PHOTOHULL_CHECK_OP(choices.size(), <=, kMostAlike);
  return match_all({surfels, {}, choices, choice_of, {}, true}, {});
}

Matches PatchMatcher::match_all(Batch all, const OffsetRange& range) const {
  const std::size_t offsets = std::size_t(range.count);
  Matches out;
  out.range = range;
  if (!all.textures_alone) out.scores.assign(all.surfels.size() * offsets, kNoScore);
  out.texture.assign(all.surfels.size(), 1);
  std::vector<std::uint32_t> matched;
  matched.reserve(all.surfels.size());
  for (std::uint32_t i = 0; i < all.surfels.size(); ++i)
    if (all.choice(i).comparable()) matched.push_back(i);
  const std::size_t most = std::clamp<std::size_t>(kMostThreads / offsets, 1, kBatch);
  const std::size_t batch =
      gpu::batch_size(std::max(sizeof(shaders::MatchChoice), offsets * sizeof(float)), most);
  for (std::size_t first = 0; first < matched.size(); first += batch) {
    all.indices = std::span(matched).subspan(first, std::min(batch, matched.size() - first));
    match(all, out);
  }
  return out;
}

void PatchMatcher::match(const Batch& batch, Matches& out) const {
  const bool bent = !batch.bends.empty(), alike = !batch.choice_of.empty();
  const bool shared = alike && batch.choices.size() == 1;
  const auto program = gpu::Program::compute(
      context_, "refine_match_patches.comp.glsl",
      concat(shared ? concat("#define SHARED_VIEWS ", batch.choices[0].views.size(), "\n")
                    : std::string(views_.defines()),
             "#define PATCH_RADIUS ", rules_.radius, "\n", bent ? "#define PATCH_BENT\n" : "",
             batch.textures_alone ? "#define TEXTURES_ALONE\n" : ""));
  const std::size_t count = batch.indices.size(), offsets = std::size_t(out.range.count);
  const double variance = rules_.noise_sigma * rules_.noise_sigma;
  const shaders::MatchParameters parameters{
      {int(count), 0, out.range.count, 0},
      {float(out.range.first), float(out.range.step), float(rules_.least_spacing),
       float(rules_.pixel_spacing)},
      {float(variance), float(rules_.best_pairs), float(variance_floor(rules_.noise_sigma)), 0}};
  const Buffer uniforms(sizeof parameters, &parameters);
  const Buffer surfels = surfels_at(batch.surfels, batch.indices, [&](std::size_t k) {
    return alike ? std::size_t(batch.choice_of[batch.indices[k]]) : k;
  });
  const Buffer choices = shared  ? share(batch.choices[0], gpu_views_)
                         : alike ? to_device(batch.choices)
                                 : to_device(batch.choices, batch.indices);
  const Buffer bends = bent ? bends_at(batch.bends, batch.indices) : Buffer();
  const std::size_t score_count = batch.textures_alone ? 0 : count * offsets;
  const Buffer scores(score_count * sizeof(float)), textures(count * sizeof(float));
  uniforms.bind_uniform(shaders::kMatchParametersBinding);
  views_.bind();
  surfels.bind_storage(shaders::kMatchSurfelsBinding);
  if (shared)
    choices.bind_uniform(shaders::kMatchSharedViewsBinding);
  else
    choices.bind_storage(shaders::kMatchChoicesBinding);
  if (bent) bends.bind_storage(shaders::kMatchBendsBinding);
  scores.bind_storage(shaders::kMatchScoresBinding);
  textures.bind_storage(shaders::kMatchTexturesBinding);
  images_.texture().bind(shaders::kImagesUnit);
  program->dispatch(context_, launch_, gpu::group_count(count * offsets, shaders::kPatchGroup));
  for (const std::uint32_t i : batch.indices)
    out.samples +=
        (batch.textures_alone ? 1 : std::int64_t(offsets) * batch.choice(i).views.size()) *
        taps_of(rules_.radius);
  const std::size_t first = batch.indices.front();
  if (batch.indices.back() - first + 1 == count) {  // all of them: they follow each other
    if (score_count > 0)
      scores.read(0, score_count * sizeof(float), out.scores.data() + first * offsets);
    textures.read(0, count * sizeof(float), out.texture.data() + first);
    return;
  }
  const auto score = scores.download<float>(score_count);
  const auto texture = textures.download<float>(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = batch.indices[k];
    if (score_count > 0)
      std::copy_n(score.begin() + std::ptrdiff_t(k * offsets), offsets,
                  out.scores.begin() + std::ptrdiff_t(i * offsets));
    out.texture[i] = texture[k];
  }
}

}  // namespace photohull::refine
