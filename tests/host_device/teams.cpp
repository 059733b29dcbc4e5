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
  /// The first continue_now() calls body(pause). There, pause() returns to the caller of
  /// continue_now(), and the next continue_now() returns from pause().
  explicit Coroutine(std::function<void(std::function<void()> const&)> body)
      : body_(std::move(body)), stack_(bytes) {
    getcontext(&here_);
    here_.uc_stack.ss_sp = stack_.data();
    here_.uc_stack.ss_size = stack_.size();
    here_.uc_link = &caller_;
    makecontext(&here_, start, 0);
  }

  bool has_ended() const { return ended_; }
  void continue_now() {
    running = this;
    swapcontext(&caller_, &here_);
  }

 private:
  static constexpr std::size_t bytes = std::size_t{1} << 18;
  static inline thread_local Coroutine* running = nullptr;

  static void start() {
    Coroutine& self = *running;
    self.body_([&self] { swapcontext(&self.here_, &self.caller_); });
    self.ended_ = true;
  }

  std::function<void(std::function<void()> const&)> body_;
  std::vector<char> stack_;
  ucontext_t here_ = {}, caller_ = {};
  bool ended_ = false;
};

}  // namespace

void run_teams(int league_size, int team_size,
               std::function<void(HostDeviceTeam const&)> const& body) {
  for (int team = 0; team < league_size; ++team) {
    std::vector<std::unique_ptr<Coroutine>> threads;
    for (int rank = 0; rank < team_size; ++rank)
      threads.push_back(std::make_unique<Coroutine>([&, rank](auto const& pause) {
        body(HostDeviceTeam(team, league_size, rank, team_size, pause));
      }));
    auto const has_ended = [](auto const& thread) { return thread->has_ended(); };
    while (std::ranges::none_of(threads, has_ended))
      for (auto const& thread : threads) thread->continue_now();
    if (!std::ranges::all_of(threads, has_ended))
      Kokkos::abort("HostDevice: a thread of a team ends before a barrier of the others");
  }
}

}  // namespace cayspin::test
