// From the hull inwards [Furukawa09], coarse to fine, with the projection onto tangent planes that
// [Montenegro03] proposes as the next step.
#include "refine/refine.h"

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "carving/fit_grid.h"
#include "core/error.h"
#include "core/option_word.h"
#include "refine/bounding_hull.h"
#include "refine/checkpoint.h"
#include "refine/settle.h"
#include "refine/surface.h"
#include "refine/trust.h"
#include "render/surface_points.h"
#include "volume/cavities.h"
#include "volume/combine.h"
#include "volume/distance_from_mesh.h"
#include "volume/extract_mesh.h"

namespace photohull::refine {
namespace {

constexpr double kLeastPixels = 3;  // that a voxel of the first level is wide, without silhouettes
constexpr double kNearReach = kStillReach;  // voxels of exact distance that a step needs
constexpr double kAnglePerSpacing = 2.0;  // reach of a view's partners, in spacings of the cameras
constexpr double kSparseAngle = 75;       // degrees, to which the farthest partners' is widened
constexpr int kMiddleIterations = 2;      // of matching and moving, at the levels between
// What membrane and fairing are for offsets that were fitted: these know more than peaks do.
constexpr double kFitMembrane = 30, kFitFairing = 3;
constexpr double kFullReach = SparseVolume::kBand;
constexpr std::size_t kPart = std::size_t(1) << 19;  // surfels that are matched at once
constexpr std::size_t kManySurfels = std::size_t(1) << 18;

/// What was freed goes back to the system, where it is worth the time: the trees that meshes are
/// extracted from leave holes all over.
void give_back(const TriMesh& mesh) {
  if (mesh.positions.size() >= kManySurfels) malloc_trim(0);
}

bool any_silhouette(std::span<const carving::Silhouette> silhouettes) {
  return std::any_of(silhouettes.begin(), silhouettes.end(),
                     [](const carving::Silhouette& s) { return s.distance; });
}

std::vector<glm::vec3> voxel_positions(const GridSpec& grid, const TriMesh& mesh) {
  const glm::dvec3 offset = (mesh.origin - grid.origin) / grid.voxel_size;
  std::vector<glm::vec3> out;
  out.reserve(mesh.positions.size());
  for (const glm::vec3& p : mesh.positions)
    out.emplace_back(glm::dvec3(p) / grid.voxel_size + offset);
  return out;
}

/// Angles to the reference view that the cameras' spacing asks for: where neighbours stand far
/// apart, views at the usual angles would be too few.
MatchOptions fit_angles(std::span<const Camera> cameras, const glm::dvec3& middle,
                        MatchOptions options) {
  std::vector<double> nearest;
  for (const Camera& camera : cameras) {
    const glm::dvec3 ray = glm::normalize(camera.center() - middle);
    double largest = -1;  // cosine
    for (const Camera& other : cameras)
      if (&other != &camera)
        largest = std::max(largest, glm::dot(ray, glm::normalize(other.center() - middle)));
    nearest.push_back(glm::degrees(std::acos(std::clamp(largest, -1.0, 1.0))));
  }
  std::nth_element(nearest.begin(), nearest.begin() + long(nearest.size() / 2), nearest.end());
  const double wanted = kAnglePerSpacing * nearest[nearest.size() / 2];
  options.farthest_angle = std::max(options.farthest_angle, std::min(wanted, kSparseAngle));
  return options;
}

std::vector<bool> seen_by_any(std::span<const shaders::MatchChoice> choices) {
  std::vector<bool> seen;
  for (const shaders::MatchChoice& choice : choices) seen.push_back(choice.second.z > 0);
  return seen;
}

/// What fitted peaks tell, whatever their taps' spacing.
std::vector<float> weights_told(std::span<const Peak> peaks, std::span<const float> spacings) {
  std::vector<float> out;
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    const float square = spacings[i] * spacings[i];
    out.push_back(peaks[i].weight * square * square);
  }
  return out;
}

class Refiner {
 public:
  Refiner(gpu::Context& context, const HullAt& hull_at,
          std::span<const carving::Silhouette> silhouettes, const projtex::ImageSet& images,
          std::span<const Camera> cameras, const glm::dvec3& middle, const RefineOptions& options)
      : context_(context),
        hull_at_(hull_at),
        silhouettes_(silhouettes),
        images_(images),
        cameras_(cameras),
        options_(options) {
    options_.match = fit_angles(cameras, middle, options.match);
  }

