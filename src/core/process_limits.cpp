#include "core/process_limits.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <limits>
#include <string>
#include <thread>

#include "core/error.h"
#include "core/option_word.h"

namespace photohull {
namespace {

constexpr double kMebibyte = 1 << 20;
// What the driver, its compiler and the smallest job took beside their threads: with less, drivers
// were seen to end by a signal.
constexpr double kDevice = 160 * kMebibyte;
constexpr double kUsualStack = 8 * kMebibyte;
constexpr double kArena = 64 * kMebibyte;  // of addresses, that the allocator takes for a thread

struct Limit {
  __rlimit_resource resource;
  const char* option;  ///< of ulimit
  const char* field;   ///< of /proc/self/status: what of it is in use
  bool addresses;      ///< does what is only set aside count?
};

double bytes_in_use(const std::string& field) {
  std::ifstream status("/proc/self/status");
  std::string name;
  for (double kibibytes = 0; status >> name;) {
    if (name == field && status >> kibibytes) return 1024 * kibibytes;
    status.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return 0;
}

/// Infinity where there is none.
double soft_limit(__rlimit_resource resource) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::numeric_limits<double>::infinity();
  return double(limit.rlim_cur);
}

}  // namespace

void check_process_limits(int threads) {
  if (threads <= 0) threads = std::max(1, int(std::thread::hardware_concurrency()));
  const double given = soft_limit(RLIMIT_STACK);
  const double stack = given < std::numeric_limits<double>::infinity() ? given : kUsualStack;
  for (const Limit& limit :
       {Limit{RLIMIT_DATA, "-d", "VmData:", false}, Limit{RLIMIT_AS, "-v", "VmSize:", true}}) {
    const double may = soft_limit(limit.resource);
    const double each = stack + (limit.addresses ? kArena : 0);
    const double needs = bytes_in_use(limit.field) + kDevice + 2 * threads * each;
    if (may < needs)
      throw Error(concat("this process may take ", std::int64_t(may / kMebibyte),
                         " MiB of memory (ulimit ", limit.option,
                         "), and with the graphics device's ", threads,
                         threads == 1 ? " thread" : " threads", " it needs ",
                         std::int64_t(needs / kMebibyte), " MiB at least: raise the limit",
                         threads == 1 ? "" : concat(", or give fewer ", option_word("threads"))));
  }
}

}  // namespace photohull
