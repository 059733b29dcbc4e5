// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/key.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

// Exchange and DMI. Exchange, InterfacialDmi and BulkDmi are lattice terms: their H is linear in
// the spins of a site and its neighbours. To add such a term, write a struct with the same members
// as Exchange, add a member to Field, and list that member in Field::lattice_terms. The scene
// reader, `cayspin check`, the stability bound and the kernels use that list.
namespace cayspin::inline v0_2 {
class Exchange;
class InterfacialDmi;
class BulkDmi;
}  // namespace cayspin::inline v0_2

namespace cayspin::inline v0_2::io {

/// Returns the sum of part(axis, spacing) over the axes along which sites have neighbours.
template <class Lattice, class Part>
double sum_over_axes(Lattice const& lattice, Part const& part) {
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (lattice.has_neighbors(static_cast<int>(axis))) sum += part(axis, lattice.spacing[axis]);
  return sum;
}

/// H = constant * Lap(m).
struct Exchange {
  double constant = 0;

  /// Returns the constant, to which H is proportional.
  double& strength() { return constant; }

  static constexpr std::string_view key = "exchange";
  /// If a term has only one key, its value is typed without a table: exchange = 1.
  static constexpr auto keys() {
    return std::to_array<Key<Exchange>>({{"constant", &Exchange::constant, {}, true}});
  }
  /// Printed by `cayspin check`, with the values of keys() in place of {}.
  static constexpr std::string_view formula = "H = {} Lap(m)";

  /// Returns an upper bound on the magnitudes of H's eigenvalues, with H as a linear operator on
  /// all spins. An upper bound of |H| for unit spins is such a bound.
  template <class Lattice>
  double field_bound(Lattice const& lattice) const {
    return exchange_bound(lattice, constant);
  }
  /// Returns a bound on the sum of the |energies| of a site's bonds. Round-off is proportional to
  /// it.
  template <class Lattice>
  double energy_magnitude(Lattice const& lattice) const {
    return sum_over_axes(lattice, [&](std::size_t, double spacing) {
      return 2 * std::abs(constant) / (spacing * spacing);
    });
  }
  /// Returns an object of the library's class for this term. Kernels call its neighbor_field().
  template <class Lattice, class Term = cayspin::Exchange>
  Term term(Lattice const& lattice) const {
    return Term(lattice, constant);
  }
};

/// Interfacial Dzyaloshinskii-Moriya interaction of a film.
struct InterfacialDmi {
  double interfacial = 0;     ///< D in the energy density D * (m_n div m - m.grad m_n)
  Triple normal = {0, 0, 1};  ///< unit vector n

  double& strength() { return interfacial; }

  static constexpr std::string_view key = "dmi";
  static constexpr auto keys() {
    return std::to_array<Key<InterfacialDmi>>(
        {{"interfacial", &InterfacialDmi::interfacial, {}, true},
         {"normal", &InterfacialDmi::normal, {"three numbers"}, true}});
  }
  static constexpr std::string_view formula = "E = {} (m_n div m - m.grad m_n), n = {}";

  /// Returns an upper bound of |H|: along each axis e, each of the two neighbours contributes at
  /// most |D| * |n x e| / spacing.
  template <class Lattice>
  double field_bound(Lattice const& lattice) const {
    return 2 * energy_magnitude(lattice);
  }
  template <class Lattice>
  double energy_magnitude(Lattice const& lattice) const {
    return sum_over_axes(lattice, [&](std::size_t axis, double spacing) {
      double const across = 1 - normal[axis] * normal[axis];  // |n x e|^2; may round below 0
      return across > 0 ? std::abs(interfacial) * std::sqrt(across) / spacing : 0;
    });
  }
  template <class Lattice, class Term = cayspin::InterfacialDmi>
  Term term(Lattice const& lattice) const {
    return Term(lattice, interfacial, {normal[0], normal[1], normal[2]});
  }
};

/// Bulk Dzyaloshinskii-Moriya interaction. A scene has only one kind of DMI.
struct BulkDmi {
  double constant = 0;  ///< D in the energy density D * m.(curl m)

  double& strength() { return constant; }

  static constexpr std::string_view key = "dmi";
  static constexpr auto keys() {
    return std::to_array<Key<BulkDmi>>({{"bulk", &BulkDmi::constant, {}, true}});
  }
  static constexpr std::string_view formula = "E = {} m.curl m";

  /// Returns an upper bound of |H|: along each axis, each of the two neighbours contributes at most
  /// |D| / spacing.
  template <class Lattice>
  double field_bound(Lattice const& lattice) const {
    return 2 * energy_magnitude(lattice);
  }
  template <class Lattice>
  double energy_magnitude(Lattice const& lattice) const {
    return sum_over_axes(lattice,
                         [&](std::size_t, double spacing) { return std::abs(constant) / spacing; });
  }
  template <class Lattice, class Term = cayspin::BulkDmi>
  Term term(Lattice const& lattice) const {
    return Term(lattice, constant);
  }
};

/// DMI of crystals with symmetry D2d. It is evaluated as a site-dependent term, even if it is
/// uniform.
struct D2dDmi {
  double constant = 0;  ///< D in the energy density D * m.(dm/dx x e_x - dm/dy x e_y)

  static constexpr std::string_view formula = "E = {} m.(dm/dx x e_x - dm/dy x e_y)";
  static constexpr auto keys() { return std::to_array<Key<D2dDmi>>({{"d2d", &D2dDmi::constant}}); }
};

}  // namespace cayspin::inline v0_2::io
