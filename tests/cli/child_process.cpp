#include "child_process.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <poll.h>
#include <pty.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "support/places.h"

namespace photohull::test {
namespace {

using Clock = std::chrono::steady_clock;
using testing::HasSubstr;
using testing::Not;

/// A file descriptor that closes itself.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
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
  int fd_ = -1;
};

struct Channel {
  Descriptor ours, childs;
};

Channel open_pipe() {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return {};
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

Channel open_terminal() {
  int master = -1, slave = -1;
  winsize size{};
  size.ws_row = 25;
  size.ws_col = 100;
  if (::openpty(&master, &slave, nullptr, nullptr, &size) != 0) return {};
  ::fcntl(master, F_SETFD, FD_CLOEXEC);
  ::fcntl(slave, F_SETFD, FD_CLOEXEC);
  return {Descriptor(master), Descriptor(slave)};
}

/// In the child of a process with one thread, between fork and exec.
[[noreturn]] void become(char* const* command, const RunOptions& options, int out, int err) {
  if (options.file_size_limit) {
    const rlimit limit{*options.file_size_limit, *options.file_size_limit};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  if (options.data_limit) {
    const rlimit limit{*options.data_limit, *options.data_limit};
    ::setrlimit(RLIMIT_DATA, &limit);
  }
  if (options.cpu_seconds) {
    const rlimit limit{*options.cpu_seconds, *options.cpu_seconds};
    ::setrlimit(RLIMIT_CPU, &limit);
  }
  if (options.obeys_permissions)  // what fails for all but root, who alone needs it
    for (const int right : {CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH})
      ::prctl(PR_CAPBSET_DROP, right, 0, 0, 0);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::signal(signal, SIG_DFL);
  for (const std::string& variable : options.environment)
    ::putenv(const_cast<char*>(variable.c_str()));
  if (!options.working_folder.empty() && ::chdir(options.working_folder.c_str()) != 0) ::_exit(127);
  const int in = ::open("/dev/null", O_RDONLY);
  ::dup2(in, STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  ::execvp(command[0], command);
  ::_exit(127);
}

/// Appends what there is to read; false at the end of the stream.
bool drain(const Descriptor& from, std::string& text) {
  std::array<char, 4096> block;
  const ssize_t count = ::read(from.get(), block.data(), block.size());
  if (count <= 0) return count < 0 && errno == EINTR;  // a closed terminal reads as EIO
  text.append(block.data(), std::size_t(count));
  return true;
}

/// Would the signal end the child in a way of the child's own? Not before it has come to its main.
bool is_ready_for(int signal, pid_t child) {
  if (signal == SIGKILL) return true;
  std::ifstream status(concat("/proc/", child, "/status"));
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("SigCgt:"))
      return std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1;
  return false;
}

/// Reads both streams until the child has closed them, and signals it on the way.
void converse(pid_t child, const RunOptions& options, Channel& out, Channel& err,
              Finished& finished) {
  const auto end = Clock::now() + std::chrono::duration<double>(options.timeout_seconds);
  bool signalled = options.signal == 0;
  auto signal_time = Clock::time_point::max();
  while (out.ours.get() >= 0 || err.ours.get() >= 0) {
    std::array<pollfd, 2> ready{{{out.ours.get(), POLLIN, 0}, {err.ours.get(), POLLIN, 0}}};
    const bool soon = !signalled && signal_time - Clock::now() < std::chrono::milliseconds(100);
    const int events = ::poll(ready.data(), ready.size(), soon ? 1 : 50);
    if (events > 0 && ready[0].revents && !drain(out.ours, finished.out)) out.ours.close();
    if (events > 0 && ready[1].revents && !drain(err.ours, finished.err)) err.ours.close();
    if (!signalled && finished.err.find(options.signal_after) != std::string::npos)
      signal_time =
          std::min(signal_time,
                   Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(options.signal_delay_seconds)));
    if (!signalled && Clock::now() >= signal_time && is_ready_for(options.signal, child)) {
      ::kill(child, options.signal);
      signalled = true;
    }
    if (Clock::now() < end) continue;
    ADD_FAILURE() << "still running after " << options.timeout_seconds << " s";
    ::kill(child, SIGKILL);
    break;
  }
  if (!signalled && !options.may_end_before_signal)
    ADD_FAILURE() << "'" << options.signal_after << "' never came on standard error";
}

}  // namespace

std::vector<std::string> Finished::error_lines(const std::string& prefix) const {
  std::vector<std::string> lines;
  std::istringstream in(err);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(prefix)) lines.push_back(line);
  return lines;
}

Finished run_program(const Arguments& command, const RunOptions& options) {
  Channel out = open_pipe(), err = options.error_terminal ? open_terminal() : open_pipe();
  if (!options.output_file.empty())
    out.childs = Descriptor(::open(options.output_file.c_str(), O_WRONLY | O_CLOEXEC));
  if (options.output_closed) out.ours.close();
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) become(words.data(), options, out.childs.get(), err.childs.get());
  out.childs.close();
  err.childs.close();
  Finished finished;
  converse(child, options, out, err, finished);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status)) finished.code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) finished.signal = WTERMSIG(status);
  return finished;
}

Finished run_photohull(const Arguments& arguments, const RunOptions& options) {
  Arguments command = {test::program()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  Finished finished = run_program(command, options);
  EXPECT_EQ(finished.signal, 0) << "ended by a signal\n" << finished.err;
  EXPECT_THAT(finished.err, Not(HasSubstr("Sanitizer")));
  EXPECT_THAT(finished.err, Not(HasSubstr("runtime error:")));
  return finished;
}

}  // namespace photohull::test
