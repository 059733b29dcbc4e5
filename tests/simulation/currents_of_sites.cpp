// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Torques of a current density where the magnetization differs from site to site.
#include "scenes_of_text.hpp"
#include "simulation/plan.hpp"

#include <cstddef>
#include <string>

namespace cayspin::simulation::test {
namespace {

// Three rows without exchange, which a current along x does not couple.
std::vector<double> end_of_rows(std::string const& Ms, std::string const& torque,
                                Precision precision) {
  return end_of(scene_of("units = 'SI'\nmaterial = { Ms = " + Ms +
                         ", alpha = 0.1, damping_form = 'gilbert' }\n[torque]\n" + torque + R"toml(
[system]
kind = "llg"
[lattice]
shape = [8, 3]
spacing = 4e-9
boundary = ["periodic", "open"]
regions = "j"
[field]
applied = [0, 0.3, 0.1]
[initial]
random = { seed = 5 }
[integrator]
method = "rkmk4"
dt = 1e-13
steps = 100
)toml"),
                precision);
}

TEST(CurrentsOfSites, ActOnEachSiteByItsMagnetization) {
  for (std::string const torque :
       {"zhang_li = { current_density = [5e12, 0, 0], polarization = 0.4, nonadiabaticity = 0.1 }",
        "slonczewski = { current_density = 5e12, efficiency = 0.4, thickness = 3e-9, "
        "polarization = [1, 0, 0] }",
        "slonczewski = { current_density = { profile = '5e12*x', time = '1 + 1e11*t' }, "
        "efficiency = 0.4, epsilon_prime = 0.1, lambda = 1.5, thickness = 3e-9, "
        "polarization = [1, 0, 0] }",
        "slonczewski = { current_density = { regions = [5e12, 8e12, 0] }, efficiency = 0.4, "
        "field_like = 0.05, thickness = 3e-9, polarization = [1, 0, 0] }",
        "zhang_li = { current_density = [5e12, 0, 0], polarization = 0.4 }\n"
        "slonczewski = { damping_like = 0.2, polarization = [1, 0, 0] }"})
    for (auto const precision : precisions) {
      SCOPED_TRACE(torque);
      auto const weak = end_of_rows("4e5", torque, precision),
                 strong = end_of_rows("1.2e6", torque, precision);
      EXPECT_GT(largest_distance(weak, strong), 0.1);
      for (std::string const Ms : {"{ regions = [4e5, 1.2e6, 0] }", "'4e5 + 8e5*j'"}) {
        auto const both = end_of_rows(Ms, torque, precision);
        for (std::size_t i = 0; i < 48; ++i)  // the first two rows
          EXPECT_NEAR(both[i], i < 24 ? weak[i] : strong[i], 1e-11 + 200 * epsilon(precision)) << i;
      }
    }
}

// A strength in T is a field, which turns a spin whatever its magnetization.
TEST(CurrentsOfSites, StrengthsInTeslaDoNotDependOnTheMagnetization) {
  std::string const torque =
      "zhang_li = { velocity = [150, 0, 0] }\n"
      "slonczewski = { damping_like = 0.2, field_like = 0.1, polarization = [1, 0, 0] }";
  for (auto const precision : precisions) {
    auto const one = end_of_rows("4e5", torque, precision),
               both = end_of_rows("{ regions = [4e5, 1.2e6, 8e5] }", torque, precision);
    for (std::size_t i = 0; i < one.size(); ++i)
      EXPECT_NEAR(both[i], one[i], 1e-11 + 200 * epsilon(precision)) << i;
  }
}

// The least Ms turns spins most, and so limits the step.
TEST(CurrentsOfSites, BoundTheStepByTheLeastMagnetization) {
  auto const stable_seconds = [](std::string const& Ms, std::string const& torque) {
    auto const scene = scene_of("units = 'SI'\nmaterial = { Ms = " + Ms +
                                ", alpha = 0.1, damping_form = 'gilbert' }\ntorque = { " + torque +
                                R"toml( }
system = { kind = "llg" }
lattice = { shape = [4, 2], spacing = 4e-9, regions = "j" }
initial = { uniform = [0, 0, 1] }
integrator = { method = "rkmk4", dt = 1e-14, steps = 1 }
)toml");
    return make_plan(scene, Precision::double_precision).stable_dt * scene.units.time;
  };
  for (std::string const torque :
       {"slonczewski = { current_density = 1e12, efficiency = 0.4, "
        "thickness = 3e-9, polarization = [1, 0, 0] }",
        "zhang_li = { current_density = [1e12, 0, 0], polarization = 0.4 }"}) {
    double const weak = stable_seconds("8e4", torque);
    EXPECT_NEAR(stable_seconds("{ regions = [8e5, 8e4] }", torque), weak, 1e-12 * weak) << torque;
    EXPECT_NEAR(stable_seconds("8e5", torque), 10 * weak, 1e-11 * weak) << torque;
  }
}

}  // namespace
}  // namespace cayspin::simulation::test
