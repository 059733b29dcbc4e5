// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/row_fields.hpp>
#include <cayspin/detail/table.hpp>
#include <cayspin/field/effective_field.hpp>
#include <cayspin/field/forwarding.hpp>
#include <cayspin/field/local_part.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::inline v0_1 {

namespace detail {

/// A number for each site of a crystal's cell.
struct NumbersOfCell {
  double const* numbers;
  std::int32_t cell_sites;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION auto at(Site const& site) const {
    return as_value<ValueOf<Site>>(numbers[site.z() % cell_sites]);
  }
};

inline void require_positive(char const* who, std::vector<double> const& numbers) {
  for (double const number : numbers)
    if (!(number > 0) || !std::isfinite(number))
      throw std::invalid_argument(std::string(who) + ": the numbers must be positive and finite");
}
/// Moments, of which 0 is that of a site without a spin.
inline void require_moments(char const* who, std::vector<double> const& moments) {
  for (double const moment : moments)
    if (!(moment >= 0) || !std::isfinite(moment))
      throw std::invalid_argument(std::string(who) +
                                  ": a moment must be finite and positive, or 0 without a spin");
}

/// A number for each site of a cell, in memory.
template <class MemorySpace>
class CellNumbers {
 public:
  /// Throws std::invalid_argument unless there is a number for each site of a cell.
  CellNumbers(char const* who, Lattice const& lattice, std::vector<double> const& numbers)
      : view_(table_of<MemorySpace>(who, numbers)) {
    require_whole(who, lattice);
    if (static_cast<std::int64_t>(numbers.size()) != lattice.cell_sites)
      throw std::invalid_argument(std::string(who) +
                                  ": there is not one number for each site of a cell");
  }

  NumbersOfCell numbers() const { return {view_.data(), static_cast<std::int32_t>(view_.size())}; }

 private:
  Kokkos::View<double*, MemorySpace> view_;
};

/// What FieldOfMoments is at one time.
template <class Field>
class FieldTimesNumbers : public ForwardingEnergy<FieldTimesNumbers<Field>, Field> {
 public:
  static constexpr bool is_local = detail::is_local<Field>;

  FieldTimesNumbers(Field field, NumbersOfCell const& factors)
      : field_(std::move(field)), factors_(factors) {}

  KOKKOS_FORCEINLINE_FUNCTION Field const& part() const { return field_; }

