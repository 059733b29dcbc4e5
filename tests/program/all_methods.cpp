// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Every valid combination of method, generator, isotropy and rotation converges at its order in
// scenes of spins and of rigid bodies, if the method has equal steps.
#include "../support/method_choice.hpp"
#include "program_test.hpp"

#include <cmath>
#include <set>

namespace cayspin::program::test {
namespace {

using cayspin::test::for_each_method_choice;
using cayspin::test::MethodChoice;

class AllMethods : public ProgramTest {
 protected:
  std::vector<double> end(std::string const& scene, Arguments const& changes,
                          std::string const& dt) const {
    Arguments const plain{"--threads", "1", "--set", "integrator.energy_guard=false"};
    return end_of(scene, joined(joined(changes, set("integrator.dt=" + dt)), plain));
  }

  // Errors up to `floor` are round-off; the order is then measured with longer steps.
  void expect_orders(std::string const& scene, io::SystemKind kind, double floor) {
    auto const reference = end(scene, set("integrator.method='rkmk8'"), "0.0025");
    std::set<std::string_view> checked;
    std::set<double> errors_of_rkmk4;
    for_each_method_choice([&](MethodChoice const& choice) {
      // Adaptive methods have no order in dt; adaptive_methods.cpp tests them.
      if (!choice.method.has_equal_steps() || !choice.has_meaning(kind)) return;
      checked.insert(choice.method.word);
      Arguments changes;
      for (auto const& assignment : choice.overrides()) changes = joined(changes, set(assignment));
      // These methods move one colour of the spins at a time. They refuse a field that the host
      // computes, because it is computed at all sites at once.
      if (choice.method.by_colour)
        changes = joined(changes, set("field.slab_demag={normal=[1,0,0]}"));
      auto const name = testing::PrintToString(changes);
      auto const error = [&](char const* dt) {
        return distance(end(scene, changes, dt), reference);
      };
      double coarse = error("0.02"), fine = error("0.01");
      EXPECT_GT(fine, 0) << name;
      if (choice.method.word == "rkmk4") {
        EXPECT_TRUE(errors_of_rkmk4.insert(fine).second) << "a word without effect: " << name;
      }
      double above = 0.4;
      if (fine <= floor) coarse = error("0.2"), fine = error("0.1"), above = 2;
      if (fine <= floor) coarse = error("0.5"), fine = error("0.25");
      EXPECT_GT(fine, floor) << name;
      // In long steps, terms of higher order raise the apparent order, hence the wider upper bound.
      EXPECT_GT(std::log2(coarse / fine), choice.method.order - 0.4) << name;
      EXPECT_LT(std::log2(coarse / fine), choice.method.order + above) << name;
      if (choice.isotropy != io::Isotropy::energy) return;
      auto const energies = read_dataset("out.h5", "/energy").values;
      EXPECT_NEAR(energies.back(), energies.front(), 2e-5) << name;
    });
    for (auto const* const method : io::methods())
      EXPECT_EQ(checked.contains(method->word),
                method->has_equal_steps() && (!method->by_colour || kind == io::SystemKind::llg))
          << method->word;
  }
};

// Returns a scene with a field that the host computes.
std::string spins_scene() {
  return R"toml([system]
kind = "llg"
damping = 0.0
[lattice]
shape = [7, 5]
[field]
exchange = 0.3
anisotropy = { constant = 0.6, axis = [0, 0.6, 0.8] }
applied = [0.3, 0.1, 0.4]
slab_demag = { normal = [1, 0, 0], where = "host" }
[initial]
expression = ["0.3+0.2*cos(pi*x)", "0.5+0.1*cos(2*pi*y)", "0.8-x*y"]
[integrator]
method = "rkmk4"
dt = 0.02
end = 1.0
)toml";
}

std::string tensor_bodies_scene() {
  return R"toml([system]
kind = "rigid_body"
inertia = [[0.5, 0.1, 0.0], [0.1, 0.3, -0.05], [0.0, -0.05, 0.2]]
[lattice]
shape = [5]
[initial]
random = { seed = 3 }
[integrator]
method = "rkmk4"
dt = 0.02
end = 1.0
)toml";
}

TEST_F(AllMethods, OnSpinsHaveTheirOrder) {
  expect_orders(spins_scene(), io::SystemKind::llg, 1e-12);
}

TEST_F(AllMethods, OnRigidBodiesHaveTheirOrder) {
  expect_orders(tensor_bodies_scene(), io::SystemKind::rigid_body, 1e-12);
}

// In a field that depends on time, the analytic sigma needs dH/dt. With dH/dt, runs with the
// analytic and the finite-difference sigma differ at second order in dt; without dH/dt, at first
// order.
TEST_F(AllMethods, AnalyticSigmaSeesAFieldInTime) {
  auto const with = [&](std::string const& isotropy, char const* dt) {
    return end(spins_scene(),
               set("field.applied=['0.7*cos(3*t)','0.7*sin(3*t)','0.4']",
                   "integrator.method='euler'", "integrator.isotropy='" + isotropy + "'"),
               dt);
  };
  double const coarse = distance(with("analytic", "0.01"), with("finite_difference", "0.01"));
  double const fine = distance(with("analytic", "0.005"), with("finite_difference", "0.005"));
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.25);
}

TEST_F(AllMethods, AnImplicitStepThatIsNotSolvedEndsTheRun) {
  auto const outcome =
      run_into("out.h5", spins_scene(),
               set("integrator={method='implicit_midpoint',dt=1e7,steps=3}", "field.exchange=1e4",
                   "lattice.shape=[200]", "field.slab_demag={normal=[1,0,0]}"));
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(contains_all(
      behind_warning(outcome.errors),
      {": integrator.dt: the equation of the step from t = 0 is not solved; accepted: a smaller dt",
       "the last good frame is 0"}));
}

}  // namespace
}  // namespace cayspin::program::test
