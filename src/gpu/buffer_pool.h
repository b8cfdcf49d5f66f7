// Private to module gpu: stores of buffers, kept for those that come next.
#pragma once

#include <cstddef>

namespace photohull::gpu {

/// Makes this thread keep the stores of deleted buffers, for the context that is current on it; so
/// does Context. What an earlier context left is forgotten.
void start_buffer_pool();
/// Deletes what is kept, and keeps nothing more.
void end_buffer_pool();
/// Deletes what is kept.
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
