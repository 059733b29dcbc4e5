// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/narrowing_store.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/stencil.hpp>
#include <cayspin/stepper/gauss_legendre.hpp>

#include <cstddef>

// The passes of StiffGauss. x is the estimate of A at the stages.
namespace cayspin::inline v0_1::detail {

/// x = sums of coefficients times x of earlier steps, and the spins at the stages.
template <int Stages, int Earlier, class Real>
struct GuessStage {
  SiteArray<Real, 3> earlier[std::size_t{Earlier}];
  double coefficients[std::size_t{Stages}][std::size_t{Earlier}];
  int count;
  SiteArray<Real, 3> spins;
  OutputArray<Real, 3> x[std::size_t{Stages}], stage[std::size_t{Stages}];
  Real dt;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Vec3<Value> f[std::size_t{Stages}], there[std::size_t{Stages}];
    for (auto& guess : f) guess = zero<Value>();
    for (int i = 0; i < count; ++i) {
      Vec3<Value> const before = site.load(earlier[i]);
      for (int s = 0; s < Stages; ++s)
        f[s] = multiply_add(as_value<Value>(coefficients[s][i]), before, f[s]);
    }
    for (int s = 0; s < Stages; ++s) {
      site.store(f[s], x[s]);
      f[s] = Value(dt) * f[s];
    }
    GaussLegendre<Stages>::solve(f, site.load(spins), there);
    for (int s = 0; s < Stages; ++s) site.store(there[s], stage[s]);
  }
};

/// The residual A(Y) - x across the spin Y at a stage. What is along it has no effect, since x acts
/// as x x Y, and is taken from x.
template <class Generator, class Real>
struct ResidualStage {
  Generator generator;
  SiteArray<Real, 3> stage, x;
  OutputArray<Real, 3> next_x, residual;
  Real share;  // of the residual

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real> const stencil(site, stage);
    Vec3<Value> const m = stencil.center(), before = site.load(x);
    Vec3<Value> const a = evaluate(generator, stencil);
    Value const scale = Value(-1) / dot(m, m);
    Vec3<Value> const across = multiply_add(Value(scale * dot(before, m)), m, before);
    site.store(across, next_x);
    site.store(Value(share) * (multiply_add(Value(scale * dot(a, m)), m, a) - across), residual);
  }
};

/// x + the solution across the spins at the stages, and the spins there and at the end of the step.
/// Values: the largest |change|^2.
template <int Stages, class Real>
struct CorrectStage {
  SiteArray<Real, 6> solution[std::size_t{Stages}];
  SiteArray<Real, 3> spins, x[std::size_t{Stages}], stage[std::size_t{Stages}], end;
  Real dt;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Vec3<Value> f[std::size_t{Stages}], there[std::size_t{Stages}], v[std::size_t{Stages}];
    corrections(site, v);
    Value largest(0);
    for (int s = 0; s < Stages; ++s) {
      Vec3<Value> const at = site.load(stage[s]);
      Vec3<Value> const change = multiply_add(Value(-dot(v[s], at) / dot(at, at)), at, v[s]);
      Vec3<Value> const next = site.load(x[s]) + change;
      store_narrowed(next, site, x[s]);
      f[s] = as_value<Value>(dt) * next;
      largest = maximum<Value>(largest, dot(change, change));
    }
    Vec3<Value> const last = GaussLegendre<Stages>::solve(f, site.load(spins), there);
    for (int s = 0; s < Stages; ++s) store_narrowed(there[s], site, stage[s]);
    store_narrowed(last, site, end);
    values[0] = multiply_add(Value(0), dot(last, last), largest);  // overflow makes it NaN
  }

 private:
  // A solution (v', v'') is v' + i v'', and i stands for m x.
  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void corrections(Site const& site,
                                               Vec3<Value> (&v)[std::size_t{Stages}]) const {
    auto const part = [&](int s, int c) {
      return Vec3<Value>{site.load(solution[s], c), site.load(solution[s], c + 1),
                         site.load(solution[s], c + 2)};
    };
    if constexpr (Stages == 1) {
      v[0] = part(0, 0) + cross(Vec3<Value>(site.load(stage[0])), part(0, 3));
    } else {
      // z + z~ and i turned (z - z~)
      auto const turned = as_value<Value>(GaussLegendre<2>::turned);
      Vec3<Value> const a = part(0, 0), b = part(0, 3), c = part(1, 0), d = part(1, 3);
      v[0] = (a + c) + cross(Vec3<Value>(site.load(stage[0])), b + d);
      v[1] = turned * ((d - b) + cross(Vec3<Value>(site.load(stage[1])), a - c));
    }
  }
};

}  // namespace cayspin::inline v0_1::detail
