// How good a reconstruction is. Definitions in docs/guide/evaluate.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/describe.h"
#include "core/mesh.h"
#include "core/progress.h"
#include "eval/align.h"
#include "eval/distance_stats.h"
#include "eval/overlap.h"
#include "eval/reliability.h"
#include "eval/truth.h"

namespace photohull::eval {

/// Share of the result that accuracy looks at, as [Seitz06] has it.
inline constexpr double kAccuracyShare = 0.9;
/// Distance within which a part of the truth counts as there, of the truth's diagonal.
inline constexpr double kCompletenessThreshold = 0.005;

struct EvaluateOptions {
  std::vector<double> thresholds = {0.001, 0.0025, 0.005, 0.01};  ///< of the truth's diagonal
  std::vector<double> absolute;                                   ///< further ones, world units
  int samples = 200000;                                           ///< on the result
  std::uint64_t seed = 1;                                         ///< of the samples
  int min_views = 1;  ///< cameras that must see a sample of the truth
  int columns = 256;  ///< of measure_overlap

  /// Throws UsageError naming the option.
  void validate() const;
};

void describe(Described& to, EvaluateOptions& options);

/// Shares within one threshold, in [0, 1].
struct Score {
  double threshold = 0;  ///< of the truth's diagonal
  double distance = 0;   ///< the same in world units
  double precision = 0, recall = 0, f = 0;
};

/// Between the result's face normals and the truth's at the nearest points, degrees.
struct NormalError {
  double mean = 0, median = 0;
  double within_10 = 0;  ///< share that is at most 10 degrees off
};

/// One way of counting the result's samples; distances in world units.
struct Part {
  double share = 1;  ///< of the result's samples that count
  double accuracy = 0;
  DistanceStats to_truth;
  std::optional<double> mean_signed;   ///< positive outside the truth, which must have faces
  std::vector<Score> scores;           ///< at EvaluateOptions::thresholds
  std::vector<Score> absolute;         ///< at EvaluateOptions::absolute
  std::optional<NormalError> normals;  ///< not where either is points
};

struct Evaluation {
  EvaluateOptions options;
  std::string result_name, truth_name, truth_note;
  bool points = false;  ///< the result has no faces and was judged as points
  std::size_t vertices = 0, faces = 0, result_samples = 0;
  double result_area = 0;
  std::size_t truth_faces = 0, truth_samples = 0, truth_samples_seen = 0;
  double truth_diagonal = 0;
  bool truth_has_views = false, truth_is_points = false;

  Part all;                 ///< the whole result
  Part seen;                ///< without what lies over surface that no camera sees
  DistanceStats to_result;  ///< from the seen samples of the truth
  double completeness = 0;  ///< share of them within the completeness threshold
  double hausdorff95 = 0;   ///< greater of the two 95 % quantiles
  double chamfer = 0;       ///< mean of the two mean distances
  Overlap volume;
  std::optional<Alignment> alignment;      ///< of callers who aligned the result first
  std::optional<Reliability> reliability;  ///< for callers who measure it
  std::vector<std::string> warnings;
};

/// Judges `result`, a mesh or a point cloud. Warns where its frame is plainly another than the
/// truth's: boxes that hardly meet, or sizes that no part of the truth has. Equal input gives equal
/// output, whatever the number of threads. Throws Error when the result has no vertices or a
/// coordinate that is not finite, or when no camera sees any sample of the truth; UsageError for
/// options out of range; Cancelled.
Evaluation evaluate(const TriMesh& result, const Truth& truth, const EvaluateOptions& options = {},
                    Progress* progress = nullptr);

}  // namespace photohull::eval
