// Work on many photographs, several of them at a time.
#pragma once

#include <cstddef>
#include <functional>

namespace photohull {

/// Calls work(i) for every i below `count`, by all threads, for as many photographs at a time as
/// have 64 million pixels together (`pixels`: of each; one at least). Calls done(n) whenever n of
/// them are done, never two calls at once. Throws what work(i) throws, of those that throw for the
/// least i.
void for_photographs(
    std::size_t count, double pixels, const std::function<void(std::size_t)>& work,
    const std::function<void(std::size_t)>& done = [](std::size_t) {});

}  // namespace photohull
