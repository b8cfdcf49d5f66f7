#include "version.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.h"
#include "gpu/context.h"
#include "photohull_commit.h"

namespace photohull::cli {
namespace {

using nlohmann::ordered_json;

/// PHOTOHULL_LIBRARIES: "NAME VERSION,NAME VERSION...".
ordered_json libraries() {
  ordered_json out = ordered_json::object();
  std::istringstream list(PHOTOHULL_LIBRARIES);
  for (std::string entry; std::getline(list, entry, ',');)
    out[entry.substr(0, entry.find(' '))] = entry.substr(entry.find(' ') + 1);
  return out;
}

ordered_json device() {
  try {
    const auto context = gpu::Context::create("auto");
    return {{"renderer", context->device().renderer}, {"opengl", context->device().version}};
  } catch (const Error&) {
    return nullptr;
  }
}

}  // namespace

std::string version_json() {
  const ordered_json out = {{"version", PHOTOHULL_VERSION},
                            {"commit", PHOTOHULL_COMMIT},
                            {"libraries", libraries()},
                            {"device", device()}};
  return out.dump(2) + "\n";
}

}  // namespace photohull::cli
