// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"

#include <cayspin/units.hpp>

#include <fmt/format.h>

#include <cmath>

namespace cayspin::inline v0_1::io::detail {
namespace {

// A number in SI, or { unit = number }.
struct Unit {
  std::string_view name;
  double in_si;
};
constexpr Unit energies[] = {{"meV", 1e-3 * units::electronvolt},
                             {"eV", units::electronvolt},
                             {"mRy", 1e-3 * units::rydberg}};
constexpr Unit moments[] = {{"bohr_magnetons", units::bohr_magneton}};

double quantity(Item const& item, Scene& scene, std::span<Unit const> units,
                std::string_view accepted) {
  if (!item.node->is_table()) return number(item, accepted);
  Table const table(item, scene);
  std::vector<std::string_view> names;
  for (auto const& unit : units) names.push_back(unit.name);
  table.accept_only(names);
  if (item.node->as_table()->size() != 1) item.fail("is not one number with its unit", accepted);
  double value = 0;
  for (auto const& unit : units)
    if (auto const typed = table.find(unit.name)) value = number(*typed) * unit.in_si;
  return value;
}

double positive(Item const& item, double value) {
  if (!(value > 0)) item.fail(fmt::format("{} is not positive", value), "a number > 0");
  return value;
}

struct Keys {
  std::string_view moment, exchange, anisotropy;
};
constexpr Keys continuum{"Ms", "A", "Ku"}, atomistic{"mu_s", "J", "K"};

// Which of the two kinds of material it is.
bool is_atomistic(Table const& table) {
  constexpr std::string_view accepted = "exactly one of Ms (A/m), mu_s (J/T)";
  auto const of_atoms = table.find(atomistic.moment);
  bool const of_continuum = table.contains(continuum.moment);
  if (of_atoms && of_continuum) of_atoms->fail("stands beside material.Ms", accepted);
  if (!of_atoms && !of_continuum)
    detail::fail(table.item().place, "material.Ms", "is missing", accepted);
  auto const& [moment, exchange, anisotropy] = of_atoms ? continuum : atomistic;
  auto const& mine = of_atoms ? atomistic : continuum;
  for (auto const& [other, own] :
       {std::pair{exchange, mine.exchange}, {anisotropy, mine.anisotropy}})
    if (auto const item = table.find(other))
      item->fail(fmt::format("does not go with material.{}", mine.moment),
                 fmt::format("material.{}", own));
  return of_atoms.has_value();
}

// A vector that belongs to another key: both or neither.
Triple direction_with(Table const& table, std::string_view name, std::string_view other,
                      bool present) {
  if (present) return direction(table.required(name, "three numbers"));
  if (auto const item = table.find(name))
    item->fail(fmt::format("stands without material.{}", other), "both or neither");
  return {};
}

void read_damping(Table const& table, Material& material) {
  constexpr std::string_view forms = "\"gilbert\", \"landau_lifshitz\"";
  material.alpha = non_negative_number(table.required("alpha", "a number >= 0"));
  auto const form = table.find("damping_form");
  if (!form) {
    if (material.alpha > 0)
      detail::fail(table.item().place, "material.damping_form",
                   "is missing: the two forms of damping differ by a factor 1 + alpha^2 in time",
                   forms);
    return;
  }
  auto const name = string(*form, forms);
  if (name != "gilbert" && name != "landau_lifshitz")
    unknown_word(*form, name, {"gilbert", "landau_lifshitz"}, forms);
  material.gilbert = name == "gilbert";
}

Material read_material(Table const& table) {
  table.accept_only(
      {"Ms", "A", "Ku", "mu_s", "J", "K", "axis", "D", "normal", "alpha", "damping_form", "gamma"});
  Material material;
  material.atomistic = is_atomistic(table);
  auto const& keys = material.atomistic ? atomistic : continuum;
  auto const constant = [&](std::string_view key) -> std::optional<double> {
    auto const item = table.find(key);
    if (!item) return std::nullopt;
    if (!material.atomistic) return number(*item);
    return quantity(*item, table.scene(), energies,
                    "a number in J, { meV = number }, { eV = number } or { mRy = number }");
  };
  auto const moment = table.required(keys.moment, "a number > 0");
  material.moment = positive(
      moment, material.atomistic ? quantity(moment, table.scene(), moments,
                                            "a number in J/T, or { bohr_magnetons = number }")
                                 : number(moment));
  material.exchange = constant(keys.exchange);
  material.anisotropy = constant(keys.anisotropy);
  material.dmi = constant("D");
  read_damping(table, material);
  material.gamma = units::electron_gamma;
  if (auto const item = table.find("gamma")) material.gamma = positive_number(*item);
  return material;
}

units::Damping damping_of(Material const& material) {
  return material.gilbert ? units::gilbert(material.alpha) : units::landau_lifshitz(material.alpha);
}

// The largest there is of what it is made of; 1 T on a moment where there is nothing.
double energy_unit(Material const& material) {
  for (auto const& energy : {material.exchange, material.anisotropy, material.dmi})
    if (energy.value_or(0) != 0) return std::abs(*energy);
  return material.moment;
}

void convert_field(Scene& scene, Table const& table, auto const& units) {
  auto& field = scene.field;
  auto const& material = *scene.material;
  auto const& keys = material.atomistic ? atomistic : continuum;
  bool const has_axis = material.anisotropy.has_value(), has_normal = material.dmi.has_value();
  auto const axis = direction_with(table, "axis", keys.anisotropy, has_axis);
  auto const normal = direction_with(table, "normal", "D", has_normal);
  if (material.exchange) field.exchange = {units.exchange(*material.exchange)};
  if (has_axis) field.anisotropies = {{units.anisotropy(*material.anisotropy), axis}};
  if (has_normal) field.dmi = {units.dmi(*material.dmi), normal};
  if (field.slab_demag)
    field.slab_demag->strength = units.demagnetization(field.slab_demag->strength);
  for (auto& in_turn : field.applied_in_turn)
    for (double& component : in_turn) component = units.applied(component);
  scene.applied_in_tesla = field.applied;
  if (!field.applied) return;
  for (auto& component : *field.applied) {
    if (auto* const number = std::get_if<double>(&component))
      *number = units.applied(*number);
    else
      component = scaled_expression(std::get<std::string>(component), units.time_unit(),
                                    units.field_unit());
  }
}

void convert_integrator(Integrator& integrator, units::ReducedUnits const& units) {
  integrator.dt = units.time(integrator.dt);
  integrator.min_dt = units.time(integrator.min_dt);
  integrator.max_dt = units.time(integrator.max_dt);
  integrator.sigma = units.rate(integrator.sigma);
  if (integrator.until_torque) *integrator.until_torque = units.applied(*integrator.until_torque);
}

void convert(Scene& scene, Table const& table, auto const& units) {
  scene.units = {true, units.time_unit(), units.length_unit(), units.field_unit(),
                 units.energy_unit()};
  for (double const unit :
       {units.time_unit(), units.length_unit(), units.field_unit(), units.energy_unit()})
    if (!std::isnormal(unit))
      table.item().fail(fmt::format("a unit of the reduced equation comes to {}", unit),
                        "numbers in SI units");
  scene.system.damping = units.damping();
  convert_field(scene, table, units);
  convert_integrator(scene.integrator, units);
  if (scene.thermal) scene.thermal->temperature = units.temperature(scene.thermal->temperature);
  if (!std::isnormal(scene.integrator.dt))
    throw scene_error(scene, "integrator.dt",
                      fmt::format("comes to {} units of {} s; accepted: a time in s",
                                  scene.integrator.dt, units.time_unit()));
}

}  // namespace

bool read_is_si(Table const& root) {
  constexpr std::string_view accepted = "\"reduced\", \"SI\"";
  auto const item = root.find("units");
  auto const name = item ? string(*item, accepted) : std::string("reduced");
  if (name == "SI") return true;
  if (name != "reduced") unknown_word(*item, name, {"reduced", "SI"}, accepted);
  if (auto const material = root.find("material"))
    material->fail("belongs to units = \"SI\"", "that word above all tables, or no such table");
  return false;
}

void convert_to_reduced(Table const& root) {
  auto& scene = root.scene();
  if (scene.system.kind == SystemKind::rigid_body)
    root.find("units")->fail("\"SI\" has no meaning for kind = \"rigid_body\"", "\"reduced\"");
  auto const table = root.table("material", "a table [material] with Ms in A/m, or mu_s in J/T");
  scene.material = read_material(table);
  auto const& material = *scene.material;
  auto& spacing = scene.lattice.spacing;
  if (!material.atomistic) {
    units::Micromagnetic const units(
        {material.moment, spacing, damping_of(material), material.gamma});
    convert(scene, table, units);
    spacing = units.spacing();
  } else {
    if (spacing[1] != spacing[0] || spacing[2] != spacing[0])
      throw scene_error(scene, "lattice.spacing",
                        "differs from axis to axis; accepted: one lattice constant, since "
                        "material.J is that of every bond");
    units::Atomistic const units(
        {material.moment, energy_unit(material), spacing[0], damping_of(material), material.gamma});
    convert(scene, table, units);
    spacing = {1, 1, 1};
  }
}

}  // namespace cayspin::inline v0_1::io::detail
