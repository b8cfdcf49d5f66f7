// Private to module gpu: stores of buffers, kept for those that come next.
#pragma once

#include <cstddef>
#include <deque>

namespace photohull::gpu {

/// What a context keeps. Its members are buffer_pool.cpp's.
struct BufferPool {
  struct Store {
    unsigned id = 0;
    std::size_t bytes = 0;
  };
  std::deque<Store> kept;        ///< of deleted buffers, the longest unused first
  std::size_t bytes = 0;         ///< of these
  Store staging;                 ///< through which results are read
  const void* mapped = nullptr;  ///< that one, in the host's memory
};

/// For Context: where this thread keeps stores; null: nowhere.
void set_current_pool(BufferPool* pool);
/// Is it the one that is current on this thread?
bool is_current(const BufferPool& pool);
/// Deletes what the current one keeps.
void empty_buffer_pool();

/// A buffer that holds `bytes` at least, of undefined content. Throws Error when the device cannot
/// hold it.
unsigned take_store(std::size_t bytes);
/// Takes back what take_store gave for as many bytes.
void give_store(unsigned id, std::size_t bytes);

/// Copies a part of a buffer to the host by way of a store that lies in the host's memory: read
/// directly, drivers move the buffer itself there, where kernels are slow to reach it.
void read_store(unsigned id, std::size_t offset, std::size_t size, void* data);

}  // namespace photohull::gpu
