// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "host_job.hpp"

#include "../denormals.hpp"
#include "../plan.hpp"

namespace cayspin::program::reproduction {

HostSpins run_on_host(io::Scene const& scene, std::vector<double> const& starts,
                      std::vector<SymmetricTensor> const& inverse_inertia, HostObserver& observer) {
  auto const plan = make_plan(scene, Precision::double_precision);
  HostSpins const spins("spins", plan.lattice);
  copy_from_host(starts, spins);
  using Job = Simulation<double, HostSpace>;
  Job job{HostSpace(), spins, SceneGenerator<HostSpins>(scene, plan.lattice, inverse_inertia),
          plan.times, &observer};
  FlushDenormals const while_stepping;
  plan.method.advance(&job, plan.options);
  return job.spins;
}

}  // namespace cayspin::program::reproduction
