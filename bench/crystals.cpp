// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Nanoseconds per spin and step of Heun's method on bcc with 8 and 14 neighbours, beside the
// hand-written loop for that crystal in the same run. Cases are named PRECISION/METHOD/SIZE; a size
// is the edge of a cube of cells, each of two spins.
//   bench_crystals --benchmark_filter=/64
#include "context.hpp"
#include "hand_written_crystal.hpp"
#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace {

constexpr double first_shell = 1, second_shell = 0.3, damping = 0.1;
constexpr int edges[] = {16, 32, 64, 96};

cayspin::Lattice bcc(int n) {
  constexpr auto periodic = cayspin::Boundary::periodic;
  return cayspin::Crystal::bcc().lattice({n, n, n}, {periodic, periodic, periodic});
}

template <bool SecondShell>
struct System {
  static auto generator(cayspin::Lattice const& lattice) {
    std::vector<double> const shells{first_shell, second_shell};
    return cayspin::LandauLifshitz(
        cayspin::EffectiveField(
            cayspin::PairCouplings(lattice, cayspin::couplings_of_shells(
                                                cayspin::Crystal::bcc(),
                                                {shells.begin(), shells.end() - !SecondShell})),
            cayspin::Zeeman{{0, 0, scene::applied}}),
        damping);
  }
};

template <class Real, bool SecondShell>
class HandWritten {
 public:
  explicit HandWritten(int n)
      : spins_(2 * static_cast<std::size_t>(n) * n * n),
        method_({n, Real(first_shell), Real(SecondShell ? second_shell : 0), Real(scene::applied),
                 Real(damping)}) {
    hand_written::fill(spins_, random_spins(2 * std::int64_t(n) * n * n));
  }
  void step(double dt) { method_.step(spins_, static_cast<Real>(dt)); }
  hand_written::Vectors<Real> const& spins() const { return spins_; }

 private:
  hand_written::Vectors<Real> spins_;
  hand_written::HeunOnBcc<Real, SecondShell> method_;
};

/// How far the loop's spins are from the library's after a time. Both methods have order 2.
template <class Real, bool SecondShell>
double distance() {
  constexpr int n = 8;
  constexpr double dt = 1e-5;
  HandWritten<Real, SecondShell> loop(n);
  auto const lattice = bcc(n);
  auto spins = scene::random<cayspin::SpinField<Real>>(lattice);
  cayspin::LieHeun<cayspin::SpinField<Real>> stepper(spins);
  auto const generator = System<SecondShell>::generator(lattice);
  for (int i = 0; i < 20; ++i) {
    loop.step(dt);
    stepper.step(Kokkos::DefaultExecutionSpace(), generator, spins, 0, dt);
  }
  auto const ours = copy_to_host(spins);
  double most = 0;
  for (std::size_t i = 0; i < ours.size() / 3; ++i)
    most = std::max({most, std::abs(double(ours[3 * i]) - loop.spins().x.data[i]),
                     std::abs(double(ours[3 * i + 1]) - loop.spins().y.data[i]),
                     std::abs(double(ours[3 * i + 2]) - loop.spins().z.data[i])});
  return most;
}

template <class Real, bool SecondShell>
void add(std::string const& prefix) {
  for (int const n : edges) {
    auto const size = "/" + std::to_string(n);
    scene::add(prefix + "hand-written" + size, [n](benchmark::State& state) {
      if (!(distance<Real, SecondShell>() < 1e-9 + 100 * std::numeric_limits<Real>::epsilon()))
        return state.SkipWithError("the loop and the library take different steps");
      HandWritten<Real, SecondShell> loop(n);
      for (auto _ : state) loop.step(scene::dt);
      scene::report(state, 2 * std::int64_t(n) * n * n, 27, 0);
    });
    scene::add(prefix + "Heun" + size, [n](benchmark::State& state) {
      scene::time_steps<cayspin::LieHeun<cayspin::SpinField<Real>>, System<SecondShell>>(
          state, bcc(n), 21);
    });
  }
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  add<double, false>("f64/8 neighbours/");
  add<double, true>("f64/14 neighbours/");
  add<float, false>("f32/8 neighbours/");
  add<float, true>("f32/14 neighbours/");
  return run_benchmarks(argc, argv);
}
