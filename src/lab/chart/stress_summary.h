// Breakdown curves, kept promises, and how well the program judges itself.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "lab/chart/stress_plan.h"
#include "lab/chart/stress_record.h"

namespace photohull::chart {

/// A run at its place in the plan.
struct StressSample {
  std::string axis, label;  ///< the label of a clean point is "clean"
  bool clean = false;
  double strength = 0;
  std::string scene, variant, run;  ///< `run`: its id
  std::uint64_t seed = 1;
  int exit_code = -1;
  std::string message, mesh_hash;
  double cpu_seconds = 0;
  StressFigures figures;
  Json report;  ///< report.json; null where there is none

  Json to_json() const;
  static StressSample from_json(const std::filesystem::path& file, const std::string& where,
                                const Json& json);
};

/// Means over scenes and seeds at one point of a curve; shares from 0 to 1.
struct CurvePoint {
  double strength = 0;
  std::string label;
  std::optional<double> f025, f05, confidence, within;
  std::optional<double> kept025, kept05;  ///< mean of F over the same scene's clean F
  std::optional<double> worst025;         ///< the least of these over scenes and seeds
  std::string worst_scene;
  int samples = 0;     ///< 0: nothing was run here
  int failed = 0;      ///< ended with an error or by its own verdict
  int other_mesh = 0;  ///< meshes that are not the clean one's, byte by byte
};

/// One variant on one axis.
struct StressCurve {
  std::size_t axis = 0;  ///< in the plan
  std::string variant;
  std::vector<CurvePoint> points;  ///< the clean one first
  /// Each scene's F at 0.25 %, in the order of `points`.
  std::vector<std::pair<std::string, std::vector<std::optional<double>>>> scenes;
  /// Where the mean of the kept shares falls below the plan's; nothing when it does not, or on
  /// axes of kinds.
  std::optional<double> break025, break05;
  std::vector<std::string> broken_kinds;  ///< labels, on axes of kinds, at 0.25 %
};

struct MarkResult {
  std::string text, axis, variant, label;  ///< `label`: the point it goes to
  std::optional<double> mean, worst;       ///< least kept shares of F up to there
  std::string worst_at;                    ///< "bowl at 2"
  bool pass = false;                       ///< the worst is at least the plan's `kept`
};

/// Rows: F(0.5 %) below 0.8, from there to 0.95, above. Columns: good, doubtful, failed, none.
struct VerdictTable {
  std::array<std::array<int, 4>, 3> counts{};
  bool any = false;                   ///< some report has a verdict
  std::optional<double> bad_called;   ///< share of row 0 called doubtful or failed
  std::optional<double> good_called;  ///< share of row 2 called so
};

struct StressSummary {
  std::vector<StressSample> samples;
  std::vector<StressCurve> curves;  ///< in the order of the plan's axes, then variants
  std::vector<MarkResult> marks;
  VerdictTable verdicts;
};

/// The place where y falls below `least`, between the samples around it: linear in x, or in its
/// logarithm where both are positive and `log` is set. Nothing when it does not fall there.
struct CurveSample {
  double x = 0, y = 0;
};
std::optional<double> breakdown_point(const std::vector<CurveSample>& curve, double least,
                                      bool log);

/// Samples that the plan does not have are passed over. Curves of `earlier` ones, whose variants
/// have names of their own, come beside the others; marks and verdicts are of `samples` only.
StressSummary summarize(const StressPlan& plan, std::vector<StressSample> samples,
                        std::vector<StressSample> earlier = {});

/// Counts every run once.
VerdictTable judge_verdicts(const std::vector<StressSample>& samples);

}  // namespace photohull::chart
