// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/generator/orthogonal.hpp>
#include <cayspin/isotropy/sigma.hpp>
#include <cayspin/stencil.hpp>

// Steps from the generator at two points, one of which is kept in a field: finite differences of
// A_o, and the two-step method of Adams and Bashforth.
namespace cayspin::inline v0_1::detail {

/// The inputs of a rule at a site: the spin m that A belongs to, the spin m0 of the step's begin, A
/// there with its isotropy added, the kept vector, and dt. It returns the step's coordinates F and
/// sets `kept` to the vector to keep.
template <class Value>
struct TwoPoints {
  Vec3<Value> m, m0, a, kept;
  Value dt;
};

/// F = dt A_o, which is kept.
struct PredictOrthogonal {
  static constexpr bool reads = false, writes = true;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(TwoPoints<Value>& p) const {
    p.kept = orthogonal_part(p.a, p.m);
    return p.dt * p.kept;
  }
};

/// F = dt (w + sigma m0), w kept, sigma from A_o here.
struct ForwardDifference {
  static constexpr bool reads = true, writes = false;
  double cap;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(TwoPoints<Value>& p) const {
    Value const limit(static_cast<scalar_t<Value>>(cap));
    Vec3<Value> const difference = orthogonal_part(p.a, p.m) - p.kept;
    return multiply_add(turn_from_difference(difference, p.kept, p.m0, limit), p.m0,
                        Vec3<Value>(p.dt * p.kept));
  }
};

/// F = dt (w + sigma m), w = A_o here, sigma from the kept one of `ratio` = dt / (dt before).
struct BackwardDifference {
  static constexpr bool reads = true, writes = true;
  double cap, ratio;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(TwoPoints<Value>& p) const {
    using Scalar = scalar_t<Value>;
    Vec3<Value> const w = orthogonal_part(p.a, p.m);
    Vec3<Value> const difference = Value(static_cast<Scalar>(ratio)) * (w - p.kept);
    p.kept = w;
    return multiply_add(turn_from_difference(difference, w, p.m0, Value(static_cast<Scalar>(cap))),
                        p.m0, Vec3<Value>(p.dt * w));
  }
};

/// F = dt A, which is kept.
struct PredictFull {
  static constexpr bool reads = false, writes = true;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(TwoPoints<Value>& p) const {
    p.kept = p.a;
    return p.dt * p.a;
  }
};

/// F = dt (A + kept) / 2
struct Average {
  static constexpr bool reads = true, writes = false;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(TwoPoints<Value>& p) const {
    return Value(Value(0.5) * p.dt) * (p.a + p.kept);
  }
};

/// F = dt (A + ratio (A - kept) / 2), A kept.
struct Extrapolate {
  static constexpr bool reads = true, writes = true;
  double ratio;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(TwoPoints<Value>& p) const {
    Value const half(static_cast<scalar_t<Value>>(0.5 * ratio));
    Vec3<Value> const f = multiply_add(half, p.a - p.kept, p.a);
    p.kept = p.a;
    return p.dt * f;
  }
};

template <class Rule, class Isotropy, class Rotation, class Generator, class Real>
struct TwoPointStage {
  Generator generator;
  Isotropy isotropy;
  Rule rule;
  SiteArray<Real, 3> start, level;
  OutputArray<Real, 3> kept, next;
  Real dt;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real> const stencil(site, level);
    TwoPoints<Value> points;
    points.m = stencil.center();
    points.m0 = level.data == start.data ? points.m : site.load(start);
    points.a = isotropy(points.m, evaluate(generator, stencil));
    if constexpr (Rule::reads) points.kept = site.load(kept);
    points.dt = Value(dt);
    Vec3<Value> const f = rule(points);
    if constexpr (Rule::writes) site.store(points.kept, kept);
    site.store(Rotation::rotate(f, points.m0), next);
  }
};

}  // namespace cayspin::inline v0_1::detail
