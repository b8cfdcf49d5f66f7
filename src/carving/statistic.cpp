#include "carving/statistic.h"

#include "gpu/shader_source.h"

namespace photohull::carving {

const char* to_string(Statistic statistic) {
  switch (statistic) {
    case Statistic::kZncc:
      return "zncc";
    case Statistic::kGainVariance:
      return "gain-variance";
    case Statistic::kAdaptiveVariance:
      return "adaptive-variance";
    case Statistic::kRobustVariance:
      return "robust-variance";
    case Statistic::kHistogram:
      return "histogram";
    case Statistic::kCensus:
      return "census";
  }
  return "?";
}

std::string statistic_defines(Statistic statistic, bool coverage) {
  return gpu::define("CONSISTENCY_", to_string(statistic)) +
         (coverage ? gpu::define("SAMPLE_", "coverage") : "");
}

}  // namespace photohull::carving
