// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "dear_method.hpp"
#include "guard.hpp"
#include "plan.hpp"
#include "simulate.hpp"
#include "variant.hpp"

#include <cayspin/exchange_memory.hpp>

namespace cayspin::simulation {

/// Does a run of this plan need more than its spins to go on with the same bits?
inline bool remembers(io::Scene const& scene, Plan const& plan) {
  return plan.variant.remembers || scene.integrator.energy_control ||
         scene.integrator.until_torque.has_value() || has_dear_field(scene);
}

/// Stores or restores all that a run needs to go on from a step with the same bits. `continues`:
/// does the method go on with what it remembers? `control`: null where there is none.
template <class Real, class Space, class Control>
void exchange_state(Checkpoint& checkpoint, Simulation<Real, Space>& simulation, OpenMethod& method,
                    bool& continues, Guard& guard, Control* control) {
  simulation.exec.fence("cayspin::exchange_state");
  cayspin::detail::ExchangeMemory const visit(checkpoint);
  visit("spins", simulation.spins);
  visit("continues", continues);
  method.exchange_memory(checkpoint);
  exchange_memory(guard, checkpoint, "guard.");
  if (control) exchange_memory(*control, checkpoint, "energy_control.");
}

}  // namespace cayspin::simulation
