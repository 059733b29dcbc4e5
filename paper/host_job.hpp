// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "simulation/simulate.hpp"

#include <vector>

namespace cayspin::paper {

using namespace simulation;

using HostSpace = Kokkos::DefaultHostExecutionSpace;
using HostSpins = Simulation<double, HostSpace>::Spins;
using HostObserver = RunObserver<HostSpace, HostSpins>;

/// Runs a chain with spacing 1 like `cayspin run`, but with starts and inverse inertias from memory
/// and without files. Returns the final state. `starts`: one unit vector per site; its components
/// are adjacent. `inverse_inertia`: one tensor per body; ignored for spins. Throws NumbersFailed
/// when the run fails.
HostSpins run_on_host(io::Scene const& scene, std::vector<double> const& starts,
                      std::vector<SymmetricTensor> const& inverse_inertia, HostObserver& observer);

}  // namespace cayspin::paper
