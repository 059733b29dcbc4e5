// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "describe.hpp"

#include "io/notes.hpp"
#include "simulation/dear_method.hpp"
#include "simulation/text.hpp"
#include "simulation/thermal.hpp"

#include <cayspin/demagnetization/images.hpp>

#include <fmt/args.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

namespace cayspin::program {

using namespace simulation;

namespace {

std::string vector_text(io::Triple const& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v[0], v[1], v[2]);
}

std::string text_of(io::SiteNumbers const& numbers) {
  if (numbers.given) return "numbers of the program";
  return numbers.file.empty() ? numbers.expression : numbers.file.string();
}

std::string system_text(io::Scene const& scene) {
  auto const& system = scene.system;
  if (system.kind == io::SystemKind::llg)
    return fmt::format(
        "spins, Landau-Lifshitz with damping {}{}",
        system.dampings.there() ? text_of(system.dampings) : fmt::format("{:.6g}", system.damping),
        system.precession ? "" : ", overdamped (no precession)");
  auto const count = io::sites(scene);
  auto const who = count == 1 ? "a free rigid body" : fmt::format("{} free rigid bodies", count);
  if (auto const* moments = std::get_if<io::PrincipalMoments>(&system.inertia))
    return fmt::format("{} of principal moments {}", who, vector_text(*moments));
  if (auto const* file = std::get_if<io::InertiaFile>(&system.inertia))
    return fmt::format("{}, inertia tensors from {}", who, file->path.string());
  return who + " of one inertia tensor";
}

std::string length_text(io::Units const& units, double length) {
  return units.si ? fmt::format("{:.6g} m", length * units.length) : fmt::format("{:.6g}", length);
}

std::string numbers_text(std::vector<double> const& numbers) {
  return fmt::format("[{:.6g}]", fmt::join(numbers, ", "));
}

std::string lattice_text(io::Scene const& scene) {
  auto const& lattice = scene.lattice;
  auto const cell_sites = std::ssize(lattice.basis);
  auto cells = lattice.shape;
  cells[2] /= cell_sites;
  std::string more;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (cells[axis] > 1)
      more += fmt::format("; {}: spacing {}, {}", "xyz"[axis],
                          length_text(scene.units, lattice.spacing[axis]),
                          io::to_string(lattice.boundary[axis]));
  if (scene.material && !lattice.moments.empty())
    more += fmt::format("; mu_s {} J/T", numbers_text(scene.material->moments));
  else if (!lattice.moments.empty())
    more += "; moments " + numbers_text(lattice.moments);
  if (!lattice.gyromagnetic.empty()) more += "; gyromagnetic " + numbers_text(lattice.gyromagnetic);
  if (lattice.occupied.there()) more += "; occupied where " + text_of(lattice.occupied);
  if (lattice.frozen.there()) more += "; frozen where " + text_of(lattice.frozen);
  return fmt::format("{} = {} sites{}", cells_text(lattice.shape, cell_sites), io::sites(scene),
                     more);
}

// The term's formula with its parameters in it.
template <class Term>
std::string term_text(Term const& term) {
  fmt::dynamic_format_arg_store<fmt::format_context> numbers;
  for (auto const& key : Term::keys()) {
    if (auto const* const number = std::get_if<double Term::*>(&key.member))
      numbers.push_back(fmt::format("{:.6g}", term.**number));
    else
      numbers.push_back(vector_text(term.*std::get<io::Triple Term::*>(key.member)));
  }
  return fmt::vformat(Term::formula, numbers);
}

std::string component_text(io::AppliedComponent const& component) {
  if (auto const* const text = std::get_if<std::string>(&component)) return *text;
  return fmt::format("{:.6g}", std::get<double>(component));
}

std::string components_text(std::array<io::AppliedComponent, 3> const& applied) {
  return fmt::format("({}, {}, {})", component_text(applied[0]), component_text(applied[1]),
                     component_text(applied[2]));
}

std::string applied_text(io::Scene const& scene) {
  auto const& field = scene.field;
  auto const text = fmt::format("H = {}{}", field.mu0 == 1 ? "" : fmt::format("{:.6g} ", field.mu0),
                                components_text(*field.applied));
  if (!scene.applied_in_tesla) return text;
  return fmt::format("{} T, {}", components_text(*scene.applied_in_tesla), text);
}

std::string list_text(io::Scene const& scene) {
  auto const& list = scene.field.applied_in_turn;
  double const unit = scene.units.si ? scene.units.field : 1;
  auto const text = [&](io::Triple const& h) {
    return vector_text({h[0] * unit, h[1] * unit, h[2] * unit});
  };
  double const mu0 = scene.field.mu0;
  return fmt::format("H = {}h{} in turn, {} of them: h = {} to {}",
                     mu0 == 1 ? "" : fmt::format("{:.6g} ", mu0), scene.units.si ? " T" : "",
                     list.size(), text(list.front()), text(list.back()));
}

std::string material_text(io::Material const& material) {
  bool const atoms = material.atomistic;
  auto text =
      fmt::format("{} = {:.7g} {}", atoms ? "mu_s" : "Ms", material.moment, atoms ? "J/T" : "A/m");
  auto const add = [&](std::optional<double> value, io::SiteNumbers const& factors,
                       char const* name, char const* unit) {
    if (!value) return;
    auto const constant = factors.there() ? text_of(factors) : fmt::format("{:.7g}", *value);
    text += fmt::format(", {} = {}{}", name, constant, unit);
  };
  add(material.exchange, material.exchange_factors, atoms ? "J" : "A", atoms ? " J" : " J/m");
  add(material.anisotropy, material.anisotropy_factors, atoms ? "K" : "Ku",
      atoms ? " J" : " J/m^3");
  add(material.dmi, material.dmi_factors, "D", atoms ? " J" : " J/m^2");
  add(material.bulk_dmi, material.dmi_factors, "D_bulk", atoms ? " J" : " J/m^2");
  add(material.alpha, material.alpha_factors, "alpha", "");
  if (material.alpha > 0 || material.alpha_factors.there())
    text += material.gilbert ? " (Gilbert)" : " (Landau-Lifshitz)";
  add(material.gamma, {}, "gamma", " rad/(s T)");
  return text;
}

std::string factors_text(io::SiteNumbers const& numbers) {
  if (!numbers.there()) return {};
  return numbers.unit == 1 ? ", times " + text_of(numbers)
                           : fmt::format(", times {:.6g} ({})", numbers.unit, text_of(numbers));
}

std::string of_site_text(int site) {
  return site < 0 ? std::string() : fmt::format(", site {}", site);
}

// In SI " (K = .. J)": what the constant of a formula is a multiple of.
std::string in_si_text(io::Scene const& scene, char const* name, double constant) {
  if (!scene.material) return {};
  auto const& [x, y, z] = scene.lattice.spacing;
  double const length = scene.units.length, volume = length * length * length * x * y * z;
  bool const atoms = scene.material->atomistic;
  return fmt::format(" ({} = {:.6g} {})", name,
                     constant * scene.units.energy / (atoms ? 1 : volume), atoms ? "J" : "J/m^3");
}

void add_anisotropies(io::Scene const& scene,
                      std::vector<std::pair<std::string, std::string>>& lines) {
  for (auto const& term : scene.field.anisotropies)
    lines.emplace_back("anisotropy",
                       term_text(term) +
                           (term.factors.there() ? factors_text(term.factors)
                                                 : in_si_text(scene, "K", term.constant / 2)) +
                           of_site_text(term.site));
  for (auto const& term : scene.field.cubic_anisotropies)
    lines.emplace_back(
        "anisotropy",
        fmt::format("E = {:.6g} (a^2 b^2 + b^2 c^2 + c^2 a^2), axes {} and {}{}{}", term.constant,
                    vector_text(term.axes[0]), vector_text(term.axes[1]),
                    in_si_text(scene, "Kc", term.constant), of_site_text(term.site)));
}

std::string couplings_text(io::Scene const& scene, std::vector<Coupling> const& couplings) {
  auto const text = fmt::format("{} bonds of a cell", couplings.size());
  if (!scene.material) return text;
  double largest = 0;
  for (auto const& coupling : couplings) {
    for (double const entry : coupling.tensor) largest = std::max(largest, std::abs(entry));
    largest = std::max(largest, std::abs(coupling.biquadratic));
  }
  return fmt::format("{}, up to {:.6g} J", text, largest * scene.units.energy);
}

void add_torques(io::Scene const& scene, std::vector<std::pair<std::string, std::string>>& lines) {
  bool const si = scene.units.si;
  auto const& torque = si ? scene.torque_in_si : scene.field.torque;
  if (auto const& of = torque.zhang_li)
    lines.emplace_back("torque",
                       fmt::format("Zhang-Li, u = {}{}, xi = {:.6g}", components_text(of->velocity),
                                   si ? " m/s" : "", of->nonadiabaticity));
  if (auto const& of = torque.slonczewski)
    lines.emplace_back("torque",
                       fmt::format("Slonczewski, damping-like {}, field-like {}{}, p = {}",
                                   component_text(of->damping_like), component_text(of->field_like),
                                   si ? " (T)" : "", vector_text(of->polarization)));
}

std::string slab_text(io::Field const& field) {
  auto const& slab = *field.slab_demag;
  return fmt::format("H = -{:.6g} (m.n) n, n = {}{}", field.mu0 * slab.strength,
                     vector_text(slab.normal),
                     slab.dear      ? ", dear: computed on the host once a step"
                     : slab.on_host ? ", computed on the host"
                                    : "");
}

std::string images_text(std::array<int, 3> const& images) {
  std::string infinite, text;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (images[axis] == infinitely_many_images)
      infinite += fmt::format("{}{}", infinite.empty() ? "" : " and ", "xyz"[axis]);
    else if (images[axis] > 0)
      text += fmt::format(", {} images on each side along {}", images[axis], "xyz"[axis]);
  if (!infinite.empty()) text += ", infinitely many images along " + infinite;
  return text;
}

std::string demag_text(io::Scene const& scene) {
  auto const& demag = *scene.field.demag;
  return fmt::format("H = -{:.6g} N m, of all cells on all cells by FFTs{}{}",
                     scene.field.mu0 * demag.strength, images_text(demag.periodic_images),
                     has_dear_field(scene) ? ", dear: once a step" : "");
}

std::string thermal_text(io::Scene const& scene) {
  auto const& [temperature, seed] = *scene.thermal;
  auto const typed = fmt::format("{:.6g}", typed_temperature(scene));
  return fmt::format("{}, seed {}",
                     scene.units.si ? fmt::format("{} K ({:.6g})", typed, temperature) : typed,
                     seed);
}

std::string initial_text(io::Initial const& initial) {
  if (auto const* start = std::get_if<io::UniformStart>(&initial))
    return "uniform " + vector_text(start->direction);
  if (auto const* start = std::get_if<io::ExpressionStart>(&initial))
    return fmt::format("({}, {}, {}), normalised", start->components[0], start->components[1],
                       start->components[2]);
  if (auto const* start = std::get_if<io::RandomStart>(&initial))
    return fmt::format("random on the sphere, seed {}", start->seed);
  return "from " + std::get<io::FileStart>(initial).path.string();
}

}  // namespace

