// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/coupling.hpp>
#include <cayspin/detail/ghosts.hpp>
#include <cayspin/detail/shifted_load.hpp>
#include <cayspin/field/bonds_of_sites.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace cayspin::inline v0_1 {

namespace detail {

/// What kernels hold of PairCouplings.
template <class Real>
class PairField {
 public:
  PairField(DistantSites<Real> const& spins, BondTable const& table)
      : spins_(spins), table_(table) {}

  /// H by its degree in the spins, and the site's energy: each has half of each of its bonds.
  template <class Value>
  struct Parts {
    Vec3<Value> linear, cubic;

    KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> field() const { return linear + cubic; }
    KOKKOS_FORCEINLINE_FUNCTION Value energy(Vec3<Value> const& m) const {
      return Value(-0.25) * dot(m, Value(2) * linear + cubic);
    }
  };

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    return parts(stencil).field();
  }
  /// Of couplings without a biquadratic part, which is left out.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> linear_field(
      Stencil const& stencil) const {
    return parts(stencil).linear;
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    return parts(stencil).energy(stencil.center());
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Parts<typename Stencil::value_type> parts(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const& site = stencil.site();
    auto const& of_site = table_.sites[table_.site_of_plane(site.z())];
    std::int32_t const x = site.x(), y = site.y(), z = site.z();
    std::ptrdiff_t const offset = site.offset();
    bool const holds_rows = of_site.reach.holds_rows(y, z, spins_.extent);
    if (holds_rows && of_site.reach.holds_along_row(x, lanes_of<Value>, spins_.extent)) [[likely]]
      return sum<Value>(of_site, stencil.center(), [&](Bond const& bond) {
        return spins_.template inside<Value>(offset + bond.template offset<Real>());
      });
    return sum<Value>(of_site, stencil.center(), [&](Bond const& bond) {
      Real const* const row =
          holds_rows ? spins_.array.data + (offset + bond.template offset<Real>() - x - bond.dx)
                     : spins_.row(y + bond.dy, z + bond.dz);
      return row ? spins_.template along<Value>(row, x + bond.dx) : zero<Value>();
    });
  }

  template <class Value, class Load>
  KOKKOS_FORCEINLINE_FUNCTION Parts<Value> sum(BondsOfSite const& of_site, Vec3<Value> const& m,
                                               Load const& load) const {
    Parts<Value> sums{zero<Value>(), zero<Value>()};
    for (std::int32_t g = of_site.first_shell; g < of_site.last_shell; ++g) {
      auto const& shell = table_.shells[g];
      Vec3<Value> all = load(table_.bonds[shell.first]);
      for (std::int32_t b = shell.first + 1; b < shell.last; ++b) all = all + load(table_.bonds[b]);
      sums.linear = multiply_add(as_value<Value>(shell.exchange), all, sums.linear);
    }
    for (std::int32_t b = of_site.first_tensor; b < of_site.last_tensor; ++b) {
      Vec3<Value> const there = load(table_.bonds[b]);
      double const* const t = table_.tensors[b - table_.first_of_tensors].of;
      auto const row = [&](int i) {
        return Vec3<Value>{as_value<Value>(t[i]), as_value<Value>(t[i + 1]),
                           as_value<Value>(t[i + 2])};
      };
      sums.linear =
          sums.linear + Vec3<Value>{dot(row(0), there), dot(row(3), there), dot(row(6), there)};
      if (t[9] != 0)
        sums.cubic =
            multiply_add(Value(as_value<Value>(2 * t[9]) * dot(m, there)), there, sums.cubic);
    }
    return sums;
  }

  DistantSites<Real> spins_;
  BondTable table_;
};

}  // namespace detail

/// Bonds between any sites of a crystal: E = -m.T m' - B (m.m')^2 of each Coupling, so that
/// H = T m' + 2 B (m.m') m', and T transposed the other way. Bonds past an open end are none. A
/// periodic axis that is shorter than a bond closes on itself. On a part of a lattice its ghosts
/// have to be up to date before each look, which steppers do not see to.
template <class MemorySpace = Kokkos::DefaultExecutionSpace::memory_space>
class PairCouplings {
 public:
  /// Throws std::invalid_argument for a coupling of sites that no cell has, one of a site with
  /// itself, a number that is not finite, and a part of a lattice with fewer ghosts than bonds
  /// reach.
  PairCouplings(Lattice const& lattice, std::vector<Coupling> const& couplings)
      : PairCouplings(lattice, detail::BondLists(lattice, couplings)) {}

  template <class Spins>
  void check_spins(Spins const& spins) const {
    static_assert(std::is_same_v<typename Spins::memory_space, MemorySpace>,
                  "PairCouplings were made for spins in another memory space.");
    require_lattice("cayspin::PairCouplings", lattice_, spins.lattice());
    detail::require_whole("cayspin::PairCouplings", lattice_);
  }
  template <class Exec, class Spins>
  detail::PairField<typename Spins::value_type> prepare(Exec const&, Spins const& spins,
                                                        double) const {
    return {{spins.array(), spins.layout()}, bonds_.table()};
  }

  /// The largest |H| of unit spins at each site of a cell, or an upper bound of it.
  std::vector<double> const& field_bounds() const { return field_bounds_; }

  /// Is H more than linear in the spins?
  bool has_biquadratic() const { return bonds_.table().has_biquadratic; }

 private:
  PairCouplings(Lattice const& lattice, detail::BondLists const& lists)
      : lattice_(lattice), bonds_(lists), field_bounds_(lists.field_bounds) {
    auto const [rows, cells] = lists.rows_and_cells();
    require_ghosts(lattice.ghosts[1], rows);
    require_ghosts(lattice.ghosts[2], cells * lattice.cell_sites);
  }

  static void require_ghosts(Ghosts const& ghosts, std::int64_t needed) {
    for (std::int64_t const there : {ghosts.before, ghosts.after})
      if (there != 0 && there < needed)
        throw std::invalid_argument("cayspin::PairCouplings: bonds reach over " +
                                    std::to_string(needed) + " rows or planes, and the part has " +
                                    std::to_string(there) + " ghosts");
  }

  Lattice lattice_;
  detail::BondsOfSites<MemorySpace> bonds_;
  std::vector<double> field_bounds_;
};

PairCouplings(Lattice, std::vector<Coupling>) -> PairCouplings<>;

}  // namespace cayspin::inline v0_1
