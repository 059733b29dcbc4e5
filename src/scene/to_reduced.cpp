// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// From SI to reduced units.
#include "sections.hpp"

#include <cayspin/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>

namespace cayspin::inline v0_1::io::detail {
namespace {

// A formula in t, with t in units of `time` and the result in units of `field`.
std::string scaled_expression(std::string const& text, double time, double field) {
  static std::regex const variable(R"(\bt\b)");
  return fmt::format("({})/{}", std::regex_replace(text, variable, fmt::format("({}*t)", time)),
                     field);
}

// Of numbers that differ from site to site, the sites take their own part.
units::Damping damping_of(Material const& material) {
  return material.gilbert ? units::gilbert(material.alpha) : units::landau_lifshitz(material.alpha);
}

double largest_coupling(std::vector<Coupling> const& couplings) {
  double largest = 0;
  for (auto const& [between, offset, tensor, biquadratic] : couplings) {
    for (double const entry : tensor) largest = std::max(largest, std::abs(entry));
    largest = std::max(largest, std::abs(biquadratic));
  }
  return largest;
}

// The first of these that is one number; 1 T on a moment where there is none.
double energy_unit(Material const& material, Field const& field) {
  auto const one = [](std::optional<double> const& value, SiteNumbers const& numbers) {
    return numbers.there() ? 0 : std::abs(value.value_or(0));
  };
  for (double const energy :
       {one(material.exchange, material.exchange_factors), largest_coupling(field.couplings),
        one(material.anisotropy, material.anisotropy_factors),
        one(material.dmi, material.dmi_factors), one(material.bulk_dmi, material.dmi_factors)})
    if (energy != 0) return energy;
  return material.moment;
}

// Numbers of sites are in SI: `in_reduced` is what 1 comes to.
double constant(double typed, SiteNumbers& numbers, auto const& in_reduced) {
  if (!numbers.there()) return in_reduced(typed);
  numbers.unit = in_reduced(1);
  return 1;
}

void convert_material(Scene& scene, auto const& units) {
  auto const& material = *scene.material;
  auto& field = scene.field;
  auto const exchange = [&](double A) { return units.exchange(A); };
  auto const anisotropy = [&](double K) { return units.anisotropy(K); };
  auto const dmi = [&](double D) { return units.dmi(D); };
  for (auto& term : field.anisotropies)
    term.constant = constant(term.constant, term.factors, anisotropy);
  for (auto& term : field.cubic_anisotropies) term.constant = units.cubic_anisotropy(term.constant);
  if (material.anisotropy) {
    Anisotropy term{0, material.axis, -1, material.anisotropy_factors};
    term.constant = constant(*material.anisotropy, term.factors, anisotropy);
    field.anisotropies.insert(field.anisotropies.begin(), term);
  }
  field.exchange_factors = material.exchange_factors;
  if (material.exchange)
    field.exchange = {constant(*material.exchange, field.exchange_factors, exchange)};
  field.dmi_factors = material.dmi_factors;
  if (material.dmi) field.dmi = {constant(*material.dmi, field.dmi_factors, dmi), material.normal};
  if (material.bulk_dmi) field.bulk_dmi = {constant(*material.bulk_dmi, field.dmi_factors, dmi)};
}

void convert_couplings(Field& field, units::ReducedUnits const& units) {
  for (auto& [between, offset, tensor, biquadratic] : field.couplings) {
    for (double& entry : tensor) entry = units.energy(entry);
    biquadratic = units.energy(biquadratic);
  }
  field.couplings_scale = units.energy(field.couplings_scale);
}

// Relative to the first; none where all are alike.
void convert_moments(Scene& scene) {
  auto const& moments = scene.material->moments;
  double const first = scene.material->moment;
  if (std::ranges::all_of(moments, [&](double moment) { return moment == first; })) return;
  for (double const moment : moments) scene.lattice.moments.push_back(moment / first);
}

void convert_component(AppliedComponent& component, units::ReducedUnits const& units, double unit) {
  if (auto* const number = std::get_if<double>(&component))
    *number /= unit;
  else
    component = scaled_expression(std::get<std::string>(component), units.time_unit(), unit);
}

void convert_torque(Scene& scene, units::ReducedUnits const& units) {
  auto& [zhang_li, slonczewski] = scene.field.torque;
  scene.torque_in_si = scene.field.torque;
  if (zhang_li)
    for (auto& component : zhang_li->velocity)
      convert_component(component, units, units.velocity_unit());
  if (slonczewski) {
    convert_component(slonczewski->damping_like, units, units.field_unit());
    convert_component(slonczewski->field_like, units, units.field_unit());
  }
}

void convert_field(Scene& scene, auto const& units) {
  auto& field = scene.field;
  convert_material(scene, units);
  convert_couplings(field, units);
  convert_torque(scene, units);
  if (field.slab_demag)
    field.slab_demag->strength = units.demagnetization(field.slab_demag->strength);
  if (field.demag) field.demag->strength = units.demagnetization(field.demag->strength);
  for (auto& in_turn : field.applied_in_turn)
    for (double& component : in_turn) component = units.applied(component);
  scene.applied_in_tesla = field.applied;
  if (!field.applied) return;
  for (auto& component : *field.applied) convert_component(component, units, units.field_unit());
}

void convert_integrator(Integrator& integrator, units::ReducedUnits const& units) {
  integrator.dt = units.time(integrator.dt);
  integrator.min_dt = units.time(integrator.min_dt);
  integrator.max_dt = units.time(integrator.max_dt);
  integrator.sigma = units.rate(integrator.sigma);
  if (integrator.until_torque) *integrator.until_torque = units.applied(*integrator.until_torque);
}

void convert(Scene& scene, auto const& units) {
  scene.units = {true, units.time_unit(), units.length_unit(), units.field_unit(),
                 units.energy_unit()};
  for (double const unit : {units.time_unit(), units.length_unit(), units.field_unit(),
                            units.energy_unit(), units.velocity_unit()})
    if (!std::isnormal(unit))
      refuse(scene, "material", fmt::format("a unit of the reduced equation comes to {}", unit),
             "numbers in SI units");
  scene.system.damping = units.damping();
  scene.system.dampings = scene.material->alpha_factors;
  scene.system.gilbert_of_sites = scene.system.dampings.there() && scene.material->gilbert;
  convert_moments(scene);
  convert_field(scene, units);
  convert_integrator(scene.integrator, units);
  if (scene.thermal) scene.thermal->temperature = units.temperature(scene.thermal->temperature);
  if (!std::isnormal(scene.integrator.dt))
    refuse(scene, "integrator.dt",
           fmt::format("comes to {} units of {} s", scene.integrator.dt, units.time_unit()),
           "a time in s");
}

// Of the lattice's sites in a cube of the spacing, which the dipolar field of a slab is of.
double sites_in_cube(Lattice const& lattice) {
  return static_cast<double>(lattice.basis.size()) / crystal(lattice).volume();
}

}  // namespace

void convert_to_reduced(Scene& scene) {
  auto const& material = *scene.material;
  auto& spacing = scene.lattice.spacing;
  if (!material.atomistic) {
    units::Micromagnetic const units(
        {material.moment, spacing, damping_of(material), material.gamma});
    convert(scene, units);
    spacing = units.spacing();
  } else {
    if (spacing[1] != spacing[0] || spacing[2] != spacing[0])
      refuse(scene, "lattice.spacing", "differs from axis to axis",
             "one lattice constant, since material.J is that of every bond");
    units::Atomistic const units({material.moment, energy_unit(material, scene.field), spacing[0],
                                  damping_of(material), material.gamma});
    if (scene.field.slab_demag) scene.field.slab_demag->strength *= sites_in_cube(scene.lattice);
    convert(scene, units);
    spacing = {1, 1, 1};
  }
}

}  // namespace cayspin::inline v0_1::io::detail
