// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Nanoseconds per spin and step over the number of spins, beside the hand-written loops and the
// memory's speed in the same run. Cases are named PRECISION/METHOD/SIZE; a size is a cube's edge,
// or L2 for a lattice that the second cache holds. There a probe stands beside each method: its
// step written out for this scene alone, on one core.
//   bench_throughput --benchmark_filter='/(32|128)/' --benchmark_out=32_128.json
#include "context.hpp"
#include "hand_written.hpp"
#include "probes.hpp"
#include "scene.hpp"
#include "stream.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace {

template <template <class> class Method, class Real>
void run_hand_written(benchmark::State& state, int n, double words) {
  hand_written::Cube<Real> const cube{
      n, static_cast<Real>(scene::exchange), static_cast<Real>(scene::anisotropy),
      static_cast<Real>(scene::applied), static_cast<Real>(scene::damping)};
  hand_written::Vectors<Real> spins(cube.sites());
  auto const sites = static_cast<std::int64_t>(cube.sites());
  hand_written::fill(spins, random_spins(sites));
  Method<Real> method(cube);
  for (int i = 0; i < 2; ++i) method.step(spins, static_cast<Real>(scene::dt));
  for (auto _ : state) method.step(spins, static_cast<Real>(scene::dt));
  scene::report(state, sites, words, 0);
}

/// How far the spins of a probe are from those of the library's method after a few steps.
template <class Stepper>
double distance(probes::Probe<typename Stepper::spins_type::value_type>& probe) {
  auto const lattice = scene::in_l2();
  auto spins = scene::random<typename Stepper::spins_type>(lattice);
  auto stepper = scene::make_stepper<Stepper>(spins);
  auto const generator = scene::Default::generator(lattice);
  probe.set(random_spins(lattice.sites()));
  for (int step = 0; step < 10; ++step) {
    stepper.step(Kokkos::DefaultExecutionSpace(), generator, spins, 0, scene::dt);
    probe.step(static_cast<typename Stepper::spins_type::value_type>(scene::dt));
  }
  auto const ours = copy_to_host(spins);
  auto const its = probe.get();
  double most = 0;
  for (std::size_t i = 0; i < its.size(); ++i)
    most = std::max(most, std::abs(static_cast<double>(ours[i]) - its[i]));
  return most;
}

template <class Stepper, class Make>
void run_probe(benchmark::State& state, Make const& make, double words) {
  using Real = typename Stepper::spins_type::value_type;
  auto const shape = scene::in_l2().shape;
  auto const probe = make(probes::Scene{static_cast<int>(shape[0]), static_cast<int>(shape[1]),
                                        static_cast<int>(shape[2]), scene::exchange,
                                        scene::anisotropy, scene::applied, scene::damping});
  if (!(distance<Stepper>(*probe) < 200 * std::numeric_limits<Real>::epsilon()))
    return state.SkipWithError("the probe does not take the steps that it stands for");
  for (auto _ : state) probe->step(static_cast<Real>(scene::dt));
  scene::report(state, scene::in_l2().sites(), words, 0);
}

constexpr int edges[] = {5, 10, 16, 24, 32, 48, 64, 96, 128, 192, 256, 292};

template <class Real>
class Register {
  using Spins = cayspin::SpinField<Real>;

 public:
  explicit Register(std::string const& precision) : prefix_(precision + "/") {
    using cayspin::StereographicRungeKutta, cayspin::tableau::Heun, cayspin::tableau::Classical4;
    using Orthogonal = scene::Orthogonal<scene::Default>;
    // Numbers read and written per spin and step where each stage is a pass over memory.
    hand_written<hand_written::Heun>("hand-written Heun", 27);
    hand_written<hand_written::RungeKutta4>("hand-written RK4", 63);
    add_probe<cayspin::LieEuler<Spins>>("Euler", probes::euler<Real>, 6);
    add_probe<cayspin::LieHeun<Spins>>("Heun", probes::heun<Real>, 21);
    add_probe<cayspin::Rkmk4<Spins>>("RKMK4", probes::rkmk4<Real>, 57);
    add_probe<StereographicRungeKutta<Spins, Heun>>("Heun tangent", probes::chart_heun<Real>, 15);
    add_probe<StereographicRungeKutta<Spins, Classical4>>("RKMK4 tangent", probes::chart_rk4<Real>,
                                                          39);
    add_probe<cayspin::ProjectedRk4<Spins>>("RK4 projected", probes::projected_rk4<Real>, 51);
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
  }

 private:
  template <template <class> class Method>
  void hand_written(std::string const& name, double words) const {
    for (int const n : edges)
      scene::add(prefix_ + name + "/" + std::to_string(n),
                 [=](benchmark::State& state) { run_hand_written<Method, Real>(state, n, words); });
  }

  template <class Stepper, class Make>
  void add_probe(std::string const& name, Make make, double words) const {
    scene::add(prefix_ + "probe " + name + "/L2",
               [=](benchmark::State& state) { run_probe<Stepper>(state, make, words); });
  }

  template <class Stepper, class System = scene::Default>
  void add(std::string const& name, double words) const {
    auto const on = [&](cayspin::Lattice const& lattice, std::string const& size) {
      scene::add(prefix_ + name + "/" + size, [=](benchmark::State& state) {
        scene::time_steps<Stepper, System>(state, lattice, words);
      });
    };
    on(scene::in_l2(), "L2");
    for (int const n : edges) on(scene::cube(n), std::to_string(n));
  }

  std::string prefix_;
};

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  stream::Arrays arrays;
  stream::register_copies(arrays);
  Register<double>("f64");
  Register<float>("f32");
  return run_benchmarks(argc, argv);
}
