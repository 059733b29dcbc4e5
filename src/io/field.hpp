// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/own_field.hpp"

#include <cayspin/coupling.hpp>
#include <cayspin/crystal.hpp>

#include <algorithm>
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

// The terms of [field]. To add a lattice term, whose H is linear in the spin and its neighbours,
// write a struct with the members of Exchange, a member of Field, and its entry in
// Field::lattice_terms. The scene reader, `cayspin check`, the stability bound and the kernels use
// that list.
namespace cayspin::inline v0_2 {
class Exchange;
class InterfacialDmi;
class BulkDmi;
}  // namespace cayspin::inline v0_2

namespace cayspin::inline v0_2::io {

using Triple = std::array<double, 3>;

/// A number, or the text of an expression in t.
using AppliedComponent = std::variant<double, std::string>;

/// The values that a key accepts: a description, and a range of numbers.
struct Limits {
  std::string_view accepted = "a finite number";
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool without_least = false;  ///< the least number itself is refused
};
inline constexpr Limits not_negative{"a number >= 0", 0};
inline constexpr Limits positive{"a number > 0", 0, std::numeric_limits<double>::infinity(), true};

/// A key of a table. The scene reader sets the members of a section, or of a term, by its list
/// keys(), and refuses any other key. A Triple is normalised.
template <class Section>
struct Key {
  std::string_view name;
  /// Empty if a separate function reads the key.
  std::variant<std::monostate, bool Section::*, std::optional<bool> Section::*, int Section::*,
               std::int64_t Section::*, double Section::*, std::optional<double> Section::*,
               Triple Section::*, AppliedComponent Section::*>
      member = {};
  Limits limits = {};
  bool required = false;
};

/// Returns the sum of of(axis, spacing) over the axes along which sites have neighbours.
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

  /// Returns the factor to which H is proportional.
  double& strength() { return constant; }

  static constexpr std::string_view key = "exchange";
  /// A single number may be typed without a table.
  static constexpr auto keys() {
    return std::to_array<Key<Exchange>>({{"constant", &Exchange::constant, {}, true}});
  }
  /// For `cayspin check`: the numbers are inserted in the order above.
  static constexpr std::string_view formula = "H = {} Lap(m)";

  /// Returns the largest |H| of alternating unit spins, or an upper bound of it.
  template <class Lattice>
  double field_bound(Lattice const& lattice) const {
    return exchange_bound(lattice, constant);
  }
  /// Returns the largest sum of |bond energies| of a site, to which round-off is proportional.
  template <class Lattice>
  double energy_magnitude(Lattice const& lattice) const {
    return sum_over_axes(lattice, [&](std::size_t, double spacing) {
      return 2 * std::abs(constant) / (spacing * spacing);
    });
  }
  /// Returns the library's term for kernels, which has neighbor_field.
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

  /// Returns an upper bound: both neighbours along each axis, in the direction normal to n.
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

/// Bulk Dzyaloshinskii-Moriya interaction. It replaces the interfacial one.
struct BulkDmi {
  double constant = 0;  ///< D in the energy density D m.(curl m)

  double& strength() { return constant; }

  static constexpr std::string_view key = "dmi";
  static constexpr auto keys() {
    return std::to_array<Key<BulkDmi>>({{"bulk", &BulkDmi::constant, {}, true}});
  }
  static constexpr std::string_view formula = "E = {} m.curl m";

  /// Returns an upper bound: both neighbours along each axis.
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

/// DMI of crystals of symmetry D2d, instead of the others. Evaluated as a site-dependent term.
struct D2dDmi {
  double constant = 0;  ///< D in the energy density D m.(dm/dx x e_x - dm/dy x e_y)

  static constexpr std::string_view formula = "E = {} m.(dm/dx x e_x - dm/dy x e_y)";
  static constexpr auto keys() { return std::to_array<Key<D2dDmi>>({{"d2d", &D2dDmi::constant}}); }
};

/// One number for each site, x fastest, that a program passes with the text of a scene.
using GivenNumbers = std::shared_ptr<std::vector<double> const>;

/// One number for each site: from an expression as in [initial], an HDF5 or OVF file, the pixels of
/// an image, one number for each of the lattice's regions, or passed by a program.
struct SiteNumbers {
  std::string expression;
  std::filesystem::path file;
  std::vector<double> of_regions;
  GivenNumbers given;
  double unit = 1;  ///< multiplies each number: they may be typed in SI
  std::string key;  ///< in SI the key of [material] that they replace
  std::filesystem::path image = {};
  std::vector<int> levels = {};  ///< of grey: a pixel's number is how many of them it reaches

