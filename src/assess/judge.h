// Private to the verdict: what it says of each kind of sign, one method a kind.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "assess/verdict.h"
#include "core/error.h"

namespace photohull::assess {

/// Fitted on the runs of bench/plans/stress.json, seed 1, but where another fit is told of
/// (docs/measurements/verdict.md): beyond the first figure results are doubtful, beyond the
/// second they count as failed.
struct Limits {
  double doubtful, failed;
};
inline constexpr Limits kMissed{0.04, 0.3};         // of the silhouettes
inline constexpr Limits kContradiction{0.02, 0.5};  // of the silhouettes' rays
// Of the silhouettes, beyond the box, where they stay empty or the surface ends at the box's sides.
inline constexpr double kBeyondCut = 0.005;
inline constexpr double kCoarseVoxels = 2;  // times half a percent of the diagonal
// Of what silhouettes show in the box and just outside it.
inline constexpr Limits kCutOff{0.12, INFINITY};
inline constexpr double kLeastTexture = 0.1;  // of the surface, for shares of it to mean anything

inline std::string percent(double share) { return concat(std::lround(100 * share), " %"); }

inline std::string pixels(double value) { return concat(std::round(10 * value) / 10, " px"); }

class Judge {
 public:
  Judge(const Signals& signals, const std::vector<std::string>& names) : s_(signals), n_(names) {}

  Verdict run();

 private:
  /// Takes the reason where the value is beyond its limits.
  void weigh(double value, const Limits& limits, const std::string& reason);
  /// Takes a reason of which others follow: it stays before them.
  void name_cause(const std::string& reason);
  /// Is the surface cut off by the box's sides, and does it not only touch them?
  bool cut_by_box() const;
  /// What the box cuts off leaves silhouettes empty and makes them contradict each other.
  void box();
  /// Of what the photographs show in the box and just outside it: what is outside.
  double cut_share() const;
  std::string cut_off() const;
  /// Stems that are missing: masks lack them, or voxels are too large for them.
  void stems();
  /// Parts that silhouettes show and voxels are too large for.
  void thin_parts();
  /// What so few see is the cause of what is wrong there.
  void few_views();
  /// Words about the voxels' size.
  std::string too_coarse() const;
  /// What outlines ask for is asked of all views alike, so that none stands out.
  void common_errors();
  /// Photographs that show something else, beside right masks, pull the surface about.
  void other_photographs();
  void cameras();
  void surface();
  /// Do views often show something else than others where the surface is, whatever their colours?
  bool views_disagree() const;
  /// Nearly all texture is found again, so that confidence is low because colours differ, and the
  /// surface is right. What is found again tells nothing of lumps that show the background.
  bool only_colours_differ() const;
  /// The end of a reason: masks may be the cause, where views disagree.
  std::string lumps() const;
  /// Why photographs tell too little of the surface.
  std::string why_untold() const;
  /// Silhouettes bound a surface from outside; where photographs put it elsewhere, it lies within.
  void hull();
  void silhouettes();
  void coverage();
  /// The worst by explained share, of those that are clearly worse than all together.
  std::string least_explained() const;
  /// Photographs that show something else than their cameras see.
  std::string misfits(const Explained& e) const;
  static std::string other_photograph(const std::string& list);
  /// What most of the unexplained is, and what helps.
  std::string why_unexplained() const;
  /// Surface that photographs without silhouettes show to be missing.
  void lacking();
  /// Without silhouettes: what of the photographs the model explains.
  void photographs();

  const Signals& s_;
  const std::vector<std::string>& n_;
  Verdict verdict_;
  std::ptrdiff_t causes_ = 0;  ///< reasons in front that others follow from
};

}  // namespace photohull::assess
