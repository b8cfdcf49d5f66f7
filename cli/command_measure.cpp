#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cli/front/command_table.h"
#include "commands.h"
#include "core/error.h"
#include "option_flags.h"
#include "pipeline/measure_result.h"

namespace photohull::cli {
namespace {

struct MeasureArguments {
  std::vector<std::string> folders;
  MeasureOptions options;
  bool json = false, csv = false;
};

void print_line(const char* name, const Measured& m, const char* unit) {
  std::printf("%-16s %12.6g +- %-10.3g %s\n", name, m.value, m.uncertainty, unit);
}

void print_text(const std::string& folder, const Measurements& m) {
  std::printf("%s\n", folder.c_str());
  if (m.volume)
    print_line("volume", *m.volume, "cubic units");
  else
    std::printf("%-16s not known: the mesh is open (--unseen closed closes it)\n", "volume");
  print_line("surface area", m.area, "square units");
  print_line("height", m.height, "units");
  print_line("convex hull", m.hull_volume, "cubic units");
  const glm::dvec3 size = m.box.size(), own = m.oriented.size;
  std::printf("%-16s %g x %g x %g units along the world's axes\n", "box", size.x, size.y, size.z);
  std::printf("%-16s %g x %g x %g units along its own\n", "least box", own.x, own.y, own.z);
  std::printf("%-16s %g %g %g\n", "axis", m.axis.x, m.axis.y, m.axis.z);
  for (const CrossSection& s : m.sections) {
    char name[32];
    std::snprintf(name, sizeof name, "section %.6g", s.position);
    print_line(name, s.area, "square units");
  }
  if (m.unseen > 0)
    std::printf("%.1f %% of the surface is seen by no camera: its place is a guess\n",
                100 * m.unseen);
}

void run_measure(const MeasureArguments& a) {
  if (a.json && a.csv) throw UsageError("--json and --csv exclude each other: give one");
  if (a.json && a.folders.size() > 1)
    throw UsageError("--json is for one folder; give --csv for a table of several");
  a.options.validate();
  if (a.csv) std::printf("%s\n", pipeline::csv_head().c_str());
  for (const std::string& folder : a.folders) {
    if (folder.empty()) throw UsageError("DIR is empty: give a folder of results");
    const Measurements m = pipeline::measure_folder(folder, a.options);
    if (a.json)
      std::fputs(pipeline::to_json(m).c_str(), stdout);
    else if (a.csv)
      std::printf("%s\n", pipeline::csv_row(folder, m).c_str());
    else
      print_text(folder, m);
  }
}

}  // namespace

void add_measure(CLI::App& app) {
  auto a = std::make_shared<MeasureArguments>();
  CLI::App* c = add_command(app, "measure");
  c->add_option("DIR", a->folders, "folders that reconstruct wrote")->required();
  add_flags_of(*c, a->options);
  c->add_flag("--json", a->json, "print JSON, with the cross-sections");
  c->add_flag("--csv", a->csv, "print a table with a row for each folder, without cross-sections");
  c->footer(
      "Lengths are in scene units, areas and volumes in their squares and cubes. Uncertainties\n"
      "follow from the mesh's confidence, as if all errors had the same direction.\n\n"
      "Examples:\n"
      "  photohull measure out/plant\n"
      "  photohull measure out/plant --axis z --sections 40 --json\n"
      "  photohull measure out/plant-1 out/plant-2 --csv > plants.csv");
  c->callback([a] { run_measure(*a); });
}

}  // namespace photohull::cli
