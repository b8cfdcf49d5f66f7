#include <algorithm>
#include <array>

#include "core/error.h"
#include "pipeline/methods/method.h"

namespace photohull::pipeline {

std::span<const MethodEntry> methods() {
  static const std::array entries = {
#define PHOTOHULL_METHOD(value, entry) entry,
#include "pipeline/methods/methods.def"
  };
  return entries;
}

const MethodEntry& method_of(Method method) {
  const auto entry = std::find_if(methods().begin(), methods().end(),
                                  [&](const MethodEntry& e) { return e.method == method; });
  PHOTOHULL_CHECK(entry != methods().end());
  return *entry;
}

const MethodEntry& method_of(const ReconstructOptions& options) {
  return method_of(options.effective_method());
}

const char* to_string(Method method) { return method_of(method).name; }

}  // namespace photohull::pipeline
