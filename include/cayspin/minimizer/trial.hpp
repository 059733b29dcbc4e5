// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/narrowing_store.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/scalars.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>

#include <cmath>
#include <utility>

// A point on the path m(a) = cay(a * m x d) m of a line search, and what one evaluation of the
// field gives there. Each spin turns on the great circle from m towards d.
namespace cayspin::inline v0_2::detail {

/// Returns v without its component along m.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> tangent(Vec3<Value> const& m, Vec3<Value> const& v) {
  return multiply_add(Value(-dot(m, v)), m, v);
}

template <class Real>
struct TurnTowards {
  SiteArray<Real, 3> spins, direction;
  OutputArray<Real, 3> output;
  Real step;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Vec3<Value> const m = site.load(spins), d = site.load(direction);
    Vec3<Value> const turned = Cayley::rotate(cross(m, Vec3<Value>(Value(step) * d)), m);
    // A Newton step towards |m| = 1, so that round-off does not accumulate.
    Value const half_excess = Value(Real(0.5)) * (Value(1) - dot(turned, turned));
    site.store(select<Value>(dot(d, d) == Value(0), m, multiply_add(half_excess, turned, turned)),
               output);
  }
};

/// Functor that computes at m(a) the energy, the gradient g = -(H - (H.m) * m), and a pair for
/// L-BFGS: the step and the change of the gradient, both transported to m(a) along the path.
template <class Field, class Real>
struct LookAtTrial {
  enum { energy, magnitude, slope, curvature, step_square, change_square, torque, values };
  using Combine = SumsThenMaxima<torque>;

  Field field;
  SiteArray<Real, 3> spins, direction, gradient;  // at a = 0
  double step;
  SiteArray<Real, 3> trial, new_gradient, moved, changed;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values_here) const {
    Stencil<Site, Real> const stencil(site, trial);
    energy_at(field, stencil, values_here);
    Vec3<Value> const m = stencil.center(), axis = cross(m, field.field(stencil));
    Vec3<Value> const g = cross(m, axis);
    Vec3<Value> const m0 = site.load(spins), d = site.load(direction);
    Vec3<Value> const f = cross(m0, Vec3<Value>(Value(step) * d));
    Vec3<Value> const along = Cayley::rotate(f, d);
    Vec3<Value> const change = g - Cayley::rotate(f, Vec3<Value>(site.load(gradient)));
    Vec3<Value> const moved_by = Value(step) * along;
    values_here[slope] = dot(g, along) / multiply_add(Value(0.25), dot(f, f), Value(1.0));
    values_here[curvature] = dot(moved_by, change);
    values_here[step_square] = dot(moved_by, moved_by);
    values_here[change_square] = dot(change, change);
    values_here[torque] = dot(axis, axis);
    store_narrowed(g, site, new_gradient);
    store_narrowed(moved_by, site, moved);
    store_narrowed(change, site, changed);
  }
};

/// Values at a point of the path.
struct PointOnPath {
  Energy energy;
  double slope = 0;                                          // dE/da
  double curvature = 0, step_square = 0, change_square = 0;  // of the pair: s.y, s.s, y.y
  double torque = 0;                                         // max |m x H|

  bool is_finite() const { return std::isfinite(energy.value) && std::isfinite(torque); }
};

template <class Spins>
struct SearchArrays {
  Spins trial, gradient, new_gradient, direction;
};

/// Writes `spins`, turned by `step` times `search.direction`, to `search.trial`, and evaluates the
/// field there. Writes the gradient to `search.new_gradient`, and the pair for L-BFGS to `moved`
/// and `changed`. Waits.
template <class Exec, class Field, class Spins>
PointOnPath look_along(Exec const& exec, Field const& field, double time, Spins const& spins,
                       double step, SearchArrays<Spins> const& search, Spins const& moved,
                       Spins const& changed) {
  using Real = typename Spins::value_type;
  for_each_site<Real>(exec, "cayspin::minimize::turn", spins.layout(),
                      TurnTowards<Real>{spins.array(), search.direction.array(),
                                        search.trial.output(false), static_cast<Real>(step)});
  auto prepared = prepare_term(field, exec, search.trial, time);
  using Look = LookAtTrial<decltype(prepared), Real>;
  auto const v = reduce_sites<typename Look::Combine, Look::values>(
      exec, "cayspin::minimize::look", spins.layout(),
      Look{std::move(prepared), spins.array(), search.direction.array(), search.gradient.array(),
           static_cast<double>(static_cast<Real>(step)), search.trial.array(),
           search.new_gradient.array(), moved.array(), changed.array()});
  return {{v[Look::energy], v[Look::magnitude]},
          v[Look::slope],
          v[Look::curvature],
          v[Look::step_square],
          v[Look::change_square],
          std::sqrt(v[Look::torque])};
}

}  // namespace cayspin::inline v0_2::detail
