#include "lab/chart/stress_job.h"

#include <algorithm>

#include "core/atomic_file.h"
#include "core/child_process.h"
#include "core/error.h"
#include "lab/chart/figures.h"
#include "lab/chart/identity.h"
#include "lab/chart/run_record.h"
#include "lab/chart/stress_report.h"

namespace photohull::chart {
namespace {

namespace fs = std::filesystem;

constexpr double kOtherLimitSeconds = 3600;  ///< for judging a mesh or making a scene
constexpr double kSceneWeight = 0.6, kRunWeight = 1, kDrawWeight = 1;
constexpr const char* kSceneFolder = "scene";

/// Output as JSON; null when it is none.
Json parsed(const std::string& text) {
  Json json = Json::parse(text, nullptr, false, true);
  return json.is_object() ? json : Json();
}

/// One line on what went wrong.
std::string reason(const char* step, const Finished& finished) {
  return Failure{step, finished.exit_code, finished.signal, finished.timed_out, finished.err}
      .message();
}

std::string voxel_of(const Json& report) {
  if (!report.is_object() || !report.contains("grid")) return "";
  const Json& grid = report["grid"];
  return grid.is_object() && grid.contains("voxel_size") && grid["voxel_size"].is_number()
             ? grid["voxel_size"].dump()
             : "";
}

}  // namespace

void describe(Described& to, StressOptions& o) {
  to.list("axes", &o.selection.axes, {}, "names", "names of the plan's axes to run (default: all)");
  to.list("seeds", &o.selection.seeds, at_least(0), "whole numbers",
          "seeds of the scenes in place of the plan's");
  to.text("before", &o.before,
          "folder of an earlier run, whose curves are drawn beside the new ones");
  to.flag("force", &o.force, "repeat runs that are there already");
  to.flag("retry", &o.retry, "repeat runs that failed");
  to.flag("draw_only", &o.draw_only, "draw the results that are there again");
}

StressJob::StressJob(StressOptions options)
    : options_(std::move(options)),
      plan_(read_stress_plan(options_.plan, options_.selection)),
      store_(options_.output) {
  if (!options_.draw_only) plan_runs();
}

void StressJob::plan_runs() {
  program_hash_ = hash_file(options_.program);
  for (const StressAxis& axis : plan_.axes) {
    add_samples(axis, axis.clean, true, 0);
    for (std::size_t i = 0; i < axis.points.size(); ++i)
      add_samples(axis, axis.points[i], false, axis.same_mesh ? int(i) + 1 : 0);
  }
}

void StressJob::add_samples(const StressAxis& axis, const StressPoint& point, bool clean,
                            int repeat) {
  for (const std::size_t s : axis.scenes)
    for (const std::uint64_t seed : plan_.seeds)
      for (const std::size_t v : axis.variants) {
        const StressScene& scene = plan_.scenes[s];
        const StressVariant& variant = plan_.variants[v];
        Place place;
        place.sample.axis = axis.name;
        place.sample.label = point.label;
        place.sample.clean = clean;
        place.sample.strength = point.strength;
        place.sample.scene = scene.name;
        place.sample.seed = seed;
        place.sample.variant = variant.name;
        const std::string what = clean ? "clean" : axis.name + " " + point.label;
        place.run = run_of(stress_spec(scene, point, seed),
                           merge_arguments(variant.arguments, point.arguments), repeat,
                           concat(scene.name, ": ", what, ": ", variant.name));
        places_.push_back(std::move(place));
      }
}

std::size_t StressJob::run_of(const Json& spec, const std::vector<std::string>& arguments,
                              int repeat, const std::string& label) {
  const std::string text = spec.dump();
  const std::string source = concat(plan_.file.string(), ": the scene of ", label);
  const std::string spec_hash =
      hash_text(options_.normalize ? options_.normalize(text, source) : text);
  const std::string id = hash_text(Json{
      {"layout", StressRecord::kLayout},
      {"program", program_hash_},
      {"spec", spec_hash},
      {"arguments", arguments},
      {"repeat", repeat}}.dump());
  const auto [at, added] = run_at_.try_emplace(id, runs_.size());
  if (added) {
    runs_.push_back({id, label, spec, spec_hash, arguments, std::nullopt});
    find_done(runs_.back());
  }
  return at->second;
}

void StressJob::find_done(Run& run) {
  if (options_.force) return;
  const fs::path file = store_.folder() / "runs" / (run.id + ".json");
  std::error_code status;
  if (!fs::exists(file, status)) return;
  try {
    StressRecord record = StressRecord::from_json(file, read_json(file));
    if (record.id != run.id) throw Error(concat(file.string(), ": id: is another run's"));
    if (options_.retry && record.exit_code != 0) return;
    if (record.timed_out && record.time_limit_seconds < plan_.time_limit_seconds) return;
    run.record = std::move(record);
  } catch (const Error& e) {
    warnings_.push_back(concat(e.what(), "; the run is repeated"));
  }
}

std::vector<std::vector<std::size_t>> StressJob::runs_by_scene() const {
  std::vector<std::vector<std::size_t>> groups;
  std::map<std::string, std::size_t> group_at;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    if (runs_[i].record) continue;
    const auto [at, added] = group_at.try_emplace(runs_[i].spec_hash, groups.size());
    if (added) groups.emplace_back();
    groups[at->second].push_back(i);
  }
  return groups;
}

double StressJob::total_weight() const {
  double sum = kDrawWeight;
  for (const auto& group : runs_by_scene()) sum += kSceneWeight + kRunWeight * double(group.size());
  return sum;
}

