#include "gpu/traffic.h"

namespace photohull::gpu {
namespace {

thread_local Traffic* current = nullptr;

}  // namespace

void set_current_traffic(Traffic* traffic) { current = traffic; }

void count_upload(std::size_t bytes) {
  if (!current) return;
  ++current->uploads;
  current->bytes_up += std::int64_t(bytes);
}

void count_download(std::size_t bytes) {
  if (!current) return;
  ++current->downloads;
  current->bytes_down += std::int64_t(bytes);
}

}  // namespace photohull::gpu
