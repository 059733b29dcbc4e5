// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "quantity.hpp"
#include "sections.hpp"

#include <cayspin/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace cayspin::inline v0_2::io::detail {
namespace {

double positive_moment(Item const& item, double value) {
  if (!(value > 0)) item.fail(fmt::format("{} is not positive", value), "a number > 0");
  return value;
}

struct Keys {
  std::string_view moment, exchange, anisotropy, anisotropy2;
};
constexpr Keys continuum{"Ms", "A", "Ku", "Ku2"}, atomistic{"mu_s", "J", "K", "K2"};

// Returns true for an atomistic material, false for a continuum.
bool is_atomistic(Table const& table) {
  constexpr std::string_view accepted = "exactly one of Ms (A/m), mu_s (J/T)";
  auto const of_atoms = table.find(atomistic.moment);
  bool const of_continuum = table.contains(continuum.moment);
  if (of_atoms && of_continuum) of_atoms->fail("stands beside material.Ms", accepted);
  if (!of_atoms && !of_continuum)
    detail::fail(table.item().place, "material.Ms", "is missing", accepted);
  auto const& [moment, exchange, anisotropy, anisotropy2] = of_atoms ? continuum : atomistic;
  auto const& mine = of_atoms ? atomistic : continuum;
  for (auto const& [other, own] : {std::pair{exchange, mine.exchange},
                                   {anisotropy, mine.anisotropy},
                                   {anisotropy2, mine.anisotropy2}})
    if (auto const item = table.find(other))
      item->fail(fmt::format("does not go with material.{}", mine.moment),
                 fmt::format("material.{}", own));
  return of_atoms.has_value();
}

// Reads moments if they are site-dependent, and chooses the moment that counts as 1: the largest
// moment of a region. Other site-dependent moments are not evaluated here; for them, 1 T / mu0 or a
// Bohr magneton counts as 1.
bool read_moments_of_sites(Item const& item, Scene& scene, Material& material) {
  if (!are_numbers_of_sites(item)) return false;
  auto& numbers = material.moment_factors;
  read_site_numbers(item, scene, numbers);
  numbers.key = item.key;
  material.moment = material.atomistic ? units::bohr_magneton : 1 / units::vacuum_permeability;
  if (numbers.per_region.empty()) return true;
  for (double const moment : numbers.per_region)
    if (!(moment >= 0)) item.fail(fmt::format("{} is negative", moment), "numbers >= 0");
  material.moment = std::ranges::max(numbers.per_region);
  if (material.moment == 0) item.fail("leaves no spin", "a number > 0 among those of the regions");
  return true;
}

// Reads one moment for all sites of the cell, or one for each.
void read_moments(Item const& item, Scene& scene, Material& material) {
  if (read_moments_of_sites(item, scene, material)) return;
  auto const sites = scene.lattice.basis.size();
  auto const accepted = sites == 1
                            ? std::string(accepted_moment)
                            : fmt::format("{}, or {} of these, one for each site of the cell",
                                          accepted_moment, sites);
  auto const typed = in_joules_per_tesla(item, scene, accepted);
  if (!typed.value.node->is_array()) {
    material.moment = positive_moment(typed.value, number(typed.value, {accepted}) * typed.unit);
    return;
  }
  bool const has_unit = typed.value.node != item.node;
  for (auto const& entry : entries(typed.value, sites, sites, accepted)) {
    auto const [value, unit] =
        has_unit ? InUnit{entry, typed.unit} : in_joules_per_tesla(entry, scene);
    material.moments.push_back(positive_moment(value, number(value, {accepted_moment}) * unit));
  }
  material.moment = material.moments.front();
}

// Reads the vector `name`, which belongs to the key `other`: the scene must have both or neither.
// `present`: whether the scene has `other`. Site-dependent vectors go to `of_sites`.
Triple direction_with(Table const& table, std::string_view name, std::string_view other,
                      bool present, SiteVectors& of_sites) {
  if (present) {
    auto const item = table.required(name, "three numbers, or vectors per site");
    auto const one = axis_of_sites(item, table.scene(), of_sites);
    of_sites.key = item.key;
    return one;
  }
  if (auto const item = table.find(name))
    item->fail(fmt::format("stands without material.{}", other), "both or neither");
  return {};
}

void read_damping(Table const& table, Material& material) {
  constexpr Word<bool> forms[] = {{"gilbert", true}, {"landau_lifshitz", false}};
  auto const alpha = table.required("alpha", not_negative_or_of_sites.accepted);
  if (read_site_numbers(alpha, table.scene(), material.alpha_factors))
    material.alpha_factors.key = alpha.key;
  else
    material.alpha = number(alpha, not_negative_or_of_sites);
  auto const form = table.find("damping_form");
  if (!form) {
    if (material.alpha > 0 || material.alpha_factors.there())
      detail::fail(table.item().place, "material.damping_form",
                   "is missing: the two forms of damping differ by a factor 1 + alpha^2 in time",
                   quoted<bool>(forms));
    return;
  }
  material.gilbert = word_among<bool>(forms, *form);
}

// Reads gamma. If it is site-dependent, the value of the free electron counts as 1.
void read_gamma(Item const& item, Scene& scene, Material& material) {
  if (!read_site_numbers(item, scene, material.gamma_factors)) {
    material.gamma = number(item, positive_or_of_sites);
    return;
  }
  material.gamma_factors.key = item.key;
  if (!scene.lattice.gyromagnetic.empty() || scene.lattice.gyromagnetic_of_sites.there())
    item.fail("stands beside lattice.gyromagnetic", "one of the two, or one number");
}

}  // namespace

