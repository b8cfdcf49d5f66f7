#include "gpu/limits.h"

#include <charconv>
#include <sstream>

#include "core/error.h"

namespace photohull::gpu {
namespace {

thread_local const Limits* current = nullptr;

template <typename T>
void lower(T& limit, std::int64_t value) {
  limit = T(std::min<std::int64_t>(limit, value));
}

}  // namespace

Limits lowered(const Limits& limits, const std::string& text) {
  Limits out = limits;
  std::istringstream list(text);
  for (std::string entry; std::getline(list, entry, ',');) {
    const std::size_t equals = std::min(entry.find('='), entry.size());
    const std::string name = entry.substr(0, equals);
    const char* end = entry.data() + entry.size();
    std::int64_t value = 0;
    const auto [last, problem] =
        std::from_chars(entry.data() + std::min(equals + 1, entry.size()), end, value);
    const bool number = problem == std::errc() && last == end && value > 0;
    if (number && name == "groups") {
      for (std::int64_t& along : out.groups) lower(along, value);
    } else if (number && name == "block") {
      lower(out.ssbo_bytes, value);
    } else if (number && name == "size") {
      lower(out.texture_size, value);
    } else if (number && name == "layers") {
      lower(out.texture_layers, value);
    } else {
      throw UsageError(concat(kLimitsVariable, ": ", entry,
                              ": expected groups=, block=, size= or layers= and a positive number, "
                              "with commas between them"));
    }
  }
  return out;
}

const Limits& current_limits() {
  PHOTOHULL_CHECK(current != nullptr);
  return *current;
}

void set_current_limits(const Limits* limits) { current = limits; }

std::size_t batch_size(std::size_t item_bytes, std::size_t most, std::size_t multiple,
                       std::size_t fixed_bytes) {
  const std::size_t block = std::size_t(current_limits().ssbo_bytes);
  std::size_t count = block > fixed_bytes ? (block - fixed_bytes) / item_bytes : 0;
  count = std::min(count, most);
  if (count > multiple) count -= count % multiple;
  return std::max<std::size_t>(count, 1);
}

}  // namespace photohull::gpu
