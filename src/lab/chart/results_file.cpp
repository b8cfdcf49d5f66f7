#include "lab/chart/results_file.h"

#include <algorithm>

#include "core/atomic_file.h"
#include "core/error.h"
#include "lab/chart/statistics.h"

namespace photohull::chart {
namespace {

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json outcome_json(const Outcome& o) {
  Json j = {{"scene", o.scene},
            {"tool", o.variant},
            {"resolution", o.resolution ? Json(*o.resolution) : Json()},
            {"failed", o.failed},
            {"cpu_seconds", or_null(o.cpu_seconds)},
            {"wall_seconds", or_null(o.wall_seconds)},
            {"peak_mb", or_null(o.peak_mb)},
            {"accuracy_percent", or_null(o.figures.accuracy_percent)},
            {"completeness_percent", or_null(o.figures.completeness_percent)},
            {"f", Json::array()}};
  for (const auto& [threshold, f] : o.figures.f_percent)
    j["f"].push_back({{"threshold_percent", threshold}, {"f_percent", f}});
  return j;
}

/// Exponents of error, time and memory against resolution, of each variant.
Json fits_of(const std::vector<Outcome>& outcomes) {
  std::vector<std::string> variants;
  for (const Outcome& o : outcomes)
    if (!o.external && o.resolution &&
        std::find(variants.begin(), variants.end(), o.variant) == variants.end())
      variants.push_back(o.variant);
  Json fits = Json::array();
  for (const std::string& variant : variants) {
    std::vector<Sample> error, time, memory;
    for (const Outcome& o : outcomes) {
      if (o.external || o.variant != variant || !o.resolution || !o.complete()) continue;
      const double n = *o.resolution;
      if (o.figures.accuracy_percent) error.push_back({n, *o.figures.accuracy_percent});
      if (o.cpu_seconds) time.push_back({n, *o.cpu_seconds});
      if (o.peak_mb) memory.push_back({n, *o.peak_mb});
    }
    const auto exponent = [](const std::vector<Sample>& samples) {
      const auto law = fit_power_law(samples);
      return law ? Json(law->exponent) : Json();
    };
    fits.push_back({{"variant", variant},
                    {"error_exponent", exponent(error)},
                    {"time_exponent", exponent(time)},
                    {"memory_exponent", exponent(memory)}});
  }
  return fits;
}

Json group_json(const std::string& name, const std::vector<Outcome>& outcomes,
                double threshold_percent) {
  Json front = Json::array();
  for (const std::size_t i : front_of(outcomes, threshold_percent))
    front.push_back(outcomes[i].label());
  return {{"scene", name}, {"pareto_front", front}, {"fits", fits_of(outcomes)}};
}

}  // namespace

void write_results(const std::filesystem::path& file, const Plan& plan,
                   const std::vector<RunRecord>& records, const std::vector<Outcome>& external) {
  Json j = {{"layout", RunRecord::kLayout}, {"photohull", PHOTOHULL_VERSION},
            {"title", plan.title},          {"threshold_percent", plan.threshold_percent},
            {"groups", Json::array()},      {"runs", Json::array()},
            {"external", Json::array()}};
  std::vector<Outcome> outcomes;
  for (const RunRecord& record : records) {
    j["runs"].push_back(record.to_json());
    outcomes.push_back(outcome_of(record));
  }
  for (const Outcome& o : external) {
    j["external"].push_back(outcome_json(o));
    outcomes.push_back(o);
  }
  std::vector<std::string> scenes;
  for (const PlanScene& s : plan.scenes) scenes.push_back(s.name);
  const auto& averaged = plan.mean_over.empty() ? scenes : plan.mean_over;
  if (averaged.size() > 1)
    j["groups"].push_back(
        group_json("mean", means_over(outcomes, averaged), plan.threshold_percent));
  for (const std::string& scene : scenes) {
    std::vector<Outcome> of_scene;
    std::copy_if(outcomes.begin(), outcomes.end(), std::back_inserter(of_scene),
                 [&](const Outcome& o) { return o.scene == scene; });
    j["groups"].push_back(group_json(scene, of_scene, plan.threshold_percent));
  }
  write_atomically(file, j.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::vector<RunRecord> read_results(const std::filesystem::path& file) {
  std::error_code status;
  if (!std::filesystem::is_regular_file(file, status))
    throw Error(concat(file.string(), ": there are no results to draw; run without --draw-only"));
  const Json json = read_json(file);
  const Fields fields(file, "", json);
  if (fields.at("layout") != RunRecord::kLayout)
    fields.fail("layout", "written by another version of photohull; run without --draw-only");
  std::vector<RunRecord> records;
  for (const auto& [where, value] : fields.elements("runs"))
    records.push_back(RunRecord::from_json(file, where, *value));
  return records;
}

}  // namespace photohull::chart