void read_material(Table const& root, Scene& scene) {
  if (scene.system.kind == SystemKind::rigid_body)
    root.find("units")->fail("\"SI\" has no meaning for kind = \"rigid_body\"", "\"reduced\"");
  auto const table = root.table("material", "a table [material] with Ms in A/m, or mu_s in J/T");
  table.accept_only({"Ms", "A", "Ku", "Ku2", "mu_s", "J", "K", "K2", "axis", "D", "normal",
                     "D_bulk", "D2d", "alpha", "free_boundary", "damping_form", "gamma"});
  auto& material = scene.material.emplace();
  material.atomistic = is_atomistic(table);
  auto const& keys = material.atomistic ? atomistic : continuum;
  auto const constant = [&](std::string_view key, SiteNumbers& numbers) -> std::optional<double> {
    auto const item = table.find(key);
    if (!item) return std::nullopt;
    double const value = constant_of_sites(*item, scene, numbers);
    if (numbers.there()) numbers.key = item->key;
    return value;
  };
  auto const moment = table.required(keys.moment, "a number > 0");
  if (material.atomistic)
    read_moments(moment, scene, material);
  else if (!read_moments_of_sites(moment, scene, material))
    material.moment = number(moment, positive_or_of_sites);
  material.exchange = constant(keys.exchange, material.exchange_factors);
  material.anisotropy = constant(keys.anisotropy, material.anisotropy_factors);
  material.anisotropy2 = constant(keys.anisotropy2, material.anisotropy2_factors);
  material.axis = direction_with(table, "axis", keys.anisotropy,
                                 material.anisotropy || material.anisotropy2, material.axes);
  material.dmi = constant("D", material.dmi_factors);
  material.normal =
      direction_with(table, "normal", "D", material.dmi.has_value(), material.normals);
  constexpr std::string_view one_dmi = "D with normal, of an interface, D_bulk, or D2d";
  auto const bulk = table.find("D_bulk"), d2d = table.find("D2d");
  if (bulk && material.dmi) bulk->fail("stands beside material.D", one_dmi);
  if (d2d && (bulk || material.dmi))
    d2d->fail(fmt::format("stands beside material.{}", bulk ? "D_bulk" : "D"), one_dmi);
  material.bulk_dmi = constant("D_bulk", material.dmi_factors);
  material.d2d_dmi = constant("D2d", material.dmi_factors);
  read_damping(table, material);
  material.gamma = units::electron_gamma;
  if (auto const item = table.find("gamma")) read_gamma(*item, scene, material);
}

bool read_is_si(Table const& root) {
  constexpr Word<bool> systems[] = {{"reduced", false}, {"SI", true}};
  auto const item = root.find("units");
  if (item && word_among<bool>(systems, *item)) return true;
  if (auto const material = root.find("material"))
    material->fail("belongs to units = \"SI\"",
                   "units = \"SI\" above all tables, or no such table");
  return false;
}

void check_si(Scene const& scene) {
  auto const refuse_if_typed = [&](std::string_view key, std::string_view wrong,
                                   std::string_view accepted) {
    if (scene.places.contains(key)) refuse(scene, key, wrong, accepted);
  };
  bool const atomistic = scene.material->atomistic;
  refuse_if_typed(
      "lattice.moments", "belongs to reduced units",
      atomistic ? "material.mu_s, one number or one for each site of the cell" : "material.Ms");
  if (!atomistic)
    for (auto const* const key :
         {"lattice.crystal", "lattice.cell", "lattice.basis", "field.couplings"})
      refuse_if_typed(key, "is of atoms, and material.Ms of a continuum",
                      "material.mu_s, or no such key");
  // The field of a slab is that of the moments per volume, but is computed from each site's own
  // moment.
  auto const differ = [](std::vector<double> const& numbers) {
    return std::ranges::adjacent_find(numbers, std::not_equal_to<>()) != numbers.end();
  };
  auto const& of_sites = scene.material->moment_factors;
  bool const may_differ_in_cell = of_sites.there() && scene.lattice.basis.size() > 1 &&
                                  (of_sites.per_region.empty() || differ(of_sites.per_region));
  if (differ(scene.material->moments) || may_differ_in_cell)
    refuse_if_typed("field.slab_demag", "needs moments that are all alike",
                    "one number in material.mu_s, or field.dipoles");
}

}  // namespace cayspin::inline v0_2::io::detail
