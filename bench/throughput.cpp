// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Nanoseconds per spin and step for many numbers of spins, next to the hand-written loops and the
// memory's speed in the same run. Cases are named PRECISION/METHOD/SIZE; a size is a cube's edge,
// or L2 for a lattice that fits the second-level cache. For that lattice most methods also have a
// probe: the same step, written out for this scene only.
//   bench_throughput --benchmark_filter='/(32|128)/' --benchmark_out=32_128.json
#include "hand_written.hpp"
#include "main.hpp"
#include "probes.hpp"
#include "scene.hpp"
#include "stream.hpp"

#include <cayspin/stepper/paired_stages.hpp>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace {

template <class Real>
using Cube = hand_written::Cube<Real>;

template <class Real, class Method>
void run_hand_written(benchmark::State& state, Method method, int n, double words) {
  Cube<Real> const cube{n, static_cast<Real>(scene::exchange), static_cast<Real>(scene::anisotropy),
                        static_cast<Real>(scene::applied), static_cast<Real>(scene::damping)};
  hand_written::Vectors<Real> spins(cube.sites());
  auto const sites = static_cast<std::int64_t>(cube.sites());
  hand_written::fill(spins, random_spins(sites));
  hand_written::Steps<Cube<Real>> steps(cube);
  auto const dt = static_cast<Real>(scene::dt);
  (steps.*method)(spins, dt, 2);
  for (auto _ : state) (steps.*method)(spins, dt, 1);
  scene::report(state, sites, words, 0);
}

template <class Stepper, class Method>
void run_probe(benchmark::State& state, Method method, double words) {
  using Real = typename Stepper::spins_type::value_type;
  constexpr int few = 10;
  auto const dt = static_cast<Real>(scene::dt);
  auto const lattice = scene::in_l2();
  auto const& shape = lattice.shape;
  probes::Probe<Real> probe({static_cast<int>(shape[0]), static_cast<int>(shape[1]),
                             static_cast<int>(shape[2]), scene::exchange, scene::anisotropy,
                             scene::applied, scene::damping});
  probe.set(random_spins(lattice.sites()));
  for (int step = 0; step < few; ++step) (probe.*method)(dt);
  if (!(scene::distance_to<Stepper>(probe.get(), lattice, few, scene::dt) <
        200 * std::numeric_limits<Real>::epsilon()))
    return state.SkipWithError("the probe does not take the steps that it stands for");
  for (auto _ : state) (probe.*method)(dt);
  scene::report(state, lattice.sites(), words, 0);
}

// Steps of one stage in pairs, of which integrate() would take batches.
template <class Stepper>
void run_two_steps(benchmark::State& state, cayspin::Lattice const& lattice) {
  auto spins = scene::random<typename Stepper::spins_type>(lattice);
  auto const generator = scene::Default::generator(lattice);
  Stepper stepper(spins);
  Kokkos::DefaultExecutionSpace const exec;
  auto const take = [&] {
    stepper.batch(exec, generator, spins, 0, scene::dt, 2);
    exec.fence();
  };
  take();
  for (auto _ : state) take();
  scene::report(state, 2 * lattice.sites(), 3, scene::work_bytes(stepper));
}

constexpr int edges[] = {5, 10, 16, 24, 32, 48, 64, 96, 128, 192, 256, 292};

template <class Real>
class Register {
  using Spins = cayspin::SpinField<Real>;
  using Loop = hand_written::Steps<Cube<Real>>;
  using Probe = probes::Probe<Real>;

 public:
  explicit Register(std::string const& precision) : prefix_(precision + "/") {
    using cayspin::StereographicRungeKutta, cayspin::tableau::Heun, cayspin::tableau::Classical4;
    using Orthogonal = scene::Orthogonal<scene::Default>;
    // The last argument: values read and written per spin and step if each stage is a pass over
    // memory.
    hand_written("hand-written Heun", &Loop::heun, 27);
    hand_written("hand-written RK4", &Loop::runge_kutta4, 63);
    add_probe<cayspin::LieEuler<Spins>>("Euler", &Probe::euler, 6);
    add_probe<cayspin::LieHeun<Spins>>("Heun", &Probe::heun, 21);
    add_probe<cayspin::Rkmk4<Spins>>("RKMK4", &Probe::rkmk4, 57);
    add_probe<StereographicRungeKutta<Spins, Heun>>("Heun tangent", &Probe::chart_heun, 15);
    add_probe<StereographicRungeKutta<Spins, Classical4>>("RKMK4 tangent", &Probe::chart_rk4, 39);
    add_probe<cayspin::ProjectedRk4<Spins>>("RK4 projected", &Probe::projected_rk4, 51);
    add<cayspin::LieEuler<Spins>>("Euler", 6);
    add<cayspin::LieHeun<Spins>>("Heun", 21);
    add<cayspin::Rkmk4<Spins>>("RKMK4", 57);
    add<cayspin::LieEuler<Spins>, Orthogonal>("Euler orthogonal", 6);
    add<cayspin::LieHeun<Spins>, Orthogonal>("Heun orthogonal", 21);
    add<cayspin::Rkmk4<Spins>, Orthogonal>("RKMK4 orthogonal", 57);
    add<StereographicRungeKutta<Spins, Heun>>("Heun tangent", 15);
    add<StereographicRungeKutta<Spins, Classical4>>("RKMK4 tangent", 39);
    add<cayspin::ProjectedHeun<Spins>>("Heun projected", 21);
    add<cayspin::ProjectedRk4<Spins>>("RK4 projected", 51);
    if constexpr (!cayspin::detail::is_host_execution<Kokkos::DefaultExecutionSpace>) {
      using cayspin::PairedStages;
      for (int const n : {64, 128, 256})
        scene::add(prefix_ + "Euler in pairs/" + std::to_string(n), [n](benchmark::State& state) {
          run_two_steps<PairedStages<cayspin::LieEuler<Spins>>>(state, scene::cube(n).lattice);
        });
      add<PairedStages<cayspin::LieHeun<Spins>>>("Heun in pairs", 6);
      add<PairedStages<cayspin::Rkmk4<Spins>>>("RKMK4 in pairs", 27);
      add<PairedStages<StereographicRungeKutta<Spins, Heun>>>("Heun tangent in pairs", 6);
      add<PairedStages<StereographicRungeKutta<Spins, Classical4>>>("RKMK4 tangent in pairs", 21);
    }
  }

 private:
  template <class Method>
  void hand_written(std::string const& name, Method method, double words) const {
    for (int const n : edges)
      scene::add(prefix_ + name + "/" + std::to_string(n),
                 [=](benchmark::State& state) { run_hand_written<Real>(state, method, n, words); });
  }

  template <class Stepper, class Method>
  void add_probe(std::string const& name, Method method, double words) const {
    scene::add(prefix_ + "probe " + name + "/L2",
               [=](benchmark::State& state) { run_probe<Stepper>(state, method, words); });
  }

  template <class Stepper, class System = scene::Default>
  void add(std::string const& name, double words) const {
    std::vector<scene::Size> sizes{{scene::in_l2(), "L2"}};
    for (int const n : edges) sizes.push_back(scene::cube(n));
    scene::add(prefix_ + name, sizes,
               [=](benchmark::State& state, cayspin::Lattice const& lattice) {
                 scene::time_steps<Stepper, System>(state, lattice, words);
               });
  }

  std::string prefix_;
};

}  // namespace

void register_benchmarks() {
  stream::register_copies();
  Register<double>("f64");
  Register<float>("f32");
}
