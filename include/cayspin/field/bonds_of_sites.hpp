// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/coupling.hpp>
#include <cayspin/detail/pack.hpp>
#include <cayspin/detail/table.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/part.hpp>
#include <cayspin/row_layout.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

// The bonds of each site of a cell, in the order in which kernels sum them.
namespace cayspin::inline v0_2::detail {

/// Distance in memory to another site. It differs between arrays of doubles and of floats, because
/// their rows are padded differently.
struct OffsetInMemory {
  std::ptrdiff_t of_doubles, of_floats;

  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION std::ptrdiff_t offset() const {
    return std::is_same_v<Real, double> ? of_doubles : of_floats;
  }
};
/// The offset to the other site, in memory and along x, y and z.
struct Bond : OffsetInMemory {
  std::int32_t dx, dy, dz;
};
/// A range of bonds that have the same exchange constant.
struct Shell {
  std::int32_t first, last;
  double exchange;
};
/// The tensor T of a bond (see PairCouplings), row by row, and then the bond's constant B.
struct BondTensor {
  double of[10];
};
/// How far the bonds of a site reach towards lower and higher coordinates, along each axis.
struct Reach {
  std::int32_t low[3] = {}, high[3] = {};

  void include(std::array<std::int32_t, 3> const& way) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::max(low[axis], -way[axis]);
      high[axis] = std::max(high[axis], way[axis]);
    }
  }
  /// Return true if no bond leads out of the lattice: along y and z, from the row at y, z; along x,
  /// from the sites x .. x + lanes - 1.
  KOKKOS_FORCEINLINE_FUNCTION bool holds_rows(std::int32_t y, std::int32_t z,
                                              std::int32_t const* extent) const {
    return y >= low[1] && y + high[1] < extent[1] && z >= low[2] && z + high[2] < extent[2];
  }
  KOKKOS_FORCEINLINE_FUNCTION bool holds_along_row(std::int32_t x, std::int32_t lanes,
                                                   std::int32_t const* extent) const {
    return x >= low[0] && x + lanes + high[0] <= extent[0];
  }
};

/// Bonds of one site of a cell: first those of its shells, then those with a tensor.
struct BondsOfSite {
  std::int32_t first_shell, last_shell, first_bond, first_tensor, last_bond;
  std::int32_t to_tensor;  // a bond's number plus this is its tensor's number
  std::int32_t first_round;
  std::int32_t farthest;  // bond to the row that a pass through the lattice reaches last
  Reach reach;
};

/// The table of bonds for kernels.
struct BondTable {
  BondsOfSite const* sites;
  Shell const* shells;
  Bond const* bonds;
  BondTensor const* tensors;
  OffsetInMemory const* rounds;
  std::int32_t cell_sites;
  bool has_biquadratic;

  KOKKOS_FORCEINLINE_FUNCTION std::int32_t site_of_plane(std::int32_t z) const {
    if (cell_sites == 1) return 0;
    return (cell_sites & (cell_sites - 1)) == 0 ? z & (cell_sites - 1) : z % cell_sites;
  }
};

/// Builder of the tables.
class BondLists {
 public:
  std::vector<BondsOfSite> sites;
  std::vector<Shell> shells;
  std::vector<Bond> bonds;
  std::vector<BondTensor> tensors;
  /// For lattices that are periodic along x: the wrapped offsets of all bonds of a site, at each of
  /// the first reach.low[0] and the last reach.high[0] sites of a row. A site of the cell has no
  /// such offsets if its bonds reach farther along x than the length of a pack of floats.
  std::vector<OffsetInMemory> rounds;
  bool has_biquadratic = false;
  /// Upper bound on |H| at each site of a cell, for spins of length 1.
  std::vector<double> field_bounds;

  /// Throws std::invalid_argument for the couplings for which PairCouplings does.
  BondLists(Lattice const& lattice, std::vector<Coupling> const& couplings) {
    for (int site = 0; site < static_cast<int>(lattice.cell_sites); ++site) {
      auto seen = seen_from(site, lattice, couplings);
      std::ranges::stable_sort(seen, {}, [](Seen const& bond) { return bond.way[0]; });
      auto& mine = sites.emplace_back();
      add_shells(seen, lattice, mine);
      add_tensors(seen, lattice, mine);
      double bound = 0;
      for (auto const& bond : seen) {
        mine.reach.include(bond.way);
        bound += bond.bound();
      }
      field_bounds.push_back(bound);
      find_farthest(mine);
      add_rounds(lattice, mine);
    }
  }

