// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/own_field.hpp"

#include <cayspin/coupling.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
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
class BulkDmi;
}  // namespace cayspin::inline v0_1

namespace cayspin::inline v0_1::io {

using Triple = std::array<double, 3>;

/// A number, or the text of an expression in t.
using AppliedComponent = std::variant<double, std::string>;

/// What a key accepts: in words, and of numbers from where to where.
struct Limits {
  std::string_view accepted = "a finite number";
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool without_least = false;  ///< the least number itself is refused
};
inline constexpr Limits not_negative{"a number >= 0", 0};
inline constexpr Limits positive{"a number > 0", 0, std::numeric_limits<double>::infinity(), true};

/// A key of a table. The scene reader sets the members of a section, or of a term, by the list
/// keys() of these, and refuses any other key. A Triple is normalised.
template <class Section>
struct Key {
  std::string_view name;
  /// None where a function of its own reads the key.
  std::variant<std::monostate, bool Section::*, std::optional<bool> Section::*, int Section::*,
               std::int64_t Section::*, double Section::*, std::optional<double> Section::*,
               Triple Section::*, AppliedComponent Section::*>
      member = {};
  Limits limits = {};
  bool required = false;
};

/// The sum of of(axis, spacing) over the axes along which sites have neighbours.
template <class Lattice, class Of>
double sum_over_axes(Lattice const& lattice, Of const& of) {
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (lattice.has_neighbors(static_cast<int>(axis))) sum += of(axis, lattice.spacing[axis]);
  return sum;
}

/// H = constant Lap(m).
struct Exchange {
  double constant = 0;

  /// H is proportional to it.
  double& strength() { return constant; }

  static constexpr std::string_view key = "exchange";
  /// One number alone is typed without a table.
  static constexpr auto keys() {
    return std::to_array<Key<Exchange>>({{"constant", &Exchange::constant, {}, true}});
  }
  /// For `cayspin check`: the numbers in the order above.
  static constexpr std::string_view formula = "H = {} Lap(m)";

  /// The largest |H| of unit spins that alternate, or an upper bound of it.
  template <class Lattice>
  double field_bound(Lattice const& lattice) const {
    return exchange_bound(lattice, constant);
  }
  /// The largest sum of |bond energies| of a site: what round-off is proportional to.
  template <class Lattice>
  double energy_magnitude(Lattice const& lattice) const {
    return sum_over_axes(lattice, [&](std::size_t, double spacing) {
      return 2 * std::abs(constant) / (spacing * spacing);
    });
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

  double& strength() { return interfacial; }

  static constexpr std::string_view key = "dmi";
  static constexpr auto keys() {
    return std::to_array<Key<InterfacialDmi>>(
        {{"interfacial", &InterfacialDmi::interfacial, {}, true},
         {"normal", &InterfacialDmi::normal, {"three numbers"}, true}});
  }
  static constexpr std::string_view formula = "E = {} (m_n div m - m.grad m_n), n = {}";

  /// An upper bound: both neighbours along each axis across n.
  template <class Lattice>
  double field_bound(Lattice const& lattice) const {
    return 2 * energy_magnitude(lattice);
  }
  template <class Lattice>
  double energy_magnitude(Lattice const& lattice) const {
    return sum_over_axes(lattice, [&](std::size_t axis, double spacing) {
      double const across = 1 - normal[axis] * normal[axis];  // |n x e|^2, but for round-off
      return across > 0 ? std::abs(interfacial) * std::sqrt(across) / spacing : 0;
    });
  }
  template <class Lattice, class Term = cayspin::InterfacialDmi>
  Term term(Lattice const& lattice) const {
    return Term(lattice, interfacial, {normal[0], normal[1], normal[2]});
  }
};

/// Bulk Dzyaloshinskii-Moriya interaction. It stands in place of the interfacial one.
struct BulkDmi {
  double constant = 0;  ///< D in the energy density D m.(curl m)

  double& strength() { return constant; }

  static constexpr std::string_view key = "dmi";
  static constexpr auto keys() {
    return std::to_array<Key<BulkDmi>>({{"bulk", &BulkDmi::constant, {}, true}});
  }
  static constexpr std::string_view formula = "E = {} m.curl m";

  /// An upper bound: both neighbours along each axis.
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

/// Numbers of sites, x fastest, that a program gives beside the text of a scene.
using GivenNumbers = std::shared_ptr<std::vector<double> const>;

/// A number for each site: an expression as in [initial], a dataset of an HDF5 file, or given.
struct SiteNumbers {
  std::string expression;
  std::filesystem::path file;
  GivenNumbers given;
  double unit = 1;  ///< what each is multiplied by: they may be typed in SI
  std::string key;  ///< in SI that of [material], where it stands in place of another

  bool there() const { return !expression.empty() || !file.empty() || given; }
  std::string_view key_or(std::string_view other) const {
    return key.empty() ? other : std::string_view(key);
  }
};

/// H = constant (m.axis) axis.
struct Anisotropy {
  double constant = 0;       ///< K in H = K (m.e) e
  Triple axis = {};          ///< unit vector e
  int site = -1;             ///< of the cell; all where it is below 0
  SiteNumbers factors = {};  ///< of the constant, which then is 1

