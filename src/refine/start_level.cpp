#include "refine/start_level.h"

#include "refine/restore.h"
#include "refine/thin_hull.h"
#include "refine/vote.h"

namespace photohull::refine {
namespace {

VoteOptions vote_options(const RefineJob& job, bool last) {
  VoteOptions options = job.options.vote;
  if (!job.is_bounded()) {
    options.tiles = job.options.open.tiles;
    options.bare_reach = last ? job.options.open.last_reach : job.options.open.reach;
  }
  if (last) options.rounds = options.last_rounds;
  return options;
}

}  // namespace

SparseVolume first_guess(const RefineJob& job, const SparseVolume& hull) {
  const RefineOptions& options = job.options;
  if (!options.voting) return bounded(hull, hull);
  if (!job.is_bounded() && options.label.iterations > 0)
    return bounded(label_by_votes(job.context, hull, job.photographs, vote_options(job, false),
                                  options.label, job.shared),
                   hull);
  return bounded(vote_free_space(job.context, hull, job.photographs, options.vote, job.shared),
                 hull);
}

void revise_by_votes(const RefineJob& job, const SparseVolume& hull, bool last,
                     SparseVolume& volume, LevelReport& counts) {
  VoteOptions options = vote_options(job, last);
  if (last) options.again_spacing = options.last_spacing;
  const Revision revision =
      vote_again(job.context, volume, hull, job.photographs, options, job.shared);
  counts.restored += std::int64_t(revision.added);
  counts.freed += std::int64_t(revision.freed);
}

void restore_lost(const RefineJob& job, const SparseVolume& hull, SparseVolume& volume,
                  LevelReport& counts) {
  if (!job.is_bounded()) return;
  counts.restored +=
      std::int64_t(restore_silhouettes(job.context, volume, hull, job.cones, job.options.restore));
}

void keep_thin(const RefineJob& job, const SparseVolume& hull, SparseVolume& volume,
               LevelReport& counts) {
  if (job.is_bounded())
    counts.restored += std::int64_t(keep_thin_hull(hull, job.options.thin, volume));
}

}  // namespace photohull::refine
