#include "gpu/buffer.h"

#include <algorithm>

#include "core/error.h"
#include "core/option_word.h"
#include "gpu/gl.h"
#include "gpu/gl_error.h"
#include "gpu/limits.h"
#include "gpu/traffic.h"

namespace photohull::gpu {

Buffer::Buffer(std::size_t bytes, const void* data) : bytes_(bytes) {
  glCreateBuffers(1, &id_);
  // A zero-sized store is illegal in GL, an empty list is not: keep at least one vector.
  glNamedBufferStorage(id_, GLsizeiptr(std::max<std::size_t>(bytes, 16)),
                       bytes >= 16 ? data : nullptr, GL_DYNAMIC_STORAGE_BIT);
  const unsigned error = pending_error();
  if (error != GL_NO_ERROR) {
    glDeleteBuffers(1, &id_);
    throw_gl_error(error, concat("a buffer of ", bytes >> 20, " MiB"));
  }
  if (data && bytes >= 16) count_upload(bytes);
  if (data && bytes > 0 && bytes < 16) write(0, bytes, data);
}

Buffer::~Buffer() {
  if (id_) glDeleteBuffers(1, &id_);
}

void Buffer::bind_storage(unsigned binding) const {
  const std::size_t most = std::size_t(current_limits().ssbo_bytes);
  if (bytes_ > most)
    throw Error(concat("a list of ", (bytes_ >> 20) + 1, " MiB is more than the ", most >> 20,
                       " MiB that this graphics device gives a kernel in one block; lower ",
                       option_word("resolution"), ", use fewer ", option_word("views"),
                       " or give another ", option_word("device")));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id_);
}

void Buffer::bind_uniform(unsigned binding) const {
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, id_);
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
  glGetNamedBufferSubData(id_, GLintptr(offset), GLsizeiptr(size), data);
  count_download(size);
  check_gl("reading a buffer");
}

void Buffer::fill(unsigned word) {
  glClearNamedBufferData(id_, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &word);
}

}  // namespace photohull::gpu