  bool there() const {
    return !expression.empty() || !file.empty() || !image.empty() || !of_regions.empty() || given;
  }
  std::string_view key_or(std::string_view other) const {
    return key.empty() ? other : std::string_view(key);
  }
};

/// One vector for each site: from components that are numbers or site-dependent, from a file with
/// dataset /values (.., 3) or in OVF, or one vector for each of the lattice's regions.
struct SiteVectors {
  Triple uniform = {};
  std::array<SiteNumbers, 3> components = {};  ///< used instead of a number where not empty
  std::filesystem::path file;
  std::vector<Triple> of_regions;
  double unit = 1;  ///< multiplies each number

  bool there() const {
    return !file.empty() || !of_regions.empty() || uniform != Triple{} ||
           std::ranges::any_of(components, &SiteNumbers::there);
  }
};

/// A factor on the exchange of bonds between two regions.
struct ExchangeBetween {
  std::array<std::int64_t, 2> regions = {};
  double factor = 1;
};

/// E = -J m.m' - B (m.m')^2 across each face between two regions, with J and B per area. m is the
/// spin at the face; exchange turns the spins between the face and the centre of its cell.
struct Interlayer {
  std::array<std::int64_t, 2> regions = {};
  double bilinear = 0, biquadratic = 0;  ///< J, B
  std::int64_t range = 0;                ///< number of cells without a spin in between
};

/// H = profile time(t).
struct Source {
  SiteVectors profile;
  AppliedComponent time = 1.0;
};

/// H = (constant (m.axis) + constant2 (m.axis)^3) axis.
struct Anisotropy {
  double constant = 0;        ///< K in H = K (m.e) e
  Triple axis = {};           ///< unit vector e
  int site = -1;              ///< index in the cell; below 0: all sites
  SiteNumbers factors = {};   ///< multiply the constant, which then is 1
  double constant2 = 0;       ///< K2
  SiteNumbers factors2 = {};  ///< multiply K2, which then is 1
  SiteVectors axes = {};      ///< instead of one axis; normalised when used

  /// Returns true unless the term has one constant and one axis.
  bool is_of_sites() const {
    return factors.there() || constant2 != 0 || factors2.there() || axes.there();
  }

  static constexpr std::string_view formula = "H = {} (m.e) e, e = {}";
  static constexpr auto keys() {
    return std::to_array<Key<Anisotropy>>(
        {{"constant", &Anisotropy::constant}, {"axis", &Anisotropy::axis}});
  }
};

/// Anisotropy of a crystal, from m's components along two orthogonal axes and their cross product.
/// Cubic, with components a, b, c: E = constant (a^2 b^2 + b^2 c^2 + c^2 a^2) + constant2 a^2 b^2
/// c^2. Hexagonal, with components c, a, b: E = constant Re (a + i b)^6.
struct CrystalAnisotropy {
  bool hexagonal = false;
  double constant = 0;
  std::array<Triple, 2> axes = {};  ///< unit vectors
  int site = -1;                    ///< index in the cell; below 0: all sites
  SiteNumbers factors = {};         ///< multiply the constant, which then is 1
  double constant2 = 0;
  SiteNumbers factors2 = {};                      ///< multiply constant2, which then is 1
  std::array<SiteVectors, 2> axes_of_sites = {};  ///< each instead of one axis

  /// Returns true if it is cubic of the lowest order, and equal on all sites of the cell that have
  /// it.
  bool is_plain() const {
    return !hexagonal && constant2 == 0 && !factors.there() && !factors2.there() &&
           !axes_of_sites[0].there() && !axes_of_sites[1].there();
  }
};

/// The table [field.in_time]: factors that are numbers, or expressions in t.
struct InTime {
  AppliedComponent exchange = 1.0, anisotropy = 1.0, dmi = 1.0;

  bool there() const { return *this != InTime{}; }
  bool operator==(InTime const&) const = default;
  std::array<AppliedComponent, 3> components() const { return {exchange, anisotropy, dmi}; }

  static constexpr auto keys() {
    return std::to_array<Key<InTime>>({{"exchange", &InTime::exchange},
                                       {"anisotropy", &InTime::anisotropy},
                                       {"dmi", &InTime::dmi}});
  }
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

/// Slonczewski 1996: t = a c m x (p x m) - b m x p, c = 2 L^2 / ((L^2 + 1) + (L^2 - 1) m.p).
struct Slonczewski {
  AppliedComponent damping_like = 0.0, field_like = 0.0;   ///< a, b
  Triple polarization = {};                                ///< unit vector p
  double lambda = 1;                                       ///< L
  SiteNumbers damping_like_of_sites, field_like_of_sites;  ///< multiply a and b, if given
  SiteVectors polarizations;  ///< instead of one vector; normalised when used

