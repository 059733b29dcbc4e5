// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Errors of energy, total spin and norm in long runs without damping, for each of thirteen methods
// with and without EnergyControl: spins on a periodic cube with only exchange, from a random start.
// All methods get equally many field evaluations per unit time. For each run prints a row of a
// Markdown table, with the largest errors among about a thousand samples.
//   bench_long_runs [--steps=1000000] [--edge=16] [--evaluations=80] [--period=1] [--only=METHOD]
#include "random_spins.hpp"

#include <cayspin/cayspin.hpp>

#include <Kokkos_Timer.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

namespace {

using namespace cayspin;
using Exec = Kokkos::DefaultExecutionSpace;
using Spins = SpinField<double>;
using Generator = LandauLifshitz<EffectiveField<Exchange>>;

struct Options {
  std::int64_t steps = 1000000, edge = 16, period = 1;
  double evaluations = 80;  // per unit time
  std::string only;
};

/// Observer that records the largest errors so far. It comes before EnergyControl, so that it sees
/// the spins before they are corrected.
class Watch {
 public:
  Watch(Generator const& generator, std::int64_t sites)
      : generator_(generator), sites_(static_cast<double>(sites)) {}

  void operator()(Exec const& exec, Step const& step, Spins const& spins) {
    Sample const now = sample(exec, generator_, step, spins);
    if (!first_) first_ = now;
    auto const moved = now.magnetization - first_->magnetization;
    energy = std::fmax(energy, std::abs(now.energy.value - first_->energy.value) / sites_);
    spin = std::fmax(spin, std::sqrt(dot(moved, moved)));
    norm = std::fmax(norm, now.norm_defect);
    finite = finite && std::isfinite(now.energy.value);
  }

  double energy = 0, spin = 0, norm = 0;
  bool finite = true;

 private:
  Generator generator_;
  double sites_;
  std::optional<Sample> first_;
};

class Runs {
 public:
  explicit Runs(Options const& options)
      : options_(options), lattice_(Lattice::cubic(options.edge, options.edge, options.edge)) {
    lattice_.boundary = {Boundary::periodic, Boundary::periodic, Boundary::periodic};
    std::printf(
        "| method | dt | steps | max \\|dE\\|/N | max \\|dS\\|/N | max \\|\\|m\\| - 1\\| | ns per "
        "spin "
        "and step |\n|---|---|---|---|---|---|---|\n");
  }

  /// `made_with`: further constructor arguments of the stepper.
  template <class Stepper, class... Arguments>
  void run(std::string const& method, Arguments const&... made_with) const {
    if (!options_.only.empty() && method != options_.only) return;
    run_once<Stepper>(method, false, made_with...);
    run_once<Stepper>(method + ", energy control", true, made_with...);
  }

 private:
  template <class Stepper, class... Arguments>
  void run_once(std::string const& name, bool controlled, Arguments const&... made_with) const {
    Spins spins("spins", lattice_);
    copy_from_host(random_spins(lattice_.sites()), spins);
    Generator const generator(EffectiveField(Exchange(lattice_, 1)), 0);
    Watch watch(generator, lattice_.sites());
    EnergyControl control(spins, generator, {.period = options_.period});
    Stepper stepper(spins, made_with...);
    double const dt = Stepper::evaluations / options_.evaluations;
    Times const times{0, dt, options_.steps};
    Every looks(std::max<std::int64_t>(1, options_.steps / 1000), std::ref(watch));
    Kokkos::Timer const clock;
    if (controlled)
      integrate(Exec(), stepper, generator, spins, times, looks, control);
    else
      integrate(Exec(), stepper, generator, spins, times, looks);
    double const seconds = clock.seconds();
    double const updates = static_cast<double>(lattice_.sites() * options_.steps);
    std::printf("| %s | %.4g | %lld | %.1e | %.1e | %.1e | %.1f |%s\n", name.c_str(), dt,
                static_cast<long long>(options_.steps), watch.energy, watch.spin, watch.norm,
                seconds / updates * 1e9, watch.finite ? "" : " not finite");
    std::fflush(stdout);
  }

  Options options_;
  Lattice lattice_;
};

Options options_of(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    std::string const word = argv[i];
    auto const value = [&](std::string const& key) -> char const* {
      return word.rfind("--" + key + "=", 0) == 0 ? argv[i] + key.size() + 3 : nullptr;
    };
    if (auto const* text = value("steps"))
      options.steps = std::atoll(text);
    else if (auto const* text = value("edge"))
      options.edge = std::atoll(text);
    else if (auto const* text = value("evaluations"))
      options.evaluations = std::atof(text);
    else if (auto const* text = value("period"))
      options.period = std::atoll(text);
    else if (auto const* text = value("only"))
      options.only = text;
    else
      throw std::invalid_argument("bench_long_runs: unknown option " + word);
  }
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  Runs const runs(options_of(argc, argv));
  runs.run<ProjectedRk4<Spins>>("RK4 + renormalise");
  runs.run<Rkmk4<Spins>>("RKMK4");
  // With this sigma, A is the sum over the six neighbours: sigma * m cancels the term -6 * m of
  // exchange.
  isotropy::Constant const neighbor_sum{6};
  runs.run<Rkmk4<Spins, isotropy::Constant>>("RKMK4, sigma = 6", neighbor_sum);
  runs.run<StereographicRungeKutta<Spins, tableau::Classical4>>("RK4 in the chart");
  runs.run<Rkmk4<Spins, isotropy::Zero, Exponential>>("RKMK4, exponential");
  runs.run<CommutatorFree4<Spins>>("commutator-free 4");
  runs.run<CommutatorFree4<Spins, isotropy::Constant>>("commutator-free 4, sigma = 6",
                                                       neighbor_sum);
  runs.run<RedBlack2<Spins>>("red-black 2");
  runs.run<RedBlack4<Spins>>("red-black 4");
  runs.run<Rkmk<Spins, tableau::Tsitouras5>>("order 5");
  runs.run<Rkmk<Spins, tableau::DormandPrince8>>("order 8");
  runs.run<LieHeun<Spins>>("geometric Heun");
  runs.run<LieEuler<Spins>>("geometric Euler");
}
