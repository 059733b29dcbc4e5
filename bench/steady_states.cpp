// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The cost of finding equilibria of films and cubes, to max |m x H| < 1e-6: field evaluations and
// seconds of cayspin::minimize, with and without its preconditioner, of Barzilai and Borwein's
// steps with the same kernels, and of a relaxation in time. `bench_steady_states --large`: also
// 256^2 and 64^3 spins. Methods stop after 60000 evaluations.
#include "random_spins.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/minimize.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

namespace {

using namespace cayspin;
using Spins = SpinField<double>;
using Exec = Kokkos::DefaultExecutionSpace;

constexpr std::int64_t most_evaluations = 60000;
constexpr double bound = 1e-6;

auto film(Lattice const& lattice, double exchange) {
  return EffectiveField(Exchange(lattice, exchange), UniaxialAnisotropy(0.1, {1, 0, 0}),
                        SlabDemag({0, 0, 1}, 1.0));
}

std::vector<double> vortex(Lattice const& lattice) {
  auto const& n = lattice.shape;
  std::vector<double> numbers;
  for (std::int64_t j = 0; j < n[1]; ++j)
    for (std::int64_t i = 0; i < n[0]; ++i) {
      double const x = (i + 0.5) / n[0] - 0.5, y = (j + 0.5) / n[1] - 0.5;
      double const length = std::sqrt(x * x + y * y + 0.01);
      for (double const c : {-y, x, 0.1}) numbers.push_back(c / length);
    }
  return numbers;
}

struct Cost {
  bool converged = false;
  std::int64_t evaluations = 0;
  double seconds = 0;
};

template <class Field>
Cost by_minimize(Field const& field, Spins& spins, bool preconditioned) {
  Kokkos::Timer const clock;
  auto const found = minimize(
      Exec(), field, spins,
      {.torque = bound, .evaluations = most_evaluations, .preconditioned = preconditioned});
  return {found.end == MinimizeEnd::converged, found.evaluations, clock.seconds()};
}

/// Takes steps against the gradient. The ratio of step to gradient is |s.s / s.y| and |s.y / y.y|
/// in turn, where s is the previous step and y the change of the gradient during that step.
template <class Field>
Cost by_barzilai_borwein(Field const& field, Spins& spins) {
  auto const& lattice = spins.lattice();
  Exec const exec;
  detail::SearchArrays<Spins> search{Spins("trial", lattice), Spins("gradient", lattice),
                                     Spins("new_gradient", lattice), Spins("direction", lattice)};
  Spins const moved("moved", lattice), changed("changed", lattice);
  Kokkos::Timer const clock;
  Kokkos::deep_copy(search.direction.allocation(), 0.0);
  auto point = detail::look_along(exec, field, 0, spins, 0, search, moved, changed);
  Cost cost{.evaluations = 1};
  double step = 0.1 / point.torque;
  for (; point.torque >= bound && cost.evaluations < most_evaluations; ++cost.evaluations) {
    swap(search.gradient, search.new_gradient);
    detail::combine(exec, -1, search.gradient, 0, search.gradient, search.direction);
    point = detail::look_along(exec, field, 0, spins, step, search, moved, changed);
    swap(spins, search.trial);
    step = cost.evaluations % 2 ? point.step_square / point.curvature
                                : point.curvature / point.change_square;
    step = std::abs(step);
    if (!std::isfinite(step)) break;
  }
  cost.converged = point.torque < bound;
  cost.seconds = clock.seconds();
  return cost;
}

/// Integrates m' = (m x H) x m by RKMK4 at 0.95 of its largest stable step.
template <class Field>
Cost by_relaxing(Field const& field, Spins& spins, double field_bound) {
  Exec const exec;
  LandauLifshitz const generator(field, 1.0, false), precession(field, 0.0);
  Rkmk4<Spins> stepper(spins);
  double const dt =
      0.95 * largest_stable_step<Rkmk4<Spins>>(field_bound, 1.0, {.precession = false});
  Kokkos::Timer const clock;
  Cost cost;
  while (!cost.converged && cost.evaluations < most_evaluations) {
    for (int i = 0; i < 25; ++i) stepper.step(exec, generator, spins, 0, dt);
    cost.evaluations += 101;
    cost.converged = largest_rate(exec, precession, spins) < bound;
  }
  cost.seconds = clock.seconds();
  return cost;
}

void print(Cost const& cost) {
  if (cost.converged)
    std::printf(" | %6lld %8.4f", static_cast<long long>(cost.evaluations), cost.seconds);
  else
    std::printf(" |      - %8.4f", cost.seconds);
}

void compare(Lattice const& lattice, double exchange, bool random) {
  auto const field = film(lattice, exchange);
  auto const start = random ? random_spins(lattice.sites()) : vortex(lattice);
  auto const fresh = [&] {
    Spins spins("spins", lattice);
    copy_from_host(start, spins);
    return spins;
  };
  auto const& n = lattice.shape;
  std::printf("%3lld x %3lld x %2lld | %6g | %-6s", static_cast<long long>(n[0]),
              static_cast<long long>(n[1]), static_cast<long long>(n[2]), exchange,
              random ? "random" : "vortex");
  for (int method = 0; method < 4; ++method) {
    auto spins = fresh();
    print(method < 2 ? by_minimize(field, spins, method == 0)
          : method == 2
              ? by_barzilai_borwein(field, spins)
              : by_relaxing(field, spins, exchange_bound(lattice, std::abs(exchange)) + 1.1));
  }
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  bool const large = argc > 1 && std::strcmp(argv[1], "--large") == 0;
  std::printf("%-16s | %6s | %-6s | %15s | %15s | %15s | %15s\n", "spins", "A", "start", "minimize",
              "no precond.", "Barzilai-Borw.", "RKMK4 in time");
  for (double const exchange : {2.0, 50.0, 1000.0})
    for (bool const random : {false, true}) compare(Lattice::square(32, 32), exchange, random);
  compare(Lattice::square(32, 32), -50, true);
  compare(Lattice::cubic(16, 16, 16), -50, true);
  if (!large) return 0;
  for (double const exchange : {2.0, 50.0, 1000.0}) {
    compare(Lattice::square(256, 256), exchange, true);
    compare(Lattice::cubic(64, 64, 64), exchange, true);
  }
}
