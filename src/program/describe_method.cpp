// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "describe.hpp"

#include <fmt/format.h>

namespace cayspin::program {

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
