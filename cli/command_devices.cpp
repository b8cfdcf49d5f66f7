#include <cstdio>
#include <string>

#include "cli/front/command_table.h"
#include "commands.h"
#include "core/error.h"
#include "gpu/device.h"

namespace photohull::cli {
namespace {

void run_devices() {
  const std::vector<gpu::DeviceInfo> devices = gpu::list_devices();
  for (const gpu::DeviceInfo& d : devices) {
    if (!d.problem.empty()) {
      std::printf("%d  not usable: %s\n", d.index, d.problem.c_str());
      continue;
    }
    std::printf("%d  %s (%s, OpenGL %s)%s\n", d.index, d.renderer.c_str(), d.vendor.c_str(),
                d.version.c_str(), d.software ? ", software" : "");
  }
  const gpu::DeviceInfo chosen = gpu::choose_device(devices, "auto");
  std::printf("auto takes %d: %s\n", chosen.index,
              chosen.software ? "no hardware device gives an OpenGL 4.5 context, so the software "
                                "rasterizer"
                              : "the first hardware device that gives an OpenGL 4.5 context");
}

}  // namespace

void add_devices(CLI::App& app) {
  CLI::App* c = add_command(app, "devices");
  c->footer(
      "Examples:\n"
      "  photohull devices\n"
      "  photohull reconstruct SCENE --out DIR --device 1");
  c->callback(run_devices);
}

}  // namespace photohull::cli
