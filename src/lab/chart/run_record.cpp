#include "lab/chart/run_record.h"

#include <sstream>

#include "core/error.h"
#include "lab/chart/figures.h"

namespace photohull::chart {
namespace {

Json to_json(const Timing& t) {
  return {{"wall_seconds", t.wall_seconds},
          {"cpu_seconds", t.cpu_seconds},
          {"peak_memory_bytes", t.peak_memory_bytes}};
}

Json to_json(const Failure& f) {
  return {{"step", f.step},         {"exit_code", f.exit_code},
          {"signal", f.signal},     {"timed_out", f.timed_out},
          {"message", f.message()}, {"standard_error", f.standard_error}};
}

Failure failure_from(const std::filesystem::path& file, const std::string& where,
                     const Json& json) {
  const Fields fields(file, where, json);
  Failure f;
  f.step = fields.text("step");
  f.exit_code = fields.integer("exit_code", -1, 255);
  f.signal = fields.integer("signal", 0, 255);
  f.timed_out = fields.flag("timed_out", false);
  if (const Json& text = fields.at("standard_error"); text.is_string())
    f.standard_error = text.get<std::string>();
  return f;
}

}  // namespace

std::string Failure::message() const {
  std::string reason, line;
  std::istringstream lines(standard_error);
  while (std::getline(lines, line))
    if (line.find_first_not_of(" \t\r") != std::string::npos) reason = line;
  // A bar redraws its line.
  if (const std::size_t at = reason.find_last_of('\r'); at != std::string::npos)
    reason.erase(0, at + 1);
  if (reason.size() > 300) reason = reason.substr(0, 297) + "...";
  if (timed_out) return step + ": killed at the time limit";
  std::string how = signal ? concat("ended by signal ", signal) : concat("exit code ", exit_code);
  return step + ": " + how + (reason.empty() ? "" : ": " + reason);
}

Json RunRecord::to_json() const {
  Json j;
  j["layout"] = kLayout;
  j["id"] = id;
  j["scene"] = scene;
  j["variant"] = variant;
  j["resolution"] = resolution ? Json(*resolution) : Json();
  j["arguments"] = arguments;
  j["status"] = failure ? "failed" : "ok";
  j["time_limit_seconds"] = time_limit_seconds;
  j["median_repeat"] = median;
  j["repeats"] = Json::array();
  for (const Timing& t : repeats) j["repeats"].push_back(chart::to_json(t));
  if (failure) j["failure"] = chart::to_json(*failure);
  if (!mesh.empty()) j["mesh"] = mesh;
  j["report"] = report;
  j["evaluation"] = evaluation;
  return j;
}

RunRecord RunRecord::from_json(const std::filesystem::path& file, const std::string& where,
                               const Json& json) {
  const Fields fields(file, where, json);
  fields.require_layout(kLayout);
  RunRecord r;
  r.id = fields.text("id");
  r.scene = fields.text("scene");
  r.variant = fields.text("variant");
  if (!fields.at("resolution").is_null()) r.resolution = fields.integer("resolution", 1, 1 << 20);
  r.arguments = fields.texts("arguments");
  r.time_limit_seconds = fields.number("time_limit_seconds", 0, 1e9);
  for (const auto& [element, value] : fields.elements("repeats")) {
    const Fields t(file, fields.path(element), *value);
    r.repeats.push_back({t.number("wall_seconds", 0, 1e12), t.number("cpu_seconds", 0, 1e12),
                         std::int64_t(t.number("peak_memory_bytes", 0, 1e18))});
  }
  if (r.repeats.empty()) fields.fail("repeats", "is empty");
  r.median = std::size_t(fields.integer("median_repeat", 0, int(r.repeats.size()) - 1));
  if (fields.has("failure"))
    r.failure = failure_from(file, fields.path("failure"), fields.at("failure"));
  if (fields.has("mesh")) r.mesh = fields.text("mesh");
  r.report = fields.at("report");
  r.evaluation = fields.at("evaluation");
  const std::string status = fields.text("status");
  if (status != (r.failure ? "failed" : "ok")) fields.fail("status", "contradicts the record");
  if (!r.failure) figures_of_evaluation(r.evaluation);
  return r;
}

}  // namespace photohull::chart
