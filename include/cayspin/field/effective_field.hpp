// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/field/local_part.hpp>
#include <cayspin/stencil.hpp>

#include <utility>

namespace cayspin {

/// The sum of field terms, composed by type: what is not listed is not computed.
///
/// A term is a plain struct with two device-callable templates,
///   Vec3<Value> field(Stencil const&) const          H at the stencil's centre
///   Value       energy_density(Stencil const&) const its share of E, with H = -dE/dm
/// where Value = Stencil::value_type. A term that needs more than neighbours, or depends on time,
/// has instead
///   auto prepare(exec, spins, t) const
/// which is called on the host before each stage and returns such a struct; a term whose numbers
/// then change with t, and not with the spins, says static constexpr bool depends_on_time = true.
///
/// For isotropy::Analytic and Series4 a term also says how its H depends on the spins:
///   static constexpr int degree                     2 where H is linear in the spins, 1 where it
///                                                   does not depend on them
///   Vec3<Value> linear_field(Stencil const&) const  where H is affine: its linear part
///   Vec3<Value> field_rate(Vec3<Value> const& m, Stencil const& rates) const
///                                                   otherwise, for Analytic: dH/dt along the rates
/// and, where H depends on t, prepare_rate(exec, rates, t, dt), which returns such a struct.
///
/// Methods that extrapolate the field of other spins are more accurate for a term that says
///   static constexpr bool is_local = true           its H depends on the spin itself and on t
///   alone
/// before it is prepared and after, or has a neighbor_field(stencil) (field/local_part.hpp).
template <class... Terms>
class EffectiveField;

template <>
class EffectiveField<> {
 public:
  static constexpr bool is_local = true;

