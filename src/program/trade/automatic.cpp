// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "automatic.hpp"

#include "../failure.hpp"
#include "advice.hpp"

#include <fmt/format.h>

#include <cmath>

namespace cayspin::program::trade {

io::Scene with_method(io::Scene scene, std::string const& space, Precision precision) {
  auto& integrator = scene.integrator;
  if (integrator.method != io::Method::automatic) return scene;
  if (integrator.steps == 0) {
    integrator.method = io::Method::rkmk4;  // takes none of them
    return scene;
  }
  Pilot const pilot(scene, space);
  auto const advised = advise(pilot, {*integrator.error, {}, precision});
  if (!advised.choice)
    throw NumbersFailed(fmt::format("{}: no method gets to an error of {:g} in {} precision",
                                    scene.path.string(), *integrator.error, to_string(precision)));
  auto const& choice = *advised.choice;
  integrator.method = choice.candidate.method;
  integrator.generator = choice.candidate.generator;
  integrator.rotation = choice.candidate.rotation;
  integrator.sigma = choice.candidate.sigma;
  if (integrator.sigma != 0) integrator.isotropy = io::Isotropy::constant;
  if (choice.candidate.is_adaptive()) {
    integrator.tolerance = choice.steps.tolerance;
  } else {
    auto const parts = static_cast<std::int64_t>(std::ceil(integrator.dt / choice.dt - 1e-9));
    integrator.dt /= static_cast<double>(parts);
    integrator.steps *= parts;
    scene.output.every *= parts;
    scene.output.scalars_every *= parts;
  }
  return scene;
}

}  // namespace cayspin::program::trade
