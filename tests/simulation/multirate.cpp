// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Expensive (multirate) fields in scenes: orders of convergence, numbers of evaluations, bitwise
// identical results of interrupted runs, and refused scenes.
#include "scenes_of_text.hpp"
#include "simulation/multirate_method.hpp"
#include "simulation/variant.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace cayspin::simulation::test {
namespace {

io::Scene film_on_host(std::string const& integrator, std::vector<std::string> const& overrides = {
                                                          "field.slab_demag.multirate=true"}) {
  return scene_of(R"toml(
[system]
kind = "llg"
damping = 0.1
[lattice]
shape = [8, 6]
boundary = ["periodic", "open"]
[field]
exchange = 0.5
anisotropy = { constant = 0.4, axis = [1, 2, 3] }
applied = ["0.3*cos(2*t)", 0, 0.2]
slab_demag = { normal = [1, 0, 0], strength = 0.8, where = "host" }
[initial]
random = { seed = 5 }
[integrator]
)toml" + integrator,
                  overrides);
}

TEST(MultirateFields, OfScenesHaveOrderThreeOrFour) {
  auto const exact = end_of(film_on_host("method='rkmk8'\ndt=0.002\nsteps=500", {}));
  for (auto const& [method, order] : {std::pair{"heun", 2}, {"rkmk4", 3}, {"rkmk8", 4}}) {
    double errors[2];
    for (int i = 0; i < 2; ++i) {
      int const steps = 40 << i;
      errors[i] = largest_distance(
          end_of(film_on_host(
              fmt::format("method='{}'\nsubsteps=2\ndt={}\nsteps={}", method, 1. / steps, steps))),
          exact);
    }
    std::printf("    %-14s error %.1e, order %.2f\n", method, errors[1],
                std::log2(errors[0] / errors[1]));
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), order, 0.3) << method;
  }
}

// Expensive fields also work with torques, and with vacant and frozen sites.
TEST(MultirateFields, BesideCurrentsAndSitesOfTheirOwn) {
  std::vector<std::string> const others{
      "torque={ zhang_li = { velocity = [0.2, 0, 0], nonadiabaticity = 0.1 } }",
      "lattice.occupied='i != 3 || j > 1'", "lattice.frozen='i == 0'"};
  auto multirate = others;
  multirate.push_back("field.slab_demag.multirate=true");
  auto const exact = end_of(film_on_host("method='rkmk8'\ndt=0.005\nsteps=200", others));
  for (auto const& [method, limit] : {std::pair{"rkmk4", 4e-6}, {"rkmk5", 5e-7}}) {
    auto const scene = film_on_host(
        "method='" + std::string(method) + "'\nsubsteps=2\ndt=0.025\nsteps=40", multirate);
    double const error = largest_distance(end_of(scene), exact);
    std::printf("    %-14s error %.1e\n", method, error);
    EXPECT_LT(error, limit) << method;
  }
}

TEST(MultirateFields, HaveTheOrderThatTheSmallestDampingNeeds) {
  for (auto const& [damping, order] :
       {std::pair{"0.1", 3}, {"'0.1 + 0*i'", 3}, {"0.01", 4}, {"'0.01 + i'", 4}}) {
    auto const scene =
        film_on_host("method='rkmk4'\ndt=0.1\nsteps=1",
                     {"field.slab_demag.multirate=true", std::string("system.damping=") + damping});
    EXPECT_EQ(order_of_multirate(scene, find_variant(scene)), order) << damping;
  }
}

/// Returns a scene with a field of the program. `calls` counts the field's evaluations.
io::Scene with_own_field(std::string const& integrator, std::shared_ptr<int> const& calls) {
  auto scene = film_on_host(integrator, {"field={exchange=0.5}"});
  scene.field.own.nonlocal = [calls](io::HostVectors const& spins, io::HostVectors const& field,
                                     double) {
    ++*calls;
    auto const* const m = static_cast<double const*>(spins.data);
    auto* const h = static_cast<double*>(field.data);
    auto const& [nz, ny, nx] = spins.shape;
    for (std::int64_t j = 0; j < ny; ++j)
      for (std::int64_t i = 0; i < nx; ++i)
        for (std::int64_t c = 0; c < 3; ++c) {
          auto const at = [&](auto const& strides, std::int64_t x) {
            return j * strides[1] + x * strides[2] + c * strides[3];
          };
          h[at(field.strides, i)] =
              -0.3 * (m[at(spins.strides, (i + 3) % nx)] + m[at(spins.strides, (i + nx - 3) % nx)]);
        }
  };
  return scene;
}

// A function of Python must not be called while Ctrl-C has set an exception.
TEST(OwnFields, AreNotCalledAfterAnInterruptOfASearch) {
  for (std::string const lattice : {"lattice.occupied=\"i != 2\"", "lattice.moments=2.0"}) {
    auto const calls = std::make_shared<int>(0);
    auto scene = with_own_field("method='rkmk4'\ndt=0.1\nsteps=1", calls);
    auto given = scene.field.own;
    scene = io::with_overrides(scene, {lattice});
    // The search asks about twenty times a second whether it is interrupted.
    given.nonlocal = [inner = given.nonlocal](io::HostVectors const& spins,
                                              io::HostVectors const& field, double t) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      inner(spins, field, t);
    };
    scene.field.own = given;
    auto const run = SceneRun::open(scene, {});
    int at_interrupt = -1;
    run->relax({.torque = 1e-30, .interrupted = [&] {
                  if (*calls > 20) at_interrupt = *calls;
                  return *calls > 20;
                }});
    EXPECT_GT(at_interrupt, 20) << lattice;
    EXPECT_EQ(*calls, at_interrupt) << lattice;
  }
}

