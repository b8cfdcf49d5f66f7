#include "lab/chart/chart_job.h"

#include <algorithm>

#include "core/atomic_file.h"
#include "core/error.h"
#include "lab/chart/draw.h"
#include "lab/chart/external.h"
#include "lab/chart/identity.h"
#include "lab/chart/results_file.h"

namespace photohull::chart {
namespace {

namespace fs = std::filesystem;
constexpr double kSceneWeight = 4, kDrawWeight = 1;

/// Work of a run, in those of 64 voxels: the surface that the sweeps judge.
double weight_of(const std::optional<int>& resolution) {
  const double n = resolution.value_or(192) / 64.0;
  return n * n;
}

std::string run_id(const std::string& program_hash, const std::string& scene_hash,
                   const PlannedRun& run, int repeats) {
  return hash_text(Json{
      {"layout", RunRecord::kLayout},
      {"program", program_hash},
      {"scene", scene_hash},
      {"arguments", run.arguments},
      {"repeats",
       repeats}}.dump());
}

}  // namespace

void describe(Described& to, ChartOptions& o) {
  to.flag("force", &o.force, "repeat runs and synthetic scenes that are there already");
  to.flag("retry", &o.retry, "repeat runs that failed");
  to.flag("draw_only", &o.draw_only, "draw the results that are there again");
}

ChartJob::ChartJob(ChartOptions options)
    : options_(std::move(options)), plan_(read_plan(options_.plan)), store_(options_.output) {
  for (const ExternalSource& source : plan_.external)
    for (Outcome& o : read_external(source.path)) {
      const bool twice = std::any_of(external_.begin(), external_.end(), [&](const Outcome& e) {
        return e.scene == o.scene && e.label() == o.label();
      });
      if (twice)
        throw Error(concat(source.path.string(), ": ", o.label(), " on ", o.scene,
                           " is in another external table too"));
      external_.push_back(std::move(o));
    }
  for (const std::string& name : plan_.mean_over) {
    const bool known = std::any_of(plan_.scenes.begin(), plan_.scenes.end(),
                                   [&](const PlanScene& s) { return s.name == name; });
    if (!known) plan_.notes.push_back("mean_over: the scene " + name + " is not there");
  }
  std::erase_if(plan_.mean_over, [&](const std::string& name) {
    return std::none_of(plan_.scenes.begin(), plan_.scenes.end(),
                        [&](const PlanScene& s) { return s.name == name; });
  });
  if (!plan_.mean_over.empty()) {
    std::string names;
    for (const std::string& name : plan_.mean_over) names += (names.empty() ? "" : ", ") + name;
    plan_.notes.push_back("the mean is over " + names);
  }
  if (!options_.draw_only) plan_runs();
}

fs::path ChartJob::scene_folder(const PlanScene& scene) const {
  return scene.synthetic ? store_.scene_folder(scene.name) : scene.path;
}

void ChartJob::plan_runs() {
  program_hash_ = hash_file(options_.program);
  for (std::size_t s = 0; s < plan_.scenes.size(); ++s) {
    const PlanScene& scene = plan_.scenes[s];
    const bool there =
        !scene.synthetic || (!options_.force && scene_is_made(program_hash_, scene, store_));
    scene_hashes_.push_back(there ? hash_folder(scene_folder(scene)) : "");
    for (const Variant& variant : plan_.variants) {
      std::vector<std::optional<int>> resolutions(variant.resolutions.begin(),
                                                  variant.resolutions.end());
      if (resolutions.empty()) resolutions.emplace_back();
      for (const auto& resolution : resolutions) {
        Run run{{"", scene.name, variant.name, resolution, variant.arguments},
                s,
                weight_of(resolution),
                std::nullopt};
        if (resolution) {
          run.planned.arguments.push_back("--resolution");
          run.planned.arguments.push_back(std::to_string(*resolution));
        }
        find_done(run);
        runs_.push_back(std::move(run));
      }
    }
  }
}

void ChartJob::find_done(Run& run) {
  const std::string& scene_hash = scene_hashes_[run.scene];
  if (scene_hash.empty()) return;
  run.planned.id = run_id(program_hash_, scene_hash, run.planned, plan_.repeats);
  if (options_.force) return;
  auto record = store_.load(run.planned.id,
                            [&](const std::string& message) { warnings_.push_back(message); });
  if (!record || !is_usable(*record)) return;
  // The same run may have had other names.
  record->scene = run.planned.scene;
  record->variant = run.planned.variant;
  run.record = std::move(record);
}

bool ChartJob::is_usable(const RunRecord& record) const {
  if (record.failure) {
    if (options_.retry) return false;
    return !record.failure->timed_out || record.time_limit_seconds >= plan_.time_limit_seconds;
  }
  std::error_code status;
  return !plan_.keep ||
         (!record.mesh.empty() && fs::is_regular_file(store_.folder() / record.mesh, status));
}

double ChartJob::total_weight() const {
  double sum = kDrawWeight;
  for (const std::string& hash : scene_hashes_)
    if (hash.empty()) sum += kSceneWeight;
  for (const Run& run : runs_)
    if (!run.record) sum += run.weight;
  return sum;
}

void ChartJob::make_scenes(Progress& progress) {
  for (std::size_t s = 0; s < plan_.scenes.size(); ++s) {
    if (!scene_hashes_[s].empty()) continue;
    const PlanScene& scene = plan_.scenes[s];
    progress.check_cancelled();
    progress.stage("scene " + scene.name, kSceneWeight);
    if (options_.force) {
      std::error_code ignored;
      fs::remove_all(store_.scene_folder(scene.name), ignored);
    }
    make_scene(options_.program, program_hash_, scene, store_, progress);
    scene_hashes_[s] = hash_folder(scene_folder(scene));
    for (Run& run : runs_)
      if (run.scene == s) find_done(run);
  }
}

void ChartJob::make_runs(Progress& progress, ChartSummary& summary) {
  std::size_t left = 0;
  for (const Run& run : runs_) left += !run.record;
  summary.reused = int(runs_.size() - left);
  std::size_t number = 0;
  for (Run& run : runs_) {
    if (run.record) continue;
    progress.check_cancelled();
    progress.stage(concat("run ", ++number, " of ", left, ": ", run.planned.label()), run.weight);
    RunRecord record = execute_run(options_.program, scene_folder(plan_.scenes[run.scene]),
                                   run.planned, plan_, store_, progress);
    store_.save(record);
    if (record.failure)
      progress.warn(concat(run.planned.label(), " failed: ", record.failure->message()));
    run.record = std::move(record);
    ++summary.made;
  }
}

std::vector<RunRecord> ChartJob::records() const {
  std::vector<RunRecord> found;
  for (const Run& run : runs_)
    if (run.record) found.push_back(*run.record);
  return found;
}

std::vector<Outcome> ChartJob::collect(const std::vector<RunRecord>& records) const {
  std::vector<Outcome> outcomes;
  for (const RunRecord& record : records) outcomes.push_back(outcome_of(record));
  outcomes.insert(outcomes.end(), external_.begin(), external_.end());
  return outcomes;
}

ChartSummary ChartJob::run(Progress& progress) {
  store_.open();
  ChartSummary summary;
  std::vector<RunRecord> all;
  if (options_.draw_only) {
    all = read_results(store_.folder() / "results.json");
    summary.reused = int(all.size());
  } else {
    try {
      make_scenes(progress);
      make_runs(progress, summary);
    } catch (const Error&) {
      write_results(store_.folder() / "results.json", plan_, records(), external_);
      throw;
    }
    all = records();
    write_results(store_.folder() / "results.json", plan_, all, external_);
  }
  summary.outcomes = collect(all);
  for (const RunRecord& record : all) summary.failed += record.failure.has_value();
  return summary;
}

void ChartJob::draw(ChartSummary& summary, Progress& progress) const {
  progress.stage("charts", kDrawWeight);
  summary.files = draw_charts(plan_, summary.outcomes, store_.folder(), progress);
}

}  // namespace photohull::chart
