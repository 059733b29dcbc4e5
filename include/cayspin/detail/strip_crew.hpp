// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/backend.hpp>

#include <atomic>
#include <cstdint>
#include <thread>

#if defined(CAYSPIN_DETAIL_X86)
#include <immintrin.h>
#endif

// Threads that work side by side, step by step, each on a strip. A strip waits for its two
// neighbours alone.
namespace cayspin::inline v0_1::detail {

/// Twice the steps that a strip has done, and one more while a thread is at the next. In a place
/// of its own in the cache.
struct alignas(cache_line_bytes) StripProgress {
  std::atomic<std::int64_t> state = 0;
};

/// Does `steps` steps of each strip. Step n of a strip begins when its neighbours have done
/// n - apart steps. The first strip and the last are neighbours, too. Any number of threads does
/// the work, in any order: one that has to wait for long takes the steps of others. `progress` has
/// a place more than there are strips, and is 0 before and after.
struct StripCrew {
  StripProgress* progress;
  std::int32_t strips;
  std::int64_t steps;
  std::int32_t apart;

  /// Calls run(strip, step). Every strip has to call this once, from any thread. Returns when
  /// strip `own` is done.
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
  /// Some microseconds: helping moves a strip into the cache of another core.
  static constexpr int patience = 256;

  std::int64_t done(std::int32_t strip) const {
    return progress[strip].state.load(std::memory_order_acquire) / 2;
  }

  /// Does the next step of a strip, if it can begin and nobody is at it.
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

  // The last to leave clears the progress for the next time: by then all others are gone.
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

}  // namespace cayspin::inline v0_1::detail
