// The statistics by which a voxel counts as photo-consistent.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace photohull::carving {

enum class Statistic {
#define PHOTOHULL_STATISTIC(value, name, reference) value,
#include "carving/statistics.def"
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

/// Lines for carving_score_columns that choose the statistic. `coverage`: samples tell coverage by
/// their alpha (SampleImages), and taps without any do not count.
std::string statistic_defines(Statistic statistic, bool coverage);

}  // namespace photohull::carving