void StressJob::make_scene(const Run& run, const fs::path& folder, const Progress& progress) {
  const fs::path spec = folder / "spec.json";
  write_atomically(spec, run.spec.dump(1) + "\n");
  const Finished finished = run_child(
      options_.program, {"synthesize", spec.string(), "--out", (folder / kSceneFolder).string()},
      kOtherLimitSeconds, progress);
  if (!finished.ok())
    throw Error(concat(plan_.file.string(), ": the scene of ", run.label,
                       " cannot be made: ", reason("synthesize", finished)));
}

StressRecord StressJob::execute(const Run& run, const fs::path& scene,
                                const Progress& progress) const {
  const WorkFolder work(store_, run.id);
  const fs::path out = work.path() / "out", mesh = out / "mesh.ply";
  std::vector<std::string> words = {"reconstruct", scene.string(), "--out", out.string(), "--json"};
  words.insert(words.end(), run.arguments.begin(), run.arguments.end());
  const Finished finished = run_child(options_.program, words, plan_.time_limit_seconds, progress);
  StressRecord record{.id = run.id,
                      .spec = run.spec,
                      .arguments = run.arguments,
                      .time_limit_seconds = plan_.time_limit_seconds,
                      .exit_code = finished.timed_out ? -1 : finished.exit_code,
                      .signal = finished.signal,
                      .timed_out = finished.timed_out,
                      .message = finished.ok() ? "" : reason("reconstruct", finished),
                      .cpu_seconds = finished.cpu_seconds(),
                      .wall_seconds = finished.wall_seconds,
                      .peak_memory_bytes = finished.peak_memory_bytes,
                      .mesh_hash = {},
                      .report = parsed(finished.out),
                      .evaluation = {}};
  std::error_code status;
  if (record.report.is_null() && fs::is_regular_file(out / "report.json", status))
    record.report = parsed(read_file(out / "report.json"));
  if (!fs::is_regular_file(mesh, status)) {
    if (record.message.empty()) record.message = "reconstruct: left no mesh.ply";
    return record;
  }
  record.mesh_hash = hash_file(mesh);
  std::vector<std::string> question = {"evaluate", mesh.string(), "--truth", scene.string(),
                                       "--json"};
  if (const std::string voxel = voxel_of(record.report); !voxel.empty())
    question.insert(question.end(), {"--reliability", voxel});
  const Finished judged = run_child(options_.program, question, kOtherLimitSeconds, progress);
  if (judged.ok()) {
    record.evaluation = parsed(judged.out);
    figures_of_evaluation(record.evaluation);
  } else {
    record.message += (record.message.empty() ? "" : "; ") + reason("evaluate", judged);
  }
  return record;
}

void StressJob::make_runs(Progress& progress, StressOutcome& outcome) {
  const auto groups = runs_by_scene();
  std::size_t left = 0, number = 0;
  for (const auto& group : groups) left += group.size();
  outcome.reused = int(runs_.size() - left);
  for (const auto& group : groups) {
    progress.check_cancelled();
    const Run& first = runs_[group.front()];
    progress.stage("scene of " + first.label, kSceneWeight);
    const WorkFolder work(store_, "scene-" + first.spec_hash);
    make_scene(first, work.path(), progress);
    for (const std::size_t i : group) {
      Run& run = runs_[i];
      progress.check_cancelled();
      progress.stage(concat("run ", ++number, " of ", left, ": ", run.label), kRunWeight);
      run.record = execute(run, work.path() / kSceneFolder, progress);
      write_atomically(
          store_.folder() / "runs" / (run.id + ".json"),
          run.record->to_json().dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
      if (!run.record->message.empty()) progress.warn(concat(run.label, ": ", run.record->message));
      ++outcome.made;
    }
  }
}

std::vector<StressSample> StressJob::samples() const {
  std::vector<StressSample> all;
  for (const Place& place : places_) {
    const Run& run = runs_[place.run];
    if (!run.record) continue;
    StressSample s = place.sample;
    s.run = run.id;
    s.exit_code = run.record->exit_code;
    s.message = run.record->message;
    s.mesh_hash = run.record->mesh_hash;
    s.cpu_seconds = run.record->cpu_seconds;
    s.figures = figures_of(*run.record);
    s.report = run.record->report;
    all.push_back(std::move(s));
  }
  return all;
}

StressOutcome StressJob::run(Progress& progress) {
  std::vector<StressSample> earlier;
  if (!options_.before.empty()) {
    earlier = read_stress_results(options_.before / "results.json");
    for (StressSample& s : earlier) s.variant = "before: " + s.variant;
  }
  store_.open();
  const fs::path file = store_.folder() / "results.json";
  StressOutcome outcome;
  if (options_.draw_only) {
    outcome.summary = summarize(plan_, read_stress_results(file), std::move(earlier));
  } else {
    try {
      make_runs(progress, outcome);
    } catch (const Error&) {
      write_stress_results(file, plan_, summarize(plan_, samples(), {}));
      throw;
    }
    outcome.summary = summarize(plan_, samples(), std::move(earlier));
    write_stress_results(file, plan_, outcome.summary);
    for (const Run& run : runs_) outcome.failed += run.record && run.record->exit_code != 0;
  }
  return outcome;
}

void StressJob::draw(StressOutcome& outcome, Progress& progress) const {
  progress.stage("charts", kDrawWeight);
  outcome.files = write_stress_page(store_.folder(), plan_, outcome.summary, progress);
}

}  // namespace photohull::chart
