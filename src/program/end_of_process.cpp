// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "end_of_process.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <thread>

namespace cayspin::program {
namespace {

enum class Awaited { ended, no_status, running };

Awaited await(pid_t child, int& status, std::chrono::milliseconds longest) {
  using namespace std::chrono_literals;
  auto const deadline = std::chrono::steady_clock::now() + longest;
  for (auto pause = 50us;; pause = std::min<std::chrono::microseconds>(2 * pause, 10ms)) {
    auto const found = ::waitpid(child, &status, WNOHANG);
    if (found > 0) return Awaited::ended;
    if (found < 0 && errno != EINTR) return Awaited::no_status;
    if (std::chrono::steady_clock::now() > deadline) return Awaited::running;
    std::this_thread::sleep_for(pause);
  }
}

}  // namespace

std::optional<int> end_of_process(pid_t child, std::chrono::milliseconds longest) {
  int status = 0;
  auto awaited = await(child, status, longest);
  if (awaited == Awaited::running) {
    ::kill(child, SIGKILL);
    awaited = await(child, status, std::chrono::seconds(10));
  }
  return awaited == Awaited::ended ? std::optional(status) : std::nullopt;
}

}  // namespace cayspin::program
