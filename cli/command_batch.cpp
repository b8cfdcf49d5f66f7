#include <memory>

#include "batch/pieces.h"
#include "batch_job.h"
#include "cli/front/command_table.h"
#include "cli/front/parse_faults.h"
#include "commands.h"
#include "core/error.h"
#include "option_flags.h"
#include "scene_arguments.h"

namespace photohull::cli {
namespace {

struct Arguments {
  pipeline::ReconstructOptions job;
  io::LoadSceneOptions load;
  BatchOptions batch;
  std::vector<std::string> scenes;
  std::string list, frames, out;
};

/// Puts the frame's number where the options that hold for all pieces ask for it.
void name_frame(BatchPiece& piece, const std::string& frame) {
  Described described;
  describe(described, piece.job, piece.load);
  for (const Option& option : described.options()) {
    const std::string text = text_of(option);
    if (text.find(batch::kFrameToken) != std::string::npos)
      read_option(option, batch::with_frame(text, frame));
  }
}

/// A piece's own words, on top of what holds for all of them.
BatchPiece parse_piece(const batch::Piece& given, const Arguments& all) {
  BatchPiece piece{given.name, {}, all.job, all.load};
  if (!all.frames.empty()) name_frame(piece, given.frame);
  CLI::App parser("", "batch");
  add_scene(parser, piece.scene);
  Described described;
  describe(described, piece.job, piece.load);
  add_flags(parser, described);
  std::vector<const char*> words = {"batch"};
  for (const std::string& word : given.words) words.push_back(word.c_str());
  try {
    parser.parse(int(words.size()), words.data());
    check_scene(piece.scene);
    piece.job.validate();
    piece.load.validate();
    check_output(piece.scene, piece.load, all.out);
  } catch (const CLI::ParseError& e) {
    throw UsageError(given.from + ": " + parse_fault(parser, e));
  } catch (const Error& e) {
    throw Error(given.from + ": " + e.what(), e.kind());
  }
  return piece;
}

std::vector<BatchPiece> pieces_of(const Arguments& a) {
  std::vector<batch::Piece> given = batch::pieces_of_scenes(a.scenes);
  if (!a.list.empty()) {
    const std::vector<batch::Piece> listed = batch::read_piece_list(a.list);
    given.insert(given.end(), listed.begin(), listed.end());
  }
  if (!a.frames.empty()) {
    const auto frames = batch::parse_frames(a.frames);
    if (!frames)
      throw UsageError("--frames " + a.frames +
                       ": give the first and the last, such as 0-299 or 0000-0299");
    given = batch::pieces_of_frames(given, *frames);
  }
  check_pieces(given);
  std::vector<BatchPiece> pieces;
  for (const batch::Piece& piece : given) pieces.push_back(parse_piece(piece, a));
  return pieces;
}

void run(Arguments& a) {
  if (a.out.empty()) throw UsageError("--out is empty: give a folder for the results");
  a.job.validate();
  a.batch.sequence = !a.frames.empty();
  const std::vector<BatchPiece> pieces = pieces_of(a);
  run_batch(pieces, batch::Store(a.out), a.batch);
}

}  // namespace

void add_batch(CLI::App& app) {
  auto a = std::make_shared<Arguments>();
  CLI::App* c = add_command(app, "batch");
  c->add_option("scenes", a->scenes, "scenes, as for reconstruct");
  c->add_option("--list", a->list,
                "file with a scene a line, after it options for this scene alone, and --name NAME "
                "for its folder's name");
  c->add_option("--frames", a->frames,
                "first and last frame, such as 0000-0299: each scene once for each, with the "
                "frame's number in place of {frame} in its name and options");
  c->add_option("--out", a->out,
                "folder for the results, in a folder each; made when it does not "
                "exist")
      ->required();
  c->add_flag("--retry", a->batch.retry,
              "try again what had no result before, though nothing of it has changed");
  c->add_flag("--json", a->batch.json, "print a line of JSON for each scene instead of a summary");
  Described described;
  describe(described, a->job, a->load);
  add_flags(*c, described);
  c->footer(
      "Reconstructs scenes one after another; one that fails does not stop the others. batch.csv "
      "in the output folder tells of all of them. Run again, it makes what is not there yet. "
      "Several processes may work at the same batch at once, on one machine or on several that "
      "share the folder: each takes scenes that no other has.\n\n"
      "Examples:\n"
      "  photohull batch plants/*/ --out out/plants --method hull --resolution 256\n"
      "  photohull batch --list plants.txt --out out/plants\n"
      "  photohull batch rig.json --images \"frames/{frame}\" --frames 0000-0299 --out out/dance\n"
      "  srun -n 8 photohull batch --list plants.txt --out /shared/plants");
  c->callback([a] { run(*a); });
}

}  // namespace photohull::cli