  // For stages over rows.
  static constexpr int row_fields = detail::row_fields<Field>;
  template <class Real>
  void begin_row(RowOfSpins<Real> const& row, std::int32_t begin, std::int32_t end,
                 RowFields<Real> const& fields) {
    if constexpr (row_fields > 0) field_.begin_row(row, begin, end, fields);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    return factors_.at(stencil.site()) * field_.field(stencil);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> neighbor_field(Stencil const& stencil) const {
    return factors_.at(stencil.site()) * detail::neighbor_field(field_, stencil);
  }
  template <class Spin>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Spin> local_field(Spin const& spin) const {
    return factors_.at(spin.site()) * detail::local_field(field_, spin);
  }
  KOKKOS_FORCEINLINE_FUNCTION bool local_field_varies() const {
    return detail::local_field_varies(field_);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> linear_field(Stencil const& stencil) const
    requires has_linear_part<Field, Stencil>
  {
    return factors_.at(stencil.site()) * detail::linear_field(field_, stencil);
  }
  template <class Value, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> field_rate(Vec3<Value> const& m,
                                                     Stencil const& rates) const
    requires has_derivative<Field, Stencil>
  {
    return factors_.at(rates.site()) * detail::field_rate(field_, m, rates);
  }

 private:
  Field field_;
  NumbersOfCell factors_;
};

template <class Field, class Stencil>
inline constexpr bool comes_in_parts<FieldTimesNumbers<Field>, Stencil> =
    comes_in_parts<Field, Stencil>;

/// What ZeemanOfMoments is in kernels.
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

/// The field of spins that have a moment mu and a gyromagnetic ratio g each, by sites of a
/// crystal's cell: H = -(g / mu) dE/dm with the energies E of the terms inside. All terms have to
/// stand inside; an applied field is a ZeemanOfMoments there. A moment of 0 is no spin: H is 0 on
/// these sites, whose spins are to be zero vectors, by which PairCouplings see none there; lattice
/// terms do so in a FieldWithVacancies. What conserves E without damping
/// conserves it here, but H is not the derivative of E: EnergyControl and what else follows an
/// energy by its derivative refuse it, and take the field inside.
template <class Field, class MemorySpace = Kokkos::DefaultExecutionSpace::memory_space>
class FieldOfMoments : public Forwarding<FieldOfMoments<Field, MemorySpace>, Field> {
 public:
  static constexpr int energy_terms = detail::energy_terms<Field>;
  static constexpr bool is_conservative = false;

  /// `gyromagnetic`: none are all 1. Throws std::invalid_argument unless both are a number for each
  /// site of a cell, and moments not negative and gyromagnetic ratios positive.
  FieldOfMoments(Lattice const& lattice, Field field, std::vector<double> const& moments,
                 std::vector<double> const& gyromagnetic = {})
      : lattice_(lattice),
        field_(std::move(field)),
        factors_("cayspin::FieldOfMoments", lattice, factors(moments, gyromagnetic)) {}

  template <class Spins>
  void check_spins(Spins const& spins) const {
    require_lattice("cayspin::FieldOfMoments", lattice_, spins.lattice());
  }
  // For Forwarding.
  template <class Make>
  auto with_parts(Make const& make) const {
    using Prepared = decltype(make(field_));
    return detail::FieldTimesNumbers<Prepared>(make(field_), factors_.numbers());
  }
  template <class Test>
  bool all_parts(Test const& test) const {
    return test(field_);
  }

 private:
  static std::vector<double> factors(std::vector<double> const& moments,
                                     std::vector<double> const& gyromagnetic) {
    if (!gyromagnetic.empty() && gyromagnetic.size() != moments.size())
      throw std::invalid_argument(
          "cayspin::FieldOfMoments: there is not a gyromagnetic ratio for each moment");
    detail::require_moments("cayspin::FieldOfMoments", moments);
    detail::require_positive("cayspin::FieldOfMoments", gyromagnetic);
    auto made = moments;
    for (std::size_t site = 0; site < made.size(); ++site)
      made[site] =
          moments[site] == 0 ? 0 : (gyromagnetic.empty() ? 1 : gyromagnetic[site]) / moments[site];
    return made;
  }

  Lattice lattice_;
  Field field_;
  detail::CellNumbers<MemorySpace> factors_;
};

template <class Field>
FieldOfMoments(Lattice, Field, std::vector<double>, std::vector<double> = {})
    -> FieldOfMoments<Field>;

/// A uniform applied field on the moments of a crystal's sites: E = -mu m.H, in a FieldOfMoments.
template <class MemorySpace = Kokkos::DefaultExecutionSpace::memory_space>
class ZeemanOfMoments : public detail::PreparedOnce {
 public:
  static constexpr bool is_local = true;

  /// Throws std::invalid_argument unless there is a moment for each site of a cell, none of them
  /// negative, and when the applied field is not finite.
  ZeemanOfMoments(Lattice const& lattice, Vec3<double> const& applied,
                  std::vector<double> const& moments)
      : applied_(detail::finite(applied, "cayspin::ZeemanOfMoments: the applied field")),
        moments_("cayspin::ZeemanOfMoments", lattice, moments) {
    detail::require_moments("cayspin::ZeemanOfMoments", moments);
  }

  template <class Exec, class Spins>
  detail::AppliedToMoments prepare(Exec const&, Spins const&, double) const {
    return {applied_, moments_.numbers()};
  }

 private:
  Vec3<double> applied_;
  detail::CellNumbers<MemorySpace> moments_;
};

ZeemanOfMoments(Lattice, Vec3<double>, std::vector<double>) -> ZeemanOfMoments<>;

}  // namespace cayspin::inline v0_1
