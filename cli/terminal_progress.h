// Progress on the terminal: a bar with the time left, or plain lines where standard error is no
// terminal, or one without escape sequences (TERM=dumb), or NO_COLOR is set.
#pragma once

#include <chrono>
#include <string>

#include "core/progress.h"

namespace photohull::cli {

class TerminalProgress : public Progress {
 public:
  /// `total_weight` is the sum of the stages' weights to come.
  explicit TerminalProgress(double total_weight);
  ~TerminalProgress() override;
  void stage(const std::string& name, double weight) override;
  void update(double fraction) override;
  void warn(const std::string& message) override;
  void note(const std::string& message) override;
  /// Ends the bar's line.
  void finish();

 private:
  void draw(double fraction);
  void clear_line();

  std::chrono::steady_clock::time_point start_, drawn_;
  double total_, done_ = 0, weight_ = 0;
  std::string name_;
  bool terminal_, open_line_ = false;
};

}  // namespace photohull::cli
