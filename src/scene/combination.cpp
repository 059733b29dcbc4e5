// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace cayspin::inline v0_2::io {
namespace {

using detail::refuse;

std::string accepted_isotropies(Integrator const& integrator, SystemKind kind) {
  std::string list;
  for (auto const& word : words<Isotropy>()) {
    if (!integrator.method->takes(word.value, kind)) continue;
    if (!list.empty()) list += ", ";
    list += word.value == Isotropy::constant ? std::string("{ constant = sigma }")
                                             : fmt::format("\"{}\"", word.name);
  }
  return list;
}

void check_energy_control(Scene const& scene) {
  auto const& [system, integrator] = std::tie(scene.system, scene.integrator);
  constexpr std::string_view key = "integrator.energy_control";
  if (!integrator.energy_control) return;
  if (system.kind == SystemKind::llg && (system.damping != 0 || !system.precession))
    refuse(scene, key, "needs a system that conserves its energy",
           "damping = 0 with precession, or no such key");
  if (!integrator.method->has_equal_steps())
    refuse(scene, key,
           fmt::format("method \"{}\" chooses its steps and continues from its own copy of the "
                       "spins, so it would ignore what energy_control changes",
                       integrator.method->word),
           "a method with steps of dt, or no such key");
}

std::string compensated_methods() {
  std::vector<std::string_view> list;
  for (auto const* const method : methods())
    if (method->compensated) list.push_back(method->word);
  return fmt::format("\"{}\"", fmt::join(list, "\", \""));
}

void check_compensation(Scene const& scene) {
  auto const& integrator = scene.integrator;
  if (!integrator.compensated) return;
  if (!integrator.method->compensated)
    refuse(scene, "integrator.compensated",
           fmt::format("does not go with method \"{}\"", integrator.method->word),
           compensated_methods());
  if (integrator.isotropy == Isotropy::energy)
    refuse(scene, "integrator.isotropy", "\"energy\" does not go with compensated",
           "\"zero\", { constant = sigma }");
  if (integrator.rotation != Rotation::cayley)
    refuse(scene, "integrator.rotation", "compensated belongs to Cayley coordinates", "\"cayley\"");
}

void check_isotropy(Scene const& scene) {
  auto const& [system, integrator] = std::tie(scene.system, scene.integrator);
  constexpr std::string_view key = "integrator.isotropy";
  bool const is_energy = integrator.isotropy == Isotropy::energy;
  if (is_energy && system.kind != SystemKind::rigid_body)
    refuse(scene, key, "\"energy\" corrects only steps of kind = \"rigid_body\"",
           accepted_isotropies(integrator, system.kind));
  if (!integrator.method->takes(integrator.isotropy, system.kind))
    refuse(scene, key,
           fmt::format("\"{}\" does not go with method \"{}\" and kind = \"{}\"",
                       to_string(integrator.isotropy), integrator.method->word,
                       to_string(system.kind)),
           accepted_isotropies(integrator, system.kind));
  if (is_energy && integrator.rotation != Rotation::cayley)
    refuse(scene, "integrator.rotation", "isotropy \"energy\" belongs to Cayley coordinates",
           "\"cayley\"");
}

// Checks the requirements of methods that move one colour of a checkerboard at a time: a lattice of
// spins, the default generator, and an even number of cells, or one, along periodic axes.
void check_two_colours(Scene const& scene) {
  constexpr std::string_view key = "integrator.method";
  auto const method = scene.integrator.method->word;
  if (scene.system.kind != SystemKind::llg)
    refuse(scene, key, fmt::format("\"{}\" moves spins of a lattice", method),
           "another method, or kind = \"llg\"");
  if (scene.integrator.generator != Generator::standard)
    refuse(scene, "integrator.generator",
           fmt::format("method \"{}\" moves each spin exactly: it has no other generator", method),
           "\"default\"");
  for (int axis = 0; axis < 3; ++axis) {
    auto const extent = scene.lattice.shape[axis];
    if (scene.lattice.boundary[axis] == BoundaryKind::periodic && extent > 1 && extent % 2 != 0)
      refuse(scene, "lattice.shape",
             fmt::format("method \"{}\" colours the lattice like a checkerboard, which does not "
                         "close on itself over the {} sites along the periodic axis {}",
                         method, extent, "xyz"[axis]),
             "an even extent, an open boundary, or another method");
  }
}

void check_tangent(Scene const& scene) {
  auto const& integrator = scene.integrator;
  if (!integrator.method->takes(Generator::tangent))
    refuse(scene, "integrator.generator",
           fmt::format("\"tangent\" does not go with method \"{}\"", integrator.method->word),
           "\"default\", \"orthogonal\"");
  if (integrator.isotropy != Isotropy::zero)
    refuse(scene, "integrator.isotropy", "generator \"tangent\" has no isotropy of its own",
           "\"zero\"");
  if (integrator.rotation != Rotation::cayley)
    refuse(scene, "integrator.rotation", "generator \"tangent\" belongs to Cayley coordinates",
           "\"cayley\"");
}

// Checks the keys of [integrator] against each other, and against the system, the temperature and
// the lattice. Also refuses field.applied beside a program's own uniform field.
void check_integrator(Scene const& scene) {
  if (scene.field.own.uniform && scene.field.applied)
    refuse(scene, "field.applied", "the program has a uniform field of its own", "no such key");
  auto const& integrator = scene.integrator;
  auto const& method = *integrator.method;
  check_energy_control(scene);
  check_compensation(scene);
  detail::check_thermal(scene);
  if (method.automatic && integrator.substeps > 1)
    refuse(scene, "integrator.substeps", "method \"auto\" chooses the substeps", "no such key");
  if (method.is_baseline() || method.automatic) return;
  if (!method.takes(integrator.rotation)) {
    bool const exponential = method.usual_rotation() == Rotation::exponential;
    refuse(scene, "integrator.rotation",
           fmt::format(
               "method \"{}\" {}", method.word,
               exponential ? "is made of exact exponentials" : "belongs to Cayley coordinates"),
           exponential ? "\"exponential\"" : "\"cayley\"");
  }
  if (method.by_colour) check_two_colours(scene);
  if (integrator.generator == Generator::tangent) return check_tangent(scene);
  check_isotropy(scene);
}

}  // namespace

void check_combination(Scene const& scene) {
  check_integrator(scene);
  detail::check_pairs(scene);
}

}  // namespace cayspin::inline v0_2::io
