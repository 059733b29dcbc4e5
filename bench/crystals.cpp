// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Nanoseconds per spin and step of Heun's method on bcc with 8 and 14 neighbours, next to the
// hand-written loop for that crystal in the same run. Cases are named
// PRECISION/NEIGHBOURS/METHOD/SIZE; a size is the edge of a cube of cells, each of two spins.
//   bench_crystals --benchmark_filter=/64
#include "hand_written.hpp"
#include "main.hpp"
#include "scene.hpp"

#include <cstdint>
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
  using Bcc = hand_written::Bcc<Real, SecondShell>;

 public:
  explicit HandWritten(int n)
      : bcc_{n, Real(first_shell), Real(SecondShell ? second_shell : 0), Real(scene::applied),
             Real(damping)},
        spins_(bcc_.sites()),
        steps_(bcc_) {
    hand_written::fill(spins_, random_spins(std::int64_t(bcc_.sites())));
  }
  void step(double dt) { steps_.heun(spins_, static_cast<Real>(dt)); }
  std::vector<double> spins() const { return hand_written::numbers_of(spins_, bcc_.sites()); }

 private:
  Bcc bcc_;
  hand_written::Vectors<Real> spins_;
  hand_written::Steps<Bcc> steps_;
};

template <class Real, bool SecondShell>
void add(std::string const& prefix) {
  using Heun = cayspin::LieHeun<cayspin::SpinField<Real>>;
  // The loop and the library use different methods of order 2, whose short steps differ little.
  auto const distance = [] {
    constexpr int n = 8, steps = 20;
    constexpr double dt = 1e-5;
    HandWritten<Real, SecondShell> loop(n);
    for (int i = 0; i < steps; ++i) loop.step(dt);
    return scene::distance_to<Heun, System<SecondShell>>(loop.spins(), bcc(n), steps, dt);
  };
  for (int const n : edges) {
    auto const size = "/" + std::to_string(n);
    scene::add(prefix + "hand-written" + size, [=](benchmark::State& state) {
      if (!(distance() < 1e-9 + 100 * std::numeric_limits<Real>::epsilon()))
        return state.SkipWithError("the loop and the library take different steps");
      HandWritten<Real, SecondShell> loop(n);
      for (auto _ : state) loop.step(scene::dt);
      scene::report(state, 2 * std::int64_t(n) * n * n, 27, 0);
    });
    scene::add(prefix + "Heun" + size, [n](benchmark::State& state) {
      scene::time_steps<Heun, System<SecondShell>>(state, bcc(n), 21);
    });
  }
}

}  // namespace

void register_benchmarks() {
  add<double, false>("f64/8 neighbours/");
  add<double, true>("f64/14 neighbours/");
  add<float, false>("f32/8 neighbours/");
  add<float, true>("f32/14 neighbours/");
}