  SparseVolume run(const std::vector<GridSpec>& grids, const CheckpointFile* checkpoint,
                   Progress& progress, RefineReport& report) {
    SparseVolume volume;
    if (checkpoint)
      if (auto done = read_checkpoint(*checkpoint, grids, progress)) {
        volume = std::move(done->volume);
        settled_ = std::move(done->settled);
        report.levels = std::move(done->levels);
      }
    report.resumed = int(report.levels.size());
    if (report.resumed > 0)
      progress.note(concat("an interrupted run of this job had done ", report.resumed, " of ",
                           grids.size(), " levels of the refinement: going on from there (",
                           option_word("fresh"), " starts anew)"));
    for (std::size_t level = report.levels.size(); level < grids.size(); ++level) {
      const auto start = std::chrono::steady_clock::now();
      LevelReport counts;
      counts.voxel_size = grids[level].voxel_size;
      BoundingHull bounding(hull_at_(grids[level]));
      const SparseVolume& hull = bounding.volume();
      volume =
          level == 0
              ? first_guess(hull)
              : bounded(distance_from_mesh(extract_mesh(volume), volume, hull.grid, kNearReach),
                        hull);
      restore(volume, hull, counts);
      const bool first = level == 0, last = level + 1 == grids.size();
      if (!first && options_.voting) vote(volume, hull, last, counts);
      // From here on the hull of space that nothing bounds is only what the surface may meet.
      if (!any_silhouette(silhouettes_)) bounding.drop_far_from(volume);
      malloc_trim(0);
      const int iterations = last    ? options_.fine_iterations
                             : first ? options_.coarse_iterations
                                     : kMiddleIterations;
      for (int i = 0; i < iterations; ++i) {
        progress.check_cancelled();
        const bool is_final = last && i + 1 == iterations;
        const NearDistances before(volume);
        step(volume, hull, first, is_final, counts);
        const double reach = is_final ? kFullReach : kNearReach;
        TriMesh mesh = extract_mesh(volume);
        give_back(mesh);
        SparseVolume after = distance_from_mesh(mesh, volume, hull.grid, reach);
        mesh = {};
        keep_still(before, volume, after);
        volume = {};
        volume = bounded(after, bounding);
        keep_thin(volume, hull, counts);
        if (is_final) restore(volume, hull, counts);
        progress.update((double(level) + double(i + 1) / iterations) / double(grids.size()));
      }
      if (last) fit(volume, bounding, counts, progress, report);
      if (last && is_bounded())
        counts.restored += std::int64_t(fill_unproven(hull, proof_.positions, proof_.normals,
                                                      proof_.weights, options_.unproven, volume));
      if (last) keep_thin(volume, hull, counts);
      if (last && any_silhouette(silhouettes_))
        counts.restored +=
            std::int64_t(rejoin_stems(hull, cameras_, silhouettes_, options_.thin, volume));
      settled_ = next_settled_;
      counts.split = settled_.count(Settled::kSplit);
      counts.settled_pixels = settled_.count(Settled::kPixels);
      counts.settled_plain = settled_.count(Settled::kPlain);
      counts.settled_flat = settled_.count(Settled::kFlat);
      counts.bricks = std::int64_t(volume.bricks.size());
      counts.seconds =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      report.levels.push_back(counts);
      if (checkpoint && !last) keep(*checkpoint, {volume, settled_, report.levels}, progress);
    }
    return volume;
  }

 private:
  /// A disk that is full must not end a job that may still write its results elsewhere.
  static void keep(const CheckpointFile& file, const Checkpoint& checkpoint, Progress& progress) {
    try {
      write_checkpoint(file, checkpoint);
    } catch (const Error& problem) {
      progress.warn(concat("an interrupted run could not go on from here: ", problem.what()));
    }
  }

  SparseVolume first_guess(const SparseVolume& hull) {
    if (!is_bounded() && options_.voting && options_.label.iterations > 0)
      return bounded(label_by_votes(context_, hull, images_, cameras_, options_.noise_sigma,
                                    vote_options(false), options_.label),
                     hull);
    return bounded(options_.voting ? vote_free_space(context_, hull, images_, cameras_,
                                                     options_.noise_sigma, options_.vote)
                                   : hull,
                   hull);
  }

  /// Not where silhouettes bound nothing: what they show of the surroundings would come back whole.
  void restore(SparseVolume& volume, const SparseVolume& hull, LevelReport& counts) {
    if (!is_bounded()) return;
    counts.restored += std::int64_t(
        restore_silhouettes(context_, volume, hull, cameras_, silhouettes_, options_.restore));
  }

