#include "commands.h"

#include "version.h"

namespace photohull::cli {
namespace {

void add_all(CLI::App& app) {
  add_scan(app);
  add_reconstruct(app);
  add_batch(app);
  add_plan(app);
  add_run(app);
  add_status(app);
  add_merge(app);
  add_submit(app);
  add_view(app);
  add_render(app);
  add_measure(app);
  add_info(app);
  add_masks(app);
  add_convert(app);
  add_board(app);
  add_pose(app);
  add_calibrate(app);
  add_refine_cameras(app);
  add_synthesize(app);
  add_evaluate(app, nullptr);
  add_devices(app);
  add_doctor(app);
  add_demo(app);
}

}  // namespace

Commands main_commands() { return {add_all, version_json}; }

}  // namespace photohull::cli
