// The statistics by which a voxel counts as photo-consistent.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace photohull::carving {

enum class Statistic {
  kZncc,              ///< zero-mean normalised cross-correlation of patches [Hernandez04]
  kGainVariance,      ///< what is left of patches that differ by a gain
  kAdaptiveVariance,  ///< variance of the voxel's colour; threshold from noise and texture
  kRobustVariance,    ///< variance of the patches of the two thirds of the views that agree best
  kHistogram,         ///< histograms of the patches intersect [Stevens02]
  kCensus             ///< taps brighter or darker than the patch's middle [ZabihWoodfill94]
};

namespace reference {
struct CommonPatches;
struct ImageNoise;
struct Evidence;
}  // namespace reference

struct StatisticEntry {
  Statistic statistic;
  const char* name;  ///< on the command line, and of shaders/include/consistency_NAME.glsl
  /// What the shader is compared with (statistic_reference.h). Null: photo_reference.h has it.
  reference::Evidence (*reference)(const reference::CommonPatches& patches,
                                   const reference::ImageNoise& noise);
};

/// In the order in which they are named.
std::span<const StatisticEntry> statistic_entries();
std::vector<Statistic> all_statistics();
const StatisticEntry& entry_of(Statistic statistic);
const char* to_string(Statistic statistic);

/// Lines of "#define" for carving_score_columns. `coverage`: samples tell coverage by their alpha
/// (SampleImages), and taps without any do not count.
std::string statistic_defines(Statistic statistic, bool coverage);

}  // namespace photohull::carving
