// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include <Kokkos_Core.hpp>
#include <ucontext.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace cayspin::test {
namespace {

/// A call that others can interrupt and continue, on a stack of its own.
class Coroutine {
 public:
  using Pause = std::function<void()>;
  Coroutine() { stack_.reset(new char[bytes]); }

  /// Prepares a call. The first continue_now() calls body(pause). There, pause() returns to the
  /// caller of continue_now(), and the next continue_now() returns from pause().
  void prepare(std::function<void(Pause const&)> body) {
    body_ = std::move(body);
    ended_ = false;
    getcontext(&here_);
    here_.uc_stack.ss_sp = stack_.get();
    here_.uc_stack.ss_size = bytes;
    here_.uc_link = &caller_;
    makecontext(&here_, start, 0);
  }

  bool has_ended() const { return ended_; }
  void continue_now() {
    running = this;
    swapcontext(&caller_, &here_);
  }

 private:
  static constexpr std::size_t bytes = std::size_t{1} << 17;
  static inline thread_local Coroutine* running = nullptr;

  static void start() {
    Coroutine& self = *running;
    self.body_([&self] { swapcontext(&self.here_, &self.caller_); });
    self.ended_ = true;
  }

  std::function<void(Pause const&)> body_;
  std::unique_ptr<char[]> stack_;
  ucontext_t here_ = {}, caller_ = {};
  bool ended_ = true;
};

}  // namespace

void run_teams(int league_size, int team_size, std::size_t scratch_bytes,
               std::function<void(HostDeviceTeam const&)> const& body) {
  std::vector<Coroutine> threads(static_cast<std::size_t>(team_size));
  for (int team = 0; team < league_size; ++team) {
    // Scratch memory has no defined content at first: here it is NaN.
    std::vector<char> scratch(scratch_bytes, '\xff');
    for (int rank = 0; rank < team_size; ++rank)
      threads[static_cast<std::size_t>(rank)].prepare([&, rank](Coroutine::Pause const& pause) {
        body(HostDeviceTeam(team, league_size, rank, team_size, scratch, pause));
      });
    while (std::ranges::none_of(threads, &Coroutine::has_ended))
      for (auto& thread : threads) thread.continue_now();
    if (!std::ranges::all_of(threads, &Coroutine::has_ended))
      Kokkos::abort("HostDevice: a thread of a team ends before a barrier of the others");
  }
}

}  // namespace cayspin::test
