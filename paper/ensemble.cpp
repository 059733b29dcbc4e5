// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "ensemble.hpp"

#include <algorithm>
#include <cmath>

namespace cayspin::paper {
namespace {

class WatchEnergies : public HostObserver {
 public:
  explicit WatchEnergies(std::vector<Body> const& bodies)
      : bodies_(bodies),
        first_(bodies.size()),
        run_{std::vector(bodies.size(), 0.0), std::vector<Vector>(bodies.size())} {
    for (std::size_t i = 0; i < bodies.size(); ++i) first_[i] = bodies[i].energy(bodies[i].start);
  }

  bool due(Step const&) const override { return true; }

  Next operator()(HostSpace const&, Step const& step, HostSpins const& spins) override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      auto const m = spins.get(static_cast<std::int64_t>(i));
      auto& error = run_.energy_errors[i];
      error = std::max(error, std::abs(bodies_[i].energy(m) - first_[i]));
      if (step.last) run_.ends[i] = m;
    }
    return Next::proceed;
  }

  EnsembleRun const& run() const { return run_; }

 private:
  std::vector<Body> const& bodies_;
  std::vector<double> first_;
  EnsembleRun run_;
};

}  // namespace

io::Integrator integrator_of(MethodChoice const& choice, double dt, double end) {
  io::Integrator integrator;
  choice.put_into(integrator);
  integrator.dt = dt;
  integrator.steps = std::llround(end / dt);
  return integrator;
}

void run_bodies(std::vector<Body> const& bodies, MethodChoice const& choice, double dt, double end,
                HostObserver& observer) {
  io::Scene scene;
  scene.system.kind = io::SystemKind::rigid_body;
  scene.lattice.shape = {static_cast<std::int64_t>(bodies.size()), 1, 1};
  scene.integrator = integrator_of(choice, dt, end);
  std::vector<SymmetricTensor> tensors;
  std::vector<double> starts;
  for (auto const& [moments, axes, start, b] : bodies) {
    tensors.push_back({b.xx, b.yy, b.zz, b.xy, b.xz, b.yz});
    starts.insert(starts.end(), {start.x, start.y, start.z});
  }
  run_on_host(scene, starts, tensors, observer);
}

EnsembleRun run_ensemble(std::vector<Body> const& bodies, MethodChoice const& choice, double dt,
                         double end) {
  WatchEnergies watch(bodies);
  run_bodies(bodies, choice, dt, end, watch);
  return watch.run();
}

}  // namespace cayspin::paper
