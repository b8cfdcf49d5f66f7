#include <sys/utsname.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "cli/front/command_table.h"
#include "commands.h"
#include "core/error.h"
#include "gpu/device.h"
#include "gpu/device_options.h"
#include "option_flags.h"
#include "pipeline/memory.h"
#include "self_test.h"
#include "version.h"

namespace photohull::cli {
namespace {

using nlohmann::json;

/// The value of a line NAME=VALUE or "NAME : VALUE" of a file; empty where there is none.
std::string value_in(const char* file, const std::string& name, char between) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind(name, 0) != 0) continue;
    std::string value = line.substr(line.find(between) + 1);
    value.erase(0, value.find_first_not_of(" \""));
    value.erase(value.find_last_not_of(" \"") + 1);
    return value;
  }
  return "";
}

void print_system() {
  utsname system{};
  uname(&system);
  std::printf("system      %s, Linux %s, %s\n",
              value_in("/etc/os-release", "PRETTY_NAME", '=').c_str(), system.release,
              system.machine);
  std::printf("processor   %s, %u threads\n", value_in("/proc/cpuinfo", "model name", ':').c_str(),
              std::thread::hardware_concurrency());
  const auto memory = pipeline::available_memory();
  std::printf("memory      %s; a job takes %s of it at most\n",
              memory ? (pipeline::memory_text(*memory) + " available").c_str() : "not known",
              pipeline::memory_text(pipeline::default_max_memory()).c_str());
}

void print_libraries() {
  const json version = json::parse(version_json());
  std::printf("photohull   %s, commit %s\n", version.at("version").get<std::string>().c_str(),
              version.at("commit").get<std::string>().c_str());
  std::string line;
  for (const auto& [name, number] : version.at("libraries").items())
    line += (line.empty() ? "" : ", ") + name + " " + number.get<std::string>();
  std::printf("libraries   %s\n", line.c_str());
}

struct Devices {
  std::vector<gpu::DeviceInfo> all;
  int chosen = -1;
  std::string fault;  ///< why none is chosen
};

/// Throws UsageError where what is wanted is no device.
Devices look_for_devices(const std::string& wanted) {
  Devices found;
  try {
    found.all = gpu::list_devices();
    found.chosen = gpu::choose_device(found.all, wanted).index;
  } catch (const UsageError&) {
    throw;
  } catch (const Error& failure) {
    found.fault = failure.what();
  }
  return found;
}

void print_devices(const Devices& devices) {
  for (const gpu::DeviceInfo& d : devices.all)
    if (d.problem.empty())
      std::printf("device %d    %s (%s), OpenGL %s%s\n", d.index, d.renderer.c_str(),
                  d.vendor.c_str(), d.version.c_str(), d.software ? ", software" : "");
    else
      std::printf("device %d    not usable: %s\n", d.index, d.problem.c_str());
  if (devices.fault.empty()) std::printf("takes       device %d\n", devices.chosen);
}

void print_variables() {
  for (const char* name : {"LIBGL_ALWAYS_SOFTWARE", "GALLIUM_DRIVER", "MESA_LOADER_DRIVER_OVERRIDE",
                           "EGL_PLATFORM", "__EGL_VENDOR_LIBRARY_FILENAMES", "LP_NUM_THREADS"})
    if (const char* value = std::getenv(name)) std::printf("variable    %s=%s\n", name, value);
}

void run_doctor(const gpu::DeviceOptions& options) {
  const Devices devices = look_for_devices(options.device);
  print_libraries();
  print_system();
  print_variables();
  print_devices(devices);
  if (!devices.fault.empty()) throw Error(devices.fault);
  const SelfTest test = run_self_test(options.device);
  if (!test.fault.empty()) throw Error("the self-test failed: " + test.fault);
  std::printf("self-test   passed in %.1f s: a ball was carved with %.1f %% of its volume\n",
              test.seconds, 100 * test.volume);
}

}  // namespace

void add_doctor(CLI::App& app) {
  auto options = std::make_shared<gpu::DeviceOptions>();
  CLI::App* c = add_command(app, "doctor");
  add_flags_of(*c, *options, {"device"});
  c->footer(
      "Put what it prints into reports of faults. The self-test carves a ball that is known.\n\n"
      "Examples:\n"
      "  photohull doctor\n"
      "  photohull doctor --device software");
  c->callback([options] { run_doctor(*options); });
}

}  // namespace photohull::cli
