// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "worker.hpp"

#include "program/end_of_process.hpp"
#include "program/progress.hpp"
#include "simulation/command_line.hpp"
#include "simulation/failure.hpp"
#include "simulation/kokkos_settings.hpp"
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
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>

namespace cayspin::program::sweep {
namespace {

constexpr std::size_t most_text = 4096;
// After each command the worker prints a line that consists of this word and the exit status.
constexpr std::string_view end_word = "end ";

using Pipe = std::array<int, 2>;

Pipe open_pipe() {
  Pipe ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw simulation::UsageError(fmt::format("cannot start a run: {}", std::strerror(errno)));
  return ends;
}

// Turns a forked child into a worker. Must not allocate memory, because it runs between fork and
// exec.
[[noreturn]] void become(char* const* words, Pipe const& requests, Pipe const& output,
                         Pipe const& errors, pid_t parent) {
  // Leaves the terminal's process group, so that an interrupt comes only once, from the parent.
  ::setpgid(0, 0);
#if defined(__linux__)
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
#endif
  ::dup2(requests[0], STDIN_FILENO);
  ::dup2(output[1], STDOUT_FILENO);
  ::dup2(errors[1], STDERR_FILENO);
  ::execv("/proc/self/exe", words);
  ::_exit(127);
}

// Reads a request: words, each followed by a zero byte, and one more zero byte. Returns false if
// the other end has closed.
bool read_request(std::vector<std::string>& words) {
  words.clear();
  std::string word;
  for (int c = std::getchar(); c != EOF; c = std::getchar()) {
    if (c != 0) {
      word += static_cast<char>(c);
    } else if (word.empty()) {
      return true;
    } else {
      words.push_back(std::exchange(word, {}));
    }
  }
  return false;
}

}  // namespace

Worker::Worker(WorkerOptions const& options) {
  auto space = options.space,
       threads = options.threads ? std::to_string(*options.threads) : std::string();
  std::string word = worker_word;
  std::array<char*, 5> words{const_cast<char*>("cayspin"), word.data(), space.data(),
                             threads.data(), nullptr};
  if (options.is_one_of_many) ::setenv("OMP_PROC_BIND", "false", 1);
  auto const requests = open_pipe(), output = open_pipe(), errors = open_pipe();
  auto const parent = ::getpid();
  process_ = ::fork();
  if (process_ == 0) become(words.data(), requests, output, errors, parent);
  ::close(requests[0]);
  ::close(output[1]);
  ::close(errors[1]);
  requests_ = requests[1];
  streams_ = {output[0], errors[0]};
  for (int const stream : streams_) ::fcntl(stream, F_SETFL, O_NONBLOCK);
  if (process_ < 0)
    throw simulation::UsageError(fmt::format("cannot start a run: {}", std::strerror(errno)));
}

Worker::~Worker() {
  for (int const stream : {requests_, streams_[0], streams_[1]})
    if (stream >= 0) ::close(stream);
  if (process_ <= 0) return;
  ::kill(process_, SIGKILL);
  end_of_process(process_);
}

void Worker::begin(std::vector<std::string> const& arguments) {
  status_.reset();
  share_ = 0;
  texts_ = {};
  std::string request;
  for (auto const& argument : arguments) request += argument + '\0';
  request += '\0';
  // If the process has ended, the write fails. Then has_ended() becomes true, because the streams
  // are closed.
  auto const before = std::signal(SIGPIPE, SIG_IGN);
  for (std::size_t sent = 0; sent < request.size();) {
    auto const count = ::write(requests_, request.data() + sent, request.size() - sent);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    sent += static_cast<std::size_t>(count);
  }
  std::signal(SIGPIPE, before);
}

void Worker::add_to(std::vector<pollfd>& polled) const {
  for (int const stream : streams_)
    if (stream >= 0) polled.push_back({stream, POLLIN, 0});
}

void Worker::read(std::size_t which) {
  auto& stream = streams_[which];
  std::array<char, 4096> piece{};
  while (stream >= 0) {
    auto const count = ::read(stream, piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EAGAIN) break;
    if (count > 0) {
      texts_[which].append(piece.data(), static_cast<std::size_t>(count));
      continue;
    }
    ::close(stream);
    stream = -1;
  }
}

void Worker::read() {
  read(0);
  // Errors are read after the output, so that they include all that was written before the line
  // that ends a command.
  read(1);
  auto& output = texts_[0];
  for (auto end = output.find('\n'); end != output.npos; end = output.find('\n')) {
    take_line(std::string_view(output).substr(0, end));
    output.erase(0, end + 1);
  }
  for (auto& text : texts_)
    if (text.size() > most_text) text.erase(0, text.size() - most_text);
}

void Worker::take_line(std::string_view line) {
  auto const* const last = line.data() + line.size();
  if (line.starts_with(end_word)) {
    int status = 0;
    if (std::from_chars(line.data() + end_word.size(), last, status).ec == std::errc())
      status_ = status;
    return;
  }
  double step = 0, steps = 0;
  auto const [blank, error] = std::from_chars(line.data(), last, step);
  if (error == std::errc() && blank != last &&
      std::from_chars(blank + 1, last, steps).ec == std::errc() && steps > 0)
    share_ = step / steps;
}

int Worker::status() {
  if (status_) return *status_;
  // The streams are closed, but a crash may still be writing a core. If the system keeps no status,
  // the file tells whether the run is complete.
  int const status = end_of_process(process_, std::chrono::minutes(1)).value_or(0);
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void Worker::stop(int signal) {
  if (requests_ >= 0) ::close(std::exchange(requests_, -1));
  if (process_ > 0) ::kill(process_, signal);
}

std::string Worker::message() const {
  auto text = texts_[1];
  while (text.ends_with('\n')) text.pop_back();
  auto const before = text.find_last_of('\n');
  return simulation::one_line(before == text.npos ? text : text.substr(before + 1));
}

int work(std::string const& space, std::string const& threads, int (*perform)(int, char**)) {
  catch_signals();
  std::optional<int> count;
  if (!threads.empty()) count = std::stoi(threads);
  simulation::KokkosSession const kokkos(space, count, {});
  std::vector<std::string> words;
  while (!interrupt_requested() && read_request(words)) {
    std::string name = "cayspin";
    std::vector<char*> arguments{name.data()};
    for (auto& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    int const status = simulation::perform_and_report(
        perform, static_cast<int>(arguments.size()) - 1, arguments.data());
    std::fflush(stderr);
    fmt::print("{}{}\n", end_word, status);
    std::fflush(stdout);
  }
  return interrupt_requested() ? simulation::Status::interrupted : simulation::Status::done;
}

}  // namespace cayspin::program::sweep
