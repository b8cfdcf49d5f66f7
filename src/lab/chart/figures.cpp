#include "lab/chart/figures.h"

#include <cmath>

#include "core/error.h"

namespace photohull::chart {
namespace {

std::optional<double> number(const Json& object, const char* name) {
  if (!object.is_object() || !object.contains(name) || !object[name].is_number())
    return std::nullopt;
  const double value = object[name].get<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<double> Figures::f_at(double threshold_percent) const {
  for (const auto& [threshold, f] : f_percent)
    if (std::abs(threshold - threshold_percent) < 1e-6 * threshold_percent) return f;
  return std::nullopt;
}

Figures figures_of_evaluation(const Json& evaluation) {
  if (!evaluation.is_object()) throw Error("the evaluation is not an object of JSON");
  // Surface that no camera saw says nothing of a method.
  const Json& seen = evaluation.contains("seen") ? evaluation["seen"] : evaluation;
  Figures figures;
  if (seen.is_object() && seen.contains("f") && seen["f"].is_array())
    for (const Json& at : seen["f"]) {
      const auto t = number(at, "t"), f = number(at, "f");
      if (t && f && *t > 0) figures.f_percent[100 * *t] = 100 * *f;
    }
  if (figures.f_percent.empty()) throw Error("the evaluation has no F-score");
  figures.accuracy_percent = number(seen, "accuracy_pct_diag");
  if (const auto completeness = number(evaluation, "completeness"))
    figures.completeness_percent = 100 * *completeness;
  if (const auto faces = number(evaluation, "recon_faces"))
    figures.triangles = std::int64_t(*faces);
  return figures;
}

}  // namespace photohull::chart
