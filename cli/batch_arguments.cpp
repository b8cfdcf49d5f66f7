#include "batch_arguments.h"

#include <algorithm>
#include <filesystem>

#include "cli/front/parse_faults.h"
#include "core/error.h"
#include "core/option_word.h"
#include "option_flags.h"
#include "pipeline/part_options.h"
#include "scene_arguments.h"

namespace photohull::cli {
namespace {

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
BatchPiece parse_piece(const batch::Piece& given, BatchPiece piece, const std::string& out) {
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
    check_output(piece.scene, piece.load, out);
  } catch (const CLI::ParseError& e) {
    throw UsageError(given.from + ": " + parse_fault(parser, e));
  } catch (const Error& e) {
    throw Error(given.from + ": " + e.what(), e.kind());
  }
  return piece;
}

/// The scene, and all options that are not at their defaults.
std::vector<std::string> words_of(BatchPiece piece) {
  pipeline::ReconstructOptions usual_job;
  io::LoadSceneOptions usual_load;
  Described given, usual;
  describe(given, piece.job, piece.load);
  describe(usual, usual_job, usual_load);
  std::vector<std::string> words = {piece.scene};
  for (const Option& option : given.options()) {
    const std::string text = text_of(option);
    if (text == text_of(*usual.find(option.name))) continue;
    const std::string flag = option_word(option.name);
    const auto* texts = std::get_if<std::vector<std::string>*>(&option.place);
    if (std::holds_alternative<bool*>(option.place)) {
      words.push_back(flag);
    } else if (texts && !option.list) {
      for (const std::string& each : **texts) words.push_back(flag + "=" + each);
    } else {
      words.push_back(flag + "=" + text);
    }
  }
  return words;
}

/// A scene's whole, its parts, and what joins them. Throws UsageError where the voxels' size is not
/// given, or other options do not go with parts.
std::vector<BatchPiece> in_parts(const BatchPiece& scene, int count, int finer,
                                 const std::string& out) {
  if (!scene.job.resolution && !scene.job.voxel_size)
    throw UsageError(concat("--parts: give --resolution or --voxel-size, for the whole of ",
                            scene.name, " is made on coarser voxels"));
  std::vector<BatchPiece> pieces{scene};
  BatchPiece& whole = pieces.back();
  whole.name += ".whole";
  whole.job = pipeline::options_of_whole(whole.job, finer);
  BatchPiece joined = scene;
  joined.joins.push_back(whole.name);
  BatchPiece part = scene;
  const std::filesystem::path followed = std::filesystem::path(out) / whole.name;
  const std::size_t digits = std::to_string(count).size();
  for (int number = 1; number <= count; ++number) {
    const std::string text = std::to_string(number);
    part.name = scene.name + ".part" + std::string(digits - text.size(), '0') + text;
    part.job = pipeline::options_of_part(scene.job, {number, count}, finer, followed);
    joined.joins.push_back(part.name);
    pieces.push_back(part);
  }
  pieces.push_back(std::move(joined));
  return pieces;
}

/// Those of parts may be those of other scenes.
void check_names(const std::vector<BatchPiece>& pieces) {
  std::vector<batch::Piece> named;
  for (const BatchPiece& piece : pieces) named.push_back({piece.name, {}, {}, piece.scene});
  batch::check_pieces(named);
}

}  // namespace

void BatchArguments::add_to(CLI::App& command) {
  command.add_option("scenes", scenes, "scenes, as for reconstruct");
  command.add_option("--list", list,
                     "file with a scene a line, after it options for this scene alone, and --name "
                     "NAME for its folder's name");
  command.add_option("--frames", frames,
                     "first and last frame, such as 0000-0299: each scene once for each, with the "
                     "frame's number in place of {frame} in its name and options");
  command
      .add_option("--chain", chain,
                  "so many frames follow each other: each starts from the surface of the one "
                  "before (refine), the first of every chain from nothing, and cameras and gains "
                  "are those of the very first; 1: every frame by itself")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command
      .add_option("--tiles", tiles,
                  "cut each scene's surface into so many tiles, which processes that find no scene "
                  "of their own match for those that have one (refine); 0: a scene is one "
                  "process's")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  command
      .add_option("--parts", parts,
                  "make each scene whole on coarser voxels (--finer), then so many parts of it on "
                  "those asked for, each by itself, and join them: for models larger than memory; "
                  "0: whole at once")
      ->check(CLI::Range(0, pipeline::PartNumber::kMost))
      ->capture_default_str();
  command
      .add_option("--out", out,
                  "folder for the results, in a folder each; made when it does not exist")
      ->required();
  Described described;
  describe(described, job, load);
  add_flags(command, described);
}

std::vector<BatchPiece> BatchArguments::pieces() const {
  if (out.empty()) throw UsageError("--out is empty: give a folder for the results");
  pipeline::ReconstructOptions usual = job;
  if (parts > 0) usual.finer = 1;  // of the whole
  usual.validate();
  std::vector<batch::Piece> given = batch::pieces_of_scenes(scenes);
  if (!list.empty()) {
    const std::vector<batch::Piece> listed = batch::read_piece_list(list);
    given.insert(given.end(), listed.begin(), listed.end());
  }
  if (!frames.empty()) {
    const auto range = batch::parse_frames(frames);
    if (!range)
      throw UsageError("--frames " + frames +
                       ": give the first and the last, such as 0-299 or 0000-0299");
    given = batch::pieces_of_frames(given, *range);
  }
  if (parts > 0 && !frames.empty())
    throw UsageError("--parts and --frames exclude each other: frames are made whole");
  if (frames.empty() && chain > 1)
    throw UsageError(concat("--chain ", chain, " is for frames: give --frames"));
  check_pieces(given);
  const std::vector<batch::Precedent> before = batch::precedents(given, chain);
  std::vector<BatchPiece> pieces;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const batch::Piece& one = given[i];
    BatchPiece piece{one.name, {}, usual, load};
    if (!frames.empty()) name_frame(piece, one.frame);
    if (before[i].follow && job.effective_method() == pipeline::Method::kRefine)
      piece.job.follow = std::filesystem::path(out) / *before[i].follow;
    if (before[i].rig) piece.job.rig = std::filesystem::path(out) / *before[i].rig;
    piece = parse_piece(one, std::move(piece), out);
    if (parts == 0) {
      pieces.push_back(std::move(piece));
      continue;
    }
    for (BatchPiece& each : in_parts(piece, parts, job.finer, out))
      pieces.push_back(std::move(each));
  }
  if (parts > 0) check_names(pieces);
  return pieces;
}

void add_plan_folder(CLI::App& command, std::string& job) {
  command.add_option("JOB", job, "folder of a plan or batch, which all machines see")->required();
}

void keep_plan(const std::vector<BatchPiece>& pieces, const BatchArguments& arguments,
               const batch::Store& store) {
  batch::Plan plan{batch::new_plan_id(),
                   std::filesystem::current_path(),
                   !arguments.frames.empty(),
                   arguments.tiles,
                   {}};
  for (const BatchPiece& piece : pieces)
    plan.pieces.push_back({piece.name, words_of(piece), {}, {}, 0, piece.joins});
  store.set_plan(plan);
}

std::vector<BatchPiece> planned_pieces(const batch::Plan& plan, const std::string& out) {
  std::vector<BatchPiece> pieces;
  for (const batch::Piece& piece : plan.pieces)
    pieces.push_back(parse_piece(piece, {piece.name, {}, {}, {}, piece.joins}, out));
  return pieces;
}

}  // namespace photohull::cli
