// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/expression.hpp"
#include "io/scene.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::io::detail {

/// Returns the variables of site expressions: the position, the cell's indices and, for several
/// sites per cell, the index in the cell.
std::vector<std::string> site_variables(Lattice const& lattice);

/// Returns the values of the site_variables() at a site (i, j, plane) of the lattice: plane k *
/// sites + s has site s of the cells with number k along z. If a cell has only one site, the site
/// counts as being in the middle.
inline std::array<double, 7> site_values(Lattice const& lattice,
                                         std::array<std::int64_t, 3> const& site) {
  auto const sites = static_cast<std::int64_t>(lattice.basis.size());
  auto const number = site[2] % sites;
  std::array<std::int64_t, 3> const cell{site[0], site[1], site[2] / sites};
  std::array<double, 7> values;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto const cells = static_cast<double>(lattice.shape[axis] / (axis == 2 ? sites : 1));
    double const fraction = lattice.basis[static_cast<std::size_t>(number)][axis];
    double const within = sites == 1 ? 0.5 : fraction - std::floor(fraction);
    values[3 + axis] = static_cast<double>(cell[axis]);
    values[axis] = (values[3 + axis] + within) / cells;
  }
  values[6] = static_cast<double>(number);
  return values;
}

/// Compiles an expression in the site_variables(). It may call the functions grain(size, seed) and
/// random(n, seed). `length`: converts lattice.spacing to the unit of `size`. Throws like
/// Expression.
Expression site_expression(std::string text, Lattice const& lattice, double length = 1);
inline Expression site_expression(std::string text, Scene const& scene) {
  return site_expression(std::move(text), scene.lattice, scene.units.length);
}

}  // namespace cayspin::inline v0_2::io::detail
