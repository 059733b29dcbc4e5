// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/coupling.hpp>
#include <cayspin/crystal.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace cayspin::inline v0_2 {

namespace detail {

struct BondOfLength {
  double length;
  std::array<int, 2> between;
  std::array<int, 3> offset;
};

/// Returns every bond once, shortest first, between sites at most `reach` cells apart along each
/// cell vector for which `repeats` is true, and in the same cell along the others.
inline std::vector<BondOfLength> bonds_within(Crystal const& crystal, int reach,
                                              std::array<bool, 3> const& repeats) {
  std::vector<BondOfLength> bonds;
  auto const sites = static_cast<int>(crystal.basis.size());
  int const x = repeats[0] ? reach : 0, y = repeats[1] ? reach : 0, z = repeats[2] ? reach : 0;
  constexpr double most = 2e6;
  if (0.5 * sites * sites * (2.0 * x + 1) * (2.0 * y + 1) * (2.0 * z + 1) > most)
    throw std::invalid_argument("cayspin::couplings_of_shells: more than two million bonds");
  for (int a = 0; a < sites; ++a)
    for (int b = a; b < sites; ++b)
      for (int i = -x; i <= x; ++i)
        for (int j = -y; j <= y; ++j)
          for (int k = -z; k <= z; ++k) {
            // A bond between sites of equal index occurs in both directions; one of the two is
            // kept.
            if (a == b && !(i > 0 || (i == 0 && (j > 0 || (j == 0 && k > 0))))) continue;
            auto const here = crystal.position({0, 0, 0}, static_cast<std::size_t>(a)),
                       there = crystal.position({i, j, k}, static_cast<std::size_t>(b));
            double const length =
                std::hypot(there[0] - here[0], there[1] - here[1], there[2] - here[2]);
            bonds.push_back({length, {a, b}, {i, j, k}});
          }
  std::ranges::stable_sort(bonds, {}, &BondOfLength::length);
  return bonds;
}

/// Returns an upper bound on how many cells apart, along any cell vector that repeats, two sites
/// within `length` of each other can be.
inline double cells_within(Crystal const& crystal, double length,
                           std::array<bool, 3> const& repeats) {
  auto const& [a, b, c] = crystal.cell;
  double const volume = std::abs(scalar_product(a, vector_product(b, c)));
  std::array const normals{vector_product(b, c), vector_product(c, a), vector_product(a, b)};
  double most = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto const& [x, y, z] = normals[axis];
    if (repeats[axis]) most = std::max(most, length * std::hypot(x, y, z) / volume);
  }
  double spread = 0;
  for (auto const& site : crystal.basis)
    for (auto const& other : crystal.basis)
      for (std::size_t axis = 0; axis < 3; ++axis)
        spread = std::max(spread, std::abs(site[axis] - other[axis]));
  return most + spread;
}

}  // namespace detail

/// Distances that differ by less than this fraction count as equal, because cell vectors and
/// positions are often given with few digits.
inline constexpr double same_distance = 1e-4;

/// Returns exchange bonds between all pairs of sites at the first, second, ... distance in a
/// crystal, with the constants exchange[0], exchange[1], ... `repeats` says for each cell vector
/// whether there are other cells along it. Throws std::invalid_argument for an invalid crystal, if
/// the search would have to list more than two million bonds, and, if no vector repeats, for more
/// constants than there are distances in a cell.
inline std::vector<Coupling> couplings_of_shells(Crystal const& crystal,
                                                 std::vector<double> const& exchange,
                                                 std::array<bool, 3> const& repeats = {true, true,
                                                                                       true}) {
  crystal.validate();
  std::vector<Coupling> couplings;
  bool const is_bounded = repeats == std::array<bool, 3>{};
  for (int reach = 1; !exchange.empty(); reach *= 2) {
    couplings.clear();
    std::size_t shells = 0;
    double length = 0;
    bool is_whole = is_bounded;
    for (auto const& bond : detail::bonds_within(crystal, reach, repeats)) {
      if (bond.length > length * (1 + same_distance)) {
        if (shells == exchange.size()) {
          is_whole = true;
          break;
        }
        length = bond.length;
        ++shells;
      }
      couplings.push_back(Coupling::of(bond.between, bond.offset, exchange[shells - 1]));
    }
    if (is_bounded && shells < exchange.size())
      throw std::invalid_argument("cayspin::couplings_of_shells: the sites of a cell have only " +
                                  std::to_string(shells) + " distances");
    // If the cell vectors are skew, other bonds up to this length may reach over more cells.
    if (is_whole && (is_bounded || detail::cells_within(crystal, length, repeats) <= reach)) break;
  }
  return couplings;
}

}  // namespace cayspin::inline v0_2
