// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "read_in_child.hpp"

#include "end_of_process.hpp"
#include "files/available_memory.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define CAYSPIN_SHADOW_MEMORY
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CAYSPIN_SHADOW_MEMORY
#endif

namespace cayspin::program {
namespace {

using Clock = std::chrono::steady_clock;

bool is_child = false;

// First byte sent by a child. After `failed` the message follows.
enum Outcome : char { survived = 's', failed = 'f', out_of_memory = 'm' };

constexpr int faults[] = {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGTRAP, SIGSYS, SIGXCPU};

void lower_limit(decltype(RLIMIT_CPU) resource, rlim_t most, rlim_t spare = 0) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0) return;
  limit.rlim_max = std::min(limit.rlim_max, most + spare);
  limit.rlim_cur = std::min(limit.rlim_cur, most);
  ::setrlimit(resource, &limit);
}

[[maybe_unused]] rlim_t address_space() {
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

// Returns the processor time in seconds that a child may take. It depends on the size of the file:
// a megabyte may decompress to a gigabyte, but not to a hundred gigabytes.
rlim_t most_seconds(std::filesystem::path const& path) {
  std::error_code error;
  auto const bytes = std::filesystem::file_size(path, error);
  if (error) return 2;
  return 2 + std::min<rlim_t>(bytes >> 18U, 60) + (bytes >> 26U);
}

// Makes a fault end the child at once without output; leaves signals of the terminal to the parent.
void settle_signals(pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  sigset_t blocked;
  sigfillset(&blocked);
  for (int const fault : faults) {
    std::signal(fault, SIG_DFL);
    sigdelset(&blocked, fault);
  }
  ::sigprocmask(SIG_SETMASK, &blocked, nullptr);
}

void limit_resources(std::filesystem::path const& path) {
  // When memory runs out, the kernel kills this child first.
  std::ofstream("/proc/self/oom_score_adj") << "1000";
#ifndef CAYSPIN_SHADOW_MEMORY
  auto const room = static_cast<rlim_t>(io::available_memory()), used = address_space();
  if (room < RLIM_INFINITY - used) lower_limit(RLIMIT_AS, used + room);
#endif
  lower_limit(RLIMIT_CPU, most_seconds(path), 5);
  lower_limit(RLIMIT_CORE, 0);
  ::prctl(PR_SET_DUMPABLE, 0);  // no core dump by a program that collects them, either
}

void send(int pipe, std::string const& text) {
  for (std::size_t sent = 0; sent < text.size();) {
    auto const count = ::write(pipe, text.data() + sent, text.size() - sent);
    if (count <= 0) return;
    sent += static_cast<std::size_t>(count);
  }
}

std::string answer(std::function<void()> const& reading) {
  try {
    reading();
  } catch (std::runtime_error const& error) {
    return std::string(1, failed) + error.what();
  } catch (std::bad_alloc const&) {
    return std::string(1, out_of_memory);
  } catch (std::length_error const&) {
    return std::string(1, out_of_memory);
  } catch (...) {  // the parent then reads the file and gets the same exception
  }
  return std::string(1, survived);
}

[[noreturn]] void read_as_child(int pipe, pid_t parent, std::filesystem::path const& path,
                                std::function<void()> const& reading) {
  is_child = true;
  settle_signals(parent);
  int const nowhere = ::open("/dev/null", O_RDWR);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  limit_resources(path);
  send(pipe, answer(reading));
  ::_exit(0);  // skips the parent's exit handlers
}

// Returns a limit on the elapsed time. It is far above the time needed with a slow disk or on a
// busy machine, so only a child that hangs reaches it.
std::chrono::seconds longest_reading(std::filesystem::path const& path) {
  return std::chrono::seconds(60 + 10 * most_seconds(path));
}

// The output of a child up to the deadline. `is_late`: the child was still running then.
struct Received {
  std::string text;
  bool is_late = false;
};

Received receive(int pipe, Clock::time_point deadline) {
  Received received;
  char buffer[4096];
  while (true) {
    auto const left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd polled{pipe, POLLIN, 0};
    auto const ready = ::poll(&polled, 1, static_cast<int>(std::clamp<long>(left, 0, 60000)));
    if (ready < 0 && errno != EINTR) return received;
    if (ready == 0 && left <= 60000) return {std::move(received.text), true};
    if (ready <= 0) continue;
    auto const count = ::read(pipe, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return received;
    received.text.append(buffer, static_cast<std::size_t>(count));
  }
}

// Returns why a child left no answer. There is no status if the calling program ignores SIGCHLD.
std::string cause_of(std::optional<int> status, bool is_late) {
  if (is_late) return "reading it takes too long";
  if (!status || !WIFSIGNALED(*status)) return "reading it fails";
  int const signal = WTERMSIG(*status);
  if (signal == SIGXCPU) return "reading it takes too long";
  return std::string("reading it ends with ") + ::strsignal(signal);
}

[[noreturn]] void throw_damaged(std::filesystem::path const& path, std::string const& cause) {
  throw std::runtime_error(path.string() + ": cannot read the file: it is damaged (" + cause + ")");
}

}  // namespace

void try_in_child(std::filesystem::path const& path, std::function<void()> const& reading) {
  try_in_child(path, reading, longest_reading(path));
}

void try_in_child(std::filesystem::path const& path, std::function<void()> const& reading,
                  std::chrono::milliseconds longest) {
  if (is_child) return;
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return;
  pid_t const parent = ::getpid(), child = ::fork();
  if (child == 0) read_as_child(ends[1], parent, path, reading);
  ::close(ends[1]);
  if (child < 0) {  // if no process can be started, the file is read without a trial
    ::close(ends[0]);
    return;
  }
  auto const [text, is_late] = receive(ends[0], Clock::now() + longest);
  ::close(ends[0]);
  if (is_late) ::kill(child, SIGKILL);
  auto const status = end_of_process(child);
  if (is_late || text.empty()) throw_damaged(path, cause_of(status, is_late));
  if (text[0] == failed) throw std::runtime_error(text.substr(1));
  if (text[0] == out_of_memory) throw_damaged(path, "reading it takes more memory than there is");
}

}  // namespace cayspin::program
