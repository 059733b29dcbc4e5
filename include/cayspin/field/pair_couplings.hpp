// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/coupling.hpp>
#include <cayspin/detail/ghosts.hpp>
#include <cayspin/field/bonds_of_sites.hpp>
#include <cayspin/field/pair_field.hpp>
#include <cayspin/spin_field.hpp>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace cayspin::inline v0_2 {

/// Bonds between any sites of a crystal:
/// E = -m.(T m') - B * (m.m')^2 for each Coupling, so that
/// H = T m' + 2 * B * (m.m') * m' at m, and H = T^T m + 2 * B * (m.m') * m at m', where T^T is the
/// transpose of T. Bonds past an open end are omitted. A bond may be longer than a periodic axis,
/// and then wraps around it. On a part of a lattice (mpi::Domain) every evaluation throws
/// std::invalid_argument, because between the stages of a step the ghosts are not updated as far
/// out as bonds may reach.
template <class MemorySpace = Kokkos::DefaultExecutionSpace::memory_space>
class PairCouplings {
 public:
  /// Throws std::invalid_argument for an invalid lattice, a coupling with a site number that the
  /// cell does not have or of a site with itself, a non-finite number, and a part of a lattice
  /// whose ghosts do not cover the reach of the bonds.
  PairCouplings(Lattice const& lattice, std::vector<Coupling> const& couplings)
      : PairCouplings(lattice, detail::BondLists(detail::validated(lattice), couplings)) {}

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
  template <class Exec, class Spins>
  auto prepare_for_rows(Exec const& exec, Spins const& spins, double t) const {
    using Real = typename Spins::value_type;
    if constexpr (detail::host_lanes<Real> > 1)
      return detail::PairFieldAlongRows<Real>({spins.array(), spins.layout()}, bonds_.table());
    else
      return prepare(exec, spins, t);
  }

  /// Returns an upper bound on |H| at each site of a cell, for spins of length 1.
  std::vector<double> const& field_bounds() const { return field_bounds_; }

  /// Returns true if no bond is biquadratic. H is then linear in the spins.
  bool is_affine() const { return !has_biquadratic(); }
  /// Returns true if a bond is biquadratic. H is then not linear in the spins.
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

}  // namespace cayspin::inline v0_2
