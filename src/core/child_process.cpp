#include "core/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>

#include "core/error.h"

namespace photohull {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kMaxOutput = 256u << 20, kKeptErrors = 4096;
constexpr int kCheckEveryMs = 50;

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor() { close(); }
  int get() const { return fd_; }
  void close() {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }

 private:
  int fd_;
};

struct Pipe {
  Descriptor read, write;
  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0)
      throw Error(concat("a process cannot be started: ", std::strerror(errno)));
    read = Descriptor(ends[0]);
    write = Descriptor(ends[1]);
  }
};

/// In the child, between fork and exec: system calls only.
[[noreturn]] void become(const char* program, char* const* words, pid_t parent, int out, int err,
                         int failure) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) ::signal(signal, SIG_DFL);
  const int in = ::open("/dev/null", O_RDONLY);
  ::dup2(in, STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  ::execvp(program, words);
  const int reason = errno;
  if (::write(failure, &reason, sizeof reason) < 0) ::_exit(126);
  ::_exit(127);
}

/// The child; killed with its group unless it was waited for.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid), watch_(int(::syscall(SYS_pidfd_open, pid, 0))) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (pid_ <= 0) return;
    kill();
    rusage usage;
    wait(usage);
  }
  int watch() const { return watch_.get(); }
  void kill() const {
    ::kill(-pid_, SIGKILL);
    ::kill(pid_, SIGKILL);
  }
  int wait(rusage& usage) {
    int status = 0;
    while (::wait4(pid_, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    ::kill(-pid_, SIGKILL);  // what it left running
    pid_ = 0;
    return status;
  }

 private:
  pid_t pid_;
  Descriptor watch_;
};

/// Appends what there is to read, without waiting; closes the stream at its end.
void drain(Descriptor& from, std::string& text, const Listener& listener) {
  std::array<char, 65536> block;
  while (from.get() >= 0) {
    const ssize_t count = ::read(from.get(), block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) return;
    if (count <= 0) return from.close();
    text.append(block.data(), std::size_t(count));
    if (listener) listener({block.data(), std::size_t(count)});
  }
}

/// Reads both streams until the child has ended or the time is up; true when it is up.
bool converse(const Child& child, Pipe& out, Pipe& err, Clock::time_point end, Finished& finished,
              const Progress& progress, const Listener& listener) {
  for (;;) {
    progress.check_cancelled();
    std::array<pollfd, 3> ready{
        {{child.watch(), POLLIN, 0}, {out.read.get(), POLLIN, 0}, {err.read.get(), POLLIN, 0}}};
    ::poll(ready.data(), ready.size(), kCheckEveryMs);
    drain(out.read, finished.out, listener);
    drain(err.read, finished.err, listener);
    if (finished.err.size() > 16 * kKeptErrors)
      finished.err.erase(0, finished.err.size() - kKeptErrors);
    if (finished.out.size() > kMaxOutput)
      throw Error(concat("a run printed more than ", kMaxOutput >> 20, " MiB"));
    if (ready[0].revents) return false;
    if (Clock::now() >= end) return true;
  }
}

double seconds(const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); }

void check_started(const std::filesystem::path& program, Pipe& failure) {
  failure.write.close();
  int reason = 0;
  ssize_t count;
  while ((count = ::read(failure.read.get(), &reason, sizeof reason)) < 0 && errno == EINTR) {
  }
  if (count == ssize_t(sizeof reason))
    throw Error(concat(program.string(), ": cannot be started: ", std::strerror(reason)));
}

}  // namespace

Finished run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                   double time_limit_seconds, const Progress& progress, const Listener& listener) {
  Pipe out, err, failure;
  std::vector<char*> words;
  std::string name = program.string();
  words.push_back(name.data());
  for (const std::string& a : arguments) words.push_back(const_cast<char*>(a.c_str()));
  words.push_back(nullptr);
  const pid_t parent = ::getpid();
  const auto start = Clock::now();
  const pid_t pid = ::fork();
  if (pid < 0) throw Error(concat("a process cannot be started: ", std::strerror(errno)));
  if (pid == 0)
    become(program.c_str(), words.data(), parent, out.write.get(), err.write.get(),
           failure.write.get());
  ::setpgid(pid, pid);  // whoever is first
  Child child(pid);
  if (child.watch() < 0) throw Error(concat("a process cannot be watched: ", std::strerror(errno)));
  out.write.close();
  err.write.close();
  check_started(program, failure);
  for (const int fd : {out.read.get(), err.read.get()}) ::fcntl(fd, F_SETFL, O_NONBLOCK);
  Finished finished;
  const auto limit = std::chrono::duration<double>(std::min(time_limit_seconds, 1e8));
  finished.timed_out =
      converse(child, out, err, start + std::chrono::duration_cast<Clock::duration>(limit),
               finished, progress, listener);
  if (finished.timed_out) child.kill();
  rusage usage{};
  const int status = child.wait(usage);
  finished.wall_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  drain(out.read, finished.out, listener);
  drain(err.read, finished.err, listener);
  if (finished.err.size() > kKeptErrors) finished.err.erase(0, finished.err.size() - kKeptErrors);
  if (WIFEXITED(status)) finished.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) finished.signal = WTERMSIG(status);
  finished.user_seconds = seconds(usage.ru_utime);
  finished.system_seconds = seconds(usage.ru_stime);
  finished.peak_memory_bytes = std::int64_t(usage.ru_maxrss) * 1024;
  return finished;
}

bool is_on_path(const std::string& program) {
  const char* stated = std::getenv("PATH");
  std::istringstream folders(stated ? stated : "/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path file =
        std::filesystem::path(folder.empty() ? "." : folder) / program;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(file, ignored) && ::access(file.c_str(), X_OK) == 0)
      return true;
  }
  return false;
}

}  // namespace photohull
