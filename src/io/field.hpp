// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/anisotropy.hpp"
#include "io/demag.hpp"
#include "io/exchange_and_dmi.hpp"
#include "io/exchange_between_regions.hpp"
#include "io/key.hpp"
#include "io/own_field.hpp"
#include "io/site_numbers.hpp"
#include "io/torque.hpp"

#include <cayspin/coupling.hpp>

#include <array>
#include <filesystem>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

namespace cayspin::inline v0_2::io {

/// A part of the applied field: H = profile * time(t).
struct Source {
  SiteVectors profile;
  AppliedComponent time = 1.0;
};

/// The table [field.in_time]: factors on terms, each a number or an expression in t.
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

/// The table [field]. Only terms given in the scene have a value.
struct Field {
  std::optional<Exchange> exchange;
  std::optional<InterfacialDmi> dmi;
  std::optional<BulkDmi> bulk_dmi;
  std::optional<D2dDmi> d2d_dmi;
  SiteVectors dmi_normals;  ///< if set, replace the normal of dmi; normalised when used
  SiteNumbers exchange_factors, dmi_factors;  ///< values per site; the constants are then 1
  std::vector<ExchangeBetween> exchange_between;
  std::vector<Interlayer> interlayers;
  /// Exchange between the centre of a cell and its faces. If empty, interlayers couple the centres.
  SiteNumbers exchange_at_faces;
  std::vector<Anisotropy> anisotropies;
  std::vector<CrystalAnisotropy> crystal_anisotropies;
  InTime in_time;
  std::vector<Coupling> couplings;       ///< as typed, or from shells
  std::filesystem::path couplings_file;  ///< in Vampire's format; or empty
  double couplings_scale = 1;            ///< multiplies the numbers in that file
  bool has_couplings_scale = false;      ///< true if the scene gives the scale
  Torque torque;
  std::optional<std::array<AppliedComponent, 3>> applied;
  std::vector<Source> sources;          ///< added to applied
  std::vector<Triple> applied_in_turn;  ///< for `cayspin relax`, which finds an equilibrium in each
  std::optional<SlabDemagnetization> slab_demag;
  std::optional<Demagnetization> demag;
  /// Multiplies applied, sources, slab_demag and demag. Their numbers do not include this factor.
  double mu0 = 1;
  OwnField own;  ///< empty unless a program sets it

  bool has_dmi() const { return dmi || bulk_dmi || d2d_dmi; }

  static constexpr std::tuple lattice_terms{&Field::exchange, &Field::dmi, &Field::bulk_dmi};
};

/// Returns the first key whose value depends on t: an applied field (also a program's own), a
/// source, a factor of a term, or a torque. Empty if there is none.
std::string_view key_in_time(Field const& field);
inline bool depends_on_time(Field const& field) { return !key_in_time(field).empty(); }

/// Returns the field without interlayers, without exchange and DMI that are site-dependent, and
/// without uniaxial anisotropies that are site-dependent or have a second constant. DMI of D2d
/// counts as site-dependent.
Field without_numbers_of_sites(Field field);

/// Returns true if a current acts on the spins: their energy may then rise.
bool has_torque(Field const& field);

/// Returns true if a term is computed for all sites at once: demag or dipoles, a slab's field on
/// the host, or a program's own nonlocal field.
bool is_nonlocal(Field const& field);

/// Calls work(term) for the std::optional of each lattice term.
template <class AnyField, class Work>
void for_each_lattice_term(AnyField&& field, Work&& work) {
  std::apply([&](auto... member) { (work(field.*member), ...); }, Field::lattice_terms);
}

}  // namespace cayspin::inline v0_2::io
