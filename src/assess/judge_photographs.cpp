// Verdict: what the model explains of the photographs.
#include <algorithm>
#include <cmath>
#include <utility>

#include "assess/judge.h"
#include "core/median.h"
#include "core/option_word.h"

namespace photohull::assess {
namespace {

// Of what the photographs show without silhouettes, from runs with --masks none: scenes as they
// are, and at 128 voxels with cameras turned by 1 to 20 pixels and with wrong boxes (the table in
// docs/measurements/verdict.md). Unexplained: at most 0.18 where F at 0.5 % is above 90, 0.27 to
// 0.34 at 54 to 72, 0.39 to 0.55 at 42 to 49, 0.76 and more below 13. Cut: at most 0.04 in right
// boxes, 0.04 to 0.10 in those of 0.7 of the size, 0.13 to 0.31 in those of half of it. Bare: at
// most 0.44 in right boxes with right cameras, 0.84 and more where F is below 6. From behind, on
// `python3 -m bench verdict_scenes`, seed 1, and rendered scenes: at most 0.024 where F is above
// 91, 0.087 to 0.119 at 68 to 78. Bare from within a room that lacks walls (72): 0.11.
constexpr Limits kUnexplained{0.25, 0.7};  // of the places of which something is known
constexpr Limits kBare{0.8, INFINITY};     // of all texture
constexpr double kBehind = 0.08;           // of the surface in the photographs, from behind
constexpr double kBareWithin = 0.05;       // of the texture, from within a box
constexpr double kMostWithin = 0.5;        // of the cameras
constexpr double kWorthNoting = 0.05;      // of any of them
constexpr double kMisfit = 0.5;            // of what is told of a view: its photograph is another's
constexpr double kUsualMisfit = 0.25;      // of the same, in the median view, at most
constexpr int kFewestPlaces = 30;          // told, for a share of them to mean anything
constexpr double kWorse = 0.1;             // than the mean: views that are named
constexpr std::size_t kMostNamed = 3;

}  // namespace

std::string Judge::least_explained() const {
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

std::string Judge::misfits(const Explained& e) const {
  std::string list;
  std::size_t count = 0;
  std::vector<double> shares;
  for (std::size_t i = 0; i < e.views.size(); ++i) {
    const ExplainedView& view = e.views[i];
    if (view.told() < kFewestPlaces) continue;
    shares.push_back(double(view.count(Place::kDisagreeing)) / view.told());
    if (shares.back() < kMisfit) continue;
    if (++count <= kMostNamed) list += concat(list.empty() ? "" : ", ", n_[i]);
  }
  // So many, or where so much disagrees anyway, are no single photographs' fault.
  if (3 * count > shares.size() || median(shares) > kUsualMisfit) return "";
  if (count > kMostNamed) list += concat(" and ", count - kMostNamed, " more");
  return list;
}

std::string Judge::other_photograph(const std::string& list) {
  return concat(list,
                ": other views show something else at most of what is seen there; is the "
                "photograph another view's, upside down or mirrored? Look at it, and at ",
                command_word("info", "cameras"), "; ", option_word("hold_out"),
                " leaves views out");
}

std::string Judge::why_unexplained() const {
  const Explained& e = s_.explained;
  const int missed = e.count(Place::kMissed), differs = e.count(Place::kDisagreeing),
            alone = e.count(Place::kAlone);
  if (missed >= std::max(differs, alone))
    return concat("on ", percent(e.share_told(Place::kMissed)),
                  " there is surface that the model lacks: raise ", option_word("resolution"),
                  ", add views between the present ones, or give masks");
  if (differs >= alone)
    return concat("on ", percent(e.share_told(Place::kDisagreeing)),
                  " other views show something else at the surface: check the cameras (",
                  command_word("info", "cameras"), ", ", option_word("refine_cameras", "auto"),
                  "); gloss and what moved do the same");
  return concat("on ", percent(e.share_told(Place::kAlone)),
                " no second view sees the same: add views beside these");
}

void Judge::lacking() {
  const Explained& e = s_.explained;
  const double bare = e.share_textured(Place::kBare);
  // A camera within the box sees nothing but what is to be reconstructed.
  if (s_.cameras_within > kMostWithin && bare > kBareWithin)
    name_cause(concat("on ", percent(bare),
                      " of what cameras inside the box see there is no surface: no two views agree "
                      "there; add views that look at it from nearer or more squarely"));
  if (e.share_behind() > kBehind)
    name_cause(
        concat("on ", percent(e.share_behind()),
               " of the model the photographs look at its inside, for the surface before it is "
               "missing: few views see into folds and hollows; add views that look in, or give "
               "masks"));
}

void Judge::photographs() {
  const Explained& e = s_.explained;
  if (e.looked_at() == 0) return;
  const double plain = double(e.count(Place::kPlain)) / e.looked_at();
  const double bare = e.share_textured(Place::kBare);
  if (e.told() < kFewestPlaces && plain > 1 - kLeastTexture) {
    name_cause(concat(percent(plain),
                      " of the photographs' area in the box is plain, which tells nothing without "
                      "masks: paint or project a pattern, add light, or give masks"));
    return;
  }
  if (const std::string list = misfits(e); !list.empty())
    weigh(1, {0, INFINITY}, other_photograph(list));
  const std::string worst = least_explained();
  const std::string where = worst.empty() ? "" : concat("; least in ", worst);
  const double unexplained = e.told() < kFewestPlaces ? 1 : 1 - e.explained();
  // What one view alone sees is in doubt, and not wrong.
  const double wrong = unexplained - (e.told() < kFewestPlaces ? 0 : e.share_told(Place::kAlone));
  const std::string reason =
      e.told() < kFewestPlaces
          ? concat(
                "the model is nearly empty: it explains hardly any of the texture that the "
                "photographs show in the box; check the box (",
                command_word("info", "picture"), ") and the cameras (",
                command_word("info", "cameras"), ")")
          : concat("the model explains ", percent(e.explained()),
                   " of the texture that the photographs show in the box, as far as they tell: ",
                   why_unexplained(), where);
  if (unexplained > kUnexplained.doubtful && wrong > kUnexplained.failed)
    weigh(1, {0, 0}, reason);
  else if (unexplained > kUnexplained.doubtful)
    name_cause(reason);
  lacking();
  weigh(
      bare, kBare,
      concat("on ", percent(bare),
             " of the photographs' texture in the box no views agree on any depth: the box may be "
             "in the wrong place (",
             command_word("info", "picture"), "), the cameras wrong, or the views too far apart"));
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

}  // namespace photohull::assess
