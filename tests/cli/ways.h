// Ways to go wrong, as ways_to_go_wrong.json lists them: what is done, and what must be said.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace photohull::test {

/// A mistake and the answer to it. Texts name folders as {scene}, {out} and, of both, {folder};
/// patterns stand for measured numbers by {number} and for any other text by {text}.
struct Way {
  std::string group, title;
  nlohmann::json scene;                ///< what differs from the sound scene's spec
  std::vector<nlohmann::json> damage;  ///< damaged_scenes.h
  std::string before;                  ///< command line that runs first, and ends well
  std::string run;                     ///< the command line, words as a shell splits them
  nlohmann::json with;                 ///< the surroundings (surroundings_of in ways.cpp)
  int code = 0;
  std::vector<std::string> says;    ///< patterns of the first lines on standard error
  std::vector<std::string> prints;  ///< patterns of lines on standard output, in this order
};

/// What a run said, with the folders' names in braces.
struct Heard {
  bool possible = true;  ///< false where this machine cannot arrange the way's surroundings
  int code = -1;
  std::vector<std::string> says;    ///< standard error without lines of progress
  std::vector<std::string> prints;  ///< standard output
};

std::vector<Way> read_ways();
Heard try_way(const Way& way);

bool fits(const std::string& pattern, const std::string& text);

/// The lines of `heard` that the way's patterns speak of, standard error first; fewer where some
/// pattern fits none.
std::vector<std::string> told(const Way& way, const Heard& heard);

/// A row of the document's table, of lines that were heard or of patterns.
std::string document_row(const Way& way, const std::vector<std::string>& lines);
/// All of the document's tables; `lines` in the order of the ways.
std::string document_tables(const std::vector<Way>& ways,
                            const std::vector<std::vector<std::string>>& lines);

}  // namespace photohull::test
