#include "batch/pieces.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iomanip>
#include <map>
#include <sstream>

#include "core/error.h"
#include "core/option_word.h"

namespace photohull::batch {
namespace {

namespace fs = std::filesystem;

constexpr int kMostFrames = 1000000;

/// "scans/plant_7/" -> "plant_7", "rig/transforms.json" -> "rig", "a.json" -> "a": the folder of a
/// file that every scene calls alike says more than its name.
std::string name_of_scene(const std::string& scene) {
  fs::path path = fs::path(scene).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  if (path == "." || path == "..") path = fs::absolute(path).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  const fs::path folder = path.parent_path();
  if (path.has_extension() && folder.has_filename() && folder != ".." && folder != ".")
    return folder.filename();
  return path.has_extension() ? path.stem() : path.filename();
}

/// Words of a line, those in quotes whole. Nothing: a quote is not closed.
std::optional<std::vector<std::string>> words_of(const std::string& line) {
  std::vector<std::string> words;
  std::string word;
  char quote = 0;
  bool any = false;
  for (const char c : line) {
    if (quote ? c == quote : c == '"' || c == '\'') {
      quote = quote ? 0 : c;
      any = true;
    } else if (!quote && (c == ' ' || c == '\t' || c == '\r')) {
      if (any) words.push_back(std::move(word));
      word.clear();
      any = false;
    } else {
      word += c;
      any = true;
    }
  }
  if (quote) return std::nullopt;
  if (any) words.push_back(word);
  return words;
}

/// Takes the name out of the words, which are those of a command line: "--name NAME",
/// "--name=NAME".
std::string take_name(std::vector<std::string>& words, const std::string& from) {
  const std::string flag = std::string(2, '-') + "name";
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::string name;
    std::size_t taken = 1;
    if (words[i] == flag) {
      if (i + 1 == words.size()) throw Error(concat(from, ": ", flag, " has no name after it"));
      name = words[i + 1];
      taken = 2;
    } else if (words[i].starts_with(flag + "=")) {
      name = words[i].substr(flag.size() + 1);
    } else {
      continue;
    }
    words.erase(words.begin() + long(i), words.begin() + long(i + taken));
    return name;
  }
  return {};
}

}  // namespace

std::string FrameRange::text(int frame) const {
  std::ostringstream out;
  out << std::setw(digits) << std::setfill('0') << frame;
  return out.str();
}

std::optional<FrameRange> parse_frames(const std::string& text) {
  const char* const end = text.data() + text.size();
  FrameRange range;
  const auto first = std::from_chars(text.data(), end, range.first);
  if (first.ec != std::errc() || range.first < 0) return std::nullopt;
  range.digits = int(first.ptr - text.data());
  range.last = range.first;
  if (first.ptr != end) {
    if (*first.ptr != '-') return std::nullopt;
    const auto last = std::from_chars(first.ptr + 1, end, range.last);
    if (last.ec != std::errc() || last.ptr != end) return std::nullopt;
  }
  if (range.last < range.first || range.last - range.first >= kMostFrames) return std::nullopt;
  return range;
}

std::string with_frame(std::string text, const std::string& frame) {
  const std::string token = kFrameToken;
  for (std::size_t at = text.find(token); at != std::string::npos;
       at = text.find(token, at + frame.size()))
    text.replace(at, token.size(), frame);
  return text;
}

std::vector<Piece> pieces_of_scenes(const std::vector<std::string>& scenes) {
  std::vector<Piece> pieces;
  for (const std::string& scene : scenes)
    pieces.push_back({name_of_scene(scene), {scene}, {}, "scene " + scene});
  return pieces;
}

std::vector<Piece> read_piece_list(const fs::path& file) {
  std::ifstream in(file);
  if (!in) throw Error("the list of scenes " + file.string() + " cannot be read");
  std::vector<Piece> pieces;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::string from = concat(file.string(), " line ", number);
    std::optional<std::vector<std::string>> words = words_of(line);
    if (!words) throw Error(from + ": a quotation mark is not closed");
    if (words->empty() || words->front().starts_with('#')) continue;
    std::string name = take_name(*words, from);
    if (words->empty() || words->front().starts_with('-'))
      throw Error(concat(from, ": a line begins with a scene, and '",
                         words->empty() ? "" : words->front(), "' is none"));
    if (name.empty()) name = name_of_scene(words->front());
    pieces.push_back({name, std::move(*words), {}, from});
  }
  if (in.bad()) throw Error("reading the list of scenes " + file.string() + " failed");
  return pieces;
}

std::vector<Piece> pieces_of_frames(const std::vector<Piece>& pieces, const FrameRange& frames) {
  std::vector<Piece> out;
  std::size_t sequence = 0;
  for (const Piece& piece : pieces) {
    ++sequence;
    for (int frame = frames.first; frame <= frames.last; ++frame) {
      const std::string number = frames.text(frame);
      Piece one = piece;
      one.frame = number;
      one.sequence = sequence;
      one.name = pieces.size() == 1 ? number : piece.name + "." + number;
      for (std::string& word : one.words) word = with_frame(word, number);
      out.push_back(std::move(one));
    }
  }
  return out;
}

std::vector<Precedent> precedents(const std::vector<Piece>& pieces, int chain) {
  std::vector<Precedent> out(pieces.size());
  if (chain <= 1) return out;
  std::size_t first = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (pieces[i].frame.empty() || pieces[i].sequence != pieces[first].sequence) first = i;
    if (i == first) continue;
    out[i].rig = pieces[first].name;
    if ((i - first) % std::size_t(chain) != 0) out[i].follow = pieces[i - 1].name;
  }
  return out;
}

void check_pieces(const std::vector<Piece>& pieces) {
  if (pieces.empty())
    throw UsageError(
        concat("there is no scene: give some, or a list of them by ", option_word("list")));
  std::map<std::string, std::string> seen;
  for (const Piece& piece : pieces) {
    const bool legal = !piece.name.empty() && piece.name.front() != '.' &&
                       piece.name.find('/') == std::string::npos && piece.name.size() < 200;
    if (!legal)
      throw UsageError(concat(piece.from, ": '", piece.name,
                              "' cannot be the name of a folder; give another by ",
                              option_word("name"), " in a list of the scenes"));
    const auto [at, added] = seen.emplace(piece.name, piece.from);
    if (!added)
      throw UsageError(concat(at->second, " and ", piece.from, " are both called '", piece.name,
                              "'; give them names of their own by ", option_word("name"),
                              " in a list of the scenes"));
  }
}

}  // namespace photohull::batch
