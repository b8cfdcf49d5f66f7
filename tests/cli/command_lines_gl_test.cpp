// Command lines that nobody would write: the seeds in tests/fuzz/seeds/command-line (a word a line)
// mutated, with options that the parser itself names. Whatever is written, the program ends with a
// known exit code and, where that is not 0, a sentence; it never crashes and leaves no half file.
#include <csignal>
#include <map>
#include <random>
#include <set>
#include <sstream>

#include "cli/commands.h"
#include "cli/lab/lab_commands.h"
#include "core/error.h"
#include "sphere_scene.h"
#include "support/effort.h"
#include "support/places.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;

/// The words of a description that may be values: "mipmap", "0.5", "auto".
Arguments words_of(const std::string& description) {
  Arguments words;
  std::string word;
  for (const char c : description + " ") {
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '+' || c == '.') {
      word += c;
      continue;
    }
    while (word.ends_with('.')) word.pop_back();
    if (!word.empty()) words.push_back(word);
    word.clear();
  }
  return words;
}

/// An option as it is written, with values that its help mentions.
struct Option {
  std::string name;
  bool takes_value = false;
  Arguments mentioned;
};

void collect(const CLI::App& app, std::vector<Option>& options) {
  for (const CLI::Option* option : app.get_options([](const CLI::Option*) { return true; })) {
    const bool takes_value = option->get_items_expected_max() > 0;
    for (const std::string& name : option->get_lnames())
      options.push_back({"--" + name, takes_value, words_of(option->get_description())});
    for (const std::string& name : option->get_snames())
      options.push_back({"-" + name, takes_value, {}});
  }
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    options.push_back({command->get_name(), false, {}});
    collect(*command, options);
  }
}

class CommandLines : public SphereScene {
 protected:
  CommandLines() {
    collect(*cli::make_parser(cli::main_commands()), options_);
    collect(*cli::make_parser(cli::lab_commands()), options_);
    fs::create_directories(path("cwd"));
    write_bytes(path("spec.json"), R"({"image": {"width": 48, "height": 40, "samples": 1},
        "cameras": {"layout": "hemisphere", "count": 4}, "truth_samples": 500})");
    write_bytes(path("plan.json"), R"({"title": "none", "scenes": []})");
    write_bytes(path("mesh.ply"),
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    for (const auto& entry :
         fs::directory_iterator(test::in_checkout("tests/fuzz/seeds/command-line")))
      seeds_[entry.path().filename()] = words_in(entry.path());
  }

  /// The words of a seed; {NAME} stands for a path in the folder of the test.
  Arguments words_in(const fs::path& seed) const {
    Arguments words;
    std::istringstream in(read_bytes(seed));
    for (std::string word; std::getline(in, word);)
      words.push_back(word == "{scene}" ? scene()
                      : word.starts_with('{') && word.ends_with('}')
                          ? path(word.substr(1, word.size() - 2))
                          : word);
    return words;
  }

  std::size_t below(std::size_t count) { return random_() % count; }
  template <typename T>
  const T& any(const std::vector<T>& items) {
    return items[below(items.size())];
  }

  std::string value_for(const Option& option) {
    static const Arguments odd = {"",
                                  "0",
                                  "-1",
                                  "1",
                                  "2",
                                  "7",
                                  "3.5",
                                  "1e999",
                                  "nan",
                                  "-inf",
                                  "0x10",
                                  "1e-300",
                                  "99999999999999999999",
                                  "a",
                                  "auto",
                                  "none",
                                  "off",
                                  "0-3",
                                  "3-1",
                                  "1,2,,3",
                                  "0,1",
                                  "0 0 0 1 1 1",
                                  "--",
                                  "-",
                                  "%s%n",
                                  "=",
                                  "\xff\xfe",
                                  "*",
                                  "../..",
                                  "1u",
                                  "16x16",
                                  "NAME=1",
                                  "NAME",
                                  "cwd",
                                  "0.5",
                                  " ",
                                  "{}"};
    if (!option.mentioned.empty() && below(2)) return any(option.mentioned);
    if (below(6) == 0)
      return any(Arguments{scene(), path("cutouts"), path("missing"), path("spec.json"),
                           path("mesh.ply"), path("plan.json"), image(0)});
    if (below(12) == 0) return std::string(1 + below(5000), char('a' + below(26)));
    return any(odd);
  }

  Arguments mutated(Arguments words) {
    for (std::size_t count = below(4); count > 0; --count) {
      const std::size_t at = below(words.size() + 1);
      const Option& option = any(options_);
      switch (below(5)) {
        case 0:
          if (at < words.size()) words.erase(words.begin() + long(at));
          break;
        case 1:
          if (at < words.size()) words[at] = value_for(option);
          break;
        case 2:
          if (at < words.size()) words.insert(words.begin() + long(at), std::string(words[at]));
          break;
        default:
          if (option.takes_value && below(8))
            words.insert(words.begin() + long(at), value_for(option));
          words.insert(words.begin() + long(at), option.name);
      }
    }
    return words;
  }

  std::set<std::string> files() const {
    std::set<std::string> found;
    for (const std::string& name : listing(scene()))
      if (fs::is_regular_file(folder_ / name)) found.insert(name);
    return found;
  }

  /// Runs a command line; `stopped` by Ctrl-C when it takes long.
  void expect_civil(const Arguments& words, bool stopped) {
    std::string shown;
    for (const std::string& word : words) shown += " '" + word.substr(0, 80) + "'";
    SCOPED_TRACE(shown);
    RunOptions options;
    options.working_folder = path("cwd");
    if (stopped) {
      options.signal = SIGINT;
      options.signal_delay_seconds = 3;
      options.may_end_before_signal = true;
    }
    options.timeout_seconds = 300;
    const std::set<std::string> before = files();
    const Finished run = run_photohull(words, options);
    EXPECT_THAT(run.code, AnyOf(0, 1, 2, 3, 130)) << run.err;
    ++ends_[run.code];
    const std::vector<std::string> lines = run.error_lines();
    const std::string last = lines.empty() ? "" : lines.back();
    EXPECT_TRUE(run.code == 0 || last.starts_with("photohull: ")) << run.err;
    const std::set<std::string> after = files();
    for (const std::string& name : after)
      EXPECT_EQ(name.find(".partial-"), std::string::npos) << name;
    EXPECT_TRUE(run.code != 2 || after == before);
  }

  std::vector<Option> options_;
  std::map<std::string, Arguments> seeds_;
  std::map<int, int> ends_;  ///< runs by exit code
  std::mt19937 random_{1};
};

TEST_F(CommandLines, SeedsEndAsTheirNamesSay) {
  ASSERT_FALSE(seeds_.empty());
  for (const auto& [name, words] : seeds_) {
    expect_civil(words, false);
    EXPECT_EQ(ends_[0], name.starts_with("fails") ? 0 : 1) << name;
    ends_.clear();
  }
}

TEST_F(CommandLines, RandomOnesEndWell) {
  std::vector<Arguments> all;
  for (const auto& [name, words] : seeds_) all.push_back(words);
  ASSERT_FALSE(all.empty());
  for (int i = 0; i < 16 * effort(); ++i) expect_civil(mutated(any(all)), true);
  EXPECT_GT(ends_[2], 0);  // or nothing was mutated
  std::string summary;
  for (const auto& [code, runs] : ends_) summary += concat(" ", runs, " with ", code);
  RecordProperty("exit_codes", summary);
  std::printf("exit codes:%s\n", summary.c_str());
}

}  // namespace
}  // namespace photohull::test
