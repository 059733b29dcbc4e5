// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/backend.hpp>
#include <cayspin/detail/row_fields.hpp>
#include <cayspin/field/forwarding.hpp>
#include <cayspin/field/parts.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/stencil.hpp>

#include <cstdint>
#include <utility>

namespace cayspin::inline v0_2 {

/// The sum of field terms, which are listed as template arguments; terms that are not listed cost
/// nothing. A term is a plain struct with two const, device-callable templates:
/// - `Vec3<Value> field(stencil)`, H at the stencil's centre,
/// - `Value energy_density(stencil)`, the share of that site in E, with H = -dE/dm,
///
/// where Value = Stencil::value_type. For optional members see FieldTerm in concepts.hpp.
template <class... Terms>
class EffectiveField;

/// The empty sum, which behaves as a field that does not depend on the spins.
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
  template <class Take, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> gather(Take const&, Stencil const&) const {
    return zero<ValueOf<Stencil>>();
  }
  KOKKOS_FORCEINLINE_FUNCTION bool local_field_varies() const { return false; }
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

  // Called by stages that go row by row (detail/row_fields.hpp).
  static constexpr int row_fields = detail::row_fields<First> + EffectiveField<Rest...>::row_fields;
  template <class Real>
  void begin_row(detail::RowOfSpins<Real> const& row, std::int32_t begin, std::int32_t end,
                 detail::RowFields<Real> const& fields) {
    if constexpr (detail::row_fields<First> > 0) first_.begin_row(row, begin, end, fields);
    rest_.begin_row(row, begin, end, fields.after(detail::row_fields<First>));
  }

  // Called by Forwarding.
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
    return gather(detail::WholeField(), stencil);
  }
  template <class Take, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> gather(Take const& take,
                                                       Stencil const& stencil) const {
    if constexpr (Take::template skips<First>)
      return rest_.gather(take, stencil);
    else if constexpr ((Take::template skips<Rest> && ...))
      return take(first_, stencil);
    else
      return take.add(first_, stencil, rest_.gather(take, stencil));
  }
  KOKKOS_FORCEINLINE_FUNCTION bool local_field_varies() const {
    return detail::local_field_varies(first_) || rest_.local_field_varies();
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    detail::check_energy_density<First, Stencil>();
    return first_.energy_density(stencil) + rest_.energy_density(stencil);
  }

  /// Writes the energy density of each term, in order.
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

}  // namespace cayspin::inline v0_2