  /// Returns how many rows along y and cells along z the longest bonds reach.
  std::array<std::int32_t, 2> rows_and_cells() const {
    std::array<std::int32_t, 2> most{};
    auto const of_cell = static_cast<std::int32_t>(sites.size());
    for (std::int32_t site = 0; site < of_cell; ++site) {
      auto const& [low, high] = sites[static_cast<std::size_t>(site)].reach;
      most[0] = std::max({most[0], low[1], high[1]});
      most[1] =
          std::max({most[1], (site + high[2]) / of_cell, (low[2] - site + of_cell - 1) / of_cell});
    }
    return most;
  }

 private:
  struct Seen {
    std::array<std::int32_t, 3> way;
    BondTensor tensor;

    bool is_exchange() const {
      auto const& t = tensor.of;
      return t[0] == t[4] && t[4] == t[8] && t[1] == 0 && t[2] == 0 && t[3] == 0 && t[5] == 0 &&
             t[6] == 0 && t[7] == 0 && t[9] == 0;
    }
    /// Returns an upper bound on the bond's |H| for unit spins: |J| for exchange; otherwise the
    /// Frobenius norm of T plus 2 * |B|, with the biquadratic constant B.
    double bound() const {
      if (is_exchange()) return std::abs(tensor.of[0]);
      double sum = 0;
      for (int i = 0; i < 9; ++i) sum += tensor.of[i] * tensor.of[i];
      return std::sqrt(sum) + 2 * std::abs(tensor.of[9]);
    }
  };

  static OffsetInMemory in_memory(Lattice const& lattice, std::int32_t x, std::int32_t y,
                                  std::int32_t z) {
    return {RowLayout::of<double>(lattice).row_offset(y, z) + x,
            RowLayout::of<float>(lattice).row_offset(y, z) + x};
  }
  void add(Seen const& bond, Lattice const& lattice) {
    auto const [x, y, z] = bond.way;
    bonds.push_back({in_memory(lattice, x, y, z), x, y, z});
  }
  void find_farthest(BondsOfSite& mine) const {
    mine.farthest = mine.first_bond;
    auto const row = [&](std::int32_t b) {
      auto const& bond = bonds[static_cast<std::size_t>(b)];
      return std::pair(bond.dz, bond.dy);
    };
    for (std::int32_t b = mine.first_bond; b < mine.last_bond; ++b)
      if (row(b) > row(mine.farthest)) mine.farthest = b;
  }
  void add_rounds(Lattice const& lattice, BondsOfSite& mine) {
    mine.first_round = count(rounds);
    auto const nx = static_cast<std::int32_t>(lattice.shape[0]);
    auto const add_at = [&](std::int32_t site) {
      for (std::int32_t b = mine.first_bond; b < mine.last_bond; ++b) {
        auto const& bond = bonds[static_cast<std::size_t>(b)];
        std::int32_t const there = site + bond.dx, way = (there < 0 ? nx : there < nx ? 0 : -nx);
        rounds.push_back(in_memory(lattice, bond.dx + way, bond.dy, bond.dz));
      }
    };
    if (lattice.boundary[0] != Boundary::periodic ||
        std::max(mine.reach.low[0], mine.reach.high[0]) > host_lanes<float>)
      return;  // no wrapping, or each bond is wrapped in the kernel
    for (std::int32_t site = 0; site < mine.reach.low[0]; ++site) add_at(site);
    for (std::int32_t site = nx - mine.reach.high[0]; site < nx; ++site) add_at(site);
  }
  void add_shells(std::vector<Seen> const& seen, Lattice const& lattice, BondsOfSite& mine) {
    std::vector<double> constants;
    for (auto const& bond : seen)
      if (bond.is_exchange() && std::ranges::find(constants, bond.tensor.of[0]) == constants.end())
        constants.push_back(bond.tensor.of[0]);
    mine.first_bond = count(bonds);
    mine.first_shell = count(shells);
    for (double const constant : constants) {
      auto& shell = shells.emplace_back(Shell{count(bonds), 0, constant});
      for (auto const& bond : seen)
        if (bond.is_exchange() && bond.tensor.of[0] == constant) add(bond, lattice);
      shell.last = count(bonds);
    }
    mine.last_shell = count(shells);
  }
  void add_tensors(std::vector<Seen> const& seen, Lattice const& lattice, BondsOfSite& mine) {
    mine.first_tensor = count(bonds);
    mine.to_tensor = count(tensors) - count(bonds);
    for (auto const& bond : seen) {
      if (bond.is_exchange()) continue;
      add(bond, lattice);
      tensors.push_back(bond.tensor);
      has_biquadratic = has_biquadratic || bond.tensor.of[9] != 0;
    }
    mine.last_bond = count(bonds);
  }
  template <class Element>
  static std::int32_t count(std::vector<Element> const& elements) {
    return static_cast<std::int32_t>(elements.size());
  }

