// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "host_job.hpp"

#include "simulation/variant.hpp"

namespace cayspin::paper {

HostSpins run_on_host(io::Scene const& scene, std::vector<double> const& starts,
                      std::vector<SymmetricTensor> const& inverse_inertia, HostObserver& observer) {
  auto const lattice = Lattice::chain(scene.lattice.shape[0]);
  auto const& integrator = scene.integrator;
  Simulation<double, HostSpace> simulation(
      lattice, Times{0, integrator.dt, integrator.steps}, starts,
      SceneGenerator<HostSpins>(scene, lattice, inverse_inertia));
  // Opens the method without planning the run: the search for the stable dt would take longer than
  // the run itself.
  auto const method = find_variant(scene).open(
      &simulation, {integrator.rotation, integrator.sigma, integrator.isotropy_cap, {}});
  auto const ending = simulation.advance(*method, observer);
  if (ending.failure) throw NumbersFailed(*ending.failure);
  return simulation.spins;
}

}  // namespace cayspin::paper
