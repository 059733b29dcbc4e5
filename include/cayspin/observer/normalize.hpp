// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/scalars.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/step.hpp>

#include <locale>
#include <sstream>
#include <stdexcept>

namespace cayspin::inline v0_2 {

namespace detail {

template <class Real>
struct NewtonNormalize {
  SiteArray<Real, 3> spins;
  OutputArray<Real, 3> output;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    auto const m = site.load(spins);
    using Value = typename decltype(m)::value_type;
    // Written as m plus a small change: if this is below the rounding error, m keeps its bits.
    Value const half_excess = Value(0.5) * (Value(1) - dot(m, m));
    site.store(multiply_add(half_excess, m, m), output);
  }
};

}  // namespace detail

/// Takes one Newton step towards |m| = 1 for every spin, m <- m * (3 - m.m) / 2, without a root or
/// a division: a length of 1 + d becomes 1 - 1.5 * d^2, to leading order. Repeated calls converge
/// to 1 from lengths between 0 and sqrt(3); non-finite spins stay non-finite.
template <class Exec, class Real, class MemorySpace>
void normalize(Exec const& exec, SpinField<Real, MemorySpace> const& spins) {
  detail::check_access<Exec, MemorySpace>();
  detail::require_sites("cayspin::normalize", spins.sites());
  detail::for_each_site<Real>(exec, "cayspin::normalize", spins.layout(),
                              detail::NewtonNormalize<Real>{spins.array(), spins.output(false)});
}

/// Throws std::invalid_argument when a spin's length differs from 1 by more than `tolerance`, or is
/// not a number; waits. The default accepts spins rounded to single precision. Call it for your own
/// spins before a run: steppers preserve the lengths that they are given.
template <class Exec, class Real, class MemorySpace>
void require_unit_spins(Exec const& exec, SpinField<Real, MemorySpace> const& spins,
                        double tolerance = 1e-6) {
  double const defect = norm_defect(exec, spins);
  if (defect <= tolerance) return;
  std::ostringstream message;
  message.imbue(std::locale::classic());
  message
      << "cayspin::require_unit_spins: the spins must be of length 1, and the largest | |m| - 1 "
         "| is "
      << defect << "; cayspin::normalize corrects small deviations";
  throw std::invalid_argument(message.str());
}

/// Observer that calls normalize, for runs so long that round-off in |m| accumulates:
/// integrate(..., Every(1000, Normalize{})). Does not compile with an AdaptiveStepper.
struct Normalize {
  static constexpr bool changes_spins = true;

  template <class Exec, class Spins>
  void operator()(Exec const& exec, Step const&, Spins const& spins) const {
    normalize(exec, spins);
  }
};

}  // namespace cayspin::inline v0_2
