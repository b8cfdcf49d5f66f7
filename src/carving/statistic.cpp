#include "carving/statistic.h"

#include "core/error.h"

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

Statistic parse_statistic(const std::string& option, const std::string& text) {
  std::string legal;
  for (const Statistic statistic : kStatistics) {
    if (text == to_string(statistic)) return statistic;
    legal += (legal.empty() ? "" : ", ") + std::string(to_string(statistic));
  }
  throw UsageError(concat(option, " ", text, ": expected one of ", legal));
}

std::string statistic_defines(Statistic statistic, bool coverage) {
  std::string name = to_string(statistic);
  for (char& c : name) c = c == '-' ? '_' : char(c - 'a' + 'A');
  return concat("#define CONSISTENCY_", name, "\n", coverage ? "#define SAMPLE_COVERAGE\n" : "");
}

}  // namespace photohull::carving
