// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "describe.hpp"

#include "io/notes.hpp"
#include "simulation/message.hpp"
#include "simulation/multirate_method.hpp"
#include "simulation/text.hpp"
#include "simulation/thermal.hpp"

#include <cayspin/demagnetization/images.hpp>

#include <fmt/args.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <ranges>

namespace cayspin::program {

using namespace simulation;

namespace {

std::string vector_text(io::Triple const& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v[0], v[1], v[2]);
}

std::string text_of(io::SiteNumbers const& numbers) {
  if (numbers.given) return "numbers of the program";
  if (!numbers.per_region.empty())
    return fmt::format("[{:.6g}] of regions", fmt::join(numbers.per_region, ", "));
  if (!numbers.image.empty()) return numbers.image.string();
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
  if (lattice.regions.there()) more += "; regions " + text_of(lattice.regions);
  if (lattice.moments_of_sites.there())
    more += fmt::format("; {} {}",
                        !scene.material             ? "moments"
                        : scene.material->atomistic ? "mu_s in J/T"
                                                    : "Ms in A/m",
                        text_of(lattice.moments_of_sites));
  else if (scene.material && !lattice.moments.empty())
    more += fmt::format("; mu_s {} J/T", numbers_text(scene.material->moments));
  else if (!lattice.moments.empty())
    more += "; moments " + numbers_text(lattice.moments);
  if (!lattice.gyromagnetic.empty()) more += "; gyromagnetic " + numbers_text(lattice.gyromagnetic);
  if (lattice.gyromagnetic_of_sites.there())
    more +=
        fmt::format("; {} {}",
                    scene.material && scene.material->gamma_factors.there() ? "gamma in rad/(s T)"
                                                                            : "gyromagnetic",
                    text_of(lattice.gyromagnetic_of_sites));
  if (lattice.occupied.there()) more += "; occupied where " + text_of(lattice.occupied);
  if (lattice.frozen.there()) more += "; frozen where " + text_of(lattice.frozen);
  if (auto const& follow = lattice.follow)
    more +=
        fmt::format("; follows {} along {}", io::to_string(follow->quantity), "xyz"[follow->axis]);
  return fmt::format("{} = {}{}", cells_text(lattice.shape, cell_sites),
                     counted(io::sites(scene), "site"), more);
}

std::string vectors_text(io::SiteVectors const& vectors) {
  if (!vectors.file.empty()) return vectors.file.string();
  if (!vectors.per_region.empty())
    return fmt::format("[{}] of regions",
                       fmt::join(vectors.per_region | std::views::transform(vector_text), ", "));
  auto const component = [&](std::size_t c) {
    auto const& numbers = vectors.components[c];
    return numbers.there() ? text_of(numbers) : fmt::format("{:.6g}", vectors.uniform[c]);
  };
  return fmt::format("({}, {}, {})", component(0), component(1), component(2));
}

// Returns the term's formula with its parameters inserted. `of_sites`: if set, the term's vector,
// which is then site-dependent.
template <class Term>
std::string term_text(Term const& term, io::SiteVectors const& of_sites = {}) {
  fmt::dynamic_format_arg_store<fmt::format_context> numbers;
  for (auto const& key : Term::keys()) {
    if (auto const* const number = std::get_if<double Term::*>(&key.member))
      numbers.push_back(fmt::format("{:.6g}", term.**number));
    else if (of_sites.there())
      numbers.push_back(vectors_text(of_sites));
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

std::string source_text(io::Scene const& scene, io::Source const& source) {
  auto const& [profile, time] = source;
  return fmt::format(
      "H = {}{}{}{}", scene.field.mu0 == 1 ? "" : fmt::format("{:.6g} ", scene.field.mu0),
      vectors_text(profile), scene.units.si ? " T" : "",
      time == io::AppliedComponent(1.0) ? "" : " times " + factor_text(scene.units, time));
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
  auto const name = atoms ? "mu_s" : "Ms", unit = atoms ? "J/T" : "A/m";
  auto text = material.moment_factors.there()
                  ? fmt::format("{} = {}, in units of {:.7g} {}", name,
                                text_of(material.moment_factors), material.moment, unit)
                  : fmt::format("{} = {:.7g} {}", name, material.moment, unit);
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
  add(material.d2d_dmi, material.dmi_factors, "D2d", atoms ? " J" : " J/m^2");
  add(material.alpha, material.alpha_factors, "alpha", "");
  if (material.alpha > 0 || material.alpha_factors.there())
    text += material.gilbert ? " (Gilbert)" : " (Landau-Lifshitz)";
  add(material.gamma, material.gamma_factors, "gamma", " rad/(s T)");
  return text;
}

std::string factors_text(io::SiteNumbers const& numbers) {
  if (!numbers.there()) return {};
  if (numbers.expression == "1") return fmt::format(", times {:.6g}", numbers.unit);
  return numbers.unit == 1 ? ", times " + text_of(numbers)
                           : fmt::format(", times {:.6g} ({})", numbers.unit, text_of(numbers));
}

std::string of_site_text(int site) {
  return site < 0 ? std::string() : fmt::format(", site {}", site);
}

// Returns a formula's constant in SI, such as " (K = 1e-21 J)", or an empty string for a scene in
// reduced units.
std::string in_si_text(io::Scene const& scene, char const* name, double constant) {
  if (!scene.material) return {};
  auto const& [x, y, z] = scene.lattice.spacing;
  double const length = scene.units.length, volume = length * length * length * x * y * z;
  bool const atoms = scene.material->atomistic;
  return fmt::format(" ({} = {:.6g} {})", name,
                     constant * scene.units.energy / (atoms ? 1 : volume), atoms ? "J" : "J/m^3");
}

std::string second_text(io::Anisotropy const& term) {
  if (term.constant2 == 0) return {};
  return fmt::format(", and H = {:.6g} (m.e)^3 e{}", term.constant2, factors_text(term.factors2));
}

std::string crystal_text(io::Scene const& scene, io::CrystalAnisotropy const& term) {
  auto const axis = [&](std::size_t i) {
    return term.axes_of_sites[i].there() ? vectors_text(term.axes_of_sites[i])
                                         : vector_text(term.axes[i]);
  };
  auto text =
      fmt::format("E = {:.6g} {}", term.constant,
                  term.hexagonal ? "sin(theta)^6 cos(6 phi)" : "(a^2 b^2 + b^2 c^2 + c^2 a^2)");
  text += factors_text(term.factors);
  if (term.constant2 != 0)
    text += fmt::format(", and {:.6g} a^2 b^2 c^2{}", term.constant2, factors_text(term.factors2));
  text += fmt::format(", {} {} and {}", term.hexagonal ? "axis and in plane" : "axes", axis(0),
                      axis(1));
  if (!term.factors.there()) text += in_si_text(scene, term.hexagonal ? "K" : "Kc", term.constant);
  return text + of_site_text(term.site);
}

void add_anisotropies(io::Scene const& scene,
                      std::vector<std::pair<std::string, std::string>>& lines) {
  for (auto const& term : scene.field.anisotropies)
    lines.emplace_back("anisotropy",
                       term_text(term, term.axes) + second_text(term) +
                           (term.factors.there() ? factors_text(term.factors)
                                                 : in_si_text(scene, "K", term.constant / 2)) +
                           of_site_text(term.site));
  for (auto const& term : scene.field.crystal_anisotropies)
    lines.emplace_back("anisotropy", crystal_text(scene, term));
}

std::string couplings_text(io::Scene const& scene, std::vector<Coupling> const& couplings) {
  auto const text = counted(std::ssize(couplings), "bond") + " of a cell";
  if (!scene.material) return text;
  double largest = 0;
  for (auto const& coupling : couplings) {
    for (double const entry : coupling.tensor) largest = std::max(largest, std::abs(entry));
    largest = std::max(largest, std::abs(coupling.biquadratic));
  }
  return fmt::format("{}, up to {:.6g} J", text, largest * scene.units.energy);
}

// Returns the division of a strength by the moment of each site, if there is one.
std::string per_moment_text(io::Scene const& scene, bool per_moment) {
  return per_moment ? fmt::format(" / (Ms / {:.6g} A/m)", scene.material->moment) : "";
}

void add_torques(io::Scene const& scene, std::vector<std::pair<std::string, std::string>>& lines) {
  bool const si = scene.units.si;
  auto const& torque = si ? scene.torque_in_si : scene.field.torque;
  if (auto const& of = torque.zhang_li)
    lines.emplace_back(
        "torque",
        fmt::format("Zhang-Li, u = {}{}{}, xi = {:.6g}", components_text(of->velocity),
                    si ? " m/s" : "", per_moment_text(scene, of->per_moment), of->nonadiabaticity));
  if (auto const& of = torque.slonczewski)
    lines.emplace_back(
        "torque",
        fmt::format("Slonczewski, damping-like {}{}{}, field-like {}{}{}{}, p = {}{}",
                    component_text(of->damping_like), factors_text(of->damping_like_of_sites),
                    per_moment_text(scene, of->damping_like_per_moment),
                    component_text(of->field_like), factors_text(of->field_like_of_sites),
                    per_moment_text(scene, of->field_like_per_moment), si ? " (T)" : "",
                    of->polarizations.there() ? vectors_text(of->polarizations)
                                              : vector_text(of->polarization),
                    of->lambda == 1 ? "" : fmt::format(", Lambda = {:.6g}", of->lambda)));
}

std::string slab_text(io::Field const& field) {
  auto const& slab = *field.slab_demag;
  return fmt::format("H = -{:.6g} (m.n) n, n = {}{}", field.mu0 * slab.strength,
                     vector_text(slab.normal),
                     slab.multirate ? ", multirate: computed on the host once a step"
                     : slab.on_host ? ", computed on the host"
                                    : "");
}

std::string images_text(std::array<int, 3> const& images) {
  std::string infinite, text;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (images[axis] == infinitely_many_images)
      infinite += fmt::format("{}{}", infinite.empty() ? "" : " and ", "xyz"[axis]);
    else if (images[axis] > 0)
      text += ", " + counted(images[axis], "image") + " on each side along " + "xyz"[axis];
  if (!infinite.empty()) text += ", infinitely many images along " + infinite;
  return text;
}

std::string demag_text(io::Scene const& scene) {
  auto const& demag = *scene.field.demag;
  double const strength = scene.field.mu0 * demag.strength;
  auto const [x, y, z] = demag.demagnetizing_factors;
  return fmt::format(
      "{}, {} by FFTs{}{}{}",
      demag.dipoles ? fmt::format("H = {:.6g} sum V (3 r (r.m) - m r^2) / (4 pi r^5)", strength)
                    : fmt::format("H = -{:.6g} N m", strength),
      demag.dipoles ? "of all dipoles," : "of all cells,", images_text(demag.periodic_images),
      x != 0 || y != 0 || z != 0
          ? fmt::format(", demagnetizing factors {:.6g} {:.6g} {:.6g}", x, y, z)
          : "",
      has_slow_field(scene) ? ", multirate: once a step" : "");
}

std::string thermal_text(io::Scene const& scene) {
  auto const& [temperature, in_time, of_sites, seed] = *scene.thermal;
  auto text = fmt::format("{:.6g}", typed_temperature(scene));
  if (scene.units.si) text = fmt::format("{} K ({:.6g})", text, temperature);
  if (of_sites.there()) text += ", times " + text_of(of_sites);
  if (in_time != io::AppliedComponent(1.0)) text += ", times " + factor_text(scene.units, in_time);
  return fmt::format("{}, seed {}", text, seed);
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
      bool const has_normal = std::is_same_v<Term, io::InterfacialDmi>;
      auto const normals = has_normal ? field.dmi_normals : io::SiteVectors();
      if (term) lines.emplace_back(Term::key, term_text(*term, normals) + factors_text(factors));
    });
    if (field.d2d_dmi)
      lines.emplace_back("dmi", term_text(*field.d2d_dmi) + factors_text(field.dmi_factors));
    if (auto const bonds = io::couplings(scene); !bonds.empty())
      lines.emplace_back("couplings", couplings_text(scene, bonds));
    add_anisotropies(scene, lines);
    add_torques(scene, lines);
    for (auto const& [regions, factor] : field.exchange_between)
      lines.emplace_back("exchange", fmt::format("times {:.6g} between regions {} and {}", factor,
                                                 regions[0], regions[1]));
    for (auto const& [regions, bilinear, biquadratic, range] : field.interlayers)
      lines.emplace_back("interlayer",
                         fmt::format("E = {:.6g} m.m' + {:.6g} (m.m')^2, regions {} and {}{}{}",
                                     -bilinear, 0 - biquadratic, regions[0], regions[1],
                                     range > 0 ? ", over " + counted(range, "vacant cell") : "",
                                     field.exchange_at_faces.there() ? ", at the faces" : ""));
    for (auto const& [name, factor] : {std::pair{"exchange", field.in_time.exchange},
                                       {"anisotropy", field.in_time.anisotropy},
                                       {"dmi", field.in_time.dmi}})
      if (factor != io::AppliedComponent(1.0))
        lines.emplace_back("in time", name + (" times " + factor_text(scene.units, factor)));
    if (field.applied) lines.emplace_back("applied", applied_text(scene));
    for (auto const& source : field.sources)
      lines.emplace_back("source", source_text(scene, source));
    if (!field.applied_in_turn.empty()) lines.emplace_back("applied", list_text(scene));
    if (field.slab_demag) lines.emplace_back("slab demag", slab_text(field));
    if (field.demag)
      lines.emplace_back(field.demag->dipoles ? "dipoles" : "demag", demag_text(scene));
  }
  if (scene.thermal) lines.emplace_back("temperature", thermal_text(scene));
  lines.emplace_back("start", describe_start(scene));
  return lines;
}

void warn_of_notes(io::Scene const& scene) {
  for (auto const& note : io::notes(scene)) print_message("warning: {}\n", note);
}

}  // namespace cayspin::program