  /// Returns true if a, b or p is site-dependent, or a depends on the angle.
  bool is_of_sites() const {
    return lambda != 1 || damping_like_of_sites.there() || field_like_of_sites.there() ||
           polarizations.there();
  }

  static constexpr auto keys() {
    return std::to_array<Key<Slonczewski>>({{"damping_like"},
                                            {"field_like"},
                                            {"polarization"},
                                            {"lambda", &Slonczewski::lambda, {"a number >= 1", 1}},
                                            {"current_density"},
                                            {"efficiency"},
                                            {"thickness"},
                                            {"epsilon_prime"}});
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
  bool on_host = false;    ///< computed on the host through a mirror copy
  bool multirate = false;  ///< evaluated once or twice a step, between substeps of the rest

  static constexpr auto keys() {
    using Slab = SlabDemagnetization;
    return std::to_array<Key<Slab>>({{"normal", &Slab::normal, {"three numbers"}, true},
                                     {"strength", &Slab::strength},
                                     {"where"},
                                     {"multirate", &Slab::multirate}});
  }
};

/// The field of all cells on all cells, H = -strength sum N m; or that of point dipoles.
struct Demagnetization {
  double strength = 1;
  std::array<int, 3> periodic_images{};  ///< besides the nearest one, on each side
  std::optional<Crystal> dipoles;        ///< their positions; empty: cells of DemagnetizingField
  Triple demagnetizing_factors = {};     ///< of dipoles that are periodic along three axes
  std::string key = "demag";             ///< of [field]
  std::optional<bool> multirate;         ///< default: true if the method supports it
  std::filesystem::path
      kept_in;  ///< file that caches tensors, which take long to compute; or empty

  static constexpr auto keys() {
    return std::to_array<Key<Demagnetization>>({{"strength", &Demagnetization::strength},
                                                {"periodic_images"},
                                                {"multirate", &Demagnetization::multirate}});
  }
};

/// The table [field]. Only terms given in the scene have a value.
struct Field {
  std::optional<Exchange> exchange;
  std::optional<InterfacialDmi> dmi;
  std::optional<BulkDmi> bulk_dmi;
  std::optional<D2dDmi> d2d_dmi;
  SiteVectors dmi_normals;  ///< instead of the normal of dmi; normalised when used
  SiteNumbers exchange_factors, dmi_factors;  ///< multiply constants, which then are 1
  std::vector<ExchangeBetween> exchange_between;
  std::vector<Interlayer> interlayers;
  SiteNumbers exchange_at_faces;  ///< A for interlayers; empty: they couple centres
  std::vector<Anisotropy> anisotropies;
  std::vector<CrystalAnisotropy> crystal_anisotropies;
  InTime in_time;
  std::vector<Coupling> couplings;       ///< as typed, or from shells
  std::filesystem::path couplings_file;  ///< in Vampire's format; or empty
  double couplings_scale = 1;            ///< multiplies the numbers in that file
  Torque torque;
  std::optional<std::array<AppliedComponent, 3>> applied;
  std::vector<Source> sources;          ///< added to applied
  std::vector<Triple> applied_in_turn;  ///< for `cayspin relax`: one equilibrium for each
  std::optional<SlabDemagnetization> slab_demag;
  std::optional<Demagnetization> demag;
  double mu0 =
      1;         ///< multiplies applied, sources, slab_demag and demag, which do NOT include it yet
  OwnField own;  ///< empty, unless a program sets it

  bool has_dmi() const { return dmi || bulk_dmi || d2d_dmi; }

  static constexpr std::tuple lattice_terms{&Field::exchange, &Field::dmi, &Field::bulk_dmi};
};

/// Returns a key of the field that contains t: an applied field (also a program's), a source, a
/// factor of a term, or a current. Empty if there is none.
std::string_view key_in_time(Field const& field);
inline bool depends_on_time(Field const& field) { return !key_in_time(field).empty(); }

/// Returns the field without terms whose constants differ from site to site.
Field without_numbers_of_sites(Field field);

/// Returns true if a current acts on the spins, so that their energy need not fall.
bool has_torque(Field const& field);

/// Returns true if the field at a site depends on more than the site and its neighbours.
bool is_nonlocal(Field const& field);

/// Calls work(term) for the std::optional of each lattice term.
template <class AnyField, class Work>
void for_each_lattice_term(AnyField&& field, Work&& work) {
  std::apply([&](auto... member) { (work(field.*member), ...); }, Field::lattice_terms);
}

}  // namespace cayspin::inline v0_2::io
