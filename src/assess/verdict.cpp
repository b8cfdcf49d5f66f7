#include "assess/verdict.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/median.h"

namespace photohull::assess {
namespace {

// Fitted on the runs of bench/plans/stress.json, seed 1 (docs/stability.md): beyond the first
// figure results are doubtful, beyond the second they count as failed.
struct Limits {
  double doubtful, failed;
};
constexpr Limits kResidual{0.5, 2};           // of the distance that counts as far off
constexpr Limits kMoved{0.6, 2.4};            // the same, of what is left in the mean of the views
constexpr Limits kFarOff{0.09, 0.6};          // share of the matches
constexpr Limits kUnmatched{0.42, INFINITY};  // of the surface, textured and not found again
constexpr Limits kUnsure{0.3, INFINITY};      // of the surface, where matches are few
constexpr Limits kUnseen{0.5, 0.8};           // of the surface
constexpr Limits kAtBox{0.08, INFINITY};      // of the surface
constexpr Limits kMissed{0.04, 0.3};          // of the silhouettes
constexpr Limits kExcess{0.06, 0.3};          // of the surface's projection
constexpr Limits kContradiction{0.02, 0.5};   // of the silhouettes' rays
constexpr Limits kFewViews{0.45, INFINITY};   // of the surface, seen by fewer than three
// Of the surface: texture that is not found again, and what else has little confidence. Fitted on
// bench/verdict_scenes.py, seed 1 (docs/stability.md): at most 0.25 where F at 0.5 % is above 95,
// 0.31 to 0.41 at 60 to 69. Rendered and real scenes of that quality have up to 0.26, without
// silhouettes.
constexpr Limits kUnconfirmed{0.27, INFINITY};
constexpr double kUnsureWeight = 0.7;  // of what has little confidence, beside what is not found
constexpr double kRestored = 0.5;      // of what lines of silhouettes show, put into the masks
constexpr double kManyStems = 0.3;     // of the surface
constexpr double kCoarseVoxels = 2;    // times half a percent of the diagonal
constexpr double kGoesOn = 0.02;       // of a hull's surface, beyond the box's sides
// Of what the photographs show without silhouettes, from runs with --masks none: scenes as they
// are, and at 128 voxels with cameras turned by 1 to 20 pixels and with wrong boxes (the table in
// docs/stability.md). Unexplained: at most 0.18 where F at 0.5 % is above 90, 0.27 to 0.34 at 54 to
// 72, 0.39 to 0.55 at 42 to 49, 0.76 and more below 13. Cut: at most 0.04 in right boxes, 0.04 to
// 0.10 in those of 0.7 of the size, 0.13 to 0.31 in those of half of it. Bare: at most 0.44 in
// right boxes with right cameras, 0.84 and more where F is below 6.
constexpr Limits kUnexplained{0.25, 0.7};  // of the places of which something is known
constexpr Limits kCutOff{0.12, INFINITY};  // of these and those just outside the box
constexpr Limits kBare{0.8, INFINITY};     // of all texture
constexpr double kWorthNoting = 0.05;      // of any of them
constexpr double kBeyondBox = 0.05;        // of the silhouettes
constexpr double kBeyondCut = 0.01;        // likewise, where the box's sides cut the surface
constexpr double kThinVoxels = 2;          // voxels: what is narrower may fall between them
constexpr double kFinestPixels = 0.5;      // pixels to a voxel: finer ones show nothing more
constexpr double kMisfit = 0.5;            // of what is told of a view: its photograph is another's
constexpr double kGuessed = 0.2;           // of the surface, unseen: worth saying what to do
constexpr int kFewestPlaces = 30;          // told, for a share of them to mean anything
constexpr double kWorse = 0.1;             // than the mean: views that are named
constexpr std::size_t kMostNamed = 3;
constexpr double kAlike = 0.6;             // of the views' movement, in common
constexpr double kHullOff = 0.18;          // of a hull's matches that are far off
constexpr double kHullUnconfirmed = 0.36;  // of a hull's textured surface
constexpr double kEnoughMatched = 0.7;     // of the textured surface
constexpr double kLeastTexture = 0.1;      // of the surface, for shares of it to mean anything
constexpr double kPlainConfidence = 0.93;  // mean, where there is less texture than that
constexpr double kOutlying = 3;            // times what is usual: a view's residual
constexpr int kFewestMatches = 5;          // of a view, to accuse it
constexpr int kFewestOfAll = 20;           // of all views, to accuse their cameras

std::string percent(double share) { return concat(std::lround(100 * share), " %"); }

std::string pixels(double value) { return concat(std::round(10 * value) / 10, " px"); }

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
        v.pixels * s.pixel_size > kResidual.doubtful * s.far)
      views.push_back(i);
  }
  // All of them at once is no view's fault.
  if (views.size() > residuals.size() / 3) views.clear();
  return views;
}

