// Progress reports and cancellation, handed down to every long stage.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <utility>

namespace photohull {

/// Asks jobs to stop. Copies are the same token. Safe to use from several threads and, once made,
/// in signal handlers.
class CancellationToken {
 public:
  void cancel() const { flag_->store(true); }
  bool cancelled() const { return flag_->load(); }
  /// As if nothing had been asked for: for the next job.
  void reset() const { flag_->store(false); }

 private:
  static_assert(std::atomic<bool>::is_always_lock_free);
  std::shared_ptr<std::atomic<bool>> flag_ = std::make_shared<std::atomic<bool>>(false);
};

/// The token of progress that is given none: what Ctrl-C is for a program as a whole.
const CancellationToken& process_cancellation();

/// Receives the job's progress. The default one is silent. Implementations may be called often.
class Progress {
 public:
  Progress() : Progress(process_cancellation()) {}
  explicit Progress(CancellationToken token) : token_(std::move(token)) {}
  virtual ~Progress() = default;
  /// A stage begins; `weight` is its expected share of the job in arbitrary units.
  virtual void stage(const std::string& name, double weight);
  /// Share of the current stage done, in [0, 1].
  virtual void update(double fraction);
  virtual void warn(const std::string& message);
  /// Something worth knowing that is no fault.
  virtual void note(const std::string& message);
  bool cancelled() const { return token_.cancelled(); }
  /// Throws Cancelled once cancellation was asked for; stages call it at safe points.
  void check_cancelled() const;
  /// For work that is to stop with this and reports nothing.
  const CancellationToken& token() const { return token_; }

 private:
  CancellationToken token_;
};

}  // namespace photohull