  static std::vector<Seen> seen_from(int site, Lattice const& lattice,
                                     std::vector<Coupling> const& couplings) {
    std::vector<Seen> seen;
    auto const sites = static_cast<int>(lattice.cell_sites);
    for (auto const& [between, offset, tensor, biquadratic] : couplings) {
      check(between, offset, tensor, biquadratic, sites);
      for (int end = 0; end < 2; ++end) {
        if (between[static_cast<std::size_t>(end)] != site) continue;
        std::int64_t const sign = end == 0 ? 1 : -1;
        int const other = between[static_cast<std::size_t>(1 - end)];
        std::array<std::int64_t, 3> way{sign * offset[0], sign * offset[1],
                                        sign * offset[2] * sites + other - site};
        if (!stays(way, lattice)) continue;
        Seen bond{};
        for (std::size_t axis = 0; axis < 3; ++axis)
          bond.way[axis] = static_cast<std::int32_t>(way[axis]);
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t j = 0; j < 3; ++j)
            bond.tensor.of[3 * i + j] = tensor[end == 0 ? 3 * i + j : 3 * j + i];
        bond.tensor.of[9] = biquadratic;
        seen.push_back(bond);
      }
    }
    return seen;
  }

  static void check(std::array<int, 2> const& between, std::array<int, 3> const& offset,
                    std::array<double, 9> const& tensor, double biquadratic, int sites) {
    for (int const site : between)
      if (site < 0 || site >= sites)
        throw std::invalid_argument("cayspin::PairCouplings: there is no site " +
                                    std::to_string(site) + " in a cell of " +
                                    std::to_string(sites));
    if (between[0] == between[1] && offset == std::array<int, 3>{})
      throw std::invalid_argument("cayspin::PairCouplings: a site is not coupled to itself");
    bool finite = std::isfinite(biquadratic);
    for (double const number : tensor) finite = finite && std::isfinite(number);
    if (!finite) throw std::invalid_argument("cayspin::PairCouplings: a number is not finite");
  }

  /// Shortens an offset by whole turns around each periodic axis. Returns false if it leads out of
  /// the lattice along an open axis.
  static bool stays(std::array<std::int64_t, 3>& way, Lattice const& of_sites) {
    auto const& lattice = whole(of_sites);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (lattice.boundary[axis] == Boundary::periodic)
        way[axis] %= lattice.shape[axis];
      else if (std::abs(way[axis]) >= lattice.shape[axis])
        return false;
    }
    return true;
  }
};

/// The tables in the memory space of the kernels.
template <class MemorySpace>
class BondsOfSites {
 public:
  explicit BondsOfSites(BondLists const& lists)
      : sites_(table_of<MemorySpace>("cayspin::PairCouplings::sites", lists.sites)),
        shells_(table_of<MemorySpace>("cayspin::PairCouplings::shells", lists.shells)),
        bonds_(table_of<MemorySpace>("cayspin::PairCouplings::bonds", lists.bonds)),
        tensors_(table_of<MemorySpace>("cayspin::PairCouplings::tensors", lists.tensors)),
        rounds_(table_of<MemorySpace>("cayspin::PairCouplings::rounds", lists.rounds)),
        has_biquadratic_(lists.has_biquadratic) {}

  BondTable table() const {
    return {sites_.data(),   shells_.data(), bonds_.data(),
            tensors_.data(), rounds_.data(), static_cast<std::int32_t>(sites_.size()),
            has_biquadratic_};
  }

 private:
  template <class Element>
  using Table = Kokkos::View<Element*, MemorySpace>;

  Table<BondsOfSite> sites_;
  Table<Shell> shells_;
  Table<Bond> bonds_;
  Table<BondTensor> tensors_;
  Table<OffsetInMemory> rounds_;
  bool has_biquadratic_;
};

}  // namespace cayspin::inline v0_2::detail
