// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/local_part.hpp>
#include <cayspin/detail/unrolled.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/stencil.hpp>

namespace cayspin::detail {

/// The neighbour field of every spin.
template <class Generator, class Real>
struct NeighborFieldStage {
  Generator generator;
  SiteArray<Real, 3> spins;
  OutputArray<Real, 3> to;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    Stencil<Site, Real> const stencil(site, spins);
    site.store(neighbor_field_of(generator, stencil), to);
  }
};

/// What a step says about the one before it: the angle by which it missed, from the neighbour field
/// that the Order fields before had foretold for its end.
template <int Order, class Real>
struct ErrorOfExtrapolation {
  static constexpr bool is_known = true;
  static constexpr int older = Order;
  double weights[Order], scale;  // of the fields before; dt of the step and what is left of it
  OutputArray<Real, 1> angles;
};

template <int Order>
struct NoErrorOfExtrapolation {
  static constexpr bool is_known = false;
  static constexpr int older = Order - 1;
};

/// One step of every spin in its neighbour field, the polynomial through the Order last ones: one
/// step of Rkmk4, which needs the field at the begin, the middle and the end.
template <int Order, class Error, class Generator, class Local, class Real>
struct FieldExtrapolationStage {
  Generator generator;
  Local local[3];                    // at the begin, the middle and the end
  double middle[Order], end[Order];  // weights of the polynomial, newest first
  SiteArray<Real, 3> spins;
  SiteArray<Real, 3> older[Error::older];  // neighbour fields of the steps before, newest first
  OutputArray<Real, 3> newest, next;       // the field's array may be that of the oldest
  Error error;
  Real dt;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real> const stencil(site, spins);
    Vec3<Value> const m = stencil.center();
    Vec3<Value> const h = neighbor_field_of(generator, stencil);
    Vec3<Value> before[Error::older];
    unrolled<Error::older>([&](auto j) { before[j()] = site.load(older[j()]); });
    Vec3<Value> at_middle = value<Value>(middle[0]) * h, at_end = value<Value>(end[0]) * h;
    unrolled<Order - 1>([&](auto j) {
      at_middle = multiply_add(value<Value>(middle[j() + 1]), before[j()], at_middle);
      at_end = multiply_add(value<Value>(end[j() + 1]), before[j()], at_end);
    });

    Value const half(static_cast<scalar_t<Value>>(0.5));
    Vec3<Value> const f1 = increment(local[0], site, m, h);
    Vec3<Value> f = half * f1;
    Vec3<Value> const f2 =
        Cayley::inverse_tangent(f, increment(local[1], site, Cayley::rotate(f, m), at_middle));
    f = half * f2;
    Vec3<Value> const f3 =
        Cayley::inverse_tangent(f, increment(local[1], site, Cayley::rotate(f, m), at_middle));
    Vec3<Value> const f4 =
        Cayley::inverse_tangent(f3, increment(local[2], site, Cayley::rotate(f3, m), at_end));
    f = value<Value>(1. / 6) * (f1 + multiply_add(Value(2), f2 + f3, f4));

    if constexpr (Error::is_known) {
      Vec3<Value> foretold = value<Value>(error.weights[0]) * before[0];
      unrolled<Order - 1>([&](auto j) {
        foretold = multiply_add(value<Value>(error.weights[j() + 1]), before[j() + 1], foretold);
      });
      Vec3<Value> const missed = cross(f1 - increment(local[0], site, m, foretold), m);
      site.store(value<Value>(error.scale) * square_root<Value>(dot(missed, missed)), error.angles);
    }
    site.store(h, newest);
    site.store(Cayley::rotate(f, m), next);
  }

 private:
  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> increment(Local const& at, Site const& site,
                                                    Vec3<Value> const& q,
                                                    Vec3<Value> const& h) const {
    return Value(dt) * generator_at(at, SpinAlone<Site>(site, q), h);
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Value value(double number) {
    return Value(static_cast<scalar_t<Value>>(number));
  }
};

/// The largest of the numbers at sites.
template <class Real>
struct LargestOfSites {
  SiteArray<Real, 1> numbers;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    values[0] = site.load(numbers);
  }
};

}  // namespace cayspin::detail
