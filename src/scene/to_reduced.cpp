// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Conversion of scenes from SI to reduced units.
#include "sections.hpp"

#include <cayspin/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>

namespace cayspin::inline v0_2::io::detail {
namespace {

// Returns the formula rewritten for t in units of `time` and for a value in units of `field`.
std::string scaled_expression(std::string const& text, double time, double field) {
  static std::regex const variable(R"(\bt\b)");
  auto const scaled = std::regex_replace(text, variable, fmt::format("({}*t)", time));
  return field == 1 ? fmt::format("({})", scaled) : fmt::format("({})/{}", scaled, field);
}

// If alpha is site-dependent, material.alpha is 0, and the unit of time has no factor 1 + alpha^2.
// In Gilbert's form, that factor is then applied at each site.
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

// Returns the unit of energy: the magnitude of J, of the largest entry of the couplings, of K or of
// D, whichever is the first that is uniform and not 0. If none is, moment * 1 T.
double energy_unit(Material const& material, Field const& field) {
  auto const one = [](std::optional<double> const& value, SiteNumbers const& numbers) {
    return numbers.there() ? 0 : std::abs(value.value_or(0));
  };
  for (double const energy :
       {one(material.exchange, material.exchange_factors), largest_coupling(field.couplings),
        one(material.anisotropy, material.anisotropy_factors),
        one(material.dmi, material.dmi_factors), one(material.bulk_dmi, material.dmi_factors),
        one(material.d2d_dmi, material.dmi_factors)})
    if (energy != 0) return energy;
  return material.moment;
}

// Converts a constant. Site-dependent numbers stay in SI, and their unit becomes the factor that
// converts them.
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
  // The field of Ku is 2 * Ku * (m.e) e, and that of Ku2 is 4 * Ku2 * (m.e)^3 e, so the factor for
  // Ku2 is twice that for Ku.
  auto const anisotropy2 = [&](double K) { return 2 * units.anisotropy(K); };
  for (auto& term : field.anisotropies) {
    term.constant = constant(term.constant, term.factors, anisotropy);
    term.constant2 = constant(term.constant2, term.factors2, anisotropy2);
  }
  auto const of_crystal = [&](double K) { return units.cubic_anisotropy(K); };
  for (auto& term : field.crystal_anisotropies) {
    term.constant = constant(term.constant, term.factors, of_crystal);
    term.constant2 = constant(term.constant2, term.factors2, of_crystal);
  }
  if (material.anisotropy || material.anisotropy2) {
    Anisotropy term{.axis = material.axis,
                    .factors = material.anisotropy_factors,
                    .factors2 = material.anisotropy2_factors,
                    .axes = material.axes};
    term.constant = constant(material.anisotropy.value_or(0), term.factors, anisotropy);
    term.constant2 = constant(material.anisotropy2.value_or(0), term.factors2, anisotropy2);
    field.anisotropies.insert(field.anisotropies.begin(), term);
  }
  field.exchange_factors = material.exchange_factors;
  if (material.exchange)
    field.exchange = {constant(*material.exchange, field.exchange_factors, exchange)};
  field.dmi_factors = material.dmi_factors;
  for (auto& [regions, bilinear, biquadratic, range] : field.interlayers)
    bilinear = units.dmi(bilinear), biquadratic = units.dmi(biquadratic);
  if (material.dmi) field.dmi = {constant(*material.dmi, field.dmi_factors, dmi), material.normal};
  field.dmi_normals = material.normals;
  if (material.d2d_dmi) field.d2d_dmi = {constant(*material.d2d_dmi, field.dmi_factors, dmi)};
  if (material.bulk_dmi) field.bulk_dmi = {constant(*material.bulk_dmi, field.dmi_factors, dmi)};
}

void convert_couplings(Field& field, units::ReducedUnits const& units) {
  for (auto& [between, offset, tensor, biquadratic] : field.couplings) {
    for (double& entry : tensor) entry = units.energy(entry);
    biquadratic = units.energy(biquadratic);
  }
  field.couplings_scale = units.energy(field.couplings_scale);
}

// Stores site-dependent moments with their unit and, unless all are equal, the moments of a cell's
// sites relative to the first.
void convert_moments(Scene& scene) {
  scene.lattice.moments_of_sites = scene.material->moment_factors;
  scene.lattice.moments_of_sites.unit = 1 / scene.material->moment;
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
  if (!slonczewski) return;
  auto const convert_strength = [&](AppliedComponent& component, SiteNumbers& of_sites) {
    if (of_sites.there()) of_sites.unit /= units.field_unit();
    convert_component(component, units, of_sites.there() ? 1 : units.field_unit());
  };
  convert_strength(slonczewski->damping_like, slonczewski->damping_like_of_sites);
  convert_strength(slonczewski->field_like, slonczewski->field_like_of_sites);
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
  for (auto& [profile, time] : field.sources) {
    profile.unit = 1 / units.field_unit();
    convert_component(time, units, 1);
  }
  for (auto* const factor :
       {&field.in_time.exchange, &field.in_time.anisotropy, &field.in_time.dmi})
    convert_component(*factor, units, 1);
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

void convert_initial(Initial& initial, units::ReducedUnits const& units) {
  auto* const state = std::get_if<InitialState>(&initial);
  if (state == nullptr) return;
  auto const convert_lengths = [&](auto& of) {
    if constexpr (requires { of.radius; }) of.radius /= units.length_unit();
    if constexpr (requires { of.width; }) of.width /= units.length_unit();
    if constexpr (requires { of.period; }) of.period /= units.length_unit();
  };
  std::visit(convert_lengths, *state);
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
  if (scene.material->gamma_factors.there()) {
    scene.lattice.gyromagnetic_of_sites = scene.material->gamma_factors;
    scene.lattice.gyromagnetic_of_sites.unit = 1 / scene.material->gamma;
  }
  convert_moments(scene);
  convert_field(scene, units);
  convert_initial(scene.initial, units);
  convert_integrator(scene.integrator, units);
  if (scene.thermal) {
    scene.thermal->temperature = units.temperature(scene.thermal->temperature);
    convert_component(scene.thermal->in_time, units, 1);
  }
  if (!std::isnormal(scene.integrator.dt))
    refuse(scene, "integrator.dt",
           fmt::format("comes to {} units of {} s", scene.integrator.dt, units.time_unit()),
           "a time in s");
}

// Returns the number of sites in a cube with the spacing as its edge. A slab's dipolar field refers
// to the volume of that cube.
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

}  // namespace cayspin::inline v0_2::io::detail
