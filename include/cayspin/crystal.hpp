// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/lattice.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace cayspin::inline v0_2 {

namespace detail {

inline double scalar_product(std::array<double, 3> const& a, std::array<double, 3> const& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline std::array<double, 3> vector_product(std::array<double, 3> const& a,
                                            std::array<double, 3> const& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace detail

/// A periodic crystal: three cell vectors, and the sites in a cell. This header needs no Kokkos, so
/// that scenes can be read without it.
struct Crystal {
  using Point = std::array<double, 3>;

  std::array<Point, 3> cell{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< cell vectors
  std::vector<Point> basis{{0, 0, 0}};  ///< sites, in fractions of the cell vectors

  /// Cubic cells of edge 1.
  static Crystal simple_cubic() { return {}; }
  static Crystal bcc() { return {cubic, {{0, 0, 0}, {0.5, 0.5, 0.5}}}; }
  static Crystal fcc() { return {cubic, {{0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}}}; }
  /// Corners of tetrahedra: 16 sites per cell, nearest neighbours sqrt(1/8) apart.
  static Crystal pyrochlore() {
    Crystal made{cubic, {}};
    for (auto const& corner : fcc().basis)
      for (auto const& site : fcc().basis)
        made.basis.push_back(
            {corner[0] + 0.5 * site[0], corner[1] + 0.5 * site[1], corner[2] + 0.5 * site[2]});
    return made;
  }
  /// Hexagonal cells: two edges of length 1 at an angle of 60 degrees, the first along x, and a
  /// third of length c along z. In hcp c = sqrt(8/3), the ideal ratio; otherwise c = 1.
  static Crystal hcp() {
    auto cell = hexagonal();
    cell[2][2] = std::sqrt(8.0 / 3);
    return {cell, {{0, 0, 0}, {1.0 / 3, 1.0 / 3, 0.5}}};
  }
  static Crystal honeycomb() { return {hexagonal(), {{0, 0, 0}, {1.0 / 3, 1.0 / 3, 0}}}; }
  static Crystal kagome() { return {hexagonal(), {{0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}}}; }

  /// Returns the position of site `site` in the cell with the indices `of_cell`.
  Point position(std::array<std::int64_t, 3> const& of_cell, std::size_t site) const {
    Point place{0, 0, 0};
    for (std::size_t vector = 0; vector < 3; ++vector) {
      double const along = static_cast<double>(of_cell[vector]) + basis[site][vector];
      for (std::size_t axis = 0; axis < 3; ++axis) place[axis] += along * cell[vector][axis];
    }
    return place;
  }

  /// Returns the lattice for fields on a crystal with cells[i] cells along cell vector i. Plane k *
  /// basis.size() + s along z holds site s of the cells with index k along the third vector.
  Lattice lattice(std::array<std::int64_t, 3> const& cells,
                  std::array<Boundary, 3> const& boundary = {}) const {
    Lattice made{cells, {1, 1, 1}, boundary};
    made.validate();  // the product below could overflow with unchecked counts
    made.cell_sites = static_cast<std::int64_t>(basis.size());
    made.shape[2] *= made.cell_sites;
    made.validate();
    return made;
  }

  /// Returns the volume of a cell.
  double volume() const {
    return std::abs(detail::scalar_product(cell[0], detail::vector_product(cell[1], cell[2])));
  }

  /// Returns the cell's volume divided by that of a box whose edges have the same lengths.
  double fullness() const {
    auto const length = [](Point const& v) { return std::hypot(v[0], v[1], v[2]); };
    return volume() / (length(cell[0]) * length(cell[1]) * length(cell[2]));
  }

  /// Returns two sites that coincide to within a millionth of each cell vector, in the same cell or
  /// in different cells; empty if there are none.
  std::optional<std::array<std::size_t, 2>> sites_at_one_place() const {
    auto const fraction = [](double x) { return x - std::floor(x); };
    std::vector<std::size_t> by_x(basis.size());
    std::iota(by_x.begin(), by_x.end(), std::size_t{0});
    std::ranges::sort(by_x, {}, [&](std::size_t site) { return fraction(basis[site][0]); });
    auto const apart = [](double a, double b) { return std::abs(std::remainder(a - b, 1.0)); };
    constexpr double least = 1e-6;
    for (std::size_t first = 0; first < by_x.size(); ++first)
      for (std::size_t next = 1; next < by_x.size(); ++next) {
        auto const [i, j] = std::minmax(by_x[first], by_x[(first + next) % by_x.size()]);
        auto const &a = basis[i], &b = basis[j];
        if (!(apart(a[0], b[0]) < least)) break;
        if (apart(a[1], b[1]) < least && apart(a[2], b[2]) < least) return std::array{i, j};
      }
    return std::nullopt;
  }

  /// Throws std::invalid_argument for a cell without volume or sites, for coinciding sites, and for
  /// non-finite positions.
  void validate() const {
    if (!(fullness() > 1e-12))
      throw std::invalid_argument("cayspin::Crystal: the cell's vectors span no volume");
    if (basis.empty()) throw std::invalid_argument("cayspin::Crystal: the cell has no sites");
    for (std::size_t site = 0; site < basis.size(); ++site)
      if (!std::ranges::all_of(basis[site], [](double x) { return std::isfinite(x); }))
        throw std::invalid_argument("cayspin::Crystal: site " + std::to_string(site) +
                                    " has a non-finite position");
    if (auto const two = sites_at_one_place())
      throw std::invalid_argument("cayspin::Crystal: sites " + std::to_string((*two)[0]) + " and " +
                                  std::to_string((*two)[1]) + " have the same position");
  }

 private:
  static constexpr std::array<Point, 3> cubic{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  static std::array<Point, 3> hexagonal() {
    return {{{1, 0, 0}, {0.5, std::sqrt(0.75), 0}, {0, 0, 1}}};
  }
};

}  // namespace cayspin::inline v0_2
