// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Finds the true limit of dt by bisection, for the stiffest mode of chains, planes and blocks of
// spins along a field, and compares it with the prediction, which is exact in these cases.
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"

#include <numbers>

using namespace cayspin;
using namespace cayspin::test;

namespace {

using isotropy::Constant;

constexpr double applied = 0.7, exchange = 1.3;

struct Named {
  char const* name;
  Lattice lattice;
};
Boundary const open = Boundary::open, periodic = Boundary::periodic;
Named const lattices[] = {{"chain", Lattice::chain(19)},
                          {"plane", {{8, 6, 1}, {0.8, 1.1, 1}, {open, periodic, open}}},
                          {"block", {{4, 3, 5}, {0.9, 1, 1.2}, {open, open, open}}}};

auto generator(Lattice const& lattice, double damping) {
  return LandauLifshitz(EffectiveField(Exchange(lattice, exchange), Zeeman{{0, 0, applied}}),
                        damping);
}

/// Returns spins along z that are tilted towards x by the stiffest mode, the eigenvector of
/// exchange with the largest eigenvalue.
Spins stiffest_mode(Lattice const& lattice) {
  auto const wave = [&](int axis, auto i) {
    auto const n = static_cast<double>(lattice.shape[axis]);
    if (lattice.boundary[axis] == periodic) return i % 2 == 0 ? 1.0 : -1.0;
    return std::cos(std::numbers::pi * (n - 1) * (static_cast<double>(i) + 0.5) / n);
  };
  return make_spins(lattice, [&](auto i, auto j, auto k) {
    return Vector{1e-6 * wave(0, i) * wave(1, j) * wave(2, k), 0, 1};
  });
}

double across(Spins const& spins) {
  auto const numbers = copy_to_host(spins);
  double square = 0;
  for (std::size_t i = 0; i < numbers.size(); i += 3)
    square += numbers[i] * numbers[i] + numbers[i + 1] * numbers[i + 1];
  return std::sqrt(square);
}

/// Returns the first dt near `guess` at which the mode grows; the mode may decay again at some
/// larger dt.
template <class Stepper, class Generator>
double bisected(Generator const& generator, Spins const& start, double guess, double sigma) {
  double stable = 0.98 * guess, unstable = 0.99 * guess;
  auto const grows = [&](double dt) {
    return !(across(run<Stepper>(generator, start, dt, 200, Constant{sigma})) < across(start));
  };
  EXPECT_FALSE(grows(stable));
  for (; !grows(unstable) && unstable < 1.2 * guess; unstable += 0.01 * guess) stable = unstable;
  EXPECT_LT(unstable, 1.2 * guess);
  for (int halving = 0; halving < 5; ++halving) {
    double const middle = 0.5 * (stable + unstable);
    (grows(middle) ? unstable : stable) = middle;
  }
  return 0.5 * (stable + unstable);
}

template <class Stepper>
void expect_limits(char const* method) {
  for (auto const& [name, lattice] : lattices) {
    auto const start = stiffest_mode(lattice);
    double const bound = exchange_bound(lattice, exchange) + applied;
    for (double const damping : {0.1, 1.0}) {
      auto const natural = generator(lattice, damping);
      auto const expect = [&](char const* what, auto const& of, double sigma, double along) {
        double const limit = largest_stable_step<Stepper>(bound, damping, {.sigma = along});
        double const found = bisected<Stepper>(of, start, limit, sigma);
        std::printf("    %-10s %-6s damping %-4g %-18s limit %.6f, predicted %.6f\n", method, name,
                    damping, what, found, limit);
        EXPECT_GT(found / limit, 0.995) << method << ' ' << name << ' ' << what;
        // With a sigma, another mode may be the first to grow.
        if (sigma == 0) {
          EXPECT_LT(found / limit, 1.005) << method << ' ' << name << ' ' << what;
        }
      };
      expect("orthogonal", orthogonal(natural), 0, 0);
      // The default generator's component along the spin is the field's, which acts like a sigma.
      expect("default", natural, 0, applied);
      expect("orthogonal, sigma", orthogonal(natural), -1.5, -1.5);
    }
  }
}

TEST(TrueLimit, LieEuler) { expect_limits<LieEuler<Spins, Constant>>("Euler"); }
TEST(TrueLimit, LieHeun) { expect_limits<LieHeun<Spins, Constant>>("Heun"); }
TEST(TrueLimit, Rkmk4) { expect_limits<Rkmk4<Spins, Constant>>("rkmk4"); }
TEST(TrueLimit, CommutatorFree4) { expect_limits<CommutatorFree4<Spins, Constant>>("cf4"); }
TEST(TrueLimit, DormandPrince8) {
  expect_limits<Rkmk<Spins, tableau::DormandPrince8, Constant>>("order 8");
}
TEST(TrueLimit, Tsitouras5) {
  expect_limits<Rkmk<Spins, tableau::Tsitouras5, Constant>>("Tsitouras");
}

}  // namespace
