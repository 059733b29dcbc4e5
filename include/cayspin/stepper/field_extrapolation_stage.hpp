// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/unrolled.hpp>
#include <cayspin/field/local_part.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/stage/update.hpp>
#include <cayspin/stencil.hpp>

#include <cstddef>

namespace cayspin::inline v0_1::detail {

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

/// The error of the step before, as an angle: from the difference between the neighbour field at
/// its end and the one that the Order fields before predicted.
template <int Order, class Real>
struct ErrorOfExtrapolation {
  static constexpr bool is_known = true;
  static constexpr int older = Order;
  double weights[std::size_t{Order}];  // of the fields before
  double scale;                        // dt of the step and what is left of it
  OutputArray<Real, 1> angles;
};

template <int Order>
struct NoErrorOfExtrapolation {
  static constexpr bool is_known = false;
  static constexpr int older = Order - 1;
};

/// One step of Rkmk4 of every spin, with its neighbour field at the begin, the middle and the end.
/// The field is the polynomial through the last Order fields.
template <int Order, class Error, class Generator, class Local, class Real>
struct FieldExtrapolationStage {
  Generator generator;
  Local local[3];  // at the begin, the middle and the end
  /// Weights of the polynomial, newest first.
  double middle[std::size_t{Order}], end[std::size_t{Order}];
  SiteArray<Real, 3> spins;
  /// Neighbour fields of the steps before, newest first.
  SiteArray<Real, 3> older[std::size_t{Error::older}];
  OutputArray<Real, 3> newest, next;  // the field's array may be that of the oldest
  Error error;
  Real dt;

  static constexpr bool takes_pairs = true;

  /// The stages of one site, or alternately those of two.
  template <class Site, class... Second>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Second const&... second) const {
    using Value = typename Site::value_type;
    [[maybe_unused]] Coordinates<Value> of_site, of_second;
    begin(site, of_site), (begin(second, of_second), ...);
    middle_stage(site, of_site), (middle_stage(second, of_second), ...);
    middle_stage(site, of_site), (middle_stage(second, of_second), ...);
    finish(site, of_site), (finish(second, of_second), ...);
  }

 private:
  using Update = update::Lie<Cayley>;

  template <class Value>
  struct Coordinates {
    Vec3<Value> m, at_middle, at_end;  // the spin; neighbour fields
    Vec3<Value> last, sum;             // the last increment; F1 + 2 F2 + ..
  };

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void begin(Site const& site, Coordinates<Value>& spin) const {
    Stencil<Site, Real> const stencil(site, spins);
    spin.m = stencil.center();
    Vec3<Value> const h = neighbor_field_of(generator, stencil);
    Vec3<Value> before[Error::older];
    unrolled<Error::older>([&](auto j) { before[j()] = site.load(older[j()]); });
    spin.at_middle = value<Value>(middle[0]) * h;
    spin.at_end = value<Value>(end[0]) * h;
    unrolled<Order - 1>([&](auto j) {
      spin.at_middle = multiply_add(value<Value>(middle[j() + 1]), before[j()], spin.at_middle);
      spin.at_end = multiply_add(value<Value>(end[j() + 1]), before[j()], spin.at_end);
    });
    spin.sum = spin.last = increment(local[0], site, spin.m, h);

    if constexpr (Error::is_known) {
      Vec3<Value> predicted = value<Value>(error.weights[0]) * before[0];
      unrolled<Order - 1>([&](auto j) {
        predicted = multiply_add(value<Value>(error.weights[j() + 1]), before[j() + 1], predicted);
      });
      Vec3<Value> const missed =
          cross(spin.last - increment(local[0], site, spin.m, predicted), spin.m);
      site.store(value<Value>(error.scale) * square_root<Value>(dot(missed, missed)), error.angles);
    }
    site.store(h, newest);
  }
  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void middle_stage(Site const& site, Coordinates<Value>& spin) const {
    Vec3<Value> const f = value<Value>(0.5) * spin.last;
    Vec3<Value> const m = Update::move(f, spin.m);
    spin.last = Update::increment(f, increment(local[1], site, m, spin.at_middle), m, spin.m);
    spin.sum = multiply_add(Value(2), spin.last, spin.sum);
  }
  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void finish(Site const& site, Coordinates<Value>& spin) const {
    Vec3<Value> const m = Update::move(spin.last, spin.m);
    Vec3<Value> const last =
        Update::increment(spin.last, increment(local[2], site, m, spin.at_end), m, spin.m);
    site.store(Update::finish(value<Value>(1. / 6) * (spin.sum + last), spin.m), next);
  }

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

}  // namespace cayspin::inline v0_1::detail
