#include "lab/chart/outcome.h"

#include <algorithm>

#include "core/error.h"
#include "lab/chart/statistics.h"

namespace photohull::chart {
namespace {

void add_stages(std::vector<StageTime>& sum, const std::vector<StageTime>& stages) {
  for (const StageTime& s : stages) {
    const auto same =
        std::find_if(sum.begin(), sum.end(), [&](const StageTime& t) { return t.name == s.name; });
    if (same == sum.end())
      sum.push_back(s);
    else
      same->cpu_seconds += s.cpu_seconds;
  }
}

Outcome mean_of(const std::vector<const Outcome*>& rows, std::size_t scenes) {
  Outcome mean;
  mean.scene = "mean";
  mean.variant = rows[0]->variant;
  mean.resolution = rows[0]->resolution;
  mean.external = rows[0]->external;
  mean.scenes = int(scenes);
  mean.covered = int(rows.size());
  Mean cpu, wall, peak, accuracy, completeness;
  std::map<double, double> f_sum;
  for (const Outcome* row : rows) {
    cpu.add(row->cpu_seconds);
    wall.add(row->wall_seconds);
    peak.add(row->peak_mb);
    mean.failed_scenes += row->failed;
    if (row->failed) continue;
    accuracy.add(row->figures.accuracy_percent);
    completeness.add(row->figures.completeness_percent);
    for (const auto& [threshold, f] : row->figures.f_percent) f_sum[threshold] += f;
    add_stages(mean.stages, row->stages);
  }
  for (const auto& entry : f_sum) {
    const double threshold = entry.first;
    // A threshold that some finished run lacks has no mean.
    const bool everywhere = std::all_of(rows.begin(), rows.end(), [&](const Outcome* row) {
      return row->failed || row->figures.f_at(threshold);
    });
    if (everywhere) mean.figures.f_percent[threshold] = entry.second / double(rows.size());
  }
  mean.cpu_seconds = cpu.value();
  mean.wall_seconds = wall.value();
  mean.peak_mb = peak.value();
  mean.figures.accuracy_percent = accuracy.value();
  mean.figures.completeness_percent = completeness.value();
  mean.failed = mean.failed_scenes == mean.covered;
  if (mean.failed) mean.failure = "failed in every scene";
  return mean;
}

}  // namespace

std::string Outcome::label() const {
  return resolution ? concat(variant, " ", *resolution) : variant;
}

Outcome outcome_of(const RunRecord& record) {
  Outcome o;
  o.scene = record.scene;
  o.variant = record.variant;
  o.resolution = record.resolution;
  const Timing& time = record.repeats.at(record.median);
  o.cpu_seconds = time.cpu_seconds;
  o.wall_seconds = time.wall_seconds;
  o.peak_mb = double(time.peak_memory_bytes) / (1 << 20);
  o.failed = record.failure.has_value();
  if (record.failure) o.failure = record.failure->message();
  if (!o.failed) o.figures = figures_of_evaluation(record.evaluation);
  if (record.report.is_object() && record.report.contains("stages") &&
      record.report["stages"].is_array())
    for (const Json& stage : record.report["stages"])
      if (stage.is_object() && stage.contains("name") && stage["name"].is_string() &&
          stage.contains("cpu_seconds") && stage["cpu_seconds"].is_number())
        o.stages.push_back({stage["name"].get<std::string>(), stage["cpu_seconds"].get<double>()});
  return o;
}

std::vector<Outcome> means_over(const std::vector<Outcome>& outcomes,
                                const std::vector<std::string>& scenes) {
  std::vector<std::vector<const Outcome*>> groups;
  for (const Outcome& o : outcomes) {
    if (std::find(scenes.begin(), scenes.end(), o.scene) == scenes.end()) continue;
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      return group[0]->label() == o.label() && group[0]->external == o.external;
    });
    if (same == groups.end())
      groups.push_back({&o});
    else
      same->push_back(&o);
  }
  std::vector<Outcome> means;
  for (const auto& group : groups) means.push_back(mean_of(group, scenes.size()));
  return means;
}

std::vector<std::size_t> front_of(const std::vector<Outcome>& outcomes, double threshold_percent,
                                  TimeKind kind) {
  std::vector<Choice> choices;
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const auto f = outcomes[i].figures.f_at(threshold_percent);
    const auto& seconds = outcomes[i].seconds(kind);
    if (!outcomes[i].complete() || !seconds || !f) continue;
    choices.push_back({*seconds, *f});
    index.push_back(i);
  }
  std::vector<std::size_t> front;
  for (const std::size_t i : pareto_front(choices)) front.push_back(index[i]);
  return front;
}

}  // namespace photohull::chart
