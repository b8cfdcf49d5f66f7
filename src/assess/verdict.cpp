#include "assess/verdict.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "assess/judge.h"
#include "core/median.h"
#include "core/option_word.h"

namespace photohull::assess {
namespace {

constexpr Limits kResidual{0.5, 2};           // of the distance that counts as far off
constexpr Limits kMoved{0.6, 2.4};            // the same, of what is left in the mean of the views
constexpr Limits kFarOff{0.09, 0.6};          // share of the matches
constexpr Limits kUnmatched{0.42, INFINITY};  // of the surface, textured and not found again
constexpr Limits kUnsure{0.3, INFINITY};      // of the surface, where matches are few
constexpr Limits kUnseen{0.5, 0.8};           // of the surface
constexpr Limits kAtBox{0.08, INFINITY};      // of the surface
constexpr Limits kExcess{0.06, 0.3};          // of the surface's projection
// Of the surface: texture that is not found again, and what else has little confidence. Fitted on
// `python3 -m bench verdict_scenes`, seed 1 (docs/measurements/verdict.md): at most 0.25 where F
// at 0.5 % is above 95, 0.31 to 0.41 at 60 to 69. Rendered and real scenes of that quality have up
// to 0.26, without silhouettes.
constexpr Limits kUnconfirmed{0.27, INFINITY};
constexpr double kUnsureWeight = 0.7;  // of what has little confidence, beside what is not found
constexpr double kGoesOn = 0.15;       // of a hull's surface, beyond the box's sides
constexpr double kGuessed = 0.2;       // of the surface, unseen: worth saying what to do
constexpr double kAlike = 0.7;         // of the views' movement, in common: half of its square
constexpr double kHullOff = 0.18;      // of a hull's matches that are far off
constexpr double kHullUnconfirmed = 0.36;  // of a hull's textured surface
constexpr double kHullPatches = 0.19;      // of a hull's surface, in patches where most is so
constexpr double kEnoughMatched = 0.7;     // of the textured surface
// Of the places on the surface, where other views show something else. Good scenes have up to 0.06
// at 96 voxels and more, models with lumps where masks are too large 0.12 and more (decision 16).
constexpr double kDisagreeing = 0.08;
constexpr int kFewestTold = 30;            // places, to go by that share
constexpr double kPlainConfidence = 0.93;  // mean, where there is less texture than that
constexpr double kOutlying = 3;            // times what is usual: a view's residual
constexpr int kFewestMatches = 5;          // of a view, to accuse it
constexpr int kFewestOfAll = 20;           // of all views, to accuse their cameras

/// Views whose matches lie clearly farther from the epipolar lines than usual.
std::vector<std::size_t> outlying_views(const Signals& s) {
  std::vector<double> residuals;
  for (const ViewResidual& v : s.match.views)
    if (v.matches >= kFewestMatches) residuals.push_back(v.pixels);
  const double usual = median(residuals);
  std::vector<std::size_t> views;
  for (std::size_t i = 0; i < s.match.views.size(); ++i) {
    const ViewResidual& v = s.match.views[i];
    if (v.matches >= kFewestMatches && v.pixels > kOutlying * usual &&
        v.pixels * v.pixel_size > kResidual.doubtful * s.far)
      views.push_back(i);
  }
  // All of them at once is no view's fault.
  if (views.size() > residuals.size() / 3) views.clear();
  return views;
}

}  // namespace

Verdict Judge::run() {
  box();
  thin_parts();
  common_errors();
  few_views();
  other_photographs();
  cameras();
  if (s_.hull)
    hull();
  else
    surface();
  silhouettes();
  coverage();
  photographs();
  return std::move(verdict_);
}

void Judge::weigh(double value, const Limits& limits, const std::string& reason) {
  if (!(value > limits.doubtful)) return;
  const Level level = value > limits.failed ? Level::kFailed : Level::kDoubtful;
  // What is worst comes first.
  if (level > verdict_.level)
    verdict_.reasons.insert(verdict_.reasons.begin() + causes_, reason);
  else
    verdict_.reasons.push_back(reason);
  verdict_.level = std::max(verdict_.level, level);
}

void Judge::name_cause(const std::string& reason) {
  verdict_.reasons.insert(verdict_.reasons.begin() + causes_++, reason);
  verdict_.level = std::max(verdict_.level, Level::kDoubtful);
}

bool Judge::cut_by_box() const {
  return s_.at_box > kAtBox.doubtful && (s_.hull_beyond > kGoesOn || s_.beyond_box > kBeyondCut);
}

void Judge::cameras() {
  int matches = 0;  // each is of two views
  for (const ViewResidual& v : s_.match.views) matches += v.matches;
  const std::vector<std::size_t> outlying = outlying_views(s_);
  if (!outlying.empty()) {
    double worst = 0, off = 0;
    std::string list;
    for (const std::size_t i : outlying) {
      const ViewResidual& view = s_.match.views[i];
      worst = std::max(worst, view.pixels);
      off = std::max(off, view.pixels * view.pixel_size);
      list += (list.empty() ? "" : ", ") + n_[i];
    }
    weigh(off / s_.far, {kResidual.doubtful, INFINITY},
          concat("the views ", list, " disagree with the rest by up to ", pixels(worst),
                 ": calibrate them again, leave them out (", option_word("views"), "), or try ",
                 option_word("refine_cameras", "auto")));
  }
  if (matches >= 2 * kFewestOfAll)
    weigh(s_.match.residual * s_.match.pixel_size / s_.far, kResidual,
          concat("the cameras disagree by ", pixels(s_.match.residual),
                 " (median): calibrate again, or try ", option_word("refine_cameras", "auto")));
  // Errors of single views are nearly gone from the mean of all, which is where the world lies.
  const double place =
      std::max(s_.cameras_moved_alike, s_.cameras_moved / std::sqrt(double(std::max(1, s_.views))));
  const bool alike = s_.cameras_moved_alike > kAlike * s_.cameras_moved;
  const double off = place * s_.pixel_size / s_.far;
  const std::string moved =
      concat("the cameras had to be moved by ", pixels(s_.cameras_moved),
             " to agree: shape is right, but place and size may be off by ", pixels(place),
             alike ? concat("; all were off alike, so that focal length, principal point or pixel "
                            "centre may be wrong (",
                            command_word("info", "cameras"), ", ",
                            option_word("refine_cameras", "poses+intrinsics"), ")")
                   : "");
  if (off > kMoved.failed) causes_ = 0;  // before all others, whatever these are
  weigh(off, kMoved, moved);
}

bool Judge::views_disagree() const {
  return s_.compared.told() >= kFewestTold &&
         s_.compared.share_told(Place::kDisagreeing) > kDisagreeing;
}

bool Judge::only_colours_differ() const {
  return s_.match.matched >= kEnoughMatched && !views_disagree();
}

std::string Judge::lumps() const {
  return views_disagree() ? "; lumps where masks are too large do this, too: look at the masks"
                          : "";
}

void Judge::surface() {
  if (s_.match.textured < kLeastTexture) {
    // Silhouettes alone may still show all there is. They do not when the few matches there are
    // pull the surface about, or many views do not see parts of it. Of stems, which are thinner
    // than any patch, they tell all.
    const double confidence = s_.mean_confidence / std::max(1e-9, 1 - s_.unseen);
    if (confidence < kPlainConfidence || !s_.masks)
      weigh(1 - s_.match.textured - s_.stems, {1 - kLeastTexture, INFINITY}, why_untold());
    return;
  }
  const double unmatched = s_.match.textured * (1 - s_.match.matched);
  weigh(unmatched, kUnmatched,
        concat("on ", percent(unmatched),
               " of the surface there is texture that no second view shows: cameras, focus, "
               "gloss or moving parts may be the cause"));
  const double doubted = only_colours_differ() ? 0 : std::max(0.0, s_.unsure - s_.unseen);
  if (unmatched <= kUnmatched.doubtful && (doubted == 0 || s_.unsure <= kUnsure.doubtful))
    weigh(unmatched + kUnsureWeight * doubted, kUnconfirmed,
          concat("on ", percent(unmatched + doubted),
                 " of the surface the photographs do not confirm it, for no second view shows "
                 "its texture or confidence is below one half: folds and hollows that few views "
                 "look into do this, noise and blur too; add views that look in, or sharper "
                 "ones",
                 lumps()));
  weigh(s_.match.beyond_far, kFarOff,
        concat("two views put ", percent(s_.match.beyond_far),
               " of what they both show more than 0.5 % of the diagonal off the surface: ",
               s_.voxel_size > kCoarseVoxels * s_.far ? too_coarse()
                                                      : "look at the confidence in mesh.ply"));
}

std::string Judge::why_untold() const {
  if (s_.match.seen < kLeastTexture)
    return concat("on ", percent(1 - s_.match.seen),
                  " of the surface no two views are near enough to each other to be compared: "
                  "the hull stands there; add views between the present ones");
  return concat("too little texture on ", percent(1 - s_.match.textured - s_.stems),
                " of the surface: the hull stands there; paint or project a pattern, or add "
                "light");
}

void Judge::hull() {
  if (!s_.masks) {
    causes_ = 0;  // before all others, whatever these are
    weigh(1, {0, 0},
          concat("no view has a mask: the hull is the box clipped by what the views see; give "
                 "masks, or use ",
                 option_word("method", "refine")));
    return;
  }
  std::string note =
      "a visual hull is an outer bound: concavities that no silhouette shows are filled";
  const MatchEvidence& m = s_.match;
  if (m.textured < kLeastTexture) {
    note += m.seen < kLeastTexture ? "; no two views are near enough to each other to tell where"
                                   : "; there is too little texture to tell where";
    weigh(s_.unsure, kUnsure, why_untold());
  } else {
    const double confirmed = m.matched * (1 - m.beyond_far);
    note += concat("; the photographs confirm it on ", percent(confirmed), " of its texture");
    weigh(std::max({m.beyond_far / kHullOff, (1 - confirmed) / kHullUnconfirmed,
                    m.unconfirmed_patches / kHullPatches}),
          {1, INFINITY},
          concat("on ", percent(1 - confirmed),
                 " of its texture the photographs do not confirm the hull: the object is concave "
                 "there, or too few views show its outline; add views, or use ",
                 option_word("method", "refine")));
  }
  verdict_.notes.push_back(note);
}

void Judge::silhouettes() {
  if (!s_.masks) return;
  weigh(s_.contradiction, kContradiction,
        concat("the silhouettes contradict each other: ", percent(s_.contradiction),
               " of them can be filled by no shape; check masks and cameras"));
  weigh(s_.missed, kMissed,
        concat("the surface leaves ", percent(s_.missed),
               " of the silhouettes empty: check masks and cameras"));
  weigh(s_.excess, kExcess,
        concat(percent(s_.excess),
               " of the surface's picture lies on background: check masks "
               "and cameras"));
}

void Judge::coverage() {
  verdict_.coverage = concat(percent(1 - s_.unseen), " of the surface is seen, ",
                             percent(1 - s_.few_views), " by three views or more");
  if (s_.unseen > kGuessed)
    verdict_.coverage += concat("; the rest is a guess: add views there, or leave it out with ",
                                option_word("unseen", "open"));
  weigh(s_.unseen, kUnseen,
        concat("no view sees ", percent(s_.unseen), " of the surface: add views there, or use ",
               option_word("unseen", "open")));
  if (!only_colours_differ())
    weigh(s_.unsure, kUnsure,
          concat("confidence is below one half on ", percent(s_.unsure),
                 " of the surface: other photographs do not show the same there, or it is plain; "
                 "look at them, and at ",
                 command_word("info", "cameras"), lumps()));
  weigh(cut_by_box() ? s_.at_box : 0, kAtBox,
        concat(percent(s_.at_box),
               " of the surface lies on the box's sides: the box cuts the object off (make ",
               option_word("box"), " larger), or nothing tells where it ends"));
}

const char* to_string(Level level) {
  constexpr std::array kNames = {"good", "doubtful", "failed"};
  return kNames[std::size_t(level)];
}

Verdict judge(const Signals& signals, const std::vector<std::string>& names) {
  return Judge(signals, names).run();
}

}  // namespace photohull::assess
