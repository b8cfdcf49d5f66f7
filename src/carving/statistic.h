// The statistics by which a voxel counts as photo-consistent.
#pragma once

#include <string>

namespace photohull::carving {

enum class Statistic {
  kZncc,              ///< zero-mean normalised cross-correlation of patches [Hernandez04]
  kGainVariance,      ///< what is left of patches that differ by a gain
  kAdaptiveVariance,  ///< variance of the voxel's colour; threshold from noise and texture
  kRobustVariance,    ///< variance of the patches of the two thirds of the views that agree best
  kHistogram,         ///< histograms of the patches intersect [Stevens02]
  kCensus             ///< taps brighter or darker than the patch's middle [ZabihWoodfill94]
};

inline constexpr Statistic kStatistics[] = {
    Statistic::kZncc,           Statistic::kGainVariance, Statistic::kAdaptiveVariance,
    Statistic::kRobustVariance, Statistic::kHistogram,    Statistic::kCensus};

/// Name on the command line: "zncc", "gain-variance", ...
const char* to_string(Statistic statistic);

/// Lines of "#define" for carving_score_columns. `coverage`: samples tell coverage by their alpha
/// (SampleImages), and taps without any do not count.
std::string statistic_defines(Statistic statistic, bool coverage);

}  // namespace photohull::carving
