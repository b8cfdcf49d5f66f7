#include "lab/chart/execute_run.h"

#include "core/atomic_file.h"
#include "core/child_process.h"
#include "core/error.h"
#include "lab/chart/figures.h"
#include "lab/chart/identity.h"
#include "lab/chart/statistics.h"

namespace photohull::chart {
namespace {

namespace fs = std::filesystem;

constexpr double kOtherLimitSeconds = 3600;  ///< for judging a mesh or making a scene

Failure failure_of(const char* step, const Finished& finished, const std::string& more = "") {
  return {step, finished.exit_code, finished.signal, finished.timed_out, finished.err + more};
}

/// Output as JSON; null when it is none.
Json parsed(const std::string& text) { return Json::parse(text, nullptr, false, true); }

/// Runs one reconstruction and notes its time; false when it failed.
bool reconstruct(const fs::path& program, const fs::path& scene, const PlannedRun& run,
                 const fs::path& out, const Progress& progress, RunRecord& record,
                 std::vector<Json>& reports) {
  std::vector<std::string> words = {"reconstruct", scene.string(), "--out", out.string(), "--json"};
  words.insert(words.end(), run.arguments.begin(), run.arguments.end());
  const Finished finished = run_child(program, words, record.time_limit_seconds, progress);
  record.repeats.push_back(
      {finished.wall_seconds, finished.cpu_seconds(), finished.peak_memory_bytes});
  reports.push_back(parsed(finished.out));
  if (!finished.ok())
    record.failure = failure_of("reconstruct", finished);
  else if (!reports.back().is_object())
    record.failure = failure_of("reconstruct", finished, "\nprinted no report");
  else if (!fs::is_regular_file(out / "mesh.ply"))
    record.failure = failure_of("reconstruct", finished, "\nleft no mesh.ply");
  return !record.failure;
}

void evaluate(const fs::path& program, const fs::path& scene, const fs::path& mesh,
              const Progress& progress, RunRecord& record) {
  const Finished finished =
      run_child(program, {"evaluate", mesh.string(), "--truth", scene.string(), "--json"},
                kOtherLimitSeconds, progress);
  if (!finished.ok()) {
    record.failure = failure_of("evaluate", finished);
    return;
  }
  try {
    const Json evaluation = parsed(finished.out);
    figures_of_evaluation(evaluation);
    record.evaluation = evaluation;
  } catch (const Error& e) {
    record.failure = failure_of("evaluate", finished, concat("\n", e.what()));
  }
}

void keep_mesh(const fs::path& mesh, const ResultStore& store, RunRecord& record) {
  record.mesh = ResultStore::mesh_name(record.id);
  const fs::path target = store.folder() / record.mesh;
  std::error_code error;
  fs::create_directories(target.parent_path(), error);
  fs::rename(mesh, target, error);
  if (error) throw Error(concat(target.string(), ": cannot be written: ", error.message()));
}

fs::path stamp_file(const PlanScene& scene, const ResultStore& store) {
  return store.folder() / "scenes" / (scene.name + ".json");
}

std::string stamp_text(const std::string& program_hash, const PlanScene& scene) {
  return Json{{"spec", hash_spec(scene.path)}, {"program", program_hash}}.dump(1) + "\n";
}

}  // namespace

std::string PlannedRun::label() const {
  return resolution ? concat(scene, ": ", variant, " ", *resolution) : scene + ": " + variant;
}

RunRecord execute_run(const fs::path& program, const fs::path& scene, const PlannedRun& run,
                      const Plan& plan, const ResultStore& store, const Progress& progress) {
  RunRecord record;
  record.id = run.id;
  record.scene = run.scene;
  record.variant = run.variant;
  record.resolution = run.resolution;
  record.arguments = run.arguments;
  record.time_limit_seconds = plan.time_limit_seconds;
  const WorkFolder work(store, run.id);
  std::vector<Json> reports;
  const auto folder_of = [&](std::size_t repeat) { return work.path() / std::to_string(repeat); };
  for (int repeat = 0; repeat < plan.repeats; ++repeat)
    if (!reconstruct(program, scene, run, folder_of(std::size_t(repeat)), progress, record,
                     reports))
      break;
  if (record.failure) {
    record.median = record.repeats.size() - 1;  // the one that failed
    return record;
  }
  std::vector<double> cpu;
  for (const Timing& t : record.repeats) cpu.push_back(t.cpu_seconds);
  record.median = median_index(cpu);
  record.report = reports[record.median];
  const fs::path mesh = folder_of(record.median) / "mesh.ply";
  evaluate(program, scene, mesh, progress, record);
  if (plan.keep && !record.failure) keep_mesh(mesh, store, record);
  return record;
}

bool scene_is_made(const std::string& program_hash, const PlanScene& scene,
                   const ResultStore& store) {
  std::error_code status;
  const fs::path stamp = stamp_file(scene, store);
  return fs::is_directory(store.scene_folder(scene.name), status) &&
         fs::is_regular_file(stamp, status) && read_file(stamp) == stamp_text(program_hash, scene);
}

void make_scene(const fs::path& program, const std::string& program_hash, const PlanScene& scene,
                const ResultStore& store, const Progress& progress) {
  if (scene_is_made(program_hash, scene, store)) return;
  const std::string stamp = stamp_text(program_hash, scene);
  const WorkFolder work(store, "scene");
  const fs::path made = work.path() / scene.name, target = store.scene_folder(scene.name);
  const Finished finished =
      run_child(program, {"synthesize", scene.path.string(), "--out", made.string()},
                kOtherLimitSeconds, progress);
  if (!finished.ok())
    throw Error(concat(scene.path.string(), ": the scene cannot be made: ",
                       failure_of("synthesize", finished).message()));
  if (!fs::is_regular_file(made / "gt.ply"))
    throw Error(concat(scene.path.string(), ": 'photohull synthesize' left no gt.ply"));
  std::error_code error;
  fs::remove(stamp_file(scene, store), error);
  fs::remove_all(target, error);
  fs::rename(made, target, error);
  if (error) throw Error(concat(target.string(), ": cannot be written: ", error.message()));
  write_atomically(stamp_file(scene, store), stamp);
}

}  // namespace photohull::chart
