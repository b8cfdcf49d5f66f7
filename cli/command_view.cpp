#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "cli/front/command_table.h"
#include "commands.h"
#include "core/error.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOpener = "xdg-open";

/// The page of a folder of results, or the page itself.
fs::path find_page(const std::string& given) {
  if (given.empty()) throw UsageError("DIR is empty: give the folder of the results");
  const fs::path path = given;
  std::error_code error;
  if (!fs::exists(path, error)) throw Error(concat(given, ": there is no such folder"));
  if (!fs::is_directory(path, error)) {
    if (path.filename() == "report.html") return path;
    throw Error(concat(given, ": this is a file; give the folder of the results"));
  }
  fs::path page = path / "report.html";
  if (fs::is_regular_file(page, error)) return page;
  throw Error(concat(given, " has no report.html: 'photohull reconstruct SCENE --out ", given,
                     "' writes it, but with --report-page off"));
}

bool has_display() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"})
    if (const char* value = std::getenv(name); value && *value) return true;
  return false;
}

/// Did the desktop's program take it?
bool open(const fs::path& page) {
  std::string program = kOpener, file = page.string();
  char* words[] = {program.data(), file.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, kOpener, nullptr, nullptr, words, environ) != 0) return false;
  int status = 0;
  if (waitpid(child, &status, 0) != child) return false;
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void run_view(const std::string& given) {
  const fs::path page = fs::absolute(find_page(given)).lexically_normal();
  std::printf("%s\n", page.c_str());
  if (!has_display()) return;
  std::fflush(stdout);
  if (!open(page))
    throw Error(concat(kOpener, " did not open ", page.string(), ": open it in a browser"));
}

}  // namespace

void add_view(CLI::App& app) {
  auto folder = std::make_shared<std::string>();
  CLI::App* c = add_command(app, "view");
  c->add_option("DIR", *folder, "folder that 'photohull reconstruct' wrote")->required();
  c->footer(
      "Opens report.html, the page with the model and its report, in the browser of the desktop;\n"
      "without a display it prints where the page is.\n\n"
      "Examples:\n"
      "  photohull view out/temple");
  c->callback([folder] { run_view(*folder); });
}

}  // namespace photohull::cli