  template <class Exec, class Spins>
  EffectiveField prepare(Exec const&, Spins const&, double) const {
    return {};
  }
  template <class Exec, class Spins>
  EffectiveField prepare_local(Exec const&, Spins const&, double) const {
    return {};
  }
  template <class Exec, class Spins>
  EffectiveField prepare_rate(Exec const&, Spins const&, double, double) const {
    return {};
  }
  template <class Exec, class Spins>
  bool is_stationary(Exec const&, Spins const&) const {
    return true;
  }
  template <class Exec, class Spins>
  bool needs_time_alone(Exec const&, Spins const&) const {
    return true;
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(Stencil const&) const {
    return zero<typename Stencil::value_type>();
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> neighbor_field(
      Stencil const&) const {
    return zero<typename Stencil::value_type>();
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> linear_field(
      Stencil const&) const {
    return zero<typename Stencil::value_type>();
  }
  template <class Value, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> field_rate(Vec3<Value> const&, Stencil const&) const {
    return zero<Value>();
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(Stencil const&) const {
    return typename Stencil::value_type(0);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_magnitude(Stencil const&) const {
    return typename Stencil::value_type(0);
  }

 private:
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> zero() {
    return {Value(0), Value(0), Value(0)};
  }
};

template <class First, class... Rest>
class EffectiveField<First, Rest...> {
 public:
  static constexpr bool depends_on_time =
      detail::depends_on_time<First> || (detail::depends_on_time<Rest> || ...);
  static constexpr bool is_local = detail::is_local<First> && (detail::is_local<Rest> && ...);

  explicit EffectiveField(First first, Rest... rest)
      : first_(std::move(first)), rest_(std::move(rest)...) {}

  /// Every term made ready for one evaluation at time t.
  template <class Exec, class Spins>
  auto prepare(Exec const& exec, Spins const& spins, double t) const {
    return join(detail::prepare_term(first_, exec, spins, t), rest_.prepare(exec, spins, t));
  }
  /// The local terms, and local parts of others.
  template <class Exec, class Spins>
  auto prepare_local(Exec const& exec, Spins const& spins, double t) const {
    if constexpr (detail::has_local_part<First, Exec, Spins>)
      return join(detail::prepare_local(first_, exec, spins, t),
                  rest_.prepare_local(exec, spins, t));
    else
      return rest_.prepare_local(exec, spins, t);
  }
  template <class Exec, class Spins>
  auto prepare_rate(Exec const& exec, Spins const& rates, double t, double dt) const {
    return join(detail::prepare_rate(first_, exec, rates, t, dt),
                rest_.prepare_rate(exec, rates, t, dt));
  }
  template <class Exec, class Spins>
  bool is_stationary(Exec const& exec, Spins const& spins) const {
    return detail::is_stationary(first_, exec, spins) && rest_.is_stationary(exec, spins);
  }
  template <class Exec, class Spins>
  bool needs_time_alone(Exec const& exec, Spins const& spins) const {
    return detail::needs_time_alone(first_, exec, spins) && rest_.needs_time_alone(exec, spins);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    check<Stencil>();
    if constexpr (sizeof...(Rest) == 0) {
      return first_.field(stencil);
    } else {
      return first_.field(stencil) + rest_.field(stencil);
    }
  }

  /// The part of H that is not local.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> neighbor_field(
      Stencil const& stencil) const {
    if constexpr (detail::is_local<First>)
      return rest_.neighbor_field(stencil);
    else if constexpr (EffectiveField<Rest...>::is_local)
      return detail::neighbor_field(first_, stencil);
    else
      return detail::neighbor_field(first_, stencil) + rest_.neighbor_field(stencil);
  }

  /// H of what prepare_local returned.
  template <class Spin>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Spin::value_type> local_field(Spin const& spin) const {
    if constexpr (sizeof...(Rest) == 0)
      return detail::local_field(first_, spin);
    else
      return detail::local_field(first_, spin) + rest_.local_field(spin);
  }

  KOKKOS_FORCEINLINE_FUNCTION bool local_field_varies() const {
    if constexpr (sizeof...(Rest) == 0)
      return detail::local_field_varies(first_);
    else
      return detail::local_field_varies(first_) || rest_.local_field_varies();
  }

  /// The linear part of H, applied to the stencil's array; every term has to be affine.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> linear_field(
      Stencil const& stencil) const {
    return detail::linear_field(first_, stencil) + rest_.linear_field(stencil);
  }

  /// The derivative of H at a spin m, along the rates of the stencil's array.
  template <class Value, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> field_rate(Vec3<Value> const& m,
                                                     Stencil const& rates) const {
    return detail::field_rate(first_, m, rates) + rest_.field_rate(m, rates);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    check<Stencil>();
    return first_.energy_density(stencil) + rest_.energy_density(stencil);
  }

  /// Sum of |energy density| over the terms: what round-off in the energy is proportional to.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_magnitude(
      Stencil const& stencil) const {
    return Kokkos::abs(first_.energy_density(stencil)) + rest_.energy_magnitude(stencil);
  }

 private:
  template <class...>
  friend class EffectiveField;

  EffectiveField(First first, EffectiveField<Rest...> rest)
      : first_(std::move(first)), rest_(std::move(rest)) {}

  template <class Prepared, class... Others>
  static EffectiveField<Prepared, Others...> join(Prepared first, EffectiveField<Others...> rest) {
    return EffectiveField<Prepared, Others...>::from(std::move(first), std::move(rest));
  }
  static EffectiveField from(First first, EffectiveField<Rest...> rest) {
    EffectiveField joined(std::move(first), std::move(rest));
    return joined;
  }

  template <class Stencil>
  static constexpr void check() {
    static_assert(detail::has_field<First, Stencil>,
                  "A field term needs a const, device-callable template field(stencil) that "
                  "returns Vec3<typename Stencil::value_type>, or a prepare(exec, spins, t) that "
                  "returns such a term.");
    static_assert(detail::has_energy_density<First, Stencil>,
                  "A field term needs a const, device-callable template energy_density(stencil) "
                  "that returns typename Stencil::value_type, with field = -d energy / d spin.");
  }

  First first_;
  [[no_unique_address]] EffectiveField<Rest...> rest_;
};

template <class... Terms>
EffectiveField(Terms...) -> EffectiveField<Terms...>;

namespace detail {
template <class... Terms, class Stencil>
inline constexpr bool comes_in_parts<EffectiveField<Terms...>, Stencil> =
    (comes_in_parts<Terms, Stencil> && ...);
}  // namespace detail

}  // namespace cayspin
