// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "host_job.hpp"

#include "../denormals.hpp"
#include "../method.hpp"

namespace cayspin::program::reproduction {

HostSpins run_on_host(io::Scene const& scene, std::vector<double> const& starts,
                      std::vector<SymmetricTensor> const& inverse_inertia, HostObserver& observer) {
  auto const lattice = Lattice::chain(scene.lattice.shape[0]);
  auto const& integrator = scene.integrator;
  HostSpins const spins("spins", lattice);
  copy_from_host(starts, spins);
  Simulation<double, HostSpace> job{HostSpace(), spins,
                                    SceneGenerator<HostSpins>(scene, lattice, inverse_inertia),
                                    Times{0, integrator.dt, integrator.steps}, &observer};
  // No plan of the run is made: its search for the stable dt would take longer than the run.
  FlushDenormals const while_stepping;
  find_method(scene).advance(&job,
                             {integrator.rotation, integrator.sigma, integrator.isotropy_cap, {}});
  return job.spins;
}

}  // namespace cayspin::program::reproduction
