#include "io/ffmpeg.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/option_word.h"

namespace photohull::io {
namespace {

constexpr const char* kProgram = "ffmpeg";
constexpr int kCheckEveryMs = 50;
constexpr std::size_t kMostSaid = 4096;  // bytes of its messages that are read
constexpr std::size_t kMostLine = 300;   // bytes of a line that is repeated

/// The last line that says something.
std::string last_line(const std::string& text) {
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);) {
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.pop_back();
    if (!line.empty() && line != "Conversion failed!") last = line;
  }
  if (last.size() > kMostLine) last.resize(kMostLine);
  return last;
}

}  // namespace

Ffmpeg::Ffmpeg(std::filesystem::path target, const std::vector<std::string>& words,
               const Progress& progress)
    : target_(std::move(target)), progress_(progress) {
  std::array<int, 2> ends{-1, -1};
  messages_ = ::memfd_create("ffmpeg", MFD_CLOEXEC);
  // A socket and no pipe: a program that has ended must not end this one by SIGPIPE.
  if (messages_ < 0 || ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    const int reason = errno;
    if (messages_ >= 0) ::close(messages_);
    throw Error(concat(kProgram, " cannot be started: ", std::strerror(reason)));
  }
  input_ = ends[1];
  ::fcntl(input_, F_SETFL, O_NONBLOCK);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_adddup2(&actions, messages_, STDERR_FILENO);
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);  // out of Ctrl-C's reach
  ::posix_spawnattr_setpgroup(&attributes, 0);
  std::vector<std::string> all = {kProgram,   "-hide_banner", "-loglevel", "error",
                                  "-nostdin", "-xerror",      "-y"};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& word : all) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const int failure =
      ::posix_spawnp(&child_, kProgram, &actions, &attributes, pointers.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::posix_spawnattr_destroy(&attributes);
  ::close(ends[0]);
  if (failure == 0) return;
  ::close(input_);
  ::close(messages_);
  if (failure == ENOENT)
    throw Error(concat(target_.string(), ": films are written by the program ", kProgram,
                       ", which is not installed; install the package ", kProgram, ", or give ",
                       option_word("turntable", "NAME_%04d.png"), " for a PNG file each picture"));
  throw Error(
      concat(target_.string(), ": ", kProgram, " cannot be started: ", std::strerror(failure)));
}

Ffmpeg::~Ffmpeg() {
  end_now();
  ::close(messages_);
}

void Ffmpeg::end_now() {
  if (input_ >= 0) ::close(std::exchange(input_, -1));
  if (child_ <= 0) return;
  ::kill(child_, SIGKILL);
  while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
  child_ = 0;
}

void Ffmpeg::fail(int status) {
  std::string said(kMostSaid, '\0');
  const off_t size = ::lseek(messages_, 0, SEEK_END);
  const off_t from = size > off_t(kMostSaid) ? size - off_t(kMostSaid) : 0;
  const ssize_t count = ::pread(messages_, said.data(), said.size(), from);
  said.resize(count > 0 ? std::size_t(count) : 0);
  const std::string line = last_line(said);
  const std::string how = WIFSIGNALED(status) ? concat("signal ", WTERMSIG(status), " ended it")
                                              : concat("its exit code is ", WEXITSTATUS(status));
  throw Error(concat("cannot write ", target_.string(), ": ", kProgram, " failed (",
                     line.empty() ? how : line, "); check the disk and the name, or give ",
                     option_word("turntable", "NAME_%04d.png"), " for a PNG file each picture."));
}

int Ffmpeg::wait() {
  int status = 0;
  for (;;) {
    const pid_t ended = ::waitpid(child_, &status, WNOHANG);
    if (ended == child_ || (ended < 0 && errno != EINTR)) break;
    progress_.check_cancelled();
    ::usleep(1000 * kCheckEveryMs / 5);
  }
  child_ = 0;
  return status;
}

void Ffmpeg::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    progress_.check_cancelled();
    const ssize_t written = ::send(input_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (written > 0) {
      bytes = bytes.subspan(std::size_t(written));
    } else if (written < 0 && errno == EAGAIN) {
      pollfd ready{input_, POLLOUT, 0};
      ::poll(&ready, 1, kCheckEveryMs);
    } else if (written < 0 && errno != EINTR) {
      ::close(std::exchange(input_, -1));
      fail(wait());
    }
  }
}

void Ffmpeg::finish() {
  ::close(std::exchange(input_, -1));
  const int status = wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail(status);
}

}  // namespace photohull::io
