// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/coupling.hpp>
#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/row_layout.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/part.hpp>

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

// The bonds of each site of a cell, seen from that site, in the order in which kernels sum them.
namespace cayspin::inline v0_1::detail {

/// The way to the other site, and what it is in memory, in double and in single precision.
struct Bond {
  std::int32_t dx, dy, dz;
  std::ptrdiff_t of_doubles, of_floats;

  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION std::ptrdiff_t offset() const {
    return std::is_same_v<Real, double> ? of_doubles : of_floats;
  }
};
/// Bonds of one exchange.
struct Shell {
  std::int32_t first, last;
  double exchange;
};
/// T row by row, and the biquadratic constant.
struct BondTensor {
  double of[10];
};
/// How far bonds reach.
struct Reach {
  std::int32_t low[3] = {}, high[3] = {};

  void include(std::array<std::int32_t, 3> const& way) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::max(low[axis], -way[axis]);
      high[axis] = std::max(high[axis], way[axis]);
    }
  }
  /// Do all bonds of the sites end in rows, or sites of a row, that need no way round?
  KOKKOS_FORCEINLINE_FUNCTION bool holds_rows(std::int32_t y, std::int32_t z,
                                              std::int32_t const* extent) const {
    return y >= low[1] && y + high[1] < extent[1] && z >= low[2] && z + high[2] < extent[2];
  }
  KOKKOS_FORCEINLINE_FUNCTION bool holds_along_row(std::int32_t x, std::int32_t lanes,
                                                   std::int32_t const* extent) const {
    return x >= low[0] && x + lanes + high[0] <= extent[0];
  }
};

struct BondsOfSite {
  std::int32_t first_shell, last_shell, first_tensor, last_tensor;
  Reach reach;
};

/// What kernels hold.
struct BondTable {
  BondsOfSite const* sites;
  Shell const* shells;
  Bond const* bonds;
  BondTensor const* tensors;
  std::int32_t first_of_tensors, cell_sites;
  bool has_biquadratic;

  KOKKOS_FORCEINLINE_FUNCTION std::int32_t site_of_plane(std::int32_t z) const {
    if (cell_sites == 1) return 0;
    return (cell_sites & (cell_sites - 1)) == 0 ? z & (cell_sites - 1) : z % cell_sites;
  }
};

/// The tables in the making.
class BondLists {
 public:
  std::vector<BondsOfSite> sites;
  std::vector<Shell> shells;
  std::vector<Bond> bonds;
  std::vector<BondTensor> tensors;
  std::int32_t first_of_tensors = 0;
  bool has_biquadratic = false;
  /// The largest |H| of unit spins at each site of a cell, or an upper bound of it.
  std::vector<double> field_bounds;

  /// Throws std::invalid_argument as PairCouplings does.
  BondLists(Lattice const& lattice, std::vector<Coupling> const& couplings)
      : sites(static_cast<std::size_t>(lattice.cell_sites)) {
    auto& of_shells = bonds;
    std::vector<Bond> of_tensors;
    for (int site = 0; site < static_cast<int>(lattice.cell_sites); ++site) {
      auto& mine = sites[static_cast<std::size_t>(site)];
      auto seen = seen_from(site, lattice, couplings);
      // By exchange or tensor, then along x: kernels foresee the ends of rows.
      std::ranges::stable_sort(
          seen, {}, [](Seen const& bond) { return std::pair(!bond.is_exchange(), bond.way[0]); });
      mine.first_shell = static_cast<std::int32_t>(shells.size());
      mine.first_tensor = static_cast<std::int32_t>(of_tensors.size());
      double bound = 0;
      for (auto const& bond : seen) {
        mine.reach.include(bond.way);
        bound += bond.bound();
        auto const rows = bond.way[1] + static_cast<std::ptrdiff_t>(lattice.shape[1]) * bond.way[2];
        Bond const at{bond.way[0], bond.way[1], bond.way[2],
                      rows * RowLayout::of<double>(lattice).pitch + bond.way[0],
                      rows * RowLayout::of<float>(lattice).pitch + bond.way[0]};
        if (!bond.is_exchange()) {
          of_tensors.push_back(at);
          tensors.push_back(bond.tensor);
          has_biquadratic = has_biquadratic || bond.tensor.of[9] != 0;
          continue;
        }
        auto const first = shells.begin() + mine.first_shell;
        auto const mate = std::find_if(first, shells.end(), [&](Shell const& shell) {
          return shell.exchange == bond.tensor.of[0];
        });
        // A shell's bonds lie together.
        if (mate == shells.end()) {
          auto const end = static_cast<std::int32_t>(of_shells.size());
          shells.push_back({end, end + 1, bond.tensor.of[0]});
          of_shells.push_back(at);
        } else {
          of_shells.insert(of_shells.begin() + mate->last, at);
          ++mate->last;
          for (auto later = mate + 1; later != shells.end(); ++later) ++later->first, ++later->last;
        }
      }
      mine.last_shell = static_cast<std::int32_t>(shells.size());
      mine.last_tensor = static_cast<std::int32_t>(of_tensors.size());
      field_bounds.push_back(bound);
    }
    first_of_tensors = static_cast<std::int32_t>(of_shells.size());
    for (auto& mine : sites)
      mine.first_tensor += first_of_tensors, mine.last_tensor += first_of_tensors;
    of_shells.insert(of_shells.end(), of_tensors.begin(), of_tensors.end());
  }

  /// Over how many rows along y and cells along z bonds reach.
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
    /// Of |T| by Frobenius, unless it is a multiple of 1, and of what the biquadratic part adds.
    double bound() const {
      if (is_exchange()) return std::abs(tensor.of[0]);
      double sum = 0;
      for (int i = 0; i < 9; ++i) sum += tensor.of[i] * tensor.of[i];
      return std::sqrt(sum) + 2 * std::abs(tensor.of[9]);
    }
  };

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

  /// Shortens a way round a periodic axis; false where it is longer than an open one.
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

/// The same for kernels.
template <class MemorySpace>
class BondsOfSites {
 public:
  explicit BondsOfSites(BondLists const& lists)
      : sites_(table("sites", lists.sites)),
        shells_(table("shells", lists.shells)),
        bonds_(table("bonds", lists.bonds)),
        tensors_(table("tensors", lists.tensors)),
        first_of_tensors_(lists.first_of_tensors),
        has_biquadratic_(lists.has_biquadratic) {}

  BondTable table() const {
    return {sites_.data(),   shells_.data(),    bonds_.data(),
            tensors_.data(), first_of_tensors_, static_cast<std::int32_t>(sites_.size()),
            has_biquadratic_};
  }

 private:
  template <class Element>
  using Table = Kokkos::View<Element*, MemorySpace>;
  template <class Element>
  static Table<Element> table(char const* name, std::vector<Element> const& from) {
    Table<Element> made(Kokkos::view_alloc(Kokkos::WithoutInitializing,
                                           std::string("cayspin::PairCouplings::") + name),
                        from.size());
    Kokkos::deep_copy(made,
                      Kokkos::View<Element const*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged>(
                          from.data(), from.size()));
    return made;
  }

  Table<BondsOfSite> sites_;
  Table<Shell> shells_;
  Table<Bond> bonds_;
  Table<BondTensor> tensors_;
  std::int32_t first_of_tensors_;
  bool has_biquadratic_;
};

}  // namespace cayspin::inline v0_1::detail
