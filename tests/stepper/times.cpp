// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Times at which steps evaluate the generator. With only a field H(t), A = H(t) for any spin, so
// the coordinates of a step are an explicit sum.
#include "../support/landau_lifshitz.hpp"

#include <cayspin_paper/analytic_sigma.hpp>
#include <gtest/gtest.h>

using namespace cayspin;
using namespace cayspin::test;

namespace {

constexpr double t = 0.3, dt = 0.2;
Vector const m{0.6, 0, 0.8};

Vector h(double when) { return {std::cos(3 * when), std::sin(2 * when), 0.4 + when}; }

template <class Rotation = Cayley, class Stepper>
void expect_coordinates(char const* what, Stepper stepper, Vector const& f) {
  LandauLifshitz const generator{EffectiveField{TimeDependentZeeman{h}}, 0};
  auto spins = make_spins(Lattice::chain(1), [](auto, auto, auto) { return m; });
  if constexpr (requires { stepper.remember(Space{}, generator, spins, t, dt); })
    stepper.remember(Space{}, generator, spins, t - dt, dt);
  stepper.step(Space{}, generator, spins, t, dt);
  EXPECT_LT(length(spin(spins, 0) - Rotation::rotate(f, m)), 4e-16) << what;
}

TEST(Times, OfEvaluations) {
  using isotropy::Zero;
  Spins const like("like", Lattice::chain(1));
  expect_coordinates("Euler", LieEuler(like), dt * h(t));
  expect_coordinates("implicit Euler", ImplicitLieEuler(like), dt * h(t + dt));
  expect_coordinates("midpoint", ImplicitMidpoint(like), dt * h(t + dt / 2));
  expect_coordinates("Heun", LieHeun(like), 0.5 * dt * (h(t) + h(t + dt)));
  expect_coordinates("ab2", LieAdamsBashforth2(like), 0.5 * dt * (3.0 * h(t) - h(t - dt)));

  expect_coordinates<Exponential>("Euler", LieEuler(like, Zero{}, Exponential{}), dt * h(t));
  expect_coordinates<Exponential>("implicit Euler", ImplicitLieEuler(like, Zero{}, Exponential{}),
                                  dt * h(t + dt));
  expect_coordinates<Exponential>("ab2", LieAdamsBashforth2(like, Zero{}, Exponential{}),
                                  0.5 * dt * (3.0 * h(t) - h(t - dt)));
}

// For w = H - (m.H) * m, sigma = -<w', w x m> / |w|^2, where w' includes dH/dt and the motion of m.
TEST(Times, OfTheFieldsDerivative) {
  Spins const like("like", Lattice::chain(1));
  auto const normal = [](Vector const& a, Vector const& to) { return a - dot(to, a) * to; };
  Vector const w = normal(h(t), m);
  auto const coordinates = [&](Vector const& dt_times_rate) {
    return dt * w - (dot(dt_times_rate, cross(w, m)) / dot(w, w)) * m;
  };
  expect_coordinates("forward", LieEuler(like, isotropy::FiniteDifference{}),
                     coordinates(normal(h(t + dt), Cayley::rotate(dt * w, m)) - w));
  expect_coordinates("backward", LieEuler(like, isotropy::FiniteDifferenceBackward{}),
                     coordinates(w - normal(h(t - dt), m)));
  Vector const rate{-3 * std::sin(3 * t), 2 * std::cos(2 * t), 1};
  Vector const turn = rate - dot(m, h(t)) * cross(h(t), m);  // A_o' up to a multiple of m
  LandauLifshitz const generator{EffectiveField{TimeDependentZeeman{h}}, 0};
  for (double const step : {0.2, 0.02}) {
    auto spins = make_spins(Lattice::chain(1), [](auto, auto, auto) { return m; });
    LieEuler stepper(spins, isotropy::Analytic{});
    stepper.step(Space{}, generator, spins, t, step);
    Vector const f = step * w - (step * dot(turn, cross(w, m)) / dot(w, w)) * m;
    // H is differentiated numerically, with a relative error of about (omega * dt)^4 / 1e5, where
    // omega is at most 3.
    EXPECT_LT(length(spin(spins, 0) - Cayley::rotate(f, m)), 1e-4 * std::pow(3 * step, 4) * step);
  }
}

}  // namespace
