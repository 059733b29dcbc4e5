// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/memory.hpp>
#include <cayspin/detail/strip_crew.hpp>
#include <cayspin/detail/sweep_plan.hpp>

#include <cstddef>
#include <string>

namespace cayspin::inline v0_1::detail {

/// The memory of a sweep beside fields; none at first.
template <class Real, class MemorySpace>
class SweepBuffers {
 public:
  SweepBuffers() = default;
  /// `label` begins the labels of the memory.
  SweepBuffers(std::string const& label, SweepPlan const& plan)
      : numbers_(Kokkos::view_alloc(Kokkos::WithoutInitializing, label + "::buffers"), plan.size()),
        progress_(label + "::progress", progress_size(plan)) {
    advise_huge_pages(numbers_.data(), numbers_.size() * sizeof(Real));
    for_each_task(typename MemorySpace::execution_space(), label + "::fill_buffers", plan.tasks(),
                  plan.layout.sites(), FillSweepBuffers<Real>{numbers_.data(), plan});
  }

  std::size_t bytes() const {
    return numbers_.size() * sizeof(Real) + progress_.size() * sizeof(StripProgress);
  }
  static std::size_t bytes(SweepPlan const& plan) {
    return plan.size() * sizeof(Real) + progress_size(plan) * sizeof(StripProgress);
  }

  template <class Loop>
  void set(Loop& loop) const {
    loop.memory = numbers_.data();
    loop.progress = progress_.data();
  }

 private:
  static std::size_t progress_size(SweepPlan const& plan) {
    return plan.strips == 1 ? 0 : static_cast<std::size_t>(plan.parts() * (plan.strips + 1));
  }

  Kokkos::View<Real*, MemorySpace> numbers_;
  Kokkos::View<StripProgress*, MemorySpace> progress_;
};

}  // namespace cayspin::inline v0_1::detail
