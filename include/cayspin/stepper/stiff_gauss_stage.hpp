// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/narrowing_store.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/stencil.hpp>
#include <cayspin/stepper/gauss_legendre.hpp>

#include <cstddef>

// Kernels of StiffGauss. x is the current estimate of A at the stages.
namespace cayspin::inline v0_2::detail {

/// Functor that extrapolates x by a polynomial through its values at stages of earlier steps, and
/// computes the spins at the stages.
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

/// Returns the part of v normal to the spin m; zero on a vacant site, where m is zero.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> across_spin(Vec3<Value> const& v, Vec3<Value> const& m) {
  Value const square = dot(m, m);
  auto const vacant = square == Value(0);
  Value const divisor = select<Value>(vacant, Value(1), square);
  return select<Value>(vacant, zero<Value>(), multiply_add(Value(-dot(v, m) / divisor), m, v));
}

/// Functor that computes the residual A(Y) - x at the spin Y of a stage, and stores its part normal
/// to Y, times `share`; zero on a vacant site. Parts along Y have no effect, because x acts only
/// through its cross product with Y. The functor also removes the part of x along Y.
template <class Generator, class Real>
struct ResidualStage {
  Generator generator;
  SiteArray<Real, 3> stage, x;
  OutputArray<Real, 3> next_x, residual;
  Real share;  // factor of the residual

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real> const stencil(site, stage);
    Vec3<Value> const m = stencil.center(), before = site.load(x);
    Vec3<Value> const a = evaluate(generator, stencil);
    Value const square = dot(m, m);
    auto const vacant = square == Value(0);
    Value const scale = Value(-1) / select<Value>(vacant, Value(1), square);
    Vec3<Value> const across = multiply_add(Value(scale * dot(before, m)), m, before);
    Vec3<Value> const rest = Value(share) * (multiply_add(Value(scale * dot(a, m)), m, a) - across);
    site.store(across, next_x);
    site.store(select<Value>(vacant, zero<Value>(), rest), residual);
  }
};

/// Functor that adds to x, at each stage, the part of the solution normal to the spin of the stage.
/// It then computes the spins at the stages and at the end of the step. `Scaled`: the first
/// solution is multiplied by the complex factor real + i * imaginary, and a second one by its
/// conjugate. The value to reduce is the largest |change of x|^2 over the stages.
template <int Stages, bool Scaled, class Real>
struct CorrectStage {
  SiteArray<Real, 6> solution[std::size_t{Stages}];
  SiteArray<Real, 3> spins, x[std::size_t{Stages}], stage[std::size_t{Stages}], end;
  Real dt, real, imaginary;  // `real` and `imaginary`: parts of the factor
  bool only_rotated_part;    // true if the part v' of each solution (v', v'') is zero

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Vec3<Value> f[std::size_t{Stages}], there[std::size_t{Stages}], v[std::size_t{Stages}];
    corrections(site, v);
    Value largest(0);
    for (int s = 0; s < Stages; ++s) {
      Vec3<Value> const at = site.load(stage[s]);
      Vec3<Value> const change = across_spin(v[s], at);
      Vec3<Value> const next = site.load(x[s]) + change;
      store_narrowed(next, site, x[s]);
      f[s] = as_value<Value>(dt) * next;
      largest = maximum<Value>(largest, dot(change, change));
    }
    Vec3<Value> const last = GaussLegendre<Stages>::solve(f, site.load(spins), there);
    for (int s = 0; s < Stages; ++s) store_narrowed(there[s], site, stage[s]);
    store_narrowed(last, site, end);
    values[0] = multiply_add(Value(0), dot(last, last), largest);  // NaN if `last` overflowed
  }

 private:
  // Computes the corrections v from the solutions. A solution (v', v'') stands for v' + i v'',
  // where i stands for m x.
  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void corrections(Site const& site,
                                               Vec3<Value> (&v)[std::size_t{Stages}]) const {
    auto const loaded = [&](int s, int c) {
      if (only_rotated_part && c == 0) return zero<Value>();
      return Vec3<Value>{site.load(solution[s], c), site.load(solution[s], c + 1),
                         site.load(solution[s], c + 2)};
    };
    auto const part = [&](int s, int c) -> Vec3<Value> {
      if constexpr (!Scaled) return loaded(s, c);
      auto const turned = as_value<Value>((c == 0) == (s == 0) ? -imaginary : imaginary);
      return multiply_add(turned, loaded(s, 3 - c), as_value<Value>(real) * loaded(s, c));
    };
    if constexpr (Stages == 1) {
      v[0] = part(0, 0) + cross(Vec3<Value>(site.load(stage[0])), part(0, 3));
    } else {
      // With solutions z and z~: v is z + z~ at the first stage, and i * turned * (z - z~) at the
      // second.
      auto const turned = as_value<Value>(GaussLegendre<2>::turned);
      Vec3<Value> const a = part(0, 0), b = part(0, 3), c = part(1, 0), d = part(1, 3);
      v[0] = (a + c) + cross(Vec3<Value>(site.load(stage[0])), b + d);
      v[1] = turned * ((d - b) + cross(Vec3<Value>(site.load(stage[1])), a - c));
    }
  }
};

