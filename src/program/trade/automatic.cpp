// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "automatic.hpp"

#include "../failure.hpp"
#include "resolved.hpp"

#include <fmt/format.h>

namespace cayspin::program::trade {

io::Scene with_method(io::Scene const& scene, std::string const& space, Precision precision) {
  auto const& integrator = scene.integrator;
  if (integrator.method != io::Method::automatic) return scene;
  Advised advised;
  if (integrator.steps == 0)
    advised.choice = {{io::Method::rkmk4}, {}, integrator.dt};  // takes none of them
  else
    advised = advise(Pilot(scene, space), {*integrator.error, {}, precision});
  if (!advised.choice)
    throw NumbersFailed(fmt::format("{}: no method gets to an error of {:g} in {} precision",
                                    scene.path.string(), *integrator.error, to_string(precision)));
  return io::with_overrides(scene, resolve(scene, *advised.choice).overrides);
}

}  // namespace cayspin::program::trade
