#include <cstdio>
#include <memory>

#include "cli/commands.h"
#include "cli/front/command_table.h"
#include "cli/front/programs.h"
#include "cli/lab/lab_commands.h"
#include "cli/option_flags.h"
#include "cli/terminal_progress.h"
#include "core/error.h"
#include "lab/chart/chart_job.h"
#include "lab/chart/style.h"

namespace photohull::cli {
namespace {

struct ChartArguments {
  std::string plan, out;
  chart::ChartOptions options;
  bool dry_run = false;
};

void print_notes(const chart::Plan& plan) {
  for (const std::string& note : plan.notes) std::printf("%s\n", note.c_str());
}

void print_plan(const chart::ChartJob& job) {
  int left = 0;
  for (const auto& run : job.runs()) {
    const char* state = run.record ? (run.record->failure ? "failed" : "done") : "to run";
    left += !run.record;
    std::string arguments;
    for (const std::string& a : run.planned.arguments) arguments += " " + a;
    std::printf("%-7s %-40s%s\n", state, run.planned.label().c_str(), arguments.c_str());
  }
  std::printf("%d of %zu runs to do\n", left, job.runs().size());
}

void print_summary(const chart::ChartSummary& summary, const chart::Plan& plan,
                   const std::string& out) {
  std::printf("%-20s %-28s %10s %10s %8s %8s\n", "scene", "run", "CPU s", "wall s", "MiB",
              ("F " + chart::shown(plan.threshold_percent) + " %").c_str());
  for (const chart::Outcome& o : summary.outcomes) {
    if (o.external) continue;
    const std::string quality =
        o.failed ? "failed" : chart::shown(o.figures.f_at(plan.threshold_percent));
    std::printf("%-20s %-28s %10s %10s %8s %8s\n", o.scene.c_str(), o.label().c_str(),
                chart::shown(o.cpu_seconds).c_str(), chart::shown(o.wall_seconds).c_str(),
                chart::shown(o.peak_mb).c_str(), quality.c_str());
  }
  std::printf("%d runs made, %d there already, %d of all failed\n", summary.made, summary.reused,
              summary.failed);
  std::printf("  %s/index.html, results.json and %zu charts as SVG and PNG\n", out.c_str(),
              (summary.files.size() - 1) / 2);
}

/// Before anything runs.
void check_arguments(const chart::ChartJob& job) {
  for (const auto& run : job.runs()) {
    try {
      check_reconstruct(run.planned.arguments);
    } catch (const Error& e) {
      throw Error(concat(job.plan().file.string(), ": ", run.planned.label(), ": ", e.what()));
    }
  }
}

void run_chart(const ChartArguments& a) {
  chart::ChartOptions options = a.options;
  if (options.draw_only && (options.force || options.retry || a.dry_run))
    throw UsageError("--draw-only makes no runs: leave out --force, --retry and --dry-run");
  options.plan = a.plan;
  options.output = a.out;
  options.program = program_beside(kMainProgram);
  chart::ChartJob job(options);
  if (!options.draw_only) check_arguments(job);
  print_notes(job.plan());
  TerminalProgress progress(job.total_weight());
  for (const std::string& warning : job.warnings()) progress.warn(warning);
  if (a.dry_run) return print_plan(job);
  chart::ChartSummary summary = job.run(progress);
  job.draw(summary, progress);
  progress.finish();
  print_summary(summary, job.plan(), a.out);
  if (summary.failed == summary.made + summary.reused)
    throw Error(concat(a.out, ": every run failed; ", a.out, "/index.html says how"));
}

}  // namespace

void add_chart(CLI::App& app) {
  auto a = std::make_shared<ChartArguments>();
  CLI::App* c = add_command(app, "chart");
  c->add_option("plan", a->plan, "JSON file: scenes, methods, resolutions (docs/guide/charts.md)")
      ->required();
  c->add_option("--out", a->out, "folder for results and charts; made when it does not exist")
      ->required();
  add_flags_of(*c, a->options);
  c->add_flag("--dry-run", a->dry_run, "list the runs and what is left of them; do nothing");
  c->footer(
      "Every run is a process of its own, then judged by 'photohull evaluate'. Runs that are done\n"
      "are skipped, so the same command goes on where it was stopped; a run is repeated when its\n"
      "scene, its arguments or this program changed.\n\n"
      "Writes index.html (charts with values to point at, and a table), every chart as SVG and "
      "PNG,\n"
      "and results.json. Exit code 1 when every run failed.\n\n"
      "Examples:\n"
      "  photohull chart bench/plans/smoke.json --out out/smoke\n"
      "  photohull chart bench/plans/dev.json --out out/dev --dry-run\n"
      "  photohull chart bench/plans/dev.json --out out/dev\n"
      "  photohull chart bench/plans/dev.json --out out/dev --draw-only");
  c->callback([a] { run_chart(*a); });
}

}  // namespace photohull::cli