  void keep_thin(SparseVolume& volume, const SparseVolume& hull, LevelReport& counts) {
    if (is_bounded()) counts.restored += std::int64_t(keep_thin_hull(hull, options_.thin, volume));
  }

  /// Is what silhouettes leave, and photographs do not tell of, solid?
  bool is_bounded() const { return options_.bounded && any_silhouette(silhouettes_); }

  VoteOptions vote_options(bool last) const {
    VoteOptions options = options_.vote;
    if (!is_bounded()) {
      options.tiles = options_.open.tiles;
      options.bare_reach = last ? options_.open.last_reach : options_.open.reach;
    }
    if (last) options.rounds = options.last_rounds;
    return options;
  }

  void vote(SparseVolume& volume, const SparseVolume& hull, bool last, LevelReport& counts) {
    VoteOptions options = vote_options(last);
    if (last) options.again_spacing = options.last_spacing;
    const Revision revision =
        vote_again(context_, volume, hull, images_, cameras_, options_.noise_sigma, options);
    counts.restored += std::int64_t(revision.added);
    counts.freed += std::int64_t(revision.freed);
  }

  /// What of the volume lies in the hull, without space that nothing can have looked into.
  static SparseVolume bounded(const SparseVolume& volume, const SparseVolume& hull) {
    SparseVolume out = intersection(volume, hull);
    fill_cavities(out);
    return out;
  }

  /// The same, with a hull that is looked up again should the volume reach where it was dropped.
  SparseVolume bounded(const SparseVolume& volume, BoundingHull& hull) const {
    if (!hull.bounds(volume)) hull = BoundingHull(hull_at_(volume.grid));
    return bounded(volume, hull.volume());
  }

  /// As match_patches does, some of the mesh's vertices after the other.
  Matches match_in_parts(const GridSpec& grid, const TriMesh& mesh,
                         std::span<const glm::vec3> bends,
                         std::span<const shaders::MatchChoice> choices, const OffsetRange& range) {
    const std::size_t total = mesh.positions.size();
    Matches all;
    all.range = range;
    all.scores.reserve(total * std::size_t(range.count));
    all.texture.reserve(total);
    for (std::size_t first = 0; first < total; first += kPart) {
      const std::size_t count = std::min(kPart, total - first);
      const Matches part = match_patches(
          context_, grid, render::to_voxels(grid, mesh, first, count),
          bends.empty() ? bends : bends.subspan(first, count), choices.subspan(first, count),
          images_, cameras_, options_.noise_sigma, range, options_.match);
      all.scores.insert(all.scores.end(), part.scores.begin(), part.scores.end());
      all.texture.insert(all.texture.end(), part.texture.begin(), part.texture.end());
      all.samples += part.samples;
    }
    return all;
  }

