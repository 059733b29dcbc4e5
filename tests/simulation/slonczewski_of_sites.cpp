// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Slonczewski's torque with an angular dependence and with site-dependent strengths and
// polarizations, compared with closed forms.
#include "scenes_of_text.hpp"

#include <cayspin/units.hpp>

#include <array>
#include <cmath>
#include <string>

namespace cayspin::simulation::test {
namespace {

using Vector = std::array<double, 3>;

Vector cross(Vector const& a, Vector const& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(Vector const& a, Vector const& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// z = m.p obeys dz/dt = a * c(z) * (1 - z^2), with c(z) = 2 * L^2 / ((L^2 + 1) + (L^2 - 1) * z).
TEST(SlonczewskiOfSites, TurnsAFreeSpinByItsImplicitForm) {
  constexpr double a = 0.3, L = 1.7, t = 2, z0 = -0.6;
  auto const integral = [](double z) {
    return (L * L + 1) * std::atanh(z) - (L * L - 1) / 2 * std::log(1 - z * z);
  };
  for (auto const precision : precisions) {
    auto const end =
        end_of(llg_scene("0", "rkmk4", 100,
                         fmt::format("lattice = {{ shape = [3] }}\ninitial = {{ uniform = [0.8, 0, "
                                     "-0.6] }}\ntorque = {{ slonczewski = {{ damping_like = {}, "
                                     "lambda = {}, polarization = [0, 0, 1] }} }}",
                                     a, L)),
               precision);
    for (std::size_t site = 0; site < 3; ++site)
      EXPECT_NEAR(integral(end[3 * site + 2]) - integral(z0), 2 * L * L * a * t,
                  1e-8 + 400 * epsilon(precision));
  }
}

// Near m = +-z a small tilt decays at the rate damping * (K +- b) +- a * c, where c is 1 near z and
// L^2 near -z. Beyond the threshold, where this rate is 0, the tilt grows.
TEST(SlonczewskiOfSites, HasTheThresholdOfItsAngle) {
  constexpr double damping = 0.05, K = 0.8, b = 0.1, L = 1.5, tilt = 1e-3, t = 40 * 0.02;
  for (double const side : {1.0, -1.0})
    for (double const past : {0.8, 1.2}) {
      double const c = side > 0 ? 1 : L * L;
      double const a = -side * past * damping * (K + side * b) / c;
      auto const end = end_of(llg_scene(
          "0.05", "rkmk4", 40,
          fmt::format(
              "lattice = {{ shape = [2] }}\ninitial = {{ uniform = [{}, 0, {}] }}\nfield = "
              "{{ anisotropy = {{ constant = {}, axis = [0, 0, 1] }} }}\n[torque.slonczewski]"
              "\ndamping_like = {}\nfield_like = {}\nlambda = {}\npolarization = [0, 0, 1]\n",
              tilt, side, K, a, b, L)));
      double const rate = -damping * (K + side * b) - side * a * c;
      EXPECT_NEAR(std::log(std::hypot(end[0], end[1]) / tilt), rate * t, 2e-6) << side << past;
      EXPECT_EQ(rate > 0, past > 1);
    }
}

// dm/dt = gamma / (1 + alpha^2) * ((A + alpha * B) * (m x (p x m)) + (B - alpha * A) * (p x m)),
// with A = beta * P * L^2 / ((L^2 + 1) + (L^2 - 1) * m.p), B = beta * epsilon' and
// beta = hbar * j / (e * Ms * d).
TEST(SlonczewskiOfSites, IsThatOfACurrent) {
  constexpr double Ms = 6e5, alpha = 0.3, P = 0.45, L = 1.6, second = 0.12, thickness = 2e-9;
  constexpr double dt = 1e-17;
  auto const scene = scene_of(fmt::format(R"toml(
units = "SI"
system = {{ kind = "llg" }}
material = {{ Ms = {}, alpha = {}, damping_form = "gilbert" }}
[lattice]
shape = [6, 2]
spacing = 2e-9
regions = "i % 3"
[torque.slonczewski]
current_density = {{ profile = {{ regions = [1e12, 0, -3e12] }}, time = "1 + 0*t" }}
efficiency = {}
lambda = {}
epsilon_prime = {}
thickness = {}
polarization = {{ regions = [[0, 0, 1], [1, 2, 0], [3, 0, -4]] }}
[initial]
random = {{ seed = 4 }}
[integrator]
method = "heun"
dt = {}
steps = 1
)toml",
                                          Ms, alpha, P, L, second, thickness, dt));
  constexpr double densities[] = {1e12, 0, -3e12};
  constexpr Vector polarizations[] = {
      {0, 0, 1}, {1 / 2.23606797749979, 2 / 2.23606797749979, 0}, {0.6, 0, -0.8}};
  auto const run = SceneRun::open(scene, {});
  auto const start = spins_of(*run);
  run->advance(1);
  auto const end = spins_of(*run);
  for (std::size_t site = 0; site < start.size() / 3; ++site) {
    auto const region = site % 6 % 3;
    Vector const m{start[3 * site], start[3 * site + 1], start[3 * site + 2]};
    auto const& p = polarizations[region];
    double const beta =
        units::reduced_planck * densities[region] / (units::elementary_charge * Ms * thickness);
    double const A = beta * P * L * L / ((L * L + 1) + (L * L - 1) * dot(m, p)), B = beta * second;
    auto const pxm = cross(p, m), mxpxm = cross(m, pxm);
    double const unit = units::electron_gamma * dt / (1 + alpha * alpha);
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(end[3 * site + c] - m[c],
                  unit * ((A + alpha * B) * mxpxm[c] + (B - alpha * A) * pxm[c]),
                  1e-15 + 1e-6 * unit)
          << site;
  }
}

// Site-dependent values that are equal act like one number, also with other terms and vacancies.
TEST(SlonczewskiOfSites, ThatAreAlikeAreOneTorque) {
  auto const film = [](std::string const& method, std::string const& torque,
                       std::string const& more) {
    return scene_of(fmt::format(R"toml(
[system]
kind = "llg"
damping = 0.1
[lattice]
shape = [21, 6, 2]
regions = "i > j"
{}
[field]
exchange = 0.7
applied = [0.1, 0, "0.1*cos(3*t)"]
[torque.slonczewski]
{}
[initial]
random = {{ seed = 3 }}
[integrator]
method = "{}"
dt = 0.02
steps = 20
)toml",
                                more, torque, method));
  };
  for (std::string const method : {"heun", "rkmk4", "stiff2", "projected_rk4"})
    for (std::string const more : {"", "occupied = 'i != 4'", "moments = 2"})
      for (auto const precision : precisions) {
        auto const plain = film(method,
                                "damping_like = '0.2*cos(t)'\nfield_like = 0.1\npolarization = [0, "
                                "3, 4]\n",
                                more);
        auto const of_sites = film(method,
                                   "damping_like = { profile = '0.4', time = '0.5*cos(t)' }\n"
                                   "field_like = { regions = [0.1, 0.1] }\n"
                                   "polarization = { regions = [[0, 3, 4], [0, 0.6, 0.8]] }\n",
                                   more);
        double const solved = method == "stiff2" ? 1e-7 : 0;
        EXPECT_LT(largest_distance(end_of(plain, precision), end_of(of_sites, precision)),
                  solved + 20 * 64 * epsilon(precision))
            << method << more;
      }
}

// With half the step, the error is a quarter.
TEST(SlonczewskiOfSites, GoesWithStiffMethods) {
  auto const end = [](std::string const& method, int halvings) {
    return end_of(scene_of(fmt::format(R"toml(
system = {{ kind = "llg", damping = 0.3 }}
lattice = {{ shape = [12, 3] }}
field = {{ exchange = 2, anisotropy = {{ constant = 0.5, axis = [0, 0, 1] }} }}
initial = {{ random = {{ seed = 3 }} }}
integrator = {{ method = "{}", dt = {}, steps = {} }}
[torque.slonczewski]
damping_like = "0.6*x"
lambda = 2
polarization = [1, 0, 1]
)toml",
                                       method, 0.04 / (1 << halvings), 10 << halvings)));
  };
  auto const exact = end("rkmk4", 4);
  double const once = largest_distance(end("stiff2", 1), exact),
               twice = largest_distance(end("stiff2", 2), exact);
  EXPECT_LT(once, 1e-2);
  EXPECT_NEAR(once / twice, 4, 0.4);
}

TEST(SlonczewskiOfSites, GoOnAfterABreak) {
  expect_same_bits_after_a_break(scene_of(R"toml(
system = { kind = "llg", damping = 0.1 }
lattice = { shape = [9, 7], gyromagnetic = "1 + 0.1*i" }
field = { exchange = 1 }
initial = { random = { seed = 3 } }
integrator = { method = "tsit5", tolerance = 1e-5, dt = 0.1, steps = 12 }
[torque.slonczewski]
damping_like = { profile = "0.1*i", time = "sin(3*t)" }
lambda = 2
polarization = ["x - 0.5", "y - 0.4", 1]
)toml"),
                                 5);
}

// The bound on the step uses the strongest torque: that of the strongest site, at m = -p.
TEST(SlonczewskiOfSites, BoundTheStep) {
  auto const plan_of = [](std::string const& torque) {
    return make_plan(llg_scene("0.1", "heun", 1,
                               "lattice = { shape = [4] }\ninitial = { uniform = [1, 0, 0] }\n"
                               "[torque.slonczewski]\npolarization = [0, 0, 1]\n" +
                                   torque),
                     Precision::double_precision)
        .stable_dt;
  };
  double const one = plan_of("damping_like = 0.5");
  EXPECT_NEAR(plan_of("damping_like = 0.5\nlambda = 2") * 4, one, 1e-12 * one);
  EXPECT_NEAR(plan_of("damping_like = '0.5*(1 + 2*i)'") * 7, one, 1e-12 * one);
}

}  // namespace
}  // namespace cayspin::simulation::test
