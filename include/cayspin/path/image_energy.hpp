// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/minimizer/trial.hpp>

#include <cmath>
#include <utility>

namespace cayspin::inline v0_2::detail {

/// Functor that computes the energy of an image of a path, and g = -(H - (H.m) * m).
template <class Field, class Real>
struct LookAtImage {
  enum { energy, magnitude, torque, values };
  using Combine = SumsThenMaxima<torque>;

  Field field;
  SiteArray<Real, 3> spins, gradient;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* found) const {
    Stencil<Site, Real> const stencil(site, spins);
    energy_at(field, stencil, found);
    Vec3<Value> const m = stencil.center(), axis = cross(m, field.field(stencil));
    found[torque] = dot(axis, axis);
    store_narrowed(cross(m, axis), site, gradient);
  }
};

struct ImageNow {
  Energy energy;
  double torque = 0;  // max |m x H|
};

template <class Exec, class Field, class Spins>
ImageNow look_at_image(Exec const& exec, Field const& field, double time, Spins const& spins,
                       Spins const& gradient) {
  auto prepared = prepare_term(field, exec, spins, time);
  using Look = LookAtImage<decltype(prepared), typename Spins::value_type>;
  auto const found = reduce_sites<typename Look::Combine, Look::values>(
      exec, "cayspin::path::look", spins.layout(),
      Look{std::move(prepared), spins.array(), gradient.array()});
  return {{found[Look::energy], found[Look::magnitude]}, std::sqrt(found[Look::torque])};
}

}  // namespace cayspin::inline v0_2::detail
