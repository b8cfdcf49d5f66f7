#include <cstdio>
#include <filesystem>
#include <memory>

#include "cli/front/command_table.h"
#include "commands.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "option_flags.h"
#include "sheet/draw_sheet.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

struct BoardArguments {
  std::string out;
  SheetOptions sheet;
};

void tell(const Sheet& sheet) {
  const double side = glm::length(sheet.tags[0].corners[1] - sheet.tags[0].corners[0]);
  if (!sheet.is_flat()) {
    std::printf(
        "%zu tags of %g mm on a strip of %.1f x %g mm, in %zu pieces, on a page of %g x %g mm\n",
        sheet.tags.size(), side, sheet.pieces.back().to, sheet.strip, sheet.pieces.size(),
        sheet.page.x, sheet.page.y);
    std::printf("wrap it once around the cylinder of %g mm; its ends meet\n", sheet.diameter);
    return;
  }
  const glm::dvec2 room = sheet.free_max - sheet.free_min;
  std::printf("%zu tags of %g mm around a free space of %g x %g mm, on a page of %g x %g mm\n",
              sheet.tags.size(), side, room.x, room.y, sheet.page.x, sheet.page.y);
}

void run_board(const BoardArguments& a) {
  const fs::path out(a.out);
  const std::string ending = out.extension().string();
  if (ending != ".pdf" && ending != ".svg")
    throw UsageError(concat("--out ", a.out, ": give a file that ends in .pdf or .svg"));
  const Sheet sheet = make_sheet(a.sheet);
  const std::string drawn = ending == ".pdf" ? sheet_pdf(sheet) : sheet_svg(sheet);
  fs::path described = out;
  described.replace_extension(".json");
  write_atomically(described, sheet_text(sheet));
  write_atomically(out, drawn);
  tell(sheet);
  std::printf("print it at 100 %% and measure the bar: it should be %g mm long\n",
              sheet.bar_length());
  std::printf("  %s\n  %s\n", out.string().c_str(), described.string().c_str());
}

}  // namespace
void add_board(CLI::App& app) {
  auto a = std::make_shared<BoardArguments>();
  CLI::App* c = add_command(app, "board");
  c->add_option("--out", a->out, "file to print, .pdf or .svg; its description is beside it, .json")
      ->required();
  add_flags_of(*c, a->sheet);
  c->footer(
      "Examples:\n"
      "  photohull board --out board.pdf\n"
      "  photohull board --out large.svg --paper a3 --kind charuco\n"
      "  photohull board --out rim.pdf --kind rim --diameter 250");
  c->callback([a] { run_board(*a); });
}

}  // namespace photohull::cli
