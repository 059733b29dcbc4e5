// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/io/own_field.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

// The terms of [field]. A lattice term, whose H is linear in the spin and its neighbours, is all
// here: a struct with the members of Exchange, a member of Field, and its place in
// Field::lattice_terms. The scene reader, `cayspin check`, the stability bound and the kernels go
// through that list.
namespace cayspin::inline v0_1 {
class Exchange;
class InterfacialDmi;
}  // namespace cayspin::inline v0_1

namespace cayspin::inline v0_1::io {

using Triple = std::array<double, 3>;

/// A key of a term's table: a number, or a vector that is normalised.
template <class Term>
struct Parameter {
  std::string_view name;
  std::variant<double Term::*, Triple Term::*> member;
};

/// H = constant Lap(m).
struct Exchange {
  double constant = 0;

  static constexpr std::string_view key = "exchange";
  /// One number alone is typed without a table.
  static constexpr std::array parameters{Parameter<Exchange>{"constant", &Exchange::constant}};
  /// For `cayspin check`: the parameters in the order above.
  static constexpr std::string_view formula = "H = {} Lap(m)";

  /// The largest |H| of unit spins that alternate, or an upper bound of it.
  template <class Lattice>
  double field_bound(Lattice const& lattice) const {
    return exchange_bound(lattice, constant);
  }
  /// The largest sum of |bond energies| of a site: what round-off is proportional to.
  template <class Lattice>
  double energy_magnitude(Lattice const& lattice) const {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis)
      if (lattice.has_neighbors(axis))
        sum += 2 * (constant < 0 ? -constant : constant) /
               (lattice.spacing[axis] * lattice.spacing[axis]);
    return sum;
  }
  /// The term of the library that kernels evaluate, with neighbor_field.
  template <class Lattice, class Term = cayspin::Exchange>
  Term term(Lattice const& lattice) const {
    return Term(lattice, constant);
  }
};

/// Interfacial Dzyaloshinskii-Moriya interaction of a film.
struct InterfacialDmi {
  double interfacial = 0;     ///< D in the energy density D (m_n div m - m . grad m_n)
  Triple normal = {0, 0, 1};  ///< unit vector n

  static constexpr std::string_view key = "dmi";
  static constexpr std::array parameters{
      Parameter<InterfacialDmi>{"interfacial", &InterfacialDmi::interfacial},
      Parameter<InterfacialDmi>{"normal", &InterfacialDmi::normal}};
  static constexpr std::string_view formula = "E = {} (m_n div m - m.grad m_n), n = {}";

  /// An upper bound: both neighbours along each axis across n.
  template <class Lattice>
  double field_bound(Lattice const& lattice) const {
    return 2 * energy_magnitude(lattice);
  }
  template <class Lattice>
  double energy_magnitude(Lattice const& lattice) const {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      auto const i = static_cast<std::size_t>(axis);
      double const across = 1 - normal[i] * normal[i];  // |n x e|^2
      if (lattice.has_neighbors(axis) && across > 0)
        sum += std::abs(interfacial) * std::sqrt(across) / lattice.spacing[i];
    }
    return sum;
  }
  template <class Lattice, class Term = cayspin::InterfacialDmi>
  Term term(Lattice const& lattice) const {
    return Term(lattice, interfacial, {normal[0], normal[1], normal[2]});
  }
};

/// H = constant (m.axis) axis.
struct Anisotropy {
  double constant = 0;  ///< K in H = K (m.e) e
  Triple axis = {};     ///< unit vector e

  static constexpr std::string_view formula = "H = {} (m.e) e, e = {}";
  static constexpr std::array parameters{Parameter<Anisotropy>{"constant", &Anisotropy::constant},
                                         Parameter<Anisotropy>{"axis", &Anisotropy::axis}};
};

/// H = -strength (m.normal) normal, per spin or averaged over layers.
struct SlabDemagnetization {
  Triple normal = {};  ///< unit vector n in H = -strength (m.n) n
  double strength = 1;
  bool average_layer = false;  ///< (m.n) averaged over each plane normal to n, along an axis
  bool on_host = false;        ///< computed on the host through a mirror copy
  bool dear = false;           ///< evaluated once or twice a step, between substeps of the rest
};

/// A number, or the text of an expression in t.
using AppliedComponent = std::variant<double, std::string>;

/// Only terms that stand in the scene have a value.
struct Field {
  std::optional<Exchange> exchange;
  std::optional<InterfacialDmi> dmi;
  std::vector<Anisotropy> anisotropies;
  std::optional<std::array<AppliedComponent, 3>> applied;
  std::vector<Triple> applied_in_turn;  ///< of `cayspin relax`: one state of rest for each
  std::optional<SlabDemagnetization> slab_demag;
  double mu0 = 1;  ///< multiplies applied and slab_demag; NOT yet multiplied into them
  OwnField own;    ///< empty, unless a program sets it

  static constexpr std::tuple lattice_terms{&Field::exchange, &Field::dmi};
};

/// True when a component of the applied field contains t, or the uniform field is a program's.
bool depends_on_time(Field const& field);

/// True when the field at a site depends on more than the site and its neighbours.
bool is_nonlocal(Field const& field);

/// Calls work(term) for the std::optional of each lattice term.
template <class AnyField, class Work>
void for_each_lattice_term(AnyField&& field, Work&& work) {
  std::apply([&](auto... member) { (work(field.*member), ...); }, Field::lattice_terms);
}

}  // namespace cayspin::inline v0_1::io
