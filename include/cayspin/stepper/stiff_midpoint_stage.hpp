// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/narrowing_store.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/stencil.hpp>

// The passes of StiffMidpoint. x is the estimate of A in the middle of the step.
namespace cayspin::detail {

/// x = sum of coefficients times x of earlier steps, and the spins in the middle.
template <class Real>
struct GuessStage {
  SiteArray<Real, 3> earlier[3];
  double coefficients[3];
  int count;
  SiteArray<Real, 3> spins;
  OutputArray<Real, 3> x, middle;
  Real dt;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    auto guess = zero<Value>();
    for (int i = 0; i < count; ++i)
      guess = multiply_add(as_value<Value>(coefficients[i]), site.load(earlier[i]), guess);
    site.store(guess, x);
    Vec3<Value> const m = site.load(spins);
    auto const step = Cayley::displacement(Vec3<Value>(Value(dt) * guess), m);
    site.store(multiply_add(Value(Value(0.5) * step.scale), step.direction, m), middle);
  }
};

/// The residual A(middle) - x across the spin in the middle. What is along it has no effect, since
/// cay(f) m - m = f x (m + cay(f) m) / 2, and is taken from x.
template <class Generator, class Real>
struct ResidualStage {
  Generator generator;
  SiteArray<Real, 3> middle, x;
  OutputArray<Real, 3> next_x, residual;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real> const stencil(site, middle);
    Vec3<Value> const m = stencil.center(), before = site.load(x);
    Vec3<Value> const a = evaluate(generator, stencil);
    Value const scale = Value(-1) / dot(m, m);
    Vec3<Value> const across = multiply_add(Value(scale * dot(before, m)), m, before);
    site.store(across, next_x);
    site.store(multiply_add(Value(scale * dot(a, m)), m, a) - across, residual);
  }
};

/// x + the solution across the spin in the middle, and the spins in the middle or at the end of the
/// step. Values: |change|^2.
template <class Real, int Components>
struct CorrectStage {
  SiteArray<Real, Components> solution;
  SiteArray<Real, 3> spins, middle, x, to;
  Real dt, share;  // 1/2 for the middle

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Vec3<Value> const m = site.load(spins), bar = site.load(middle);
    Vec3<Value> v{site.load(solution, 0), site.load(solution, 1), site.load(solution, 2)};
    if constexpr (Components == 6)
      v += cross(
          bar, Vec3<Value>{site.load(solution, 3), site.load(solution, 4), site.load(solution, 5)});
    v = multiply_add(Value(-dot(v, bar) / dot(bar, bar)), bar, v);
    Vec3<Value> const next = site.load(x) + v;
    store_narrowed(next, site, x);
    auto const step = Cayley::displacement(Vec3<Value>(as_value<Value>(dt) * next), m);
    Vec3<Value> const there =
        multiply_add(Value(as_value<Value>(share) * step.scale), step.direction, m);
    store_narrowed(there, site, to);
    values[0] = multiply_add(Value(0), dot(there, there), dot(v, v));  // overflow makes it NaN
  }
};

}  // namespace cayspin::detail
