// Verdict: causes of which other signs are consequences.
#include <algorithm>
#include <cmath>

#include "assess/judge.h"
#include "core/option_word.h"

namespace photohull::assess {
namespace {

constexpr Limits kFewViews{0.45, INFINITY};  // of the surface, seen by fewer than three
constexpr double kRestored = 0.5;   // of what lines of silhouettes show, put into the masks
constexpr double kManyStems = 0.3;  // of the surface
constexpr double kBeyondViews = 1.0 / 3;
constexpr double kBeyondBox = 0.05;    // of the silhouettes
constexpr double kThinVoxels = 2;      // voxels: what is narrower may fall between them
constexpr double kFinestPixels = 0.5;  // pixels to a voxel: finer ones show nothing more

}  // namespace

void Judge::box() {
  if (cut_share() > kCutOff.doubtful) name_cause(cut_off());
  const bool cut = cut_by_box();
  // Specks in few views' masks are no object that goes on.
  const bool lacking = (cut || s_.missed > kMissed.doubtful) && s_.beyond_views > kBeyondViews;
  if (!s_.masks || s_.beyond_box <= (lacking ? kBeyondCut : kBeyondBox)) return;
  const std::string beyond =
      concat(percent(s_.beyond_box), " of what the masks show lies beyond the box");
  if (lacking || s_.contradiction > kContradiction.doubtful)
    name_cause(concat(beyond, ": the box cuts the object off; make it larger (",
                      option_word("box_scale"), ") or let it be found (",
                      option_word("box", "auto"), ")"));
  else
    verdict_.notes.push_back(concat(beyond, " (", option_word("box_scale"), " makes it larger)"));
}

double Judge::cut_share() const {
  const Explained& e = s_.explained;
  return double(e.count(Place::kCut)) / std::max(1, e.count(Place::kCut) + e.told());
}

std::string Judge::cut_off() const {
  return concat(
      percent(cut_share()),
      " of what the photographs show there stands just outside the box: make the box larger (",
      option_word("box_scale"), ") if it belongs to the object");
}

void Judge::stems() {
  if (s_.stems > kManyStems && s_.stems_restored > kRestored)
    name_cause(concat(percent(std::min(1.0, s_.stems_restored)),
                      " of the thin parts were put back from the photographs, for the masks lack "
                      "them: their width is a guess; make masks that show them, or photograph "
                      "from nearer"));
  if (s_.stems > kManyStems && s_.voxel_size > kCoarseVoxels * s_.far)
    name_cause(concat(percent(s_.stems), " of the surface are stems, and ", too_coarse()));
}

std::string Judge::too_coarse() const {
  return concat("voxels are wider than one percent of its diagonal: use ",
                option_word("resolution", std::lround(s_.resolution * s_.voxel_size / s_.far)));
}

void Judge::few_views() {
  if (s_.few_views > kFewViews.doubtful)
    name_cause(
        concat("fewer than three views see ", percent(s_.few_views), " of the surface: add views"));
}

void Judge::thin_parts() {
  stems();
  const double width = s_.missed_width * s_.pixel_size;
  if (!s_.masks || !(s_.missed > kMissed.doubtful) || !(width > 0) ||
      width > kThinVoxels * s_.voxel_size)
    return;
  const double voxel = std::max(width / kThinVoxels, kFinestPixels * s_.pixel_size);
  if (voxel >= s_.voxel_size) return;
  name_cause(concat("parts that the masks show about ", pixels(s_.missed_width),
                    " wide are missing, for they are thinner than ", kThinVoxels, " voxels: use ",
                    option_word("resolution", std::lround(s_.resolution * s_.voxel_size / voxel))));
}

void Judge::common_errors() {
  const CommonError& c = s_.common;
  const std::string agree =
      concat("the outlines disagree by ", pixels(c.before), ", and by ", pixels(c.after), " with ");
  if (c.focal_counts())
    name_cause(concat(agree, "all focal lengths times ", std::round(1000 * c.focal_factor) / 1000,
                      ": they are too ", c.focal_factor < 1 ? "long" : "short",
                      ", and size and shape are off; calibrate again, or try ",
                      option_word("refine_cameras", "poses+intrinsics")));
  if (c.shift_counts())
    name_cause(concat(agree, "all masks moved by (", std::round(-10 * c.shift.x) / 10 + 0.0, ", ",
                      std::round(-10 * c.shift.y) / 10 + 0.0,
                      ") px: masks are shifted against their photographs, or principal points "
                      "are off; make the masks anew, or calibrate again"));
}

void Judge::other_photographs() {
  if (const std::string list = misfits(s_.compared); !list.empty())
    name_cause(other_photograph(list));
}

}  // namespace photohull::assess
