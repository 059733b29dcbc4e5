// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/unrolled.hpp>
#include <cayspin/stencil.hpp>

#include <cmath>
#include <stdexcept>
#include <utility>

namespace cayspin {

/// m' = -m x H - damping m x (m x H), as A x m with A = H + damping m x H; overdamped, without
/// precession, A = damping m x H. Reduced units.
template <class Field>
class LandauLifshitz {
 public:
  static constexpr bool depends_on_time = detail::depends_on_time<Field>;

  /// Throws std::invalid_argument when damping is negative or not finite.
  LandauLifshitz(Field field, double damping, bool precession = true)
      : field_(std::move(field)), damping_(damping), precession_(precession ? 1.0 : 0.0) {
    if (!(damping >= 0) || !std::isfinite(damping))
      throw std::invalid_argument("cayspin::LandauLifshitz: damping must be >= 0 and finite");
  }

  Field const& field() const { return field_; }

  template <class Exec, class Spins>
  auto prepare(Exec const& exec, Spins const& spins, double t) const {
    auto prepared = detail::prepare_term(field_, exec, spins, t);
    return LandauLifshitz<decltype(prepared)>(std::move(prepared), damping_, precession_ != 0);
  }

  template <class Exec, class Spins>
  auto prepare_rate(Exec const& exec, Spins const& rates, double t, double dt) const {
    auto prepared = detail::prepare_rate(field_, exec, rates, t, dt);
    return LandauLifshitz<decltype(prepared)>(std::move(prepared), damping_, precession_ != 0);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> operator()(
      Stencil const& stencil) const {
    return generator(stencil.center(), field_.field(stencil));
  }

  /// A' at a spin m along the rates X, less damping X x H, which is normal to X and to what sigma
  /// is made of.
  template <class Value, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> rate(Vec3<Value> const& m, Stencil const& rates) const {
    return generator(m, field_.field_rate(m, rates));
  }

  /// What Series4 differentiates: H, of which the generator is made, and its linear part.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> series_source(
      Stencil const& stencil) const {
    return field_.field(stencil);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> linear_series_source(
      Stencil const& stencil) const {
    return field_.linear_field(stencil);
  }
  /// The K-th time derivative of A from those of m and H.
  template <int K, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> derivative(Vec3<Value> const* m,
                                                     Vec3<Value> const* h) const {
    Vec3<Value> a = value<Value>(precession_) * h[K];
    detail::leibniz<K>([&](auto weight, auto j, auto rest) {
      a = multiply_add(value<Value>(damping_ * weight), cross(m[j], h[rest]), a);
    });
    return a;
  }

  /// True where the motion conserves the energy, with A = -dE/dm up to a multiple of m.
  bool is_conservative() const { return damping_ == 0 && precession_ != 0; }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    return field_.energy_density(stencil);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_magnitude(
      Stencil const& stencil) const {
    return field_.energy_magnitude(stencil);
  }

 private:
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Value value(double number) {
    return Value(static_cast<detail::scalar_t<Value>>(number));
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> generator(Vec3<Value> const& m,
                                                    Vec3<Value> const& h) const {
    return multiply_add(value<Value>(damping_), cross(m, h), value<Value>(precession_) * h);
  }

  Field field_;
  double damping_, precession_;
};

}  // namespace cayspin
