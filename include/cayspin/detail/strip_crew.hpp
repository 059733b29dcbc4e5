// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/backend.hpp>

#include <atomic>
#include <cstdint>
#include <thread>

#if defined(CAYSPIN_DETAIL_X86)
#include <immintrin.h>
#endif

// Threads that work on adjacent strips, step by step. A strip waits only for its two neighbours.
namespace cayspin::inline v0_2::detail {

/// Progress of a strip: twice the number of steps done, plus one while a thread works on the next
/// step. Each StripProgress has its own cache line.
struct alignas(cache_line_bytes) StripProgress {
  std::atomic<std::int64_t> state = 0;
};

/// Crew of threads that do `steps` steps of each strip. Step n of a strip may start when its
/// neighbours have done n - apart steps. The first strip and the last are neighbours, too. Any
/// number of threads may work, in any order: a thread that waits long takes over steps of other
/// strips. `progress` has an entry for each strip, and one that counts the calls of work() that are
/// done. All entries must be 0 before the first call of work(), and are 0 after the last one.
struct StripCrew {
  StripProgress* progress;
  std::int32_t strips;
  std::int64_t steps;
  std::int32_t apart;

  /// Calls run(strip, step) until all steps of strip `own` are done. Must be called once for each
  /// strip, from any thread.
  template <class Run>
  void work(std::int32_t own, Run const& run) const {
    int waited = 0;
    while (done(own) < steps) {
      if (take(own, run)) {
        waited = 0;
      } else if (waited < patience) {
        ++waited;
        pause();
      } else if (!help(own, run)) {
        std::this_thread::yield();
      }
    }
    leave();
  }

 private:
  /// Number of pauses, a few microseconds in all, before a thread helps others. Helping moves a
  /// strip into another core's cache.
  static constexpr int patience = 256;

  std::int64_t done(std::int32_t strip) const {
    return progress[strip].state.load(std::memory_order_acquire) / 2;
  }

  /// Does the next step of a strip if it can start and no thread works on it.
  template <class Run>
  bool take(std::int32_t strip, Run const& run) const {
    auto& state = progress[strip].state;
    std::int64_t now = state.load(std::memory_order_acquire);
    std::int64_t const step = now / 2;
    if (now % 2 != 0 || step == steps) return false;
    if (done(strip > 0 ? strip - 1 : strips - 1) < step - apart) return false;
    if (done(strip + 1 < strips ? strip + 1 : 0) < step - apart) return false;
    if (!state.compare_exchange_strong(now, now + 1, std::memory_order_acquire)) return false;
    run(strip, step);
    state.store(now + 2, std::memory_order_release);
    return true;
  }

  template <class Run>
  bool help(std::int32_t own, Run const& run) const {
    for (std::int32_t i = 1; i < strips; ++i)
      if (take((own + i) % strips, run)) return true;
    return false;
  }

  // The last thread to leave clears the progress for the next use.
  void leave() const {
    if (progress[strips].state.fetch_add(1, std::memory_order_acq_rel) + 1 < strips) return;
    for (std::int32_t i = 0; i <= strips; ++i)
      progress[i].state.store(0, std::memory_order_relaxed);
  }

  static void pause() {
#if defined(CAYSPIN_DETAIL_X86)
    _mm_pause();
#endif
  }
};

}  // namespace cayspin::inline v0_2::detail
