// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"

#include <fmt/args.h>
#include <fmt/format.h>

namespace cayspin::program {
namespace {

std::string vector_text(io::Triple const& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v[0], v[1], v[2]);
}

std::string system_text(io::Scene const& scene) {
  auto const& system = scene.system;
  if (system.kind == io::SystemKind::llg)
    return fmt::format("spins, Landau-Lifshitz with damping {:.6g}{}", system.damping,
                       system.precession ? "" : ", overdamped (no precession)");
  auto const count = io::sites(scene);
  auto const who = count == 1 ? "a free rigid body" : fmt::format("{} free rigid bodies", count);
  if (auto const* moments = std::get_if<io::PrincipalMoments>(&system.inertia))
    return fmt::format("{} of principal moments {}", who, vector_text(*moments));
  if (auto const* file = std::get_if<io::InertiaFile>(&system.inertia))
    return fmt::format("{}, inertia tensors from {}", who, file->path.string());
  return who + " of one inertia tensor";
}

std::string lattice_text(io::Scene const& scene) {
  auto const& [shape, spacing, boundary] = scene.lattice;
  std::string edges;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (shape[axis] > 1)
      edges += fmt::format("; {}: spacing {:.6g}, {}", "xyz"[axis], spacing[axis],
                           io::to_string(boundary[axis]));
  return fmt::format("{} x {} x {} = {} sites{}", shape[0], shape[1], shape[2], io::sites(scene),
                     edges);
}

// The term's formula with its parameters in it.
template <class Term>
std::string term_text(Term const& term) {
  fmt::dynamic_format_arg_store<fmt::format_context> numbers;
  for (auto const& [name, member] : Term::parameters) {
    if (auto const* const number = std::get_if<double Term::*>(&member))
      numbers.push_back(fmt::format("{:.6g}", term.**number));
    else
      numbers.push_back(vector_text(term.*std::get<io::Triple Term::*>(member)));
  }
  return fmt::vformat(Term::formula, numbers);
}

std::string applied_text(io::Field const& field) {
  std::string text;
  for (auto const& component : *field.applied) {
    if (!text.empty()) text += ", ";
    text += std::holds_alternative<double>(component)
                ? fmt::format("{:.6g}", std::get<double>(component))
                : std::get<std::string>(component);
  }
  return fmt::format("H = {}({})", field.mu0 == 1 ? "" : fmt::format("{:.6g} ", field.mu0), text);
}

std::string slab_text(io::Field const& field) {
  auto const& slab = *field.slab_demag;
  return fmt::format("H = -{:.6g} {} n, n = {}, {}{}", field.mu0 * slab.strength,
                     slab.average_layer ? "<m.n>" : "(m.n)", vector_text(slab.normal),
                     slab.average_layer ? "averaged over each layer" : "site by site",
                     slab.on_host ? ", computed on the host" : "");
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

std::vector<std::pair<std::string, std::string>> describe(io::Scene const& scene) {
  std::vector<std::pair<std::string, std::string>> lines{{"scene", scene.path.string()},
                                                         {"system", system_text(scene)}};
  if (scene.system.kind == io::SystemKind::llg) {
    auto const& field = scene.field;
    lines.emplace_back("lattice", lattice_text(scene));
    io::for_each_lattice_term(field, [&]<class Term>(std::optional<Term> const& term) {
      if (term) lines.emplace_back(Term::key, term_text(*term));
    });
    for (auto const& term : field.anisotropies) lines.emplace_back("anisotropy", term_text(term));
    if (field.applied) lines.emplace_back("applied", applied_text(field));
    if (field.slab_demag) lines.emplace_back("slab demag", slab_text(field));
  }
  lines.emplace_back("start", initial_text(scene.initial));
  return lines;
}

std::string describe_method(io::Integrator const& integrator) {
  std::string text(integrator.method->word);
  if (integrator.method->is_baseline()) return text;
  text += fmt::format(", {} generator, {} rotation", io::to_string(integrator.generator),
                      io::to_string(integrator.rotation));
  if (integrator.isotropy == io::Isotropy::constant)
    text += fmt::format(", sigma = {:.6g}", integrator.sigma);
  else if (integrator.isotropy != io::Isotropy::zero)
    text += fmt::format(", sigma by {}", io::to_string(integrator.isotropy));
  return text;
}

}  // namespace cayspin::program