  /// Moves the surface to where the photographs agree; `first`: at the first level, `is_final`: the
  /// last step of all.
  void step(SparseVolume& volume, const SparseVolume& hull, bool first, bool is_final,
            LevelReport& counts) {
    const int offsets = first ? options_.coarse_offsets : options_.fine_offsets;
    const TriMesh mesh = extract_mesh(volume, settled_.coarse(volume.grid));
    VertexGraph graph = make_graph(mesh);
    const std::vector<glm::vec3> positions = voxel_positions(volume.grid, mesh);
    give_back(mesh);
    // The curvature of a guess that no silhouette shaped says nothing of the surface's.
    std::vector<glm::vec3> bends =
        first && !is_bounded()
            ? std::vector<glm::vec3>()
            : curvatures(graph, positions, mesh.normals, options_.match.most_bend);
    const OffsetRange range{-options_.step * (offsets / 2), options_.step, offsets};
    std::vector<shaders::MatchChoice> choices =
        choose_views(context_, volume.grid, mesh, images_, cameras_, options_.match);
    std::vector<bool> seen = seen_by_any(choices);
    const std::vector<Settled> settled = settled_.at(volume.grid, positions);
    for (std::size_t i = 0; i < choices.size(); ++i)
      if (is_settled(settled[i])) choices[i].second.w = 0;
    Matches matches = match_in_parts(volume.grid, mesh, bends, choices, range);
    aggregate(graph, options_.aggregations, matches);
    std::vector<Peak> peaks = find_peaks(matches, options_.peak);
    next_settled_ = SettledBricks(volume.grid, positions, bends, matches, peaks, choices, cameras_,
                                  settled, options_.settle);
    bends = {};
    matches.scores = {};
    KnownSurface known = known_surface(positions, mesh.normals, peaks, choices, options_.look);
    choices = {};
    give_back(mesh);
    const std::vector<Sightline> sightlines =
        find_sightlines(context_, volume.grid, known, images_, cameras_, options_.noise_sigma,
                        options_.match, options_.look);
    const std::vector<glm::vec3> known_positions = std::move(known.positions);
    known = {};
    if (is_final && is_bounded()) remember_proof(positions, mesh.normals, peaks, seen, settled);
    const std::vector<float> trust =
        trust_thickness(volume, positions, mesh.normals, options_.peak.thick);
    for (std::size_t i = 0; i < peaks.size(); ++i) peaks[i].weight *= trust[i];
    // Not at first: what no silhouette shows is still to be found under the hull.
    if (!first && is_bounded())
      pull_to_hull(hull, graph, positions, matches.texture, trust, options_.rims, peaks);
    std::vector<float> moves =
        regularize(graph, peaks, positions, mesh.normals, trust, options_.regularize);
    const auto told =
        std::count_if(peaks.begin(), peaks.end(), [](const Peak& peak) { return peak.weight > 0; });
    counts.evidence = double(told) / double(std::max<std::size_t>(peaks.size(), 1));
    peaks = {};
    if (!is_bounded())  // plain background is no surface: nothing says where it is
      for (std::size_t i = 0; i < seen.size(); ++i)
        seen[i] = seen[i] && matches.texture[i] >= options_.settle.least_texture;
    if (options_.closing) {
      const auto closing = close_unseen(volume.grid, mesh, graph, seen, options_.close);
      for (std::size_t i = 0; i < moves.size(); ++i)
        if (closing[i] != 0) moves[i] = closing[i];
    }
    graph = {};
    move_surface(volume, mesh, moves);
    counts.freed +=
        std::int64_t(free_sightlines(sightlines, known_positions, cameras_, options_.look, volume));

    counts.surfels = std::int64_t(moves.size());
    counts.samples += matches.samples;
    double sum = 0;
    for (const float move : moves) sum += std::abs(move);
    counts.mean_move = sum / double(std::max<std::size_t>(moves.size(), 1));
  }

  /// Fits the surface to the photographs while the views that were held out gain by it; then once
  /// more, which gains on all development scenes, and seats it on the outlines.
  void fit(SparseVolume& volume, BoundingHull& bounding, LevelReport& counts, Progress& progress,
           RefineReport& report) {
    const SparseVolume& hull = bounding.volume();
    const bool silhouettes = any_silhouette(silhouettes_);
    SparseVolume before;
    double best = -1;
    for (int i = 0; i < options_.photometric; ++i) {
      const bool last = i + 1 == options_.photometric;
      progress.check_cancelled();
      const auto start = std::chrono::steady_clock::now();
      TriMesh mesh = extract_mesh(volume, settled_.coarse(volume.grid));
      VertexGraph graph = make_graph(mesh);
      std::vector<glm::vec3> positions = voxel_positions(volume.grid, mesh);
      give_back(mesh);
      std::vector<shaders::MatchChoice> choices =
          choose_views(context_, volume.grid, mesh, images_, cameras_, options_.match);
      const std::vector<Settled> settled = settled_.at(volume.grid, positions);
      for (std::size_t k = 0; k < choices.size(); ++k)
        if (is_settled(settled[k]) && settled[k] != Settled::kFlat) choices[k].second.w = 0;
      Matches matches = match_in_parts(volume.grid, mesh, {}, choices, {});
      matches.scores = {};
      auto results = fit_patches(context_, volume.grid, mesh, graph, images_, cameras_, choices,
                                 options_.noise_sigma, options_.fit);
      counts.samples += matches.samples + samples_of(choices, options_.fit);
      const HeldOut held = held_out(results);
      const bool better = held.before > best;
      if (best >= 0) report.fits.back().kept = better;
      if (!better) {  // on to the last pass, from the surface before
        volume = before;
        best = -1;
        i = options_.photometric - 2;
        continue;
      }
      best = held.before;
      const std::vector<float> spacings =
          tap_spacings(volume.grid, positions, cameras_, choices, options_.fit);
      std::vector<Peak> peaks = peaks_of(results, spacings, options_.fit);
      results = {};
      std::vector<float> trust =
          trust_thickness(volume, positions, mesh.normals, options_.peak.thick);
      std::vector<float> told;  // of seating alone
      if (last && silhouettes) told = told_around(graph, weights_told(peaks, spacings));
      std::vector<float> tight_at;
      for (const float t : trust) tight_at.push_back(t * t);
      trust_outlines(volume.grid, positions, choices, cameras_, silhouettes_, options_.fit, trust);
      choices = {};
      // What patches cannot be trusted with stays where it is.
      for (std::size_t k = 0; k < peaks.size(); ++k) peaks[k].offset *= trust[k];
      const double tight = is_bounded() ? pull_to_hull(hull, graph, positions, matches.texture,
                                                       trust, options_.rims, peaks)
                                        : 0;
      for (float& t : tight_at) t *= float(tight);
      RegularizeOptions smooth = options_.regularize;
      smooth.membrane = kFitMembrane, smooth.fairing = kFitFairing;
      std::vector<float> moves = regularize(graph, peaks, positions, mesh.normals, trust, smooth);
      if (last && silhouettes)
        seat_outlines(hull, cameras_, silhouettes_, mesh, graph, positions, told, tight_at,
                      options_.seat, moves);
      if (!last) before = volume;
      graph = {};
      positions = {};
      move_surface(volume, mesh, moves);
      mesh = {};
      // Not measured anew: steps are short, and passing through the mesh costs more than they gain.
      volume = bounded(volume, bounding);
      FitReport pass;
      for (const float move : moves) pass.mean_move += std::abs(move) / double(moves.size());
      pass.held_before = held.before, pass.held_after = held.after;
      pass.seconds =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      report.fits.push_back(pass);
      if (last) report.fits.back().kept = true;
    }
  }

