// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "child.hpp"

#include "program/end_of_process.hpp"
#include "simulation/failure.hpp"
#include "simulation/text.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>
#if defined(__linux__)
#include <sys/prctl.h>
#endif

#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>

namespace cayspin::program::sweep {
namespace {

constexpr std::size_t most_text = 4096;

using Pipe = std::array<int, 2>;

Pipe open_pipe() {
  Pipe ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw simulation::UsageError(fmt::format("cannot start a run: {}", std::strerror(errno)));
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  return ends;
}

// Runs after the fork: nothing here allocates.
[[noreturn]] void become(char* const* words, Pipe const& output, Pipe const& errors, pid_t parent) {
  // Leaves the terminal's process group; the parent passes an interrupt on once.
  ::setpgid(0, 0);
#if defined(__linux__)
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
#endif
  ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
  ::dup2(output[1], STDOUT_FILENO);
  ::dup2(errors[1], STDERR_FILENO);
  ::execv("/proc/self/exe", words);
  ::_exit(127);
}

}  // namespace

Child::Child(std::vector<std::string> const& arguments, bool many) {
  std::vector<char*> words{const_cast<char*>("cayspin")};
  for (auto const& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  if (many) ::setenv("OMP_PROC_BIND", "false", 1);
  auto const output = open_pipe(), errors = open_pipe();
  auto const parent = ::getpid();
  process_ = ::fork();
  if (process_ == 0) become(words.data(), output, errors, parent);
  ::close(output[1]);
  ::close(errors[1]);
  streams_ = {output[0], errors[0]};
  if (process_ < 0)
    throw simulation::UsageError(fmt::format("cannot start a run: {}", std::strerror(errno)));
}

Child::~Child() {
  for (int const stream : streams_)
    if (stream >= 0) ::close(stream);
  if (process_ <= 0) return;
  ::kill(process_, SIGKILL);
  end_of_process(process_);
}

void Child::add_to(std::vector<pollfd>& polled) const {
  for (int const stream : streams_)
    if (stream >= 0) polled.push_back({stream, POLLIN, 0});
}

void Child::read() {
  for (std::size_t which = 0; which < streams_.size(); ++which) {
    auto& stream = streams_[which];
    auto& text = texts_[which];
    std::array<char, 4096> piece{};
    while (stream >= 0) {
      auto const count = ::read(stream, piece.data(), piece.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0 && errno == EAGAIN) break;
      if (count > 0) {
        text.append(piece.data(), static_cast<std::size_t>(count));
        continue;
      }
      ::close(stream);
      stream = -1;
    }
  }
  // Only the last whole line of the output counts.
  auto& output = texts_[0];
  if (auto const end = output.find_last_of('\n'); end != output.npos) {
    auto const before = end == 0 ? output.npos : output.find_last_of('\n', end - 1);
    auto const begin = before == output.npos ? 0 : before + 1;
    double step = 0, steps = 0;
    auto const* const last = output.data() + end;
    auto const [blank, error] = std::from_chars(output.data() + begin, last, step);
    if (error == std::errc() && blank != last &&
        std::from_chars(blank + 1, last, steps).ec == std::errc() && steps > 0)
      share_ = step / steps;
    output.erase(0, end + 1);
  }
  for (auto& text : texts_)
    if (text.size() > most_text) text.erase(0, text.size() - most_text);
}

int Child::wait() {
  // The streams are closed, but a crash may still be writing a core. If the system keeps no status,
  // the file tells whether the run is complete.
  int const status = end_of_process(process_, std::chrono::minutes(1)).value_or(0);
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void Child::send(int signal) const {
  if (process_ > 0) ::kill(process_, signal);
}

std::string Child::message() const {
  auto text = texts_[1];
  while (text.ends_with('\n')) text.pop_back();
  auto const before = text.find_last_of('\n');
  return simulation::one_line(before == text.npos ? text : text.substr(before + 1));
}

}  // namespace cayspin::program::sweep
