#include <cstdio>
#include <memory>

#include "cli/commands.h"
#include "cli/front/command_table.h"
#include "cli/front/programs.h"
#include "cli/lab/lab_commands.h"
#include "cli/option_flags.h"
#include "cli/terminal_progress.h"
#include "core/error.h"
#include "lab/chart/stress_job.h"
#include "lab/chart/style.h"
#include "synth/spec.h"

namespace photohull::cli {
namespace {

struct StressArguments {
  std::string plan, out;
  chart::StressOptions options;
  bool dry_run = false;
};

void print_plan(const chart::StressJob& job) {
  int left = 0;
  for (const auto& run : job.runs()) {
    left += !run.record;
    std::string arguments;
    for (const std::string& a : run.arguments) arguments += " " + a;
    std::printf("%-7s %s:%s\n", run.record ? (run.record->exit_code ? "failed" : "done") : "to run",
                run.label.c_str(), arguments.c_str());
  }
  std::printf("%d of %zu runs to do\n", left, job.runs().size());
}

std::string percents(const std::optional<double>& share) {
  return share ? chart::shown(100 * *share) : "-";
}

void print_summary(const chart::StressOutcome& o, const chart::StressPlan& plan,
                   const std::string& out) {
  std::printf("%-28s %-22s %9s %12s\n", "degradation", "settings", "clean F", "breaks at");
  for (const chart::StressCurve& c : o.summary.curves) {
    std::string at = c.break025 ? chart::shown(*c.break025) : "-";
    for (const std::string& kind : c.broken_kinds) at += (at == "-" ? at.clear(), "" : ", ") + kind;
    std::printf("%-28s %-22s %9s %12s\n", plan.axes[c.axis].name.c_str(), c.variant.c_str(),
                percents(c.points.front().f025).c_str(), at.c_str());
  }
  for (const chart::MarkResult& m : o.summary.marks)
    std::printf("%-5s %s: %s %% kept (%s)\n", m.pass ? "pass" : "SHORT", m.text.c_str(),
                percents(m.worst).c_str(), m.worst_at.c_str());
  if (o.summary.verdicts.any)
    std::printf("called doubtful or failed: %s %% of F(0.5 %%) < 80 %%, %s %% of those > 95 %%\n",
                percents(o.summary.verdicts.bad_called).c_str(),
                percents(o.summary.verdicts.good_called).c_str());
  std::printf("%d runs made, %d there already, %d of all failed\n", o.made, o.reused, o.failed);
  std::printf("  %s/index.html, summary.md, results.json and %zu charts as SVG and PNG\n",
              out.c_str(), (o.files.size() - 2) / 2);
}

/// Before anything runs.
void check_arguments(const chart::StressJob& job) {
  for (const auto& run : job.runs()) {
    try {
      check_reconstruct(run.arguments);
    } catch (const Error& e) {
      throw Error(concat(job.plan().file.string(), ": ", run.label, ": ", e.what()));
    }
  }
}

void run_stress(const StressArguments& a) {
  chart::StressOptions options = a.options;
  if (options.draw_only && (options.force || options.retry || a.dry_run))
    throw UsageError("--draw-only makes no runs: leave out --force, --retry and --dry-run");
  options.plan = a.plan;
  options.output = a.out;
  options.program = program_beside(kMainProgram);
  options.normalize = [](const std::string& text, const std::string& source) {
    return synth::spec_text(synth::parse_spec(text, source, ""));
  };
  chart::StressJob job(options);
  if (!options.draw_only) check_arguments(job);
  TerminalProgress progress(job.total_weight());
  for (const std::string& warning : job.warnings()) progress.warn(warning);
  if (a.dry_run) return print_plan(job);
  chart::StressOutcome outcome = job.run(progress);
  job.draw(outcome, progress);
  progress.finish();
  print_summary(outcome, job.plan(), a.out);
}

}  // namespace

void add_stress(CLI::App& app) {
  auto a = std::make_shared<StressArguments>();
  CLI::App* c = add_command(app, "stress");
  c->add_option("plan", a->plan,
                "JSON file: scenes, degradations, settings (docs/measurements/stability.md)")
      ->required();
  c->add_option("--out", a->out, "folder for results and charts; made when it does not exist")
      ->required();
  for (CLI::Option* list : add_flags_of(*c, a->options, {"axes", "seeds"}))
    list->allow_extra_args(false);
  add_flags_of(*c, a->options, {"before", "force", "retry", "draw_only"});
  c->add_flag("--dry-run", a->dry_run, "list the runs and what is left of them; do nothing");
  c->footer(
      "Every reconstruction is a process of its own, then judged by 'photohull evaluate'. Runs "
      "that\n"
      "are done are skipped, so the same command goes on where it was stopped; a run is repeated\n"
      "when its scene, its arguments or this program changed.\n\n"
      "Writes index.html (curves, and a table), summary.md, results.json and every chart as SVG "
      "and\n"
      "PNG.\n\n"
      "Examples:\n"
      "  photohull stress bench/plans/stress_smoke.json --out out/smoke\n"
      "  photohull stress bench/plans/stress.json --out out/stress --dry-run\n"
      "  photohull stress bench/plans/stress.json --out out/stress\n"
      "  photohull stress bench/plans/stress.json --out out/new --axes pose-error --before "
      "out/stress");
  c->callback([a] { run_stress(*a); });
}

}  // namespace photohull::cli
