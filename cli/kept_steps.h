// Which steps of a job in a folder are done, and of what.
#pragma once

#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/describe.h"

namespace photohull::cli {

/// What a step goes by, as a digest.
class StepIdentity {
 public:
  /// The program itself is part of it.
  StepIdentity();
  void add(const std::string& text);
  /// Place and content; nothing but the place of a file that cannot be read.
  void add_file(const std::filesystem::path& file);
  void add_options(const Described& described);
  std::string digest() const;

 private:
  std::ostringstream text_;
};

/// A file in the folder has the identity of each step that is done.
class KeptSteps {
 public:
  /// Reads the file, and writes it to try whether that can be done. A damaged one counts as empty.
  /// Throws Error where the folder takes no files.
  explicit KeptSteps(std::filesystem::path file);
  bool has(const std::string& step, const std::string& identity) const;
  /// Before a step begins whose results replace those that are there.
  void begin(const std::string& step);
  void done(const std::string& step, const std::string& identity);

 private:
  void write() const;
  std::filesystem::path file_;
  std::map<std::string, std::string> steps_;
};

}  // namespace photohull::cli
