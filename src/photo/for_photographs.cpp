#include "photo/for_photographs.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <exception>
#include <mutex>

namespace photohull {
namespace {

constexpr double kPixelsTogether = 64e6;

}  // namespace

void for_photographs(std::size_t count, double pixels, const std::function<void(std::size_t)>& work,
                     const std::function<void(std::size_t)>& done) {
  const std::size_t together =
      std::size_t(std::clamp(kPixelsTogether / std::max(pixels, 1.0), 1.0, double(count) + 1));
  std::mutex mutex;
  std::size_t finished = 0, failed = count;
  std::exception_ptr failure;
  const auto one = [&](std::size_t i) {
    {
      const std::scoped_lock lock(mutex);
      if (i > failed) return;
    }
    try {
      work(i);
      const std::scoped_lock lock(mutex);
      done(++finished);
    } catch (...) {
      const std::scoped_lock lock(mutex);
      if (i < failed) failed = i, failure = std::current_exception();
    }
  };
  for (std::size_t first = 0; first < count && !failure; first += together)
    tbb::parallel_for(first, std::min(count, first + together), one);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace photohull
