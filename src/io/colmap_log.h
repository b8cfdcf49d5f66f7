// What COLMAP prints while it works. Internal to io.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "core/progress.h"

namespace photohull::io {

/// Takes what COLMAP (3.6 to 3.12) prints, in pieces, and makes progress of it.
class ColmapLog {
 public:
  ColmapLog(std::size_t photographs, Progress& progress)
      : photographs_(photographs), progress_(progress) {}

  void hear(std::string_view piece);
  /// A command of COLMAP has ended.
  void end_command();

  struct Heard {
    int features = -1;
    std::string problem;  ///< why there are none
  };
  const std::map<std::string, Heard>& images() const { return images_; }
  const std::string& text() const { return text_; }
  /// The last lines that say something, as one, of what was heard from `begin` on.
  std::string last_lines(std::size_t begin) const;

 private:
  void end_line();
  void take(std::string_view line);

  std::size_t photographs_;
  Progress& progress_;
  std::string text_, line_, image_;
  std::map<std::string, Heard> images_;
};

}  // namespace photohull::io