class Judge {
 public:
  Judge(const Signals& signals, const std::vector<std::string>& names) : s_(signals), n_(names) {}

  Verdict run() {
    box();
    thin_parts();
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

 private:
  /// Takes the reason where the value is beyond its limits.
  void weigh(double value, const Limits& limits, const std::string& reason) {
    if (!(value > limits.doubtful)) return;
    const Level level = value > limits.failed ? Level::kFailed : Level::kDoubtful;
    // What is worst comes first.
    if (level > verdict_.level)
      verdict_.reasons.insert(verdict_.reasons.begin() + causes_, reason);
    else
      verdict_.reasons.push_back(reason);
    verdict_.level = std::max(verdict_.level, level);
  }

  /// Takes a reason of which others are consequences: it stays before them.
  void name_cause(const std::string& reason) {
    verdict_.reasons.insert(verdict_.reasons.begin() + causes_++, reason);
    verdict_.level = std::max(verdict_.level, Level::kDoubtful);
  }

  /// Is the surface cut off by the box's sides, and does it not only touch them?
  bool cut_by_box() const { return s_.at_box > kAtBox.doubtful && s_.hull_beyond > kGoesOn; }

  /// What the box cuts off leaves silhouettes empty and makes them contradict each other.
  void box() {
    if (cut_share() > kCutOff.doubtful) name_cause(cut_off());
    const bool cut = cut_by_box();
    if (!s_.masks || s_.beyond_box <= (cut ? kBeyondCut : kBeyondBox)) return;
    const std::string beyond =
        concat(percent(s_.beyond_box), " of what the masks show lies beyond the box");
    if (cut || s_.missed > kMissed.doubtful || s_.contradiction > kContradiction.doubtful)
      name_cause(concat(beyond,
                        ": the box cuts the object off; make it larger (--box-scale) or let it "
                        "be found (--box auto)"));
    else
      verdict_.notes.push_back(beyond + " (--box-scale makes it larger)");
  }

  /// Of what the photographs show in the box and just outside it: what is outside.
  double cut_share() const {
    const Explained& e = s_.explained;
    return double(e.count(Place::kCut)) / std::max(1, e.count(Place::kCut) + e.told());
  }

  std::string cut_off() const {
    return concat(percent(cut_share()),
                  " of what the photographs show there stands just outside the box: make the box "
                  "larger (--box-scale) if it belongs to the object");
  }

  /// Stems that masks lack have the width that photographs suggest; those that voxels are too large
  /// for have the voxels'.
  void stems() {
    if (s_.stems > kManyStems && s_.stems_restored > kRestored)
      name_cause(concat(percent(std::min(1.0, s_.stems_restored)),
                        " of the thin parts were put back from the photographs, for the masks lack "
                        "them: their width is a guess; make masks that show them, or photograph "
                        "from nearer"));
    if (s_.stems > kManyStems && s_.voxel_size > kCoarseVoxels * s_.far)
      name_cause(concat(percent(s_.stems),
                        " of the surface are stems, and voxels are wider than one percent of its "
                        "diagonal: use --resolution ",
                        std::lround(s_.resolution * s_.voxel_size / s_.far)));
  }

  /// Parts that silhouettes show and voxels are too large for.
  void thin_parts() {
    stems();
    const double width = s_.missed_width * s_.pixel_size;
    if (!s_.masks || !(s_.missed > kMissed.doubtful) || !(width > 0) ||
        width > kThinVoxels * s_.voxel_size)
      return;
    const double voxel = std::max(width / kThinVoxels, kFinestPixels * s_.pixel_size);
    if (voxel >= s_.voxel_size) return;
    name_cause(concat("parts that the masks show about ", pixels(s_.missed_width),
                      " wide are missing, for they are thinner than ", kThinVoxels,
                      " voxels: use --resolution ",
                      std::lround(s_.resolution * s_.voxel_size / voxel)));
  }

  void cameras() {
    int matches = 0;  // each is of two views
    for (const ViewResidual& v : s_.match.views) matches += v.matches;
    const std::vector<std::size_t> outlying = outlying_views(s_);
    if (!outlying.empty()) {
      double worst = 0;
      std::string list;
      for (const std::size_t i : outlying) {
        worst = std::max(worst, s_.match.views[i].pixels);
        list += (list.empty() ? "" : ", ") + n_[i];
      }
      weigh(worst * s_.pixel_size / s_.far, {kResidual.doubtful, INFINITY},
            concat("the views ", list, " disagree with the rest by up to ", pixels(worst),
                   ": calibrate them again, leave them out (--views), or try --refine-cameras "
                   "auto"));
    }
    if (matches >= 2 * kFewestOfAll)
      weigh(s_.match.residual * s_.pixel_size / s_.far, kResidual,
            concat("the cameras disagree by ", pixels(s_.match.residual),
                   " (median): calibrate again, or try --refine-cameras auto"));
    // Errors of single views are nearly gone from the mean of all, which is where the world lies.
    const double place = std::max(s_.cameras_moved_alike,
                                  s_.cameras_moved / std::sqrt(double(std::max(1, s_.views))));
    const bool alike = s_.cameras_moved_alike > kAlike * s_.cameras_moved;
    const double off = place * s_.pixel_size / s_.far;
    const std::string moved =
        concat("the cameras had to be moved by ", pixels(s_.cameras_moved),
               " to agree: shape is right, but place and size may be off by ", pixels(place),
               alike ? "; all were off alike, so that focal length, principal point or pixel "
                       "centre may be wrong (photohull info --cameras, --refine-cameras "
                       "poses+intrinsics)"
                     : "");
    if (off > kMoved.failed) causes_ = 0;  // before all others, whatever these are
    weigh(off, kMoved, moved);
  }

  void surface() {
    if (s_.match.textured < kLeastTexture) {
      // Silhouettes alone may still show all there is. They do not when the few matches there are
      // pull the surface about, or many views do not see parts of it. Of stems, which are thinner
      // than any patch, they tell all.
      const double confidence = s_.mean_confidence / std::max(1e-9, 1 - s_.unseen);
      if (confidence < kPlainConfidence || !s_.masks)
        weigh(1 - s_.match.textured - s_.stems, {1 - kLeastTexture, INFINITY},
              concat("too little texture on ", percent(1 - s_.match.textured - s_.stems),
                     " of the surface: the hull stands there; paint or project a pattern, or add "
                     "light"));
      return;
    }
    const double unmatched = s_.match.textured * (1 - s_.match.matched);
    weigh(unmatched, kUnmatched,
          concat("on ", percent(unmatched),
                 " of the surface there is texture that no second view shows: cameras, focus, "
                 "gloss or moving parts may be the cause"));
    // Where nearly all is found again, confidence is low because colours differ.
    const double doubted =
        s_.match.matched < kEnoughMatched ? std::max(0.0, s_.unsure - s_.unseen) : 0;
    if (unmatched <= kUnmatched.doubtful && (doubted == 0 || s_.unsure <= kUnsure.doubtful))
      weigh(unmatched + kUnsureWeight * doubted, kUnconfirmed,
            concat("on ", percent(unmatched + doubted),
                   " of the surface the photographs do not confirm it, for no second view shows "
                   "its texture or confidence is below one half: folds and hollows that few views "
                   "look into do this, noise and blur too; add views that look in, or sharper "
                   "ones"));
    weigh(s_.match.beyond_far, kFarOff,
          concat("two views put ", percent(s_.match.beyond_far),
                 " of what they both show more than 0.5 % of the diagonal off the surface: look at "
                 "the confidence in mesh.ply"));
  }

  /// Silhouettes bound a surface from outside; where photographs put it elsewhere, it lies within.
  void hull() {
    if (!s_.masks) {
      weigh(1, {0, 0},
            "no view has a mask: the hull is the box clipped by what the views see; give masks, or "
            "use --method refine");
      return;
    }
    std::string note =
        "a visual hull is an outer bound: concavities that no silhouette shows are filled";
    const MatchEvidence& m = s_.match;
    if (m.textured < kLeastTexture) {
      note += m.seen < kLeastTexture ? "; no two views are near enough to each other to tell where"
                                     : "; there is too little texture to tell where";
    } else {
      const double confirmed = m.matched * (1 - m.beyond_far);
      note += concat("; the photographs confirm it on ", percent(confirmed), " of its texture");
      weigh(std::max(m.beyond_far / kHullOff, (1 - confirmed) / kHullUnconfirmed), {1, INFINITY},
            concat("on ", percent(1 - confirmed),
                   " of its texture the photographs do not confirm the hull: the object is concave "
                   "there, or too few views show its outline; add views, or use --method refine"));
    }
    verdict_.notes.push_back(note);
  }

  void silhouettes() {
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

  void coverage() {
    verdict_.coverage = concat(percent(1 - s_.unseen), " of the surface is seen, ",
                               percent(1 - s_.few_views), " by three views or more");
    if (s_.unseen > kGuessed)
      verdict_.coverage +=
          "; the rest is a guess: add views there, or leave it out with --unseen open";
    weigh(s_.unseen, kUnseen,
          concat("no view sees ", percent(s_.unseen),
                 " of the surface: add views there, or use --unseen open"));
    weigh(
        s_.few_views, kFewViews,
        concat("fewer than three views see ", percent(s_.few_views), " of the surface: add views"));
    if (s_.match.matched < kEnoughMatched)  // else colours differ, and the surface is right
      weigh(s_.unsure, kUnsure,
            concat("confidence is below one half on ", percent(s_.unsure), " of the surface"));
    weigh(cut_by_box() ? s_.at_box : 0, kAtBox,
          concat(percent(s_.at_box),
                 " of the surface lies on the box's sides: the box cuts the object off (make --box "
                 "larger), or nothing tells where it ends"));
  }

  /// The worst by explained share, of those that are clearly worse than all together.
  std::string least_explained() const {
    std::vector<std::pair<double, std::size_t>> worst;
    for (std::size_t i = 0; i < s_.explained.views.size(); ++i) {
      const ExplainedView& view = s_.explained.views[i];
      const double share = view.explained();
      if (view.told() >= kFewestPlaces && share < s_.explained.explained() - kWorse)
        worst.emplace_back(share, i);
    }
    std::sort(worst.begin(), worst.end());
    if (worst.size() > kMostNamed) worst.resize(kMostNamed);
    std::string list;
    for (const auto& [share, i] : worst)
      list += concat(list.empty() ? "" : ", ", n_[i], " (", percent(share), ")");
    return list;
  }

  /// Photographs that show something else than their cameras see.
  std::string misfits() const {
    std::string list;
    std::size_t count = 0, judged = 0;
    for (std::size_t i = 0; i < s_.explained.views.size(); ++i) {
      const ExplainedView& view = s_.explained.views[i];
      if (view.told() < kFewestPlaces) continue;
      ++judged;
      if (view.count(Place::kDisagreeing) < kMisfit * view.told()) continue;
      if (++count <= kMostNamed) list += concat(list.empty() ? "" : ", ", n_[i]);
    }
    if (3 * count > judged) return "";  // so many are no single photographs' fault
    if (count > kMostNamed) list += concat(" and ", count - kMostNamed, " more");
    return list;
  }

  /// What most of the unexplained is, and what helps.
  std::string why_unexplained() const {
    const Explained& e = s_.explained;
    const int missed = e.count(Place::kMissed), differs = e.count(Place::kDisagreeing),
              alone = e.count(Place::kAlone);
    if (missed >= std::max(differs, alone))
      return concat("on ", percent(e.share_told(Place::kMissed)),
                    " there is surface that the model lacks: raise --resolution, add views between "
                    "the present ones, or give masks");
    if (differs >= alone)
      return concat("on ", percent(e.share_told(Place::kDisagreeing)),
                    " other views show something else at the surface: check the cameras (photohull "
                    "info --cameras, --refine-cameras auto); gloss and what moved do the same");
    return concat("on ", percent(e.share_told(Place::kAlone)),
                  " no second view sees the same: add views beside these");
  }

  /// Without silhouettes: what of the photographs the model explains.
  void photographs() {
    const Explained& e = s_.explained;
    if (e.looked_at() == 0) return;
    const double plain = double(e.count(Place::kPlain)) / e.looked_at();
    const double bare = e.share_textured(Place::kBare);
    if (e.told() < kFewestPlaces && plain > 1 - kLeastTexture) {
      weigh(1, {0, INFINITY},
            concat(percent(plain),
                   " of the photographs' area in the box is plain, which tells nothing without "
                   "masks: paint or project a pattern, add light, or give masks"));
      return;
    }
    if (const std::string list = misfits(); !list.empty())
      weigh(1, {0, INFINITY},
            concat(list,
                   ": other views show something else at most of what is seen there; is the "
                   "photograph another view's, upside down or mirrored? Look at it, and at "
                   "photohull info --cameras; --hold-out leaves views out"));
    const std::string worst = least_explained();
    const std::string where = worst.empty() ? "" : concat("; least in ", worst);
    const double unexplained = e.told() < kFewestPlaces ? 1 : 1 - e.explained();
    // What one view alone sees is in doubt, and not wrong.
    const double wrong = unexplained - (e.told() < kFewestPlaces ? 0 : e.share_told(Place::kAlone));
    weigh(
        unexplained, {kUnexplained.doubtful, wrong > kUnexplained.failed ? 0 : INFINITY},
        e.told() < kFewestPlaces
            ? concat("the model is nearly empty: it explains hardly any of the texture that the "
                     "photographs show in the box; check the box (photohull info --picture) and "
                     "the cameras (photohull info --cameras)")
            : concat("the model explains ", percent(e.explained()),
                     " of the texture that the photographs show in the box, as far as they tell: ",
                     why_unexplained(), where));
    weigh(
        bare, kBare,
        concat("on ", percent(bare),
               " of the photographs' texture in the box no views agree on any depth: the box may "
               "be in the wrong place (photohull info --picture), the cameras wrong, or the views "
               "too far apart"));
    if (unexplained <= kUnexplained.doubtful)
      verdict_.notes.push_back(
          concat("the model explains ", percent(e.explained()),
                 " of the texture that the photographs show in the box, as far as they tell",
                 unexplained > kWorthNoting ? concat(": ", why_unexplained()) : "", where));
    if (plain > kWorthNoting || bare > kWorthNoting)
      verdict_.notes.push_back(
          concat("not judged: ", percent(plain),
                 " of the photographs' area in the box is plain, and on ", percent(bare),
                 " of the rest no views agree on any depth: background that few views share, or "
                 "surface too glossy or too far from the views"));
    if (cut_share() > kWorthNoting && cut_share() <= kCutOff.doubtful)
      verdict_.notes.push_back(cut_off());
  }

  const Signals& s_;
  const std::vector<std::string>& n_;
  Verdict verdict_;
  std::ptrdiff_t causes_ = 0;  ///< reasons in front that others follow from
};

}  // namespace

const char* to_string(Level level) {
  constexpr std::array kNames = {"good", "doubtful", "failed"};
  return kNames[std::size_t(level)];
}

Verdict judge(const Signals& signals, const std::vector<std::string>& names) {
  return Judge(signals, names).run();
}

}  // namespace photohull::assess
