// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>

namespace cayspin::inline v0_2::detail {

/// Functor that swaps the numbers of two fields.
template <class Array, class Output>
struct ExchangeNumbers {
  Array a, b;
  Output to_a, to_b;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    auto const of_a = site.load(a), of_b = site.load(b);
    site.store(of_b, to_a);
    site.store(of_a, to_b);
  }
};

/// Guard that returns the spins to their original memory. Steps may swap this memory with memory of
/// `worker`, for example a stepper. The destructor, which also runs after an exception, then swaps
/// the numbers back, so that copies of the field and arrays obtained from it see the spins. This
/// takes one pass over the sites, and waits. The destructor does nothing if the spins are in their
/// original memory.
///
/// `worker.visit_exchanged(visit)` calls visit(field) for each field that may be swapped.
template <class Exec, class Worker, class Spins>
class CallersMemory {
 public:
  CallersMemory(Exec const& exec, Worker& worker, Spins& spins)
      : exec_(exec), worker_(worker), spins_(spins), callers_(spins) {}
  CallersMemory(CallersMemory const&) = delete;
  CallersMemory& operator=(CallersMemory const&) = delete;

  ~CallersMemory() {
    if (is_same(spins_, callers_)) return;
    worker_.visit_exchanged([this](Spins& field) {
      if (is_same(field, callers_)) field = spins_;
    });
    for_each_site<typename Spins::value_type>(
        exec_, "cayspin::callers_memory", spins_.layout(),
        ExchangeNumbers<typename Spins::array_type, decltype(spins_.output(false))>{
            spins_.array(), callers_.array(), spins_.output(false), callers_.output(false)});
    exec_.fence("cayspin::callers_memory");
    spins_ = callers_;
  }

 private:
  static bool is_same(Spins const& a, Spins const& b) {
    return a.allocation().data() == b.allocation().data();
  }

  Exec const& exec_;
  Worker& worker_;
  Spins& spins_;
  Spins callers_;
};

}  // namespace cayspin::inline v0_2::detail
