// Progress reports and cancellation, handed down to every long stage.
#pragma once

#include <atomic>
#include <string>

namespace photohull {

/// Receives the job's progress. The default one is silent. Implementations may be called often.
class Progress {
 public:
  virtual ~Progress() = default;
  /// A stage begins; `weight` is its expected share of the job in arbitrary units.
  virtual void stage(const std::string& name, double weight);
  /// Share of the current stage done, in [0, 1].
  virtual void update(double fraction);
  virtual void warn(const std::string& message);
  /// Something worth knowing that is no fault.
  virtual void note(const std::string& message);
  /// Throws Cancelled once cancellation was asked for; stages call it at safe points.
  void check_cancelled() const;
};

/// Set by the signal handler; async-signal-safe.
void request_cancellation();
bool cancellation_requested();
void reset_cancellation();  ///< for tests

}  // namespace photohull
