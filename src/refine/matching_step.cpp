#include "refine/matching_step.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "refine/close_unseen.h"
#include "refine/displacement.h"
#include "refine/hull_prior.h"
#include "refine/kernels/choose_views.h"
#include "refine/look_through.h"
#include "refine/surface.h"
#include "refine/trust.h"
#include "volume/distance_from_mesh.h"
#include "volume/extract_mesh.h"

namespace photohull::refine {
namespace {

constexpr double kMostBelowPixels = 0.1;

/// One step. What is large goes as soon as it is not needed any more.
class MatchingStep {
 public:
  MatchingStep(const RefineJob& job, const SettledBricks& settled, const StepPlace& place,
               const SparseVolume& volume)
      : job_(job),
        options_(job.options),
        place_(place),
        grid_(volume.grid),
        mesh_(extract_mesh(volume, settled.coarse(volume.grid))),
        graph_(make_graph(mesh_)),
        positions_(voxel_positions(volume.grid, mesh_)) {
    give_back(mesh_);
    before_ = settled.at(grid_, positions_);
  }

  /// Finds where each surfel wants to go; says what of the level's bricks is settled.
  SettledBricks match() {
    const int offsets = place_.first_level ? options_.coarse_offsets : options_.fine_offsets;
    // The curvature of a guess that no silhouette shaped says nothing of the surface's.
    const std::vector<glm::vec3> bends =
        place_.first_level && !job_.is_bounded()
            ? std::vector<glm::vec3>()
            : curvatures(graph_, positions_, mesh_.normals, options_.match.most_bend);
    choices_ = choose_views(job_.context, grid_, mesh_, job_.photographs, options_.match);
    for (const ViewChoice& choice : choices_) seen_.push_back(choice.seen > 0);
    for (std::size_t i = 0; i < choices_.size(); ++i)
      if (is_settled(before_[i])) choices_[i].views.clear();
    Matches matches = match_vertices(job_, grid_, mesh_, bends, choices_,
                                     {-options_.step * (offsets / 2), options_.step, offsets});
    aggregate(graph_, options_.aggregations, matches);
    peaks_ = find_peaks(matches, options_.peak);
    texture_ = std::move(matches.texture);
    samples_ = matches.samples;
    return {grid_,
            {positions_, bends, texture_, peaks_, choices_, before_},
            job_.finest_cameras(),
            options_.settle};
  }

  /// Lines of sight that the volume blocks and should not.
  void look_through() {
    KnownSurface known = known_surface(positions_, mesh_.normals, peaks_, choices_, options_.look);
    choices_ = {};
    give_back(mesh_);
    sightlines_ = find_sightlines(job_.context, grid_, known, job_.matching(grid_), options_.match,
                                  options_.look);
    known_positions_ = std::move(known.positions);
  }

  /// What settled below the images' sampling says nothing anew; what is flat was found with
  /// certainty before. Nothing at all where more than kMostBelowPixels of the surfels settle there
  /// now: scores hardly change from one offset to the next, and no peak of them proves anything.
  Proof proof(const SettledBricks& now) const {
    const std::vector<Settled> after = now.at(grid_, positions_);
    if (double(std::count(after.begin(), after.end(), Settled::kPixels)) >
        kMostBelowPixels * double(after.size()))
      return {};
    Proof out;
    for (std::size_t i = 0; i < peaks_.size(); ++i) {
      if (before_[i] == Settled::kPixels || before_[i] == Settled::kUnseen) continue;
      out.positions.push_back(positions_[i]);
      out.normals.push_back(mesh_.normals[i]);
      out.weights.push_back(!seen_[i]                      ? -1.0f
                            : before_[i] == Settled::kFlat ? 1.0f
                                                           : peaks_[i].weight);
    }
    return out;
  }

  /// Displacements of the vertices: smooth, near the peaks.
  std::vector<float> displacements(const SparseVolume& hull, const SparseVolume& volume,
                                   LevelReport& counts) {
    const std::vector<float> trust =
        trust_thickness(volume, positions_, mesh_.normals, options_.peak.thick);
    for (std::size_t i = 0; i < peaks_.size(); ++i) peaks_[i].weight *= trust[i];
    // Not at first: what no silhouette shows is still to be found under the hull.
    if (!place_.first_level && job_.is_bounded())
      counts.hull_trust =
          pull_to_hull(hull, graph_, positions_, {texture_, trust}, options_.hull_prior, peaks_);
    std::vector<float> moves =
        regularize(graph_, peaks_, positions_, mesh_.normals, trust, options_.regularize);
    const auto told = std::count_if(peaks_.begin(), peaks_.end(),
                                    [](const Peak& peak) { return peak.weight > 0; });
    counts.evidence = double(told) / double(std::max<std::size_t>(peaks_.size(), 1));
    peaks_ = {};
    if (options_.closing) close(moves);
    graph_ = {};
    return moves;
  }

  void move(const std::vector<float>& moves, SparseVolume& volume, LevelReport& counts) const {
    move_surface(volume, mesh_, moves);
    counts.freed += std::int64_t(free_sightlines(sightlines_, known_positions_,
                                                 job_.photographs.cameras, options_.look, volume));
    counts.surfels = std::int64_t(moves.size());
    counts.samples += samples_;
    double sum = 0;
    for (const float move : moves) sum += std::abs(move);
    counts.mean_move = sum / double(std::max<std::size_t>(moves.size(), 1));
  }

 private:
  /// Moves surface that no camera sees to the membrane that the rest spans.
  void close(std::vector<float>& moves) {
    if (!job_.is_bounded())  // plain background is no surface: nothing says where it is
      for (std::size_t i = 0; i < seen_.size(); ++i)
        seen_[i] = seen_[i] && texture_[i] >= options_.settle.least_texture;
    const auto closing = close_unseen(grid_, mesh_, graph_, seen_, options_.close);
    for (std::size_t i = 0; i < moves.size(); ++i)
      if (closing[i] != 0) moves[i] = closing[i];
  }

  const RefineJob& job_;
  const RefineOptions& options_;
  StepPlace place_;
  GridSpec grid_;
  TriMesh mesh_;
  VertexGraph graph_;
  std::vector<glm::vec3> positions_;  // of the vertices, voxels
  std::vector<Settled> before_;
  std::vector<ViewChoice> choices_;
  std::vector<bool> seen_;
  std::vector<float> texture_;
  std::int64_t samples_ = 0;
  std::vector<Peak> peaks_;
  std::vector<Sightline> sightlines_;
  std::vector<glm::vec3> known_positions_;
};

}  // namespace

StepFindings matching_step(const RefineJob& job, const SettledBricks& settled,
                           const SparseVolume& hull, const StepPlace& place, SparseVolume& volume,
                           LevelReport& counts) {
  StepFindings out;
  MatchingStep step(job, settled, place, volume);
  out.settled = step.match();
  step.look_through();
  if (place.last && job.is_bounded()) out.proof = step.proof(out.settled);
  step.move(step.displacements(hull, volume, counts), volume, counts);
  return out;
}

}  // namespace photohull::refine
