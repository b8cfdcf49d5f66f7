// The progress of one of several jobs.
#pragma once

#include <set>
#include <string>

#include "core/progress.h"

namespace photohull::cli {

/// A piece's share of the progress of all; says whose stages and warnings they are.
class PieceProgress : public Progress {
 public:
  /// `weight`: of what the piece takes of the whole's progress. `own`: the sum of the weights of
  /// the stages that it announces. `said`: what other pieces have warned of, which this one need
  /// not say again, and adds to; null: all is said.
  PieceProgress(Progress& whole, std::string name, double weight, double own,
                std::set<std::string>* said = nullptr);
  void stage(const std::string& name, double weight) override;
  void update(double fraction) override;
  void warn(const std::string& message) override;
  void note(const std::string& message) override;
  /// What its stages did not use.
  void finish();

 private:
  bool is_new(const std::string& message);

  Progress& whole_;
  const std::string name_;
  double left_, scale_;
  std::set<std::string>* said_;
};

}  // namespace photohull::cli
