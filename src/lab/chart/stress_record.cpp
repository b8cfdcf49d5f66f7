#include "lab/chart/stress_record.h"

#include <cmath>

#include "core/error.h"
#include "lab/chart/figures.h"

namespace photohull::chart {
namespace {

std::optional<double> number_at(const Json& json, const std::vector<const char*>& path) {
  const Json* at = &json;
  for (const char* name : path) {
    if (!at->is_object() || !at->contains(name)) return std::nullopt;
    at = &(*at)[name];
  }
  if (!at->is_number()) return std::nullopt;
  return at->get<double>();
}

std::string text_or_empty(const Json& json, const char* name) {
  return json.is_object() && json.contains(name) && json[name].is_string()
             ? json[name].get<std::string>()
             : std::string();
}

}  // namespace

Json StressRecord::to_json() const {
  return {{"layout", kLayout},
          {"id", id},
          {"spec", spec},
          {"arguments", arguments},
          {"time_limit_seconds", time_limit_seconds},
          {"exit_code", exit_code},
          {"signal", signal},
          {"timed_out", timed_out},
          {"message", message},
          {"cpu_seconds", cpu_seconds},
          {"wall_seconds", wall_seconds},
          {"peak_memory_bytes", peak_memory_bytes},
          {"mesh_hash", mesh_hash},
          {"report", report},
          {"evaluation", evaluation}};
}

StressRecord StressRecord::from_json(const std::filesystem::path& file, const Json& json) {
  const Fields fields(file, "", json);
  fields.require_layout(kLayout);
  StressRecord r;
  r.id = fields.text("id");
  r.spec = fields.at("spec");
  r.arguments = fields.texts("arguments");
  r.time_limit_seconds = fields.number("time_limit_seconds", 0, 1e9);
  r.exit_code = fields.integer("exit_code", -1, 255);
  r.signal = fields.integer("signal", 0, 255);
  r.timed_out = fields.flag("timed_out", false);
  r.message = text_or_empty(json, "message");
  r.cpu_seconds = fields.number("cpu_seconds", 0, 1e12);
  r.wall_seconds = fields.number("wall_seconds", 0, 1e12);
  r.peak_memory_bytes = std::int64_t(fields.number("peak_memory_bytes", 0, 1e18));
  r.mesh_hash = text_or_empty(json, "mesh_hash");
  r.report = fields.at("report");
  r.evaluation = fields.at("evaluation");
  if (!r.evaluation.is_null()) figures_of_evaluation(r.evaluation);
  return r;
}

StressFigures figures_of(const StressRecord& record) {
  StressFigures f;
  f.failed = record.exit_code != 0;
  if (record.report.is_object() && record.report.contains("verdict"))
    f.verdict = text_or_empty(record.report["verdict"], "level");
  if (record.evaluation.is_null()) {
    f.f025 = f.f05 = 0;
    return f;
  }
  const Figures judged = figures_of_evaluation(record.evaluation);
  const auto share = [&](double threshold) -> std::optional<double> {
    const auto percent = judged.f_at(threshold);
    return percent ? std::optional(*percent / 100) : std::nullopt;
  };
  f.f025 = share(0.25), f.f05 = share(0.5);
  f.confidence = number_at(record.evaluation, {"reliability", "confidence"});
  f.within = number_at(record.evaluation, {"reliability", "within"});
  return f;
}

}  // namespace photohull::chart
