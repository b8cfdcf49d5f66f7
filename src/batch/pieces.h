// The pieces of a batch: what is to be reconstructed, one after another or by many processes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace photohull::batch {

/// One reconstruction.
struct Piece {
  std::string name;                ///< its folder below the batch's; unique among them
  std::vector<std::string> words;  ///< scene, and options in the command line's words
  std::string frame;               ///< its number as text; empty: it is no frame
  std::string from;                ///< where it was asked for: "plants.txt line 3", "SCENE"
  std::size_t sequence = 0;        ///< a number that frames of one sequence have in common
  /// Names of the pieces whose results this one joins, the whole first and then its parts; empty:
  /// it is a reconstruction of its own.
  std::vector<std::string> joins{};
};

/// Numbers of frames, inclusive.
struct FrameRange {
  int first = 0, last = 0;
  int digits = 1;  ///< least width; shorter numbers get zeros in front

  std::string text(int frame) const;
};

/// "0-299" or "7"; as many digits as the first number is written with ("0000-0299"). Nothing: the
/// text is neither.
std::optional<FrameRange> parse_frames(const std::string& text);

inline constexpr const char* kFrameToken = "{frame}";

/// The text with the frame's number in place of every kFrameToken.
std::string with_frame(std::string text, const std::string& frame);

/// A piece for each scene, called as its folder or file is.
std::vector<Piece> pieces_of_scenes(const std::vector<std::string>& scenes);

/// One piece a line: a scene and options of reconstruct, words with spaces in quotes. Empty lines
/// and those that begin with # say nothing. `--name NAME` is the piece's name, which is else that
/// of its scene. Throws Error naming file and line.
std::vector<Piece> read_piece_list(const std::filesystem::path& file);

/// Each piece once for each frame: named by the frame, and where there are several pieces by
/// its own name and the frame.
std::vector<Piece> pieces_of_frames(const std::vector<Piece>& pieces, const FrameRange& frames);

/// Names of the pieces that another one goes by.
struct Precedent {
  std::optional<std::string> follow;  ///< whose surface it starts from
  std::optional<std::string> rig;     ///< whose cameras and gains it takes
};

/// For each piece: frames of one sequence follow each other in chains of `chain`, and all go by the
/// rig of the first. With chains of 1, and for what is no frame, nothing.
std::vector<Precedent> precedents(const std::vector<Piece>& pieces, int chain);

/// Throws UsageError where there is no piece, where two have the same name, or where a name is
/// none that a folder can have.
void check_pieces(const std::vector<Piece>& pieces);

}  // namespace photohull::batch
