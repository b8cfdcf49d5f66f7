// Progress that keeps the warnings which pass through it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/progress.h"

namespace photohull::pipeline {

class RecordingProgress : public Progress {
 public:
  /// `to` gets all of it, and outlives this.
  explicit RecordingProgress(Progress& to) : Progress(to.token()), to_(to) {}

  void stage(const std::string& name, double weight) override { to_.stage(name, weight); }
  void update(double fraction) override { to_.update(fraction); }
  void warn(const std::string& message) override {
    warnings_.push_back(message);
    to_.warn(message);
  }
  void note(const std::string& message) override { to_.note(message); }

  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  Progress& to_;
  std::vector<std::string> warnings_;
};

}  // namespace photohull::pipeline
