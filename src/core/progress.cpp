#include "core/progress.h"

#include "core/error.h"

namespace photohull {
namespace {
std::atomic<bool> cancel_flag{false};
static_assert(std::atomic<bool>::is_always_lock_free);
}  // namespace

void Progress::stage(const std::string&, double) {}
void Progress::update(double) {}
void Progress::warn(const std::string&) {}
void Progress::note(const std::string&) {}
void Progress::check_cancelled() const {
  if (cancellation_requested()) throw Cancelled();
}

void request_cancellation() { cancel_flag.store(true); }
bool cancellation_requested() { return cancel_flag.load(); }
void reset_cancellation() { cancel_flag.store(false); }

}  // namespace photohull
