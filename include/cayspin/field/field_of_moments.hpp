// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/row_fields.hpp>
#include <cayspin/field/cell_moments.hpp>
#include <cayspin/field/effective_field.hpp>
#include <cayspin/field/forwarding.hpp>
#include <cayspin/field/parts.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>

#include <cstdint>
#include <type_traits>
#include <utility>

namespace cayspin::inline v0_2 {

namespace detail {

/// A FieldOfMoments prepared for one time, for kernels.
template <class Field>
class FieldTimesNumbers : public ForwardingEnergy<FieldTimesNumbers<Field>, Field> {
 public:
  static constexpr bool is_local = detail::is_local<Field>;

  FieldTimesNumbers(Field field, NumbersOfCell const& factors)
      : field_(std::move(field)), factors_(factors) {}

  KOKKOS_FORCEINLINE_FUNCTION Field const& part() const { return field_; }

  // Called by stages that go row by row (detail/row_fields.hpp).
  static constexpr int row_fields = detail::row_fields<Field>;
  template <class Real>
  void begin_row(RowOfSpins<Real> const& row, std::int32_t begin, std::int32_t end,
                 RowFields<Real> const& fields) {
    if constexpr (row_fields > 0) field_.begin_row(row, begin, end, fields);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    return gather(WholeField(), stencil);
  }
  template <class Take, class Stencil>
    requires(!std::is_same_v<Take, TurningField>)  // turning_field() then calls `field`
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> gather(Take const& take,
                                                       Stencil const& stencil) const {
    return factors_.at(stencil.site()) * take(field_, stencil);
  }
  KOKKOS_FORCEINLINE_FUNCTION bool local_field_varies() const {
    return detail::local_field_varies(field_);
  }

  friend PartsOf<Field> parts_of(FieldTimesNumbers const*) { return {}; }

 private:
  Field field_;
  NumbersOfCell factors_;
};

/// ZeemanOfMoments for kernels.
struct AppliedToMoments {
  static constexpr int degree = 1;  // H does not depend on the spins
  static constexpr bool is_local = true;
  Vec3<double> applied;
  NumbersOfCell moments;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    return moments.at(stencil.site()) * as_value<ValueOf<Stencil>>(applied);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return Value(-1) * dot(stencil.center(), field(stencil));
  }
};

}  // namespace detail

/// The field of spins whose moment mu and gyromagnetic ratio g depend on the site of a crystal's
/// cell: H = -(g / mu) * dE/dm, with the energy E of the terms in `field`. All terms must be in
/// `field`; for an applied field use ZeemanOfMoments. Sites without a spin have H = 0. Their spins
/// must be zero vectors, which contribute nothing to PairCouplings. Terms like Exchange, which use
/// the lattice's nearest neighbours, must be in a FieldWithVacancies to leave these sites out.
/// Without damping, E is conserved as usual. But H is not -dE/dm, so EnergyControl, and all other
/// code that needs H = -dE/dm, refuses a FieldOfMoments. It accepts `field` itself.
template <class Field, class MemorySpace>
class FieldOfMoments : public Forwarding<FieldOfMoments<Field, MemorySpace>, Field> {
 public:
  static constexpr int energy_terms = detail::energy_terms<Field>;
  static constexpr bool is_conservative = false;

  FieldOfMoments(Field field, CellMoments<MemorySpace> moments)
      : field_(std::move(field)), moments_(std::move(moments)) {}

  template <class Spins>
  void check_spins(Spins const& spins) const {
    static_assert(std::is_same_v<typename Spins::memory_space, MemorySpace>,
                  "FieldOfMoments was made for spins in another memory space.");
    require_lattice("cayspin::FieldOfMoments", moments_.lattice(), spins.lattice());
  }
  // Called by Forwarding.
  template <class Make>
  auto with_parts(Make const& make) const {
    using Prepared = decltype(make(field_));
    return detail::FieldTimesNumbers<Prepared>(make(field_), moments_.factors());
  }
  template <class Test>
  bool all_parts(Test const& test) const {
    return test(field_);
  }

 private:
  Field field_;
  CellMoments<MemorySpace> moments_;
};

/// A uniform field `applied` to the moments of a crystal's sites: E = -mu * (m.applied) per site.
/// Use it in a FieldOfMoments.
template <class MemorySpace>
class ZeemanOfMoments : public detail::PreparedOnce {
 public:
  static constexpr bool is_local = true;

  /// Throws std::invalid_argument when the applied field is not finite.
  ZeemanOfMoments(Vec3<double> const& applied, CellMoments<MemorySpace> moments)
      : applied_(detail::finite(applied, "cayspin::ZeemanOfMoments: the applied field")),
        moments_(std::move(moments)) {}

  template <class Spins>
  void check_spins(Spins const& spins) const {
    static_assert(std::is_same_v<typename Spins::memory_space, MemorySpace>,
                  "ZeemanOfMoments was made for spins in another memory space.");
    require_lattice("cayspin::ZeemanOfMoments", moments_.lattice(), spins.lattice());
  }
  template <class Exec, class Spins>
  detail::AppliedToMoments prepare(Exec const&, Spins const&, double) const {
    return {applied_, moments_.moments()};
  }

 private:
  Vec3<double> applied_;
  CellMoments<MemorySpace> moments_;
};

}  // namespace cayspin::inline v0_2
