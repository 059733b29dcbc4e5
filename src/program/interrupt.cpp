// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "progress.hpp"

#include <csignal>

namespace cayspin::program {
namespace {

std::sig_atomic_t volatile requested = 0;

extern "C" void request_interrupt(int signal) {
  requested = 1;
  std::signal(signal, SIG_DFL);  // a second signal kills the program
}

}  // namespace

void catch_signals() {
  std::signal(SIGINT, request_interrupt);
  std::signal(SIGTERM, request_interrupt);
#if defined(SIGXFSZ)
  std::signal(SIGXFSZ, SIG_IGN);
#endif
}

bool interrupt_requested() { return requested != 0; }

}  // namespace cayspin::program