  /// What settled below the images' sampling says nothing anew; what is flat was found with
  /// certainty before.
  void remember_proof(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                      std::span<const Peak> peaks, const std::vector<bool>& seen,
                      std::span<const Settled> settled) {
    proof_ = {};
    for (std::size_t i = 0; i < peaks.size(); ++i) {
      if (settled[i] == Settled::kPixels || settled[i] == Settled::kUnseen) continue;
      proof_.positions.push_back(positions[i]);
      proof_.normals.push_back(normals[i]);
      proof_.weights.push_back(!seen[i]                       ? -1.0f
                               : settled[i] == Settled::kFlat ? 1.0f
                                                              : peaks[i].weight);
    }
  }

  /// What the photographs say of the surface that the last step found.
  struct Proof {
    std::vector<glm::vec3> positions, normals;
    std::vector<float> weights;
  };

  Proof proof_;
  SettledBricks settled_, next_settled_;  // by the level before, and by this one
  gpu::Context& context_;
  const HullAt& hull_at_;
  std::span<const carving::Silhouette> silhouettes_;
  const projtex::ImageSet& images_;
  std::span<const Camera> cameras_;
  RefineOptions options_;
};

}  // namespace

SparseVolume refine_surface(gpu::Context& context, const GridSpec& finest, const HullAt& hull_at,
                            std::span<const carving::Silhouette> silhouettes,
                            const projtex::ImageSet& images, std::span<const Camera> cameras,
                            const RefineOptions& options, Progress& progress, RefineReport* report,
                            const CheckpointFile* checkpoint) {
  options.validate();
  PHOTOHULL_CHECK_OP(int(cameras.size()), ==, images.layers());
  PHOTOHULL_CHECK_OP(silhouettes.size(), ==, cameras.size());
  std::vector<GridSpec> grids{finest};
  const auto longest = [](const GridSpec& grid) {
    const glm::ivec3 n = grid.voxels();
    return std::max({n.x, n.y, n.z});
  };
  // The votes' patches reach as far as voxels: where these hardly hold pixels, they hold nothing.
  const double least = options.bounded && any_silhouette(silhouettes)
                           ? 0
                           : kLeastPixels * carving::pixel_footprint(finest.bounds(), cameras);
  const auto is_fine = [&](const GridSpec& grid) {
    return longest(grid) > RefineOptions::kCoarsestVoxels ||
           (grid.voxel_size < least && longest(grid) > RefineOptions::kFewestVoxels);
  };
  while (options.levels > 0 ? int(grids.size()) < options.levels : is_fine(grids.front()))
    grids.insert(grids.begin(), carving::coarser(grids.front()));
  RefineReport counts;
  SparseVolume volume =
      Refiner(context, hull_at, silhouettes, images, cameras, finest.bounds().center(), options)
          .run(grids, checkpoint, progress, counts);
  if (report) *report = std::move(counts);
  return volume;
}

}  // namespace photohull::refine
