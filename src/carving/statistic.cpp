#include "carving/statistic.h"

#include <algorithm>

#include "carving/statistic_reference.h"
#include "core/error.h"
#include "gpu/shader_source.h"

namespace photohull::carving {

std::span<const StatisticEntry> statistic_entries() {
  using namespace reference;
  static constexpr StatisticEntry kEntries[] = {
#define PHOTOHULL_STATISTIC(value, name, of_patches) {Statistic::value, name, of_patches},
#include "carving/statistics.def"
  };
  return kEntries;
}

std::vector<Statistic> all_statistics() {
  std::vector<Statistic> all;
  for (const StatisticEntry& entry : statistic_entries()) all.push_back(entry.statistic);
  return all;
}

const StatisticEntry& entry_of(Statistic statistic) {
  const auto entry = std::ranges::find(statistic_entries(), statistic, &StatisticEntry::statistic);
  PHOTOHULL_CHECK(entry != statistic_entries().end());
  return *entry;
}

const char* to_string(Statistic statistic) { return entry_of(statistic).name; }

std::string statistic_defines(Statistic statistic, bool coverage) {
  std::string file = concat("include/consistency_", to_string(statistic), ".glsl");
  std::ranges::replace(file, '-', '_');
  return gpu::include_instead("include/consistency_zncc.glsl", file) +
         (coverage ? gpu::define("SAMPLE_", "coverage") : "");
}

}  // namespace photohull::carving
