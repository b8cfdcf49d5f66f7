#include "job.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace photohull::python {
namespace py = pybind11;
namespace {

constexpr auto kLookEvery = std::chrono::milliseconds(50);

struct Event {
  std::string stage;
  double fraction = 0;  // of the job
  std::optional<std::string> message;
};

/// Keeps what a job reports until the caller's thread takes it.
class QueuedProgress : public Progress {
 public:
  QueuedProgress(CancellationToken token, double total_weight)
      : Progress(std::move(token)), total_weight_(std::max(total_weight, 1e-9)) {}

  void stage(const std::string& name, double weight) override {
    const std::lock_guard lock(mutex_);
    done_ += weight_;
    weight_ = weight;
    stage_ = name;
    add(0, std::nullopt);
  }
  void update(double fraction) override {
    const std::lock_guard lock(mutex_);
    // Of updates that nobody has taken yet the last one says it all.
    if (!events_.empty() && !events_.back().message && events_.back().stage == stage_)
      events_.pop_back();
    add(fraction, std::nullopt);
  }
  void warn(const std::string& message) override { say(message); }
  void note(const std::string& message) override { say(message); }

  /// The whole job is done, whatever stages it left out.
  void finish() {
    const std::lock_guard lock(mutex_);
    events_.push_back({stage_, 1, std::nullopt});
  }

  std::vector<Event> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(events_, {});
  }

 private:
  void say(const std::string& message) {
    const std::lock_guard lock(mutex_);
    add(fraction_, message);
  }
  void add(double fraction, std::optional<std::string> message) {
    fraction_ = fraction;
    const double share = (done_ + weight_ * std::clamp(fraction, 0.0, 1.0)) / total_weight_;
    events_.push_back({stage_, std::min(share, 1.0), std::move(message)});
  }

  std::mutex mutex_;
  const double total_weight_;
  double done_ = 0, weight_ = 0, fraction_ = 0;
  std::string stage_;
  std::vector<Event> events_;
};

/// The work, in a thread of its own.
class Worker {
 public:
  Worker(const std::function<void(Progress&)>& work, Progress& progress)
      : thread_([this, &work, &progress] { run(work, progress); }) {}
  ~Worker() { thread_.join(); }

  /// Waits a moment. Has it ended?
  bool wait() {
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, kLookEvery, [&] { return has_ended_; });
  }
  /// What it threw; to be asked for when it has ended.
  std::exception_ptr failure() const { return failure_; }

 private:
  void run(const std::function<void(Progress&)>& work, Progress& progress) {
    try {
      work(progress);
    } catch (...) {
      failure_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
    ended_.notify_one();
  }

  std::mutex mutex_;
  std::condition_variable ended_;
  bool has_ended_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

void tell(const py::object& callback, const std::vector<Event>& events) {
  if (callback.is_none()) return;
  for (const Event& event : events) callback(event.stage, event.fraction, event.message);
}

}  // namespace

void run_job(const py::object& callback, double total_weight,
             const std::function<void(Progress&)>& work) {
  const CancellationToken token;
  QueuedProgress progress(token, total_weight);
  std::exception_ptr raised;
  {
    Worker worker(work, progress);
    for (bool ended = false; !ended;) {
      {
        const py::gil_scoped_release free;
        ended = worker.wait();
      }
      if (raised) continue;
      try {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        tell(callback, progress.take());
      } catch (const py::error_already_set&) {
        raised = std::current_exception();
        token.cancel();
      }
    }
    if (!raised) raised = worker.failure();
  }
  if (raised) std::rethrow_exception(raised);
  progress.finish();
  tell(callback, progress.take());
}

}  // namespace photohull::python
