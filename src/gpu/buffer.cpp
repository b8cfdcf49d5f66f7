#include "gpu/buffer.h"

#include <algorithm>

#include "core/error.h"
#include "core/option_word.h"
#include "gpu/buffer_pool.h"
#include "gpu/gl.h"
#include "gpu/gl_error.h"
#include "gpu/limits.h"
#include "gpu/traffic.h"

namespace photohull::gpu {
namespace {

/// What the buffer was made for: its store may be larger. An empty range is illegal in GL, an empty
/// list is not: a vector at least.
void bind_range(GLenum target, unsigned binding, unsigned id, std::size_t bytes) {
  glBindBufferRange(target, binding, id, 0, GLsizeiptr(std::max<std::size_t>(bytes, 16)));
}

}  // namespace

Buffer::Buffer(std::size_t bytes, const void* data) : id_(take_store(bytes)), bytes_(bytes) {
  if (data) write(0, bytes, data);
}

Buffer::~Buffer() {
  if (id_) give_store(id_, bytes_);
}

void Buffer::bind_storage(unsigned binding) const {
  const std::size_t most = std::size_t(current_limits().ssbo_bytes);
  if (bytes_ > most)
    throw Error(concat("a list of ", (bytes_ >> 20) + 1, " MiB is more than the ", most >> 20,
                       " MiB that this graphics device gives a kernel in one block; lower ",
                       option_word("resolution"), ", use fewer ", option_word("views"),
                       " or give another ", option_word("device")));
  bind_range(GL_SHADER_STORAGE_BUFFER, binding, id_, bytes_);
}

void Buffer::bind_uniform(unsigned binding) const {
  bind_range(GL_UNIFORM_BUFFER, binding, id_, bytes_);
}

void Buffer::write(std::size_t offset, std::size_t size, const void* data) {
  PHOTOHULL_CHECK_OP(offset + size, <=, bytes_);
  if (size == 0) return;
  glNamedBufferSubData(id_, GLintptr(offset), GLsizeiptr(size), data);
  count_upload(size);
}

void Buffer::read(std::size_t offset, std::size_t size, void* data) const {
  PHOTOHULL_CHECK_OP(offset + size, <=, bytes_);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  if (size == 0) return;
  read_store(id_, offset, size, data);
  count_download(size);
  check_gl("reading a buffer");
}

void Buffer::fill(unsigned word) {
  const std::size_t words = (bytes_ + 3) / 4;
  if (words > 0)
    glClearNamedBufferSubData(id_, GL_R32UI, 0, GLsizeiptr(4 * words), GL_RED_INTEGER,
                              GL_UNSIGNED_INT, &word);
}

}  // namespace photohull::gpu
