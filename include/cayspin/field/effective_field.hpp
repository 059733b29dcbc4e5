// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/attributes.hpp>
#include <cayspin/detail/row_fields.hpp>
#include <cayspin/field/forwarding.hpp>
#include <cayspin/field/local_part.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/stencil.hpp>

#include <cstdint>
#include <utility>

namespace cayspin::inline v0_1 {

/// The sum of field terms, composed by type: what is not listed is not computed. A term is a plain
/// struct with two const, device-callable templates:
/// - `Vec3<Value> field(stencil)`, H at the stencil's centre,
/// - `Value energy_density(stencil)`, its share of E, with H = -dE/dm,
///
/// where Value = Stencil::value_type. What else a term may say: FieldTerm in concepts.hpp.
template <class... Terms>
class EffectiveField;

/// No terms. What it does not say is that of a field without the spins.
template <>
class EffectiveField<> : public Forwarding<EffectiveField<>> {
 public:
  static constexpr int degree = 1, energy_terms = 0, row_fields = 0;

  template <class Real>
  void begin_row(detail::RowOfSpins<Real> const&, std::int32_t, std::int32_t,
                 detail::RowFields<Real> const&) {}
  template <class Make>
  EffectiveField with_parts(Make const&) const {
    return {};
  }
  template <class Test>
  bool all_parts(Test const&) const {
    return true;
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const&) const {
    return zero<ValueOf<Stencil>>();
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const&) const {
    return ValueOf<Stencil>(0);
  }
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void energy_densities(Stencil const&, Value*) const {}
};

template <class First, class... Rest>
class EffectiveField<First, Rest...>
    : public Forwarding<EffectiveField<First, Rest...>, First, Rest...> {
 public:
  static constexpr int energy_terms = 1 + static_cast<int>(sizeof...(Rest));

  explicit EffectiveField(First first, Rest... rest)
      : first_(std::move(first)), rest_(std::move(rest)...) {}

  // For stages over rows.
  static constexpr int row_fields = detail::row_fields<First> + EffectiveField<Rest...>::row_fields;
  template <class Real>
  void begin_row(detail::RowOfSpins<Real> const& row, std::int32_t begin, std::int32_t end,
                 detail::RowFields<Real> const& fields) {
    if constexpr (detail::row_fields<First> > 0) first_.begin_row(row, begin, end, fields);
    rest_.begin_row(row, begin, end, fields.after(detail::row_fields<First>));
  }

  // For Forwarding.
  template <class Make>
  auto with_parts(Make const& make) const {
    return join(make(first_), rest_.with_parts(make));
  }
  template <class Test>
  bool all_parts(Test const& test) const {
    return test(first_) && rest_.all_parts(test);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    detail::check_field<First, Stencil>();
    detail::check_energy_density<First, Stencil>();
    if constexpr (sizeof...(Rest) == 0)
      return first_.field(stencil);
    else
      return detail::add_field(first_, stencil, rest_.field(stencil));
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> turning_field(Stencil const& stencil) const {
    detail::check_field<First, Stencil>();
    detail::check_energy_density<First, Stencil>();
    if constexpr (sizeof...(Rest) == 0)
      return detail::turning_field(first_, stencil);
    else
      return detail::add_turning_field(first_, stencil, rest_.turning_field(stencil));
  }

  /// The part of H that is not local.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> neighbor_field(Stencil const& stencil) const {
    if constexpr (detail::is_local<First>)
      return detail::neighbor_field(rest_, stencil);
    else if constexpr (EffectiveField<Rest...>::is_local)
      return detail::neighbor_field(first_, stencil);
    else
      return detail::neighbor_field(first_, stencil) + detail::neighbor_field(rest_, stencil);
  }

  /// The rest of H.
  template <class Spin>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Spin> local_field(Spin const& spin) const {
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
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> linear_field(Stencil const& stencil) const
    requires detail::has_linear_part<First, Stencil> &&
             detail::has_linear_part<EffectiveField<Rest...>, Stencil>
  {
    return detail::linear_field(first_, stencil) + detail::linear_field(rest_, stencil);
  }

  /// The derivative of H at a spin m, along the rates of the stencil's array.
  template <class Value, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> field_rate(Vec3<Value> const& m,
                                                     Stencil const& rates) const
    requires detail::has_derivative<First, Stencil> &&
             detail::has_derivative<EffectiveField<Rest...>, Stencil>
  {
    return detail::field_rate(first_, m, rates) + detail::field_rate(rest_, m, rates);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    detail::check_energy_density<First, Stencil>();
    return first_.energy_density(stencil) + rest_.energy_density(stencil);
  }

  /// Sum of |energy density| over the terms: what round-off in the energy is proportional to.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_magnitude(Stencil const& stencil) const {
    return Kokkos::abs(first_.energy_density(stencil)) + detail::energy_magnitude(rest_, stencil);
  }

  /// The energy density of each term, in their order.
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void energy_densities(Stencil const& stencil, Value* energies) const {
    detail::check_energy_density<First, Stencil>();
    energies[0] = first_.energy_density(stencil);
    rest_.energy_densities(stencil, energies + 1);
  }

 private:
  template <class...>
  friend class EffectiveField;

  EffectiveField(First first, EffectiveField<Rest...> rest)
      : first_(std::move(first)), rest_(std::move(rest)) {}

  template <class Prepared, class... Others>
  static auto join(Prepared first, EffectiveField<Others...> rest) {
    return EffectiveField<Prepared, Others...>::from(std::move(first), std::move(rest));
  }
  static EffectiveField from(First first, EffectiveField<Rest...> rest) {
    EffectiveField joined(std::move(first), std::move(rest));
    return joined;
  }

  First first_;
  CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS EffectiveField<Rest...> rest_;
};

template <class... Terms>
EffectiveField(Terms...) -> EffectiveField<Terms...>;

namespace detail {
template <class... Terms, class Stencil>
inline constexpr bool comes_in_parts<EffectiveField<Terms...>, Stencil> =
    (comes_in_parts<Terms, Stencil> && ...);
}  // namespace detail

}  // namespace cayspin::inline v0_1
