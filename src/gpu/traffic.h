// What went between the program and the device.
#pragma once

#include <cstddef>
#include <cstdint>

namespace photohull::gpu {

struct Traffic {
  std::int64_t uploads = 0, bytes_up = 0;      ///< to buffers and textures
  std::int64_t downloads = 0, bytes_down = 0;  ///< each one waits for the device
};

/// For Context: what is counted for the context that is current on this thread; null: nothing.
void set_current_traffic(Traffic* traffic);

/// Adds to the current context's.
void count_upload(std::size_t bytes);
void count_download(std::size_t bytes);

}  // namespace photohull::gpu
