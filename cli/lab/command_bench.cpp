#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/front/command_table.h"
#include "cli/lab/bench_visibility.h"
#include "cli/lab/lab_commands.h"
#include "cli/option_flags.h"
#include "cli/terminal_progress.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "gpu/context.h"
#include "gpu/device_options.h"
#include "lab/chart/png.h"
#include "lab/chart/sampling_chart.h"
#include "lab/chart/svg_renderer.h"
#include "lab/sampling/sampling_study.h"

namespace photohull::cli {
namespace {

using nlohmann::ordered_json;
using projtex::StudyCell;
using projtex::SweepRate;

struct BenchArguments {
  std::string json, out;
  gpu::DeviceOptions device;
  projtex::StudyOptions options;
};

struct Results {
  std::string device;
  projtex::StudyOptions options;
  std::vector<StudyCell> cells;
  std::vector<SweepRate> rates;
};

double rounded(double value) { return std::round(value * 1e4) / 1e4; }

std::string name_of(const StudyCell& cell) {
  const std::string sampler = projtex::to_string(cell.sampler);
  if (cell.supersample == 1) return sampler;
  return concat(sampler, " ", cell.supersample, "x", cell.supersample);
}

ordered_json to_json(const Results& results) {
  ordered_json j;
  j["device"] = results.device;
  j["squares_per_image"] = results.options.squares;
  j["cells"] = ordered_json::array();
  for (const StudyCell& c : results.cells)
    j["cells"].push_back({{"sampler", projtex::to_string(c.sampler)},
                          {"supersample", c.supersample},
                          {"footprint_pixels", c.footprint},
                          {"anisotropy", c.ratio},
                          {"rms_percent", rounded(c.rms)},
                          {"p99_percent", rounded(c.percentile99)},
                          {"nanoseconds", rounded(c.nanoseconds)}});
  j["sweeps"] = ordered_json::array();
  for (const SweepRate& r : results.rates)
    j["sweeps"].push_back({{"name", r.name},
                           {"voxel_pixels", rounded(r.pixels)},
                           {"nanoseconds", rounded(r.nanoseconds)},
                           {"share_of_raw", rounded(r.share_of_raw)}});
  return j;
}

/// A row a sampler: errors at round footprints of every size, the worst of all, and times.
void print_table(const Results& results) {
  const auto& footprints = results.options.footprints;
  std::printf("RMS error against the oracle in percent of full scale, at footprints 1 : 1\n%-26s",
              "pixels");
  for (const double f : footprints) std::printf(" %6g", f);
  std::printf(" | %6s %6s | %8s\n", "worst", "p99", "ns at 1");
  std::vector<std::string> names;
  std::map<std::string, std::vector<const StudyCell*>> rows;
  for (const StudyCell& cell : results.cells) {
    auto& row = rows[name_of(cell)];
    if (row.empty()) names.push_back(name_of(cell));
    row.push_back(&cell);
  }
  for (const std::string& name : names) {
    std::printf("%-26s", name.c_str());
    double worst = 0, p99 = 0, ns = 0;
    for (const StudyCell* cell : rows[name]) {
      if (cell->ratio == 1) std::printf(" %6.2f", cell->rms);
      if (cell->ratio == 1 && cell->footprint == 1) ns = cell->nanoseconds;
      worst = std::max(worst, cell->rms);
      p99 = std::max(p99, cell->percentile99);
    }
    std::printf(" | %6.2f %6.2f | %8.1f\n", worst, p99, ns);
  }
  std::printf("worst, p99: of all footprints and anisotropies up to %g : 1\n\n",
              results.options.ratios.back());
  std::printf("%-42s %8s %12s %10s\n", "sweep", "pixels", "ns a sample", "of raw");
  for (const SweepRate& r : results.rates) {
    const std::string share =
        r.share_of_raw > 0 ? concat(std::lround(100 * r.share_of_raw), " %") : "-";
    std::printf("%-42s %8.2f %12.1f %10s\n", r.name.c_str(), r.pixels, r.nanoseconds,
                share.c_str());
  }
}

/// Which samplers, and how often supersampled, the plot shows: all of them would hide one another.
bool is_drawn(const StudyCell& cell) {
  using projtex::Sampler;
  if (cell.supersample == 1) return cell.sampler != Sampler::kTrilinearDerivative;
  return (cell.supersample == 4 && cell.sampler == Sampler::kEwa) ||
         (cell.supersample == 8 && cell.sampler == Sampler::kAnisotropic);
}

void draw(const Results& results, const std::filesystem::path& folder) {
  std::vector<chart::SamplingPanel> panels;
  for (const double ratio : {1.0, 4.0, 16.0}) {
    chart::SamplingPanel panel{concat(ratio, " : 1"), {}};
    for (const StudyCell& cell : results.cells) {
      if (cell.ratio != ratio || !is_drawn(cell)) continue;
      if (panel.curves.empty() || panel.curves.back().name != name_of(cell))
        panel.curves.push_back(
            {name_of(cell), cell.supersample > 1 ? projtex::to_string(cell.sampler) : "", {}});
      panel.curves.back().points.emplace_back(cell.footprint, std::max(cell.rms, 1e-3));
    }
    panels.push_back(std::move(panel));
  }
  const chart::Chart drawn = chart::sampling_chart("Samplers against the oracle", panels);
  const std::string svg = chart::SvgRenderer().render(drawn.option, drawn.width, drawn.height);
  write_atomically(folder / "sampling.svg", svg);
  chart::write_png(svg, 2 * drawn.width, 2 * drawn.height, folder / "sampling.png");
}

void run_sampling(const BenchArguments& a) {
  Results results;
  results.options = a.options;
  results.options.validate();
  const auto context = gpu::Context::create(a.device.device, a.device.threads);
  results.device = context->device().renderer;
  TerminalProgress progress(10);
  progress.stage("samplers", 9);
  results.cells = projtex::study_samplers(*context, results.options, progress);
  progress.stage("sweeps", 1);
  results.rates = projtex::measure_sweeps(*context, results.options.repeats, progress);
  progress.finish();
  print_table(results);
  const std::string text = to_json(results).dump(1) + "\n";
  if (!a.json.empty()) write_atomically(a.json, text);
  if (a.out.empty()) return;
  std::filesystem::create_directories(a.out);
  write_atomically(std::filesystem::path(a.out) / "sampling.json", text);
  draw(results, a.out);
  std::printf("\n  %s/sampling.json, sampling.svg and sampling.png\n", a.out.c_str());
}

}  // namespace

void add_bench(CLI::App& app) {
  CLI::App* c = add_command(app, "bench");
  c->require_subcommand(1);
  auto a = std::make_shared<BenchArguments>();
  CLI::App* s =
      c->add_subcommand("sampling", "errors and times of the ways to resample photographs");
  s->add_option("--json", a->json, "file for all figures");
  s->add_option("--out", a->out, "folder for sampling.json and a plot as SVG and PNG");
  add_flags_of(*s, a->options);
  add_flags_of(*s, a->device);
  s->footer(
      "Errors are against the exact integral of the image over the projected square, in linear "
      "light,\n"
      "on white noise and on zones up to the Nyquist frequency. Times on software devices are "
      "processor\n"
      "time. docs/measurements/sampling.md explains the samplers and has the results.\n\n"
      "Examples:\n"
      "  photohull bench sampling\n"
      "  photohull bench sampling --squares 64 --out out/sampling");
  s->callback([a] { run_sampling(*a); });
  add_bench_visibility(*c);
}

}  // namespace photohull::cli
