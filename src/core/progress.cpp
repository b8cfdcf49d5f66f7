#include "core/progress.h"

#include "core/error.h"

namespace photohull {

const CancellationToken& process_cancellation() {
  static const CancellationToken token;
  return token;
}

void Progress::stage(const std::string&, double) {}
void Progress::update(double) {}
void Progress::warn(const std::string&) {}
void Progress::note(const std::string&) {}
void Progress::check_cancelled() const {
  if (cancelled()) throw Cancelled();
}

}  // namespace photohull
