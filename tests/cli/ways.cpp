#include "ways.h"

#include <sys/mount.h>

#include <csignal>
#include <memory>
#include <optional>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "child_process.h"
#include "core/folder_lock.h"
#include "damaged_scenes.h"
#include "sphere_scene.h"
#include "support/places.h"
#include "support/scratch_folder.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at))
    text.replace(at, from.size(), to), at += to.size();
}

struct Names {
  std::string folder;

  /// With the real folders in place of {scene}, {out} and {folder}.
  std::string filled(std::string text) const {
    replace_all(text, "{scene}", folder + "/scene");
    replace_all(text, "{out}", folder + "/out");
    replace_all(text, "{folder}", folder);
    return text;
  }
  std::string blanked(std::string text) const {
    replace_all(text, folder + "/scene", "{scene}");
    replace_all(text, folder + "/out", "{out}");
    replace_all(text, folder, "{folder}");
    return text;
  }
};

/// As a shell does, with single quotes.
Arguments split(const std::string& line) {
  Arguments words;
  bool quoted = false, open = false;
  for (const char c : line) {
    if (c == '\'') {
      quoted = !quoted;
      if (!open) words.emplace_back();
      open = true;
    } else if (c == ' ' && !quoted) {
      open = false;
    } else {
      if (!open) words.emplace_back();
      open = true;
      words.back() += c;
    }
  }
  return words;
}

std::vector<std::string> lines_of(const std::string& text) {
  static const std::regex progress("^\\[ *[0-9.]+ s\\] .*");
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (!std::regex_match(line, progress)) lines.push_back(line);
  }
  return lines;
}

/// A disk of its own at a folder, as small as it says.
class SmallDisk {
 public:
  SmallDisk(fs::path folder, const std::string& size) : folder_(std::move(folder)) {
    fs::create_directories(folder_);
    mounted_ = ::mount("tmpfs", folder_.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0;
  }
  ~SmallDisk() {
    if (mounted_) ::umount(folder_.c_str());
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  bool is_there() const { return mounted_; }

 private:
  fs::path folder_;
  bool mounted_ = false;
};

RunOptions surroundings_of(const Way& way) {
  RunOptions options;
  options.obeys_permissions = true;
  options.timeout_seconds = 60;
  for (const auto& [name, value] : way.with.items()) {
    if (name == "standard output") {
      if (value == "a closed pipe")
        options.output_closed = true;
      else
        options.output_file = value;
    } else if (name == "terminal") {
      options.error_terminal = value;
    } else if (name == "environment") {
      options.environment = value.get<std::vector<std::string>>();
    } else if (name == "most bytes of a file") {
      options.file_size_limit = value.get<rlim_t>();
    } else if (name == "most bytes of memory") {
      options.data_limit = value.get<rlim_t>();
    } else if (name == "interrupted after") {
      options.signal = SIGINT;
      options.signal_after = value;
    } else if (name != "disk of" && name != "at work in") {
      throw std::runtime_error("there are no surroundings called " + name);
    }
  }
  return options;
}

Way read_way(const json& j, const std::string& group) {
  Way way;
  way.group = group;
  way.title = j.at("title");
  way.scene = j.value("scene", json::object());
  way.damage = j.value("damage", std::vector<json>{});
  way.before = j.value("before", "");
  way.run = j.at("run");
  way.with = j.value("with", json::object());
  way.code = j.at("code");
  way.says = j.value("says", std::vector<std::string>{});
  way.prints = j.value("prints", std::vector<std::string>{});
  return way;
}

/// Folders as they are called in the document, and what would end a cell.
std::string shown(std::string text) {
  replace_all(text, "{scene}", "SCENE");
  replace_all(text, "{out}", "OUT");
  replace_all(text, "{folder}", "FOLDER");
  replace_all(text, "|", "\\|");
  return "`" + text + "`";
}

}  // namespace

std::vector<Way> read_ways() {
  const json all = json::parse(read_bytes(test::in_checkout("tests/cli/ways_to_go_wrong.json")));
  std::vector<Way> ways;
  for (const json& group : all.at("groups"))
    for (const json& way : group.at("ways")) ways.push_back(read_way(way, group.at("name")));
  return ways;
}

Heard try_way(const Way& way) {
  const ScratchFolder scratch;
  const Names names{(scratch / "").parent_path().string()};
  fs::copy(sound_scene(way.scene), scratch / "scene", fs::copy_options::recursive);
  const auto run = [&](const std::string& line, const RunOptions& options) {
    return run_photohull(split(names.filled(line)), options);
  };
  for (const json& mistake : way.damage) damage(scratch / "", mistake);
  if (!way.before.empty()) {
    const Finished first = run(way.before, {});
    if (first.code != 0) throw std::runtime_error(way.before + ": " + first.err);
  }
  std::optional<SmallDisk> disk;
  if (way.with.contains("disk of")) disk.emplace(scratch / "out", way.with["disk of"]);
  std::optional<FolderLock> lock;
  if (way.with.contains("at work in")) lock.emplace(names.filled(way.with["at work in"]), "out");
  Heard heard;
  heard.possible = !disk || disk->is_there();
  const Finished finished = run(way.run, surroundings_of(way));
  heard.code = finished.code;
  heard.says = lines_of(names.blanked(finished.err));
  heard.prints = lines_of(names.blanked(finished.out));
  for (const fs::path& closed : {scratch / "scene", scratch / "out"})  // for the folder to go
    if (fs::exists(closed)) fs::permissions(closed, fs::perms::owner_all);
  return heard;
}

bool fits(const std::string& pattern, const std::string& text) {
  static const std::regex special(R"([.^$|()\[\]{}*+?\\])");
  std::string expression = std::regex_replace(pattern, special, "\\$&");
  replace_all(expression, "\\{number\\}", "-?[0-9.]+(e[-+]?[0-9]+)?");
  replace_all(expression, "\\{text\\}", ".*");
  return std::regex_match(text, std::regex(expression));
}

std::vector<std::string> told(const Way& way, const Heard& heard) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < way.says.size() && i < heard.says.size(); ++i)
    if (fits(way.says[i], heard.says[i])) lines.push_back(heard.says[i]);
  std::size_t next = 0;
  for (const std::string& pattern : way.prints)
    for (; next < heard.prints.size(); ++next)
      if (fits(pattern, heard.prints[next])) {
        lines.push_back(heard.prints[next++]);
        break;
      }
  return lines;
}

std::string document_row(const Way& way, const std::vector<std::string>& lines) {
  std::string said;
  for (const std::string& line : lines) said += (said.empty() ? "" : "<br>") + shown(line);
  if (said.empty()) said = "nothing";
  return "| " + way.title + " | " + shown(way.run) + " | " + said + " | " +
         std::to_string(way.code) + " |";
}

std::string document_tables(const std::vector<Way>& ways,
                            const std::vector<std::vector<std::string>>& lines) {
  std::string text, group;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (ways[i].group != group) {
      group = ways[i].group;
      text +=
          "\n## " + group +
          "\n\n| what went wrong | photohull ... | what is said | exit code |\n|---|---|---|---|\n";
    }
    text += document_row(ways[i], lines[i]) + "\n";
  }
  return text;
}

}  // namespace photohull::test
