#include "cli/lab/lab_commands.h"

#include "cli/commands.h"
#include "cli/lab/draw_reliability.h"
#include "cli/version.h"

namespace photohull::cli {
namespace {

void add_all(CLI::App& app) {
  add_evaluate(app, draw_reliability);
  add_chart(app);
  add_stress(app);
  add_bench(app);
}

}  // namespace

Commands lab_commands() { return {add_all, version_json}; }

}  // namespace photohull::cli
