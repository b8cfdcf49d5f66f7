// Preloaded into the program under test (LD_PRELOAD), this library makes system and OpenGL calls
// fail as the environment says:
//
//   PHOTOHULL_FAULT=CALL:WHAT:FIRST:LAST:FOLDER
//
// CALL is open, read, write, rename, unlink, sync or mkdir, of files below FOLDER, or gl
// (glGetError) or reset (glGetGraphicsResetStatus). The calls from number FIRST to LAST, counted
// from 1, fail with the error number WHAT, or for gl and reset return it; -1 makes reads legally
// short, -2 is an early end of the file, -3 kills the process. PHOTOHULL_FAULT_COUNT names a file
// that gets the number of calls in the end.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

constexpr long kShort = -1, kEnd = -2, kKill = -3;

struct Fault {
  char call[16] = "", folder[PATH_MAX] = "";
  long what = 0, first = 0, last = 0;
};

const Fault& fault() {
  static const Fault parsed = [] {
    Fault f;
    if (const char* text = std::getenv("PHOTOHULL_FAULT"))
      std::sscanf(text, "%15[^:]:%ld:%ld:%ld:%4000[^\n]", f.call, &f.what, &f.first, &f.last,
                  f.folder);
    return f;
  }();
  return parsed;
}

std::atomic<long> calls{0};

bool is_below(const char* path) {
  return path && std::strncmp(path, fault().folder, std::strlen(fault().folder)) == 0;
}

bool is_below(int descriptor) {
  char link[64], path[PATH_MAX];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const long length = ::syscall(SYS_readlink, link, path, sizeof path - 1);
  if (length < 0) return false;
  path[length] = 0;
  return is_below(path);
}

/// Counts a call of that kind; true when it is one of those to fail.
bool strikes() {
  const long number = ++calls;
  const bool strike = number >= fault().first && number <= fault().last;
  if (strike && fault().what == kKill) ::kill(::getpid(), SIGKILL);
  return strike;
}

template <typename File>
bool strikes(const char* call, File file) {
  return std::strcmp(fault().call, call) == 0 && is_below(file) && strikes();
}

bool strikes(const char* call) { return std::strcmp(fault().call, call) == 0 && strikes(); }

template <typename Function>
Function next(const char* name, Function) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

/// What the next call of a read returns: the real call with so many bytes, or a failure.
template <typename Call>
ssize_t damaged_read(size_t bytes, const Call& call) {
  if (fault().what == kEnd) return 0;
  if (fault().what == kShort) return call(std::max<size_t>(1, bytes / 2));
  errno = int(fault().what);
  return -1;
}

int failed() {
  errno = int(fault().what);
  return -1;
}

mode_t mode_of(int flags, va_list arguments) {
  return flags & (O_CREAT | O_TMPFILE) ? mode_t(va_arg(arguments, int)) : 0;
}

struct WriteCount {
  ~WriteCount() {
    const char* file = std::getenv("PHOTOHULL_FAULT_COUNT");
    if (!file) return;
    const int out = int(::syscall(SYS_openat, AT_FDCWD, file, O_WRONLY | O_CREAT | O_TRUNC, 0666));
    char text[32];
    const int length = std::snprintf(text, sizeof text, "%ld", calls.load());
    if (::syscall(SYS_write, out, text, length) < 0) std::abort();
    ::syscall(SYS_close, out);
  }
} write_count;

}  // namespace

#define NEXT(name) static const auto real = next(#name, &name)

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  NEXT(open);
  return strikes("open", path) ? failed() : real(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  NEXT(open64);
  return strikes("open", path) ? failed() : real(path, flags, mode);
}

FILE* fopen(const char* path, const char* mode) {
  NEXT(fopen);
  return strikes("open", path) ? (failed(), nullptr) : real(path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  NEXT(fopen64);
  return strikes("open", path) ? (failed(), nullptr) : real(path, mode);
}

ssize_t read(int file, void* data, size_t bytes) {
  NEXT(read);
  if (!strikes("read", file)) return real(file, data, bytes);
  return damaged_read(bytes, [&](size_t less) { return real(file, data, less); });
}

ssize_t pread64(int file, void* data, size_t bytes, off64_t at) {
  NEXT(pread64);
  if (!strikes("read", file)) return real(file, data, bytes, at);
  return damaged_read(bytes, [&](size_t less) { return real(file, data, less, at); });
}

// A short count of this one means an error or the end, so there are no legally short ones.
size_t fread(void* data, size_t size, size_t count, FILE* file) {
  NEXT(fread);
  if (fault().what == kShort || !strikes("read", ::fileno(file)))
    return real(data, size, count, file);
  errno = fault().what > 0 ? int(fault().what) : 0;
  return 0;
}

// A disk that fills up takes a part of it first.
ssize_t write(int file, const void* data, size_t bytes) {
  NEXT(write);
  if (!strikes("write", file)) return real(file, data, bytes);
  if (fault().what == ENOSPC && calls == fault().first && bytes > 1)
    return real(file, data, bytes / 2);
  return failed();
}

ssize_t writev(int file, const iovec* parts, int count) {
  NEXT(writev);
  return strikes("write", file) ? failed() : real(file, parts, count);
}

int rename(const char* from, const char* to) {
  NEXT(rename);
  return strikes("rename", from) ? failed() : real(from, to);
}

int unlink(const char* path) {
  NEXT(unlink);
  return strikes("unlink", path) ? failed() : real(path);
}

int fsync(int file) {
  NEXT(fsync);
  return strikes("sync", file) ? failed() : real(file);
}

int mkdir(const char* path, mode_t mode) {
  NEXT(mkdir);
  return strikes("mkdir", path) ? failed() : real(path, mode);
}

unsigned glGetError() {
  NEXT(glGetError);
  return strikes("gl") ? unsigned(fault().what) : real();
}

unsigned glGetGraphicsResetStatus() {
  NEXT(glGetGraphicsResetStatus);
  return strikes("reset") ? unsigned(fault().what) : real();
}

}  // extern "C"