  static constexpr std::string_view formula = "H = {} (m.e) e, e = {}";
  static constexpr auto keys() {
    return std::to_array<Key<Anisotropy>>(
        {{"constant", &Anisotropy::constant}, {"axis", &Anisotropy::axis}});
  }
};

/// Anisotropy of a cubic crystal: E = constant (a^2 b^2 + b^2 c^2 + c^2 a^2), the m along its axes.
struct CubicAnisotropy {
  double constant = 0;  ///< Kc
  std::array<Triple, 2> axes =
      {};         ///< unit vectors normal to each other; the third is their product
  int site = -1;  ///< of the cell; all where it is below 0
};

/// Zhang and Li 2004: t = -(u.grad) m + xi m x (u.grad) m.
struct ZhangLi {
  std::array<AppliedComponent, 3> velocity = {};  ///< u
  double nonadiabaticity = 0;                     ///< xi

  static constexpr auto keys() {
    return std::to_array<Key<ZhangLi>>({{"velocity"},
                                        {"current_density"},
                                        {"polarization"},
                                        {"nonadiabaticity", &ZhangLi::nonadiabaticity}});
  }
};

/// Slonczewski 1996: t = a m x (p x m) - b m x p.
struct Slonczewski {
  AppliedComponent damping_like = 0.0, field_like = 0.0;  ///< a, b
  Triple polarization = {};                               ///< unit vector p

  static constexpr auto keys() {
    return std::to_array<Key<Slonczewski>>(
        {{"damping_like", &Slonczewski::damping_like},
         {"field_like", &Slonczewski::field_like},
         {"polarization", &Slonczewski::polarization, {"three numbers"}, true},
         {"current_density"},
         {"efficiency"},
         {"thickness"}});
  }
};

/// The table [torque].
struct Torque {
  std::optional<ZhangLi> zhang_li;
  std::optional<Slonczewski> slonczewski;
};

/// H = -strength (m.normal) normal, spin by spin.
struct SlabDemagnetization {
  Triple normal = {};  ///< unit vector n in H = -strength (m.n) n
  double strength = 1;
  bool on_host = false;  ///< computed on the host through a mirror copy
  bool dear = false;     ///< evaluated once or twice a step, between substeps of the rest

  static constexpr auto keys() {
    using Slab = SlabDemagnetization;
    return std::to_array<Key<Slab>>({{"normal", &Slab::normal, {"three numbers"}, true},
                                     {"strength", &Slab::strength},
                                     {"where"},
                                     {"dear", &Slab::dear}});
  }
};

/// The field of all cells on all cells: H = -strength sum N m.
struct Demagnetization {
  double strength = 1;
  std::array<int, 3> periodic_images{};  ///< beside the nearest one, on each side
  std::optional<bool> dear;              ///< by default where the method can
  std::filesystem::path kept_in;         ///< a file for tensors that take long to compute, or none

  static constexpr auto keys() {
    return std::to_array<Key<Demagnetization>>({{"strength", &Demagnetization::strength},
                                                {"periodic_images"},
                                                {"dear", &Demagnetization::dear}});
  }
};

/// Only terms that stand in the scene have a value.
struct Field {
  std::optional<Exchange> exchange;
  std::optional<InterfacialDmi> dmi;
  std::optional<BulkDmi> bulk_dmi;
  SiteNumbers exchange_factors, dmi_factors;  ///< of constants that then are 1
  std::vector<Anisotropy> anisotropies;
  std::vector<CubicAnisotropy> cubic_anisotropies;
  std::vector<Coupling> couplings;       ///< as typed, or made of shells
  std::filesystem::path couplings_file;  ///< of Vampire; empty without one
  double couplings_scale = 1;            ///< of the numbers in that file
  Torque torque;
  std::optional<std::array<AppliedComponent, 3>> applied;
  std::vector<Triple> applied_in_turn;  ///< of `cayspin relax`: one state of rest for each
  std::optional<SlabDemagnetization> slab_demag;
  std::optional<Demagnetization> demag;
  double mu0 = 1;  ///< multiplies applied, slab_demag and demag; NOT yet multiplied into them
  OwnField own;    ///< empty, unless a program sets it

  static constexpr std::tuple lattice_terms{&Field::exchange, &Field::dmi, &Field::bulk_dmi};
};

/// True when a component of the applied field contains t, or the uniform field is a program's.
bool depends_on_time(Field const& field);

/// Without the terms whose constants differ from site to site.
Field without_numbers_of_sites(Field field);

/// True when a current moves the spins, and their energy need not fall.
bool has_torque(Field const& field);

/// True when the field at a site depends on more than the site and its neighbours.
bool is_nonlocal(Field const& field);

/// Calls work(term) for the std::optional of each lattice term.
template <class AnyField, class Work>
void for_each_lattice_term(AnyField&& field, Work&& work) {
  std::apply([&](auto... member) { (work(field.*member), ...); }, Field::lattice_terms);
}

}  // namespace cayspin::inline v0_1::io
