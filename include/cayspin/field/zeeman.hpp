// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stencil.hpp>

#include <concepts>
#include <utility>

namespace cayspin::inline v0_1 {

/// A uniform applied field: H = applied, E = -m.H per site. What evaluates it throws
/// std::invalid_argument when it is not finite.
struct Zeeman {
  static constexpr int degree = 1;  // H does not depend on the spins
  static constexpr bool is_local = true;
  Vec3<double> applied;

  template <class Spins>
  void check_spins(Spins const&) const {
    detail::finite(applied, "cayspin::Zeeman: the applied field");
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const&) const {
    return as_value<ValueOf<Stencil>>(applied);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return Value(-1) * dot(stencil.center(), as_value<Value>(applied));
  }
};

namespace detail {

/// What an applied field adds to dH/dt.
struct AppliedRate {
  Vec3<double> rate;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> linear_field(Stencil const&) const {
    return as_value<ValueOf<Stencil>>(rate);
  }
};

/// d/dt of a callable by differences of order 4 over dt/4: relative error about (w dt)^4 / 1e5 for
/// changes of angular frequency w.
template <class Applied>
Vec3<double> time_derivative(Applied const& applied, double t, double dt) {
  if (dt == 0) return {0, 0, 0};  // a step of no time moves no spin
  double const d = dt / 8;
  Vec3<double> const near = applied(t + d) - applied(t - d);
  Vec3<double> const far = applied(t + 2 * d) - applied(t - 2 * d);
  return (1 / (12 * d)) * (8.0 * near - far);
}

}  // namespace detail

/// A uniform applied field that changes with time: `applied(t)` is called on the host, once per
/// stage, at the stage's own time. isotropy::Analytic also takes its time derivative, by
/// differences within the step, so `applied` has to be defined a quarter of a step either way.
template <class Applied>
class TimeDependentZeeman {
  static_assert(std::is_invocable_r_v<Vec3<double>, Applied const&, double>,
                "TimeDependentZeeman takes a callable Vec3<double>(double t).");

 public:
  static constexpr bool depends_on_time = true;
  static constexpr bool is_local = true;

  explicit TimeDependentZeeman(Applied applied) : applied_(std::move(applied)) {}

  template <class Exec, class Spins>
  Zeeman prepare(Exec const&, Spins const&, double t) const {
    return Zeeman{applied_(t)};
  }
  template <class Exec, class Rates>
  detail::AppliedRate prepare_rate(Exec const&, Rates const&, double t, double dt) const {
    return detail::AppliedRate{detail::time_derivative(applied_, t, dt)};
  }

 private:
  Applied applied_;
};

}  // namespace cayspin::inline v0_1
