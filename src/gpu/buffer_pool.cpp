#include "gpu/buffer_pool.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>

#include "core/error.h"
#include "gpu/gl.h"
#include "gpu/gl_error.h"

namespace photohull::gpu {
namespace {

constexpr std::size_t kLeast = 256;                        // bytes of a store
constexpr std::size_t kMostKept = std::size_t(64) << 20;   // bytes of all that are kept
constexpr std::size_t kMostStaged = std::size_t(4) << 20;  // bytes that are read at once

using Store = BufferPool::Store;

thread_local BufferPool* used = nullptr;

/// One of few sizes, at most a quarter more, for what can be kept.
std::size_t capacity_of(std::size_t bytes) {
  if (bytes > kMostKept) return bytes;  // will not be kept
  const std::size_t least = std::max(bytes, kLeast), step = std::bit_floor(least) / 4;
  return (least + step - 1) / step * step;
}

/// 0 where the device cannot hold it, for the reason that is pending.
unsigned make_store(std::size_t bytes, unsigned flags, unsigned& error) {
  unsigned id = 0;
  glCreateBuffers(1, &id);
  glNamedBufferStorage(id, GLsizeiptr(bytes), nullptr, flags);
  error = pending_error();
  if (error == GL_NO_ERROR) return id;
  glDeleteBuffers(1, &id);
  return 0;
}

unsigned make_store(std::size_t bytes, unsigned flags) {
  unsigned error = GL_NO_ERROR;
  unsigned id = make_store(bytes, flags, error);
  if (id == 0 && error == GL_OUT_OF_MEMORY && used && !used->kept.empty()) {
    empty_buffer_pool();
    id = make_store(bytes, flags, error);
  }
  if (id == 0) throw_gl_error(error, concat("a buffer of ", bytes >> 20, " MiB"));
  return id;
}

/// Makes it one of at least `bytes`, mapped.
void make_staging(BufferPool& pool, std::size_t bytes) {
  if (pool.staging.bytes >= bytes) return;
  constexpr unsigned kMap = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  if (pool.staging.id) glDeleteBuffers(1, &pool.staging.id);
  pool.staging = {};
  bytes = std::bit_ceil(bytes);
  const unsigned id = make_store(bytes, kMap | GL_CLIENT_STORAGE_BIT);
  pool.staging = {id, bytes};
  pool.mapped = glMapNamedBufferRange(id, 0, GLsizeiptr(bytes), kMap);
  check_gl("a buffer that results are read from");
}

}  // namespace

void set_current_pool(BufferPool* pool) { used = pool; }

bool is_current(const BufferPool& pool) { return used == &pool; }

void empty_buffer_pool() {
  if (!used) return;
  for (const Store& store : used->kept) glDeleteBuffers(1, &store.id);
  if (used->staging.id) glDeleteBuffers(1, &used->staging.id);
  *used = {};
}

unsigned take_store(std::size_t bytes) {
  const std::size_t capacity = capacity_of(bytes);
  if (!used) return make_store(capacity, GL_DYNAMIC_STORAGE_BIT);
  // The last one that was used is the likeliest to be in the caches.
  std::deque<Store>& kept = used->kept;
  const auto found = std::find_if(kept.rbegin(), kept.rend(),
                                  [&](const Store& store) { return store.bytes == capacity; });
  if (found == kept.rend()) return make_store(capacity, GL_DYNAMIC_STORAGE_BIT);
  const unsigned id = found->id;
  kept.erase(std::next(found).base());
  used->bytes -= capacity;
  return id;
}

void give_store(unsigned id, std::size_t bytes) {
  const std::size_t capacity = capacity_of(bytes);
  if (!used || capacity > kMostKept) {
    glDeleteBuffers(1, &id);
    return;
  }
  used->kept.push_back({id, capacity});
  used->bytes += capacity;
  for (; used->bytes > kMostKept; used->kept.pop_front()) {
    used->bytes -= used->kept.front().bytes;
    glDeleteBuffers(1, &used->kept.front().id);
  }
}

void read_store(unsigned id, std::size_t offset, std::size_t size, void* data) {
  if (!used) {
    glGetNamedBufferSubData(id, GLintptr(offset), GLsizeiptr(size), data);
    return;
  }
  make_staging(*used, std::min(size, kMostStaged));
  for (std::size_t done = 0; done < size;) {
    const std::size_t part = std::min(size - done, used->staging.bytes);
    glCopyNamedBufferSubData(id, used->staging.id, GLintptr(offset + done), 0, GLsizeiptr(part));
    glFinish();
    std::memcpy(static_cast<char*>(data) + done, used->mapped, part);
    done += part;
  }
}

}  // namespace photohull::gpu
