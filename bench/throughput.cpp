// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Nanoseconds per spin and step over the number of spins, beside the hand-written loops and the
// memory's speed in the same run. Cases are named PRECISION/METHOD/SIZE; a size is a cube's edge,
// or L2 for a lattice that the second cache holds.
//   bench_throughput --benchmark_filter='/(32|128)/' --benchmark_out=32_128.json
#include "context.hpp"
#include "hand_written.hpp"
#include "scene.hpp"
#include "stream.hpp"

#include <string>
#include <utility>

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
