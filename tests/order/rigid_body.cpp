// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Orders of the trajectory's and of the energy's error on three random triaxial rigid bodies,
// during a time of 2 and for fixed step sizes.
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"
#include "../support/larger.hpp"

#include <cayspin_paper/analytic_sigma.hpp>
#include <cayspin_paper/series4.hpp>

#include <array>

using namespace cayspin;
using namespace cayspin::test;

namespace {

constexpr int bodies = 3;
constexpr double end_time = 2;
Lattice const lattice = Lattice::chain(bodies);

// Inverse inertias; each principal value is at least 1.4 times the previous one.
std::vector<double> const tensors{0.855976, 1.162556, 1.649652, 0.043564,  0.62717,   -0.055694,
                                  1.117146, 1.857536, 1.952938, -0.004366, -0.671065, 0.412494,
                                  1.932378, 1.86113,  0.992395, -0.611087, -0.200564, -0.080505};
std::vector<double> const start{-0.8786749342491563, -0.4259259193583215, -0.21567909296222781,
                                0.4551411380605035,  0.15485317811021196, 0.8768506358976748,
                                0.20690686409015627, 0.6039173421637017,  0.769722932896187};
// The spins at t = 2, from 40-digit arithmetic.
std::vector<double> const end{
    -0.31080866215438402166, -0.9398431868768971723,   -0.14174893160401464635,
    0.24318270321290301806,  -0.84778463656548883781,  0.47129967415817921681,
    -0.11592565820051408009, -0.079931844417693954743, 0.9900364346925637893};

using Bodies = RigidBodyEnsemble<double, Spins::memory_space>;

Bodies ensemble() {
  Bodies::Tensors const field("inverse_inertia", lattice);
  copy_from_host(tensors, field);
  return Bodies(field);
}

double energy_of(std::vector<double> const& numbers, int body) {
  double const* const b = &tensors[6 * body];
  double const* const m = &numbers[3 * body];
  return 0.5 * (b[0] * m[0] * m[0] + b[1] * m[1] * m[1] + b[2] * m[2] * m[2]) + b[3] * m[0] * m[1] +
         b[4] * m[0] * m[2] + b[5] * m[1] * m[2];
}

/// For each body, the distance to the exact end, and the largest energy error on the way.
struct Errors {
  std::array<double, bodies> end{}, energy{};
};

template <class Stepper, class Generator>
Errors errors(Stepper& stepper, Generator const& generator, int steps) {
  Errors found;
  auto spins = make_spins(lattice, [](auto i, auto, auto) {
    return Vector{start[3 * i], start[3 * i + 1], start[3 * i + 2]};
  });
  auto const observe = [&](auto const&, Step const&, Spins const& now) {
    auto const numbers = copy_to_host(now);
    for (int i = 0; i < bodies; ++i)
      found.energy[i] =
          larger(found.energy[i], std::abs(energy_of(numbers, i) - energy_of(start, i)));
  };
  integrate(Space{}, stepper, generator, spins, Times{0, end_time / steps, steps}, observe);
  for (int i = 0; i < bodies; ++i) {
    auto const m = spin(spins, i);
    found.end[i] = length({m.x - end[3 * i], m.y - end[3 * i + 1], m.z - end[3 * i + 2]});
  }
  return found;
}

constexpr double exact = 0;  // stands for an energy that is conserved to round-off

struct Orders {
  int trajectory;
  double energy, energy_tolerance = 0.15;
};

constexpr double tolerance = 0.15, scattered = 0.4;
/// Returns four numbers of steps, a factor sqrt(2) apart. Methods of higher order take fewer, to
/// stay above round-off. From order 2 on, the orthogonal generator takes half as many as the
/// natural one, since its rotations are smaller.
std::vector<int> ladder(int order, bool orthogonal) {
  int const first = order == 1 ? 512 : (order == 2 ? 256 : 64) / (orthogonal ? 2 : 1);
  std::vector<int> steps;
  for (int i = 0; i < 4; ++i) steps.push_back(std::lround(first * std::pow(2, 0.5 * i)));
  return steps;
}

template <class Stepper, class Generator>
void expect(char const* what, Stepper stepper, Generator const& generator, Orders const& expected) {
  bool const orthogonal = requires { generator.is_orthogonal(); };
  std::vector<double> dts;
  std::vector<Errors> found;
  for (int const steps : ladder(expected.trajectory, orthogonal)) {
    dts.push_back(end_time / steps);
    found.push_back(errors(stepper, generator, steps));
  }
  for (int body = 0; body < bodies; ++body) {
    std::vector<double> trajectory, energy;
    double largest_energy = 0;
    for (auto const& one : found) {
      trajectory.push_back(one.end[body]);
      energy.push_back(one.energy[body]);
      largest_energy = larger(largest_energy, one.energy[body]);
    }
    auto const name = what + std::string(", body ") + std::to_string(body + 1);
    std::printf("    %-40s end %.1e .. %.1e, energy %.1e .. %.1e\n", name.c_str(),
                trajectory.front(), trajectory.back(), energy.front(), energy.back());
    expect_order(name, fitted_order(dts, trajectory), expected.trajectory, tolerance);
    if (expected.energy == exact)
      expect_below(name + " energy", largest_energy, 1e-14);
    else
      expect_order(name + " energy", fitted_order(dts, energy), expected.energy,
                   expected.energy_tolerance);
  }
}

class RigidBodyOrder : public ::testing::Test {
 protected:
  Bodies const body = ensemble();
  Orthogonal<Bodies> const w = orthogonal(body);
  Spins const like{"like", lattice};
  isotropy::Constant const constant{0.7};
  isotropy::Energy const energy{};
};

TEST_F(RigidBodyOrder, LieEuler) {
  expect("default", LieEuler(like), body, {1, 1});
  expect("orthogonal", LieEuler(like), w, {1, 1});
  expect("constant", LieEuler(like, constant), body, {1, 1});
}

TEST_F(RigidBodyOrder, LieEulerWithSigma) {
  expect("analytic", LieEuler(like, isotropy::Analytic{}), body, {1, 2});
  expect("orthogonal, analytic", LieEuler(like, isotropy::Analytic{}), w, {1, 2});
  expect("connection", LieEuler(like, isotropy::Connection{}), body, {1, 2});
  expect("forward", LieEuler(like, isotropy::FiniteDifference{}), body, {1, 2});
  expect("backward", LieEuler(like, isotropy::FiniteDifferenceBackward{}), body, {1, 2});
}

TEST_F(RigidBodyOrder, LieAdamsBashforth2) {
  expect("default", LieAdamsBashforth2(like), body, {2, 2});
  expect("orthogonal", LieAdamsBashforth2(like), w, {2, 3});
}

TEST_F(RigidBodyOrder, Implicit) {
  expect("default", ImplicitLieEuler(like), body, {1, 1});
  expect("orthogonal", ImplicitLieEuler(like), w, {1, 1});
  expect("analytic", ImplicitLieEuler(like, isotropy::Analytic{}), body, {1, 2});
  expect("orthogonal, analytic", ImplicitLieEuler(like, isotropy::Analytic{}), w, {1, 2});
  expect("midpoint", ImplicitMidpoint(like), body, {2, exact});
}

TEST_F(RigidBodyOrder, LieHeun) {
  expect("default", LieHeun(like), body, {2, 3});
  expect("orthogonal", LieHeun(like), w, {2, 3});
  expect("constant", LieHeun(like, constant), body, {2, 3});
  expect("default, energy", LieHeun(like, energy), body, {2, 4});
  expect("orthogonal, energy", LieHeun(like, energy), w, {2, 4});
}

TEST_F(RigidBodyOrder, Rkmk4) {
  expect("default", Rkmk4(like), body, {4, 4});
  expect("orthogonal", Rkmk4(like), w, {4, 4, scattered});
  expect("constant", Rkmk4(like, constant), body, {4, 4});
  expect("default, energy", Rkmk4(like, energy), body, {4, 5});
  expect("orthogonal, energy", Rkmk4(like, energy), w, {4, 5});
}

TEST_F(RigidBodyOrder, Series4) {
  expect("default", Series4(like), body, {4, 4});
  expect("orthogonal", Series4(like), w, {4, 4, scattered});
  expect("as printed", Series4Paper(like), body, {4, 4, scattered});
  expect("default, energy", Series4(like, energy), body, {4, 5});
  expect("orthogonal, energy", Series4(like, energy), w, {4, 5});
  expect("as printed, energy", Series4Paper(like, energy), body, {4, 5});
}

TEST_F(RigidBodyOrder, Stereographic) {
  expect("Heun", StereographicRungeKutta<Spins, tableau::Heun>(like), body, {2, 3});
  expect("rk4", StereographicRungeKutta<Spins, tableau::Classical4>(like), body, {4, 4, scattered});
}

}  // namespace
