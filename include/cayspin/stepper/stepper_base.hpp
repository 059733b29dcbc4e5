// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/lattice.hpp>

#include <Kokkos_Profiling_ScopedRegion.hpp>

#include <stdexcept>
#include <string>
#include <utility>

namespace cayspin::detail {

/// What every stepper begins a step with: static checks, the profiling region, run-time checks.
template <class Spins>
class StepperBase {
 public:
  using spins_type = Spins;
  using Real = typename Spins::value_type;

 protected:
  explicit StepperBase(std::string const& name) : region_("cayspin::" + name) {}

  std::string label(char const* stage) const { return region_ + stage; }

  /// The region lasts as long as what is returned. `like`: a field of the stepper's lattice.
  template <class Exec>
  [[nodiscard]] Kokkos::Profiling::ScopedRegion begin_step(Exec const& exec, Spins const& spins,
                                                           Spins const& like) const {
    return begin_step(exec, spins, like.lattice());
  }
  template <class Exec>
  [[nodiscard]] Kokkos::Profiling::ScopedRegion begin_step(Exec const&, Spins const& spins,
                                                           Lattice const& lattice) const {
    check_access<Exec, typename Spins::memory_space>();
    if (!(spins.lattice() == lattice))
      throw std::invalid_argument(region_ + "::step: the spins are not of the stepper's lattice");
    return Kokkos::Profiling::ScopedRegion(region_);
  }

 private:
  std::string region_;
};

}  // namespace cayspin::detail
