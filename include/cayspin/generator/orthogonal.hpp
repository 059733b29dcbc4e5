// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/unrolled.hpp>
#include <cayspin/field/local_part.hpp>
#include <cayspin/stencil.hpp>

#include <utility>

namespace cayspin {

namespace detail {

/// A - (m.A) m
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> orthogonal_part(Vec3<Value> const& a,
                                                        Vec3<Value> const& m) {
  return multiply_add(Value(Value(0) - dot(m, a)), m, a);
}

/// d^K/dt^K of A - (m.A) m.
template <int K, class Generator, class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> orthogonal_derivative(Generator const& generator,
                                                              Vec3<Value> const* m,
                                                              Vec3<Value> const* source) {
  Vec3<Value> a[K + 1];
  Value along[K + 1];
  unrolled<K + 1>([&](auto order) {
    a[order] = generator.template derivative<order()>(m, source);
    along[order] = Value(0);
    leibniz<order()>([&](auto weight, auto j, auto rest) {
      along[order] = multiply_add(Value(weight()), dot(m[j], a[rest]), along[order]);
    });
  });
  Vec3<Value> result = a[K];
  leibniz<K>([&](auto weight, auto j, auto rest) {
    result = multiply_add(Value(Value(-weight()) * along[j]), m[rest], result);
  });
  return result;
}

}  // namespace detail

/// A generator without its part along the spin: A_o = A - (m.A) m.
template <class Generator>
class Orthogonal {
 public:
  static constexpr bool depends_on_time = detail::depends_on_time<Generator>;

  explicit Orthogonal(Generator generator) : generator_(std::move(generator)) {}

  template <class Exec, class Spins>
  auto prepare(Exec const& exec, Spins const& spins, double t) const {
    auto prepared = detail::prepare_term(generator_, exec, spins, t);
    return Orthogonal<decltype(prepared)>(std::move(prepared));
  }
  template <class Exec, class Spins>
  auto prepare_local(Exec const& exec, Spins const& spins, double t) const {
    auto prepared = detail::prepare_local_generator(generator_, exec, spins, t);
    return Orthogonal<decltype(prepared)>(std::move(prepared));
  }
  template <class Exec, class Spins>
  bool is_stationary(Exec const& exec, Spins const& spins) const {
    return detail::is_stationary(generator_, exec, spins);
  }
  template <class Exec, class Spins>
  bool needs_time_alone(Exec const& exec, Spins const& spins) const {
    return detail::needs_time_alone(generator_, exec, spins);
  }
  template <class Exec, class Spins>
  auto prepare_rate(Exec const& exec, Spins const& rates, double t, double dt) const {
    auto prepared = detail::prepare_rate(generator_, exec, rates, t, dt);
    return Orthogonal<decltype(prepared)>(std::move(prepared));
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> operator()(
      Stencil const& stencil) const {
    return detail::orthogonal_part(detail::evaluate(generator_, stencil), stencil.center());
  }

  /// Of generators made of a field.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> neighbor_field(
      Stencil const& stencil) const {
    return detail::neighbor_field_of(generator_, stencil);
  }
  template <class Spin, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> generator_at(Spin const& spin,
                                                       Vec3<Value> const& neighbor_field) const {
    return detail::orthogonal_part(detail::generator_at(generator_, spin, neighbor_field),
                                   spin.center());
  }

  /// The generator whose part along the spin was removed.
  Generator const& bare() const { return generator_; }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> series_source(
      Stencil const& stencil) const {
    return generator_.series_source(stencil);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> linear_series_source(
      Stencil const& stencil) const {
    return generator_.linear_series_source(stencil);
  }
  /// The K-th time derivative of A_o from those of m and of the series' source.
  template <int K, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> derivative(Vec3<Value> const* m,
                                                     Vec3<Value> const* source) const {
    return detail::orthogonal_derivative<K>(generator_, m, source);
  }

  static constexpr bool is_local = detail::is_local<Generator>;
  bool is_conservative() const { return generator_.is_conservative(); }
  KOKKOS_FUNCTION static constexpr bool is_orthogonal() { return true; }

  /// Of rigid bodies.
  template <class Value, class Site>
  KOKKOS_FORCEINLINE_FUNCTION auto inverse_inertia(Site const& site) const {
    return generator_.template inverse_inertia<Value>(site);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    return generator_.energy_density(stencil);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_magnitude(
      Stencil const& stencil) const {
    return generator_.energy_magnitude(stencil);
  }

 private:
  Generator generator_;
};

template <class Generator>
Orthogonal<Generator> orthogonal(Generator generator) {
  return Orthogonal<Generator>(std::move(generator));
}

}  // namespace cayspin
