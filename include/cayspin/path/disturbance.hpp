// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/minimizer/hessian.hpp>
#include <cayspin/minimizer/preconditioner.hpp>
#include <cayspin/minimizer/probe.hpp>
#include <cayspin/stepper/field_algebra.hpp>

// The disturbance with which the search for a path starts, so that the path can leave a plane of
// symmetry.
namespace cayspin::inline v0_2::detail {

template <class Real>
struct KeepMobile {
  SiteArray<Real, 3> vectors;
  SiteArray<Real, 1> is_mobile;
  OutputArray<Real, 3> output;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    site.store(Value(site.load(is_mobile)) * Vec3<Value>(site.load(vectors)), output);
  }
};

/// Writes a smooth pattern of vectors without symmetry to `disturbance`; the longest vector has
/// length 1. Overwrites `work`.
template <class Exec, class Spins>
void make_disturbance(Exec const& exec, Preconditioner<Spins>& preconditioner, Spins const& work,
                      Spins const& disturbance) {
  using Real = typename Spins::value_type;
  auto const& shape = work.lattice().shape;
  for_each_site<Real>(exec, "cayspin::path::random_signs", work.layout(),
                      RandomSigns<Real>{shape[0], shape[1], 0, 1, work.output(false)});
  preconditioner.apply(exec, work, disturbance);
  combine(exec, 1 / largest_length(exec, disturbance), disturbance, 0, disturbance, disturbance);
}

}  // namespace cayspin::inline v0_2::detail