TEST(MultirateFields, OfAProgramAreEvaluatedOnceAStep) {
  auto const calls = std::make_shared<int>(0);
  auto const run =
      SceneRun::open(with_own_field("method='rkmk4'\nsubsteps=3\ndt=0.1\nsteps=100", calls), {});
  run->advance(1);
  int const looks = 1;  // evaluations by energy_guard, at the start
  EXPECT_EQ(*calls, looks + 2 + 3 * 4);
  *calls = 0;
  run->advance(20);
  EXPECT_EQ(*calls, 20);
  EXPECT_EQ(run->evaluations(), 3 * 4 * (1 + 2 * 20));
  run->sample();
  EXPECT_EQ(*calls, 21);
  auto const energies = run->energies();
  EXPECT_EQ(*calls, 22);
  EXPECT_NEAR(run->sample().energy.value, energies[0].second + energies[1].second, 1e-12);

  // Without substeps the field is evaluated in each stage.
  *calls = 0;
  SceneRun::open(with_own_field("method='rkmk4'\ndt=0.1\nsteps=100", calls), {})->advance(20);
  EXPECT_EQ(*calls, looks + 20 * 4);
}

TEST(MultirateFields, GoOnWithTheSameBits) {
  for (auto const precision : precisions)
    for (auto const& [method, cut] :
         {std::pair{"rkmk4", 1}, {"rkmk4", 2}, {"rkmk4", 3}, {"rkmk4", 11}, {"rkmk5", 4}}) {
      SCOPED_TRACE(fmt::format("{}, cut after {}", method, cut));
      auto const scene =
          film_on_host(fmt::format("method='{}'\nsubsteps=3\ndt=0.05\nsteps=20", method));
      auto const one_by_one = SceneRun::open(scene, {.precision = precision});
      for (int step = 0; step < 20; ++step) one_by_one->advance(1);
      EXPECT_TRUE(one_by_one->remembers());
      EXPECT_EQ(spins_of(*one_by_one), end_of(scene, precision));
      expect_same_bits_after_a_break(scene, cut, precision);
    }
}

TEST(MultirateFields, OfAProgramGoOnWithTheSameBits) {
  auto const calls = std::make_shared<int>(0);
  expect_same_bits_after_a_break(
      with_own_field("method='rkmk4'\nsubsteps=3\ndt=0.05\nsteps=20", calls), 7);
}

TEST(MultirateFields, AreRefusedInOneLine) {
  struct Wrong {
    std::string integrator;
    std::vector<std::string> overrides;
    std::string message;
  };
  std::string const rkmk4 = "method='rkmk4'\ndt=0.1\nsteps=9\n",
                    multirate = "field.slab_demag.multirate=true";
  std::string const takes_none = "takes no expensive field";
  std::vector<Wrong> wrong{
      {rkmk4 + "substeps=2", {}, "integrator.substeps: no term of the field is expensive"},
      {rkmk4 + "substeps=2\nenergy_control=true",
       {multirate, "system.damping=0", "field.applied=[0,0,1]"},
       "integrator.energy_control: does not go with an expensive field"},
      {rkmk4,
       {multirate, "thermal={temperature=0.1}", "integrator.dt=0.001"},
       "thermal.temperature: noise does not go with an expensive field"},
      {"method='euler'\nisotropy='analytic'\ndt=0.1\nsteps=9", {multirate}, takes_none},
      {"method='tsit5'\ntolerance=1e-4\nend=1", {multirate}, takes_none},
      {"method='series4'\ndt=0.1\nsteps=9", {multirate, "field.applied=[0,0,1]"}, takes_none},
      {rkmk4 + "compensated=true", {multirate}, takes_none}};
  for (char const* const method : {"ab2", "implicit_euler", "implicit_midpoint"})
    wrong.push_back(
        {"method='" + std::string(method) + "'\ndt=0.1\nsteps=9", {multirate}, takes_none});
  for (auto const& [integrator, overrides, message] : wrong) {
    SCOPED_TRACE(integrator);
    expect_refused([&] { return film_on_host(integrator, overrides); }, message);
  }
  // A field that is computed together with the program's own is multirate, too.
  auto scene = with_own_field(rkmk4 + "substeps=2", std::make_shared<int>(0));
  scene.field.slab_demag = io::SlabDemagnetization{.on_host = true, .multirate = true};
  EXPECT_NO_THROW(make_plan(scene, Precision::double_precision));
  scene.field.slab_demag.reset();
  scene.field.demag = io::Demagnetization{};
  scene.field.demag->multirate = false;
  expect_refused([&] { return scene; }, ".multirate: false does not go with substeps and a ");
}

TEST(MultirateFields, AreInThePlan) {
  auto const cheap =
      make_plan(film_on_host("method='rkmk4'\ndt=0.1\nsteps=9", {}), Precision::double_precision);
  auto const multirate = make_plan(film_on_host("method='rkmk4'\nsubsteps=4\ndt=0.1\nsteps=9"),
                                   Precision::double_precision);
  EXPECT_DOUBLE_EQ(multirate.stable_dt, 4 * cheap.stable_dt);
  EXPECT_DOUBLE_EQ(4 * multirate.turn, cheap.turn);
  EXPECT_EQ(multirate.memory.work, cheap.memory.work + 4 * cheap.memory.spins);
  EXPECT_EQ(multirate.memory.field, cheap.memory.field + cheap.memory.spins);
  auto const of = [](char const* set) {
    return make_plan(film_on_host("method='rkmk5'\ndt=0.1\nsteps=9", {set}),
                     Precision::double_precision)
        .memory;
  };
  EXPECT_EQ(of("field.slab_demag.multirate=true").work,
            of("field.slab_demag.multirate=false").work + 6 * cheap.memory.spins);
}

}  // namespace
}  // namespace cayspin::simulation::test