/// Functor that computes A.m.
template <class Generator, class Real>
struct SumAlongSpins {
  Generator generator;
  SiteArray<Real, 3> spins;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Stencil<Site, Real> const stencil(site, spins);
    values[0] = dot(evaluate(generator, stencil), stencil.center());
  }
};

/// Functor that sums the changes of the spins over the last three steps, with weights, and stores
/// the cross product of the spins at a stage with this sum. The result is a right side for the
/// solver that StiffGauss uses for corrections.
template <class Real>
struct SecondDifference {
  SiteArray<Real, 3> spins[4];  // at the end of the last step, and at the starts of the last three
  double weights[3];
  SiteArray<Real, 3> stage;
  OutputArray<Real, 3> difference;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    store(site, zero<typename Site::value_type>(), 3);
  }
  /// Adds the weighted changes over the last `count` steps to `sum`, then stores the cross product.
  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void store(Site const& site, Vec3<Value> sum, int count) const {
    Vec3<Value> later = site.load(spins[0]);
    for (int i = 0; i < count; ++i) {
      Vec3<Value> const earlier = site.load(spins[i + 1]);
      sum = multiply_add(as_value<Value>(weights[i]), later - earlier, sum);
      later = earlier;
    }
    site.store(cross(Vec3<Value>(site.load(stage)), sum), difference);
  }
};

/// SecondDifference with the rate of the spins at the end of the step in place of the third change.
template <class Generator, class Real>
struct SecondDifferenceWithEnd {
  Generator generator;
  SecondDifference<Real> of_two;
  SiteArray<Real, 3> end;
  double weight;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real> const stencil(site, end);
    Vec3<Value> const rate = cross(evaluate(generator, stencil), stencil.center());
    of_two.store(site, as_value<Value>(weight) * rate, 2);
  }
};

/// Functor that computes the spins at a time within a step: cay(f) times the spins at the start of
/// the step, where f = whole * last + slope * (last - before). `last` and `before` are A at the
/// stage of this step and at that of the previous step.
template <class Real>
struct StiffDenseOutput {
  SiteArray<Real, 3> begin, last, before;
  OutputArray<Real, 3> out;
  Real whole = 0, slope = 0;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Vec3<Value> const a = site.load(last);
    Vec3<Value> const change = a - Vec3<Value>(site.load(before));
    Vec3<Value> const f[1] = {multiply_add(Value(slope), change, Value(whole) * a)};
    Vec3<Value> stage[1];
    site.store(GaussLegendre<1>::solve(f, Vec3<Value>(site.load(begin)), stage), out);
  }
};

/// Functor that computes |v|^2 of a solution (v', v''), where v = v' + m x v''; zero on a vacant
/// site.
template <class Real>
struct LargestSolution {
  SiteArray<Real, 6> solution;
  SiteArray<Real, 3> stage;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    auto const part = [&](int c) {
      return Vec3<Value>{site.load(solution, c), site.load(solution, c + 1),
                         site.load(solution, c + 2)};
    };
    Vec3<Value> const m = site.load(stage), v = part(0) + cross(m, part(3));
    values[0] = select<Value>(dot(m, m) == Value(0), Value(0), dot(v, v));
  }
};

}  // namespace cayspin::inline v0_2::detail
