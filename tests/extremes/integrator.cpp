// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "integrator.hpp"

#include <fmt/format.h>

namespace cayspin::extremes {

std::string Integrator::name() const {
  if (relaxes) return "relax";
  std::string name(method->word);
  if (isotropy != io::Isotropy::zero) name += fmt::format(" {}", io::to_string(isotropy));
  if (generator == io::Generator::tangent) name += " tangent";
  if (compensated) name += " compensated";
  if (of_rigid_bodies) name += " (rigid body)";
  return name;
}

std::string Integrator::variant() const {
  if (relaxes || method->is_baseline() || generator == io::Generator::tangent) return "";
  return fmt::format("{} {}", io::to_string(generator), io::to_string(rotation));
}

namespace {

std::vector<io::Generator> generators_of(Variant const& variant) {
  if (variant.method->is_baseline()) return {io::Generator::standard};
  std::vector<io::Generator> all;
  for (auto const& [name, generator] : io::words<io::Generator>())
    if (variant.method->takes(generator) &&
        (generator == io::Generator::tangent) == variant.in_chart)
      all.push_back(generator);
  return all;
}

std::vector<io::Rotation> rotations_of(Variant const& variant) {
  if (variant.method->is_baseline()) return {io::Rotation::cayley};
  std::vector<io::Rotation> all;
  for (auto const& [name, rotation] : io::words<io::Rotation>())
    if (variant.rotations.contains(rotation)) all.push_back(rotation);
  return all;
}

std::vector<Integrator> integrators(bool adaptive) {
  std::vector<Integrator> all;
  for (auto const& variant : variants()) {
    if (variant.method->adaptive != adaptive) continue;
    for (auto const generator : generators_of(variant))
      for (auto const rotation : rotations_of(variant))
        all.push_back({{.method = variant.method,
                        .generator = generator,
                        .isotropy = variant.isotropy,
                        .rotation = rotation,
                        .compensated = variant.compensated},
                       variant.of_rigid_bodies});
  }
  return all;
}

}  // namespace

std::vector<Integrator> with_equal_steps() { return integrators(false); }
std::vector<Integrator> with_adaptive_steps() { return integrators(true); }

Integrator relaxation() {
  auto some = with_equal_steps().front();
  some.relaxes = true;
  return some;
}

}  // namespace cayspin::extremes