std::string describe_units(io::Units const& units) {
  if (!units.si) return "reduced";
  return fmt::format("SI; one reduced unit is {:.9g} s, {:.9g} m, {:.9g} T, {:.9g} J", units.time,
                     units.length, units.field, units.energy);
}

std::vector<std::pair<std::string, std::string>> describe(io::Scene const& scene) {
  std::vector<std::pair<std::string, std::string>> lines{{"scene", scene.path.string()},
                                                         {"system", system_text(scene)}};
  if (scene.material) {
    lines.emplace_back("units", describe_units(scene.units));
    lines.emplace_back("material", material_text(*scene.material));
  }
  if (scene.system.kind == io::SystemKind::llg) {
    auto const& field = scene.field;
    lines.emplace_back("lattice", lattice_text(scene));
    io::for_each_lattice_term(field, [&]<class Term>(std::optional<Term> const& term) {
      constexpr bool is_exchange = std::is_same_v<Term, io::Exchange>;
      auto const& factors = is_exchange ? field.exchange_factors : field.dmi_factors;
      if (term) lines.emplace_back(Term::key, term_text(*term) + factors_text(factors));
    });
    if (auto const bonds = io::couplings(scene); !bonds.empty())
      lines.emplace_back("couplings", couplings_text(scene, bonds));
    add_anisotropies(scene, lines);
    add_torques(scene, lines);
    if (field.applied) lines.emplace_back("applied", applied_text(scene));
    if (!field.applied_in_turn.empty()) lines.emplace_back("applied", list_text(scene));
    if (field.slab_demag) lines.emplace_back("slab demag", slab_text(field));
    if (field.demag) lines.emplace_back("demag", demag_text(scene));
  }
  if (scene.thermal) lines.emplace_back("temperature", thermal_text(scene));
  lines.emplace_back("start", initial_text(scene.initial));
  return lines;
}

void warn_of_notes(io::Scene const& scene) {
  for (auto const& note : io::notes(scene)) fmt::print(stderr, "warning: {}\n", note);
}

std::string describe_method(io::Scene const& scene) {
  auto const& integrator = scene.integrator;
  std::string text(integrator.method->word);
  if (integrator.substeps > 1) text += fmt::format(" in {} substeps", integrator.substeps);
  if (integrator.method->is_baseline()) return text;
  text += fmt::format(", {} generator, {} rotation", io::to_string(integrator.generator),
                      io::to_string(integrator.rotation));
  if (integrator.isotropy == io::Isotropy::constant)
    text += fmt::format(", sigma = {:.6g}{}", integrator.sigma / scene.units.time,
                        scene.units.si ? " rad/s" : "");
  else if (integrator.isotropy != io::Isotropy::zero)
    text += fmt::format(", sigma by {}", io::to_string(integrator.isotropy));
  return text;
}

}  // namespace cayspin::program
