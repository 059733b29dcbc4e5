// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"

#include <fmt/format.h>

namespace cayspin::io {
namespace {

[[noreturn]] void refuse(Scene const& scene, std::string_view key, std::string_view wrong,
                         std::string_view accepted) {
  throw scene_error(scene, key, fmt::format("{}; accepted: {}", wrong, accepted));
}

std::string accepted_isotropies(Integrator const& integrator, SystemKind kind) {
  std::string list;
  for (auto const& word : words<Isotropy>()) {
    if (!takes_isotropy(integrator.method, word.value, kind)) continue;
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
  if (depends_on_time(scene)) refuse(scene, key, "needs a field without t", "no such key");
  if (is_adaptive(integrator.method) || integrator.method == Method::automatic)
    refuse(scene, key,
           fmt::format("method \"{}\" does not step from the spins that it changes",
                       to_string(integrator.method)),
           "a method with steps of dt, or no such key");
}

std::string compensated_methods() {
  std::string list;
  for (auto const& word : words<Method>())
    if (takes_compensation(word.value))
      list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", word.name);
  return list;
}

void check_compensation(Scene const& scene) {
  auto const& integrator = scene.integrator;
  if (!integrator.compensated) return;
  if (!takes_compensation(integrator.method))
    refuse(scene, "integrator.compensated",
           fmt::format("does not go with method \"{}\"", to_string(integrator.method)),
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
  if (!takes_isotropy(integrator.method, integrator.isotropy, system.kind))
    refuse(scene, key,
           fmt::format("\"{}\" does not go with method \"{}\" and kind = \"{}\"",
                       to_string(integrator.isotropy), to_string(integrator.method),
                       to_string(system.kind)),
           accepted_isotropies(integrator, system.kind));
  if (integrator.isotropy != Isotropy::energy) return;
  if (integrator.rotation != Rotation::cayley)
    refuse(scene, "integrator.rotation", "isotropy \"energy\" belongs to Cayley coordinates",
           "\"cayley\"");
  if (system.kind == SystemKind::rigid_body) return;
  if (system.damping != 0 || !system.precession)
    refuse(scene, key, "\"energy\" needs a system that conserves its energy",
           "damping = 0 with precession, or another isotropy");
  if (depends_on_time(scene))
    refuse(scene, key, "\"energy\" needs a field without t", "another isotropy");
}

// Colours of a checkerboard that closes on itself, and spins that see their neighbours alone.
void check_red_black(Scene const& scene) {
  constexpr std::string_view key = "integrator.method";
  auto const method = to_string(scene.integrator.method);
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
                         "close on itself over the {} sites of the periodic {}",
                         method, extent, "xyz"[axis]),
             "an even extent, an open boundary, or another method");
  }
  if (auto const& slab = scene.field.slab_demag; slab && (slab->average_layer || slab->on_host))
    refuse(scene, "field.slab_demag",
           fmt::format("method \"{}\" needs a field of the neighbours alone", method),
           "neither average nor where, or another method");
}

void check_tangent(Scene const& scene) {
  auto const& integrator = scene.integrator;
  if (!takes_tangent(integrator.method))
    refuse(scene, "integrator.generator",
           fmt::format("\"tangent\" does not go with method \"{}\"", to_string(integrator.method)),
           "\"default\", \"orthogonal\"");
  if (integrator.isotropy != Isotropy::zero)
    refuse(scene, "integrator.isotropy", "generator \"tangent\" has no isotropy of its own",
           "\"zero\"");
  if (integrator.rotation != Rotation::cayley)
    refuse(scene, "integrator.rotation", "generator \"tangent\" belongs to Cayley coordinates",
           "\"cayley\"");
}

}  // namespace

void check_combination(Scene const& scene) {
  auto const& integrator = scene.integrator;
  auto const method = to_string(integrator.method);
  check_energy_control(scene);
  check_compensation(scene);
  if (is_baseline(integrator.method) || integrator.method == Method::automatic) return;
  if (needs_exponential(integrator.method) && integrator.rotation != Rotation::exponential)
    refuse(scene, "integrator.rotation",
           fmt::format("method \"{}\" is made of exact exponentials", method), "\"exponential\"");
  if (needs_cayley(integrator.method) && integrator.rotation != Rotation::cayley)
    refuse(scene, "integrator.rotation",
           fmt::format("method \"{}\" belongs to Cayley coordinates", method), "\"cayley\"");
  if (is_red_black(integrator.method)) check_red_black(scene);
  if (integrator.generator == Generator::tangent) return check_tangent(scene);
  check_isotropy(scene);
  if (is_series(integrator.method) && depends_on_time(scene))
    refuse(scene, "integrator.method",
           fmt::format("\"{}\" refuses fields that depend on t", method),
           "a method without derivatives, or numbers in field.applied");
}

}  // namespace cayspin::io
