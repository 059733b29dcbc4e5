// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"

#include <fmt/format.h>

namespace cayspin::io::detail {
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
  if (is_baseline(integrator.method)) return;
  if (needs_cayley(integrator.method) && integrator.rotation != Rotation::cayley)
    refuse(scene, "integrator.rotation",
           fmt::format("method \"{}\" belongs to Cayley coordinates", method), "\"cayley\"");
  if (integrator.generator == Generator::tangent) return check_tangent(scene);
  check_isotropy(scene);
  if (is_series(integrator.method) && depends_on_time(scene))
    refuse(scene, "integrator.method",
           fmt::format("\"{}\" refuses fields that depend on t", method),
           "a method without derivatives, or numbers in field.applied");
}

}  // namespace cayspin::io::detail
