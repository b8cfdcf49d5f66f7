#include "refine/tile_tasks.h"

#include <algorithm>
#include <span>

#include "refine/kernels/fit_patches.h"

namespace photohull::refine {
namespace {

/// Some of the items.
template <typename T>
std::vector<T> at(std::span<const T> items, std::span<const std::uint32_t> indices) {
  std::vector<T> out;
  out.reserve(items.empty() ? 0 : indices.size());
  if (!items.empty())
    for (const std::uint32_t i : indices) out.push_back(items[i]);
  return out;
}

/// Surfels that follow each other on the mesh, which goes through space brick by brick.
class Tiles {
 public:
  Tiles(std::vector<std::uint32_t> surfels, std::size_t count)
      : surfels_(std::move(surfels)), count_(count) {}

  std::size_t count() const { return count_; }
  std::span<const std::uint32_t> operator[](std::size_t tile) const {
    const std::size_t first = tile * surfels_.size() / count_;
    return std::span(surfels_).subspan(first, (tile + 1) * surfels_.size() / count_ - first);
  }

 private:
  std::vector<std::uint32_t> surfels_;
  std::size_t count_;
};

std::string perform_match(gpu::Context& context, const MatchingPhotographs& photographs,
                          ListReader& task) {
  const auto grid = task.one<GridSpec>();
  MatchRequest request;
  request.options = task.one<MatchOptions>();
  request.range = task.one<OffsetRange>();
  request.textures_alone = task.one<std::uint8_t>() != 0;
  const auto surfels = task.list<PatchSurfel>();
  const auto bends = task.list<glm::vec3>();
  const auto choices = task.list<ViewChoice>();
  const Matches matches =
      match_surfels(context, photographs, grid,
                    {[&](std::uint32_t i) { return surfels[i]; }, bends, choices}, request);
  std::string out;
  ListWriter writer(out);
  writer.list(matches.scores);
  writer.list(matches.texture);
  writer.one(matches.samples);
  return out;
}

std::string perform_fit(gpu::Context& context, const MatchingPhotographs& photographs,
                        ListReader& task) {
  const auto grid = task.one<GridSpec>();
  const auto options = task.one<FitOptions>();
  const auto positions = task.list<glm::vec3>();
  const auto normals = task.list<glm::vec3>();
  const auto bends = task.list<glm::vec3>();
  const auto choices = task.list<ViewChoice>();
  std::string out;
  ListWriter(out).list(
      fit_surfels(context, grid, {positions, normals, bends}, photographs, choices, options));
  return out;
}

/// Has tiles done: ask(tile, writer) writes what is asked of one, take(tile, reader) reads what
/// comes of it.
template <typename Ask, typename Take>
void do_tiles(const RefineJob& job, const GridSpec& grid, TaskKind kind, std::size_t count,
              const Ask& ask, const Take& take) {
  const MatchingPhotographs photographs = job.matching(grid);
  const TaskHead head{job.shared->job(), job.context.device().renderer, kind,
                      job.matches_larger(grid)};
  const auto make = [&](std::size_t tile) {
    std::string text;
    ListWriter writer(text);
    head.write(writer);
    ask(tile, writer);
    return text;
  };
  const auto perform = [&](const std::string& text) {
    ListReader reader(text);
    TaskHead::read(reader);
    return perform_tile(job.context, photographs, kind, reader);
  };
  job.shared->do_all({job.shared->next_name(kind == TaskKind::kFit ? "fit" : "match"), count, make,
                      [&](std::size_t tile, const std::string& result) {
                        ListReader reader(result);
                        take(tile, reader);
                      }},
                     perform);
}

/// Throws Error where a result is of other surfels.
void check_size(std::size_t size, std::size_t expected) {
  if (size != expected) throw Error("a result is of other surfels");
}

}  // namespace

Matches match_in_tiles(const RefineJob& job, const GridSpec& grid, const SurfelsAsked& asked,
                       const MatchRequest& request) {
  const std::vector<std::uint32_t> matched =
      job.shared ? comparable(asked.choices) : std::vector<std::uint32_t>();
  const std::size_t count = job.shared ? job.shared->tiles_of(matched.size()) : 1;
  if (count == 1) return match_surfels(job.context, job.matching(grid), grid, asked, request);
  const Tiles tiles(matched, count);
  const std::size_t scores = request.textures_alone ? 0 : std::size_t(request.range.count);
  Matches out;
  out.range = request.range;
  out.scores.assign(asked.choices.size() * scores, kNoScore);
  out.texture.assign(asked.choices.size(), 1);
  const auto ask = [&](std::size_t tile, ListWriter& to) {
    std::vector<PatchSurfel> surfels;
    for (const std::uint32_t i : tiles[tile]) surfels.push_back(asked.at(i));
    to.one(grid);
    to.one(request.options);
    to.one(request.range);
    to.one(std::uint8_t(request.textures_alone));
    to.list(surfels);
    to.list(at(asked.bends, tiles[tile]));
    to.list(at(asked.choices, tiles[tile]));
  };
  const auto take = [&](std::size_t tile, ListReader& from) {
    const std::span<const std::uint32_t> indices = tiles[tile];
    const auto some = from.list<float>();
    const auto texture = from.list<float>();
    const auto samples = from.one<std::int64_t>();
    check_size(some.size(), indices.size() * scores);
    check_size(texture.size(), indices.size());
    for (std::size_t k = 0; k < indices.size(); ++k) {
      out.texture[indices[k]] = texture[k];
      std::copy_n(some.begin() + std::ptrdiff_t(k * scores), scores,
                  out.scores.begin() + std::ptrdiff_t(indices[k] * scores));
    }
    out.samples += samples;
  };
  do_tiles(job, grid, TaskKind::kMatch, count, ask, take);
  return out;
}

std::vector<PatchFit> fit_in_tiles(const RefineJob& job, const MeshSurfels& surfels,
                                   std::span<const ViewChoice> choices) {
  const std::vector<std::uint32_t> fitted =
      job.shared ? comparable(choices) : std::vector<std::uint32_t>();
  const std::size_t count = job.shared ? job.shared->tiles_of(fitted.size()) : 1;
  const FitOptions& options = job.options.fit;
  if (count == 1)
    return fit_patches(job.context, surfels, job.matching(surfels.grid), choices, options);
  const Tiles tiles(fitted, count);
  const SurfelShapes shapes = shapes_of(surfels, options);
  std::vector<PatchFit> out = unfitted(shapes.normals);
  const auto ask = [&](std::size_t tile, ListWriter& to) {
    to.one(surfels.grid);
    to.one(options);
    to.list(at<glm::vec3>(shapes.positions, tiles[tile]));
    to.list(at<glm::vec3>(shapes.normals, tiles[tile]));
    to.list(at<glm::vec3>(shapes.bends, tiles[tile]));
    to.list(at(choices, tiles[tile]));
  };
  const auto take = [&](std::size_t tile, ListReader& from) {
    const auto fits = from.list<PatchFit>();
    check_size(fits.size(), tiles[tile].size());
    for (std::size_t k = 0; k < fits.size(); ++k) out[tiles[tile][k]] = fits[k];
  };
  do_tiles(job, surfels.grid, TaskKind::kFit, count, ask, take);
  return out;
}

std::string perform_tile(gpu::Context& context, const MatchingPhotographs& photographs,
                         TaskKind kind, ListReader& task) {
  switch (kind) {
    case TaskKind::kMatch:
      return perform_match(context, photographs, task);
    case TaskKind::kFit:
      return perform_fit(context, photographs, task);
    case TaskKind::kRays:
      break;
  }
  throw Error("the task is of another kind");
}

}  // namespace photohull::refine
