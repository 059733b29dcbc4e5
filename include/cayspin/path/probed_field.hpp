// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/minimizer/preconditioner.hpp>
#include <cayspin/minimizer/probe.hpp>
#include <cayspin/path/saddle.hpp>
#include <cayspin/spin_field.hpp>

#include <algorithm>
#include <cstdint>

namespace cayspin::inline v0_2::detail {

/// Measurements of a field that searches for saddles need, from a few evaluations. Copies share the
/// memory.
template <class Spins>
struct ProbedField {
  using Real = typename Spins::value_type;

  /// `spins`: tells which sites are occupied.
  template <class Exec, class Field>
  ProbedField(Exec const& exec, Field const& field, Spins const& spins, double time,
              bool preconditioned)
      : is_mobile("path::is_mobile", spins.lattice()) {
    Spins const work("path::pattern", spins.lattice());
    Kokkos::deep_copy(exec, is_mobile.allocation(), Real(0));
    auto const found = probe(exec, field, time, spins, work, is_mobile);
    evaluations = found.evaluations;
    strongest = found.strongest();
    preconditioner.set(spins.lattice(), found, preconditioned);
  }

  /// Returns the options of one climb to a saddle.
  SaddleSearchOptions climb(double time, double torque, std::int64_t evaluations_left) const {
    constexpr std::int64_t most = 2000;
    return {.time = time,
            .torque = torque,
            .scale = preconditioner.first_shift(),
            .strongest_field = strongest,
            .evaluations = std::clamp<std::int64_t>(evaluations_left, 1, most)};
  }

  ScalarField<Real, typename Spins::memory_space> is_mobile;
  Preconditioner<Spins> preconditioner;
  double strongest = 0;  // strongest field seen
  std::int64_t evaluations = 0;
};

}  // namespace cayspin::inline v0_2::detail
