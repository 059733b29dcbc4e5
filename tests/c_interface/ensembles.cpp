// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Each replica of an ensemble is bitwise identical to a simulation of its own. Calls from several
// threads take turns, and calls for the progress do not wait; run this test with -fsanitize=thread,
// too.
#include "c_interface_test.hpp"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

using namespace cayspin::test;

namespace {

std::string const heun_steps = "[integrator]\nmethod = \"heun\"\ndt = 0.02\nsteps = 100\n";

/// Returns a scene of a film whose spins start at random. `seed` is that of the start and of the
/// noise.
std::string film_text(std::string const& field, std::string const& temperature, int seed,
                      std::string const& integrator) {
  auto const number = std::to_string(seed);
  return "[system]\nkind = \"llg\"\ndamping = 0.2\n[lattice]\nshape = [4, 3]\n"
         "[field]\nexchange = 1.0\napplied = [0.1, 0.0, " +
         field + "]\n[thermal]\ntemperature = " + temperature + "\nseed = " + number +
         "\n[initial]\nrandom = { seed = " + number + " }\n" + integrator;
}

/// A scene with [ensemble], and the scenes of its replicas.
struct Films {
  std::string together;
  std::vector<std::string> alone;
};

/// Returns a film for each of the fields and temperatures; the keys in which they differ are
/// varied.
Films films_with(std::vector<std::string> const& fields,
                 std::vector<std::string> const& temperatures,
                 std::string const& integrator = heun_steps) {
  constexpr int seed = 5;
  auto const vary = [](std::string const& key, std::vector<std::string> const& values) {
    std::string list;
    bool differs = false;
    for (auto const& value : values) {
      list += (list.empty() ? "" : ", ") + value;
      differs = differs || value != values.front();
    }
    return differs ? "\"" + key + "\" = [" + list + "]\n" : std::string();
  };
  Films all;
  all.together = film_text(fields[0], temperatures[0], seed, integrator) +
                 "[ensemble]\nreplicas = " + std::to_string(fields.size()) + "\n[ensemble.vary]\n" +
                 vary("field.applied.2", fields) + vary("thermal.temperature", temperatures);
  for (std::size_t i = 0; i < fields.size(); ++i)
    all.alone.push_back(
        film_text(fields[i], temperatures[i], seed + static_cast<int>(i), integrator));
  return all;
}

/// Films that an ensemble steps one by one.
Films few_films(std::string const& temperature = "0.02",
                std::string const& integrator = heun_steps) {
  return films_with({"0.5", "0.25", "-0.2"}, {"0.0", temperature, temperature}, integrator);
}

/// Films that an ensemble steps together, as columns of a lattice.
Films many_films(bool thermal) {
  std::vector<std::string> temperatures;
  for (int i = 0; i < 20; ++i)
    temperatures.push_back(thermal ? "0.0" + std::to_string(10 + i) : std::string("0.0"));
  return films_with(std::vector<std::string>(20, "0.5"), temperatures);
}

/// Expects the numbers of all replicas to be bitwise identical to those of the simulations, which
/// are in the order of the replicas.
void expect_same_bits(cayspin_ensemble* ensemble, std::vector<Simulation> const& simulations) {
  std::size_t const count = simulations.size();
  std::vector<double> energies(count), magnetizations(3 * count);
  ASSERT_EQ(cayspin_ensemble_energies(ensemble, energies.data()), CAYSPIN_OK);
  ASSERT_EQ(cayspin_ensemble_magnetizations(ensemble, magnetizations.data()), CAYSPIN_OK);
  for (std::size_t replica = 0; replica < count; ++replica) {
    auto* const alone = simulations[replica].get();
    cayspin_array spins{}, expected{};
    ASSERT_EQ(cayspin_ensemble_borrow_spins(ensemble, static_cast<std::int64_t>(replica), &spins),
              CAYSPIN_OK);
    ASSERT_EQ(cayspin_borrow_spins(alone, &expected), CAYSPIN_OK);
    EXPECT_EQ(spins.precision, expected.precision);
    for (int axis = 0; axis < 4; ++axis) EXPECT_EQ(spins.shape[axis], expected.shape[axis]);
    EXPECT_EQ(numbers_of(spins), numbers_of(expected)) << "replica " << replica;
    double energy = 0, m[3] = {};
    ASSERT_EQ(cayspin_energy(alone, &energy), CAYSPIN_OK);
    ASSERT_EQ(cayspin_magnetization(alone, m), CAYSPIN_OK);
    EXPECT_EQ(energies[replica], energy) << "replica " << replica;
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(magnetizations[3 * replica + c], m[c]) << "replica " << replica;
  }
}

std::vector<Simulation> simulations_of(Films const& films, cayspin_precision precision) {
  std::vector<Simulation> simulations;
  for (auto const& scene : films.alone) simulations.push_back(open(scene, precision));
  return simulations;
}

int64_t steps_of_all(cayspin_ensemble const* ensemble) {
  int64_t steps = -1;
  EXPECT_EQ(cayspin_ensemble_steps(ensemble, &steps), CAYSPIN_OK);
  return steps;
}

TEST(CInterfaceEnsembles, StepWithTheBitsOfSimulations) {
  for (auto const& films : {few_films(), many_films(true)})
    for (auto const precision : {CAYSPIN_SINGLE, CAYSPIN_DOUBLE}) {
      auto const ensemble = open_ensemble(films.together, precision);
      auto const simulations = simulations_of(films, precision);
      int64_t replicas = 0;
      ASSERT_EQ(cayspin_ensemble_replicas(ensemble.get(), &replicas), CAYSPIN_OK);
      ASSERT_EQ(replicas, static_cast<int64_t>(simulations.size()));
      expect_same_bits(ensemble.get(), simulations);
      for (int64_t const count : {1, 7, 0, 12})
        ASSERT_EQ(cayspin_ensemble_step(ensemble.get(), count), CAYSPIN_OK) << cayspin_last_error();
      for (auto const& simulation : simulations)
        ASSERT_EQ(cayspin_step(simulation.get(), 20), CAYSPIN_OK) << cayspin_last_error();
      expect_same_bits(ensemble.get(), simulations);
      double time = -1, expected = -2;
      ASSERT_EQ(cayspin_ensemble_time(ensemble.get(), &time), CAYSPIN_OK);
      ASSERT_EQ(cayspin_time(simulations[0].get(), &expected), CAYSPIN_OK);
      EXPECT_EQ(time, expected);
      EXPECT_EQ(steps_of_all(ensemble.get()), 20);
    }
}

TEST(CInterfaceEnsembles, RelaxWithTheBitsOfSimulations) {
  for (auto const& films : {few_films("0.0", ""), few_films("0.0"), many_films(false)})
    for (auto const precision : {CAYSPIN_SINGLE, CAYSPIN_DOUBLE}) {
      bool const steps = films.together.find("[integrator]") != std::string::npos;
      auto const ensemble = open_ensemble(films.together, precision);
      auto const simulations = simulations_of(films, precision);
      auto const step = [&](int64_t count) {
        if (!steps) return;
        EXPECT_EQ(cayspin_ensemble_step(ensemble.get(), count), CAYSPIN_OK);
        for (auto const& simulation : simulations)
          EXPECT_EQ(cayspin_step(simulation.get(), count), CAYSPIN_OK);
      };
      step(5);
      std::vector<cayspin_minimum> found(simulations.size());
      ASSERT_EQ(cayspin_ensemble_relax(ensemble.get(), 1e-4, 100000, found.data()), CAYSPIN_OK)
          << cayspin_last_error();
      for (std::size_t replica = 0; replica < found.size(); ++replica) {
        cayspin_minimum own{};
        ASSERT_EQ(cayspin_relax(simulations[replica].get(), 1e-4, 100000, nullptr, &own),
                  CAYSPIN_OK);
        EXPECT_EQ(found[replica].converged, 1);
        EXPECT_EQ(found[replica].torque, own.torque);
        EXPECT_EQ(found[replica].energy, own.energy);
        EXPECT_EQ(found[replica].evaluations, own.evaluations);
      }
      expect_same_bits(ensemble.get(), simulations);
      step(3);
      expect_same_bits(ensemble.get(), simulations);
      EXPECT_EQ(steps_of_all(ensemble.get()), steps ? 8 : 0);
    }
}

// The spins are at rest, where until_torque would end a run.
TEST(CInterfaceEnsembles, TakeAllStepsInSpiteOfUntilTorque) {
  auto text = scene_text("[ensemble]\nreplicas = 2\n", "steps = 1000\nuntil_torque = 0.01");
  text.replace(text.find("uniform = [1.0, 0.0, 0.0]"), 25, "uniform = [0.0, 0.0, 1.0]");
  auto const ensemble = open_ensemble(text);
  for (int64_t const count : {300, 1, 200})
    ASSERT_EQ(cayspin_ensemble_step(ensemble.get(), count), CAYSPIN_OK) << cayspin_last_error();
  EXPECT_EQ(steps_of_all(ensemble.get()), 501);
}

TEST(CInterfaceEnsembles, LendTheSpinsOfAllReplicasInOneArray) {
  auto const ensemble = open_ensemble(few_films().together);
  cayspin_array first{}, third{}, again{};
  ASSERT_EQ(cayspin_ensemble_borrow_spins(ensemble.get(), 0, &first), CAYSPIN_OK);
  ASSERT_EQ(cayspin_ensemble_borrow_spins(ensemble.get(), 2, &third), CAYSPIN_OK);
  ASSERT_EQ(cayspin_ensemble_borrow_spins(ensemble.get(), 0, &again), CAYSPIN_OK);
  EXPECT_EQ(first.data, again.data);
  EXPECT_EQ(third.data, static_cast<double const*>(first.data) + 2 * 3 * 12);
  int64_t const shape[] = {1, 3, 4, 3}, strides[] = {36, 12, 3, 1};
  for (int axis = 0; axis < 4; ++axis) {
    EXPECT_EQ(third.shape[axis], shape[axis]);
    EXPECT_EQ(third.strides[axis], strides[axis]);
  }
}

TEST(CInterfaceEnsembles, StepAndLendInSeveralThreads) {
  auto const owner = open_ensemble(many_films(false).together);
  auto* const ensemble = owner.get();
  int64_t const count = 300;
  std::atomic<bool> done = false;
  std::atomic<int> failures = 0;
  auto const expect = [&](bool holds) { failures += holds ? 0 : 1; };
  auto const until_done = [&](auto const& call) {
    return std::thread([&done, call] {
      do {
        call();
        // A mutex is not fair: without a pause, the thread that steps might wait for long.
        std::this_thread::sleep_for(std::chrono::microseconds(50));
      } while (!done);
    });
  };
  std::vector<std::thread> others;
  others.push_back(until_done([&] {
    cayspin_array spins{};
    expect(cayspin_ensemble_borrow_spins(ensemble, 19, &spins) == CAYSPIN_OK &&
           spins.data != nullptr);
  }));
  others.push_back(until_done([&] {
    std::vector<double> energies(20), magnetizations(60);
    expect(cayspin_ensemble_energies(ensemble, energies.data()) == CAYSPIN_OK);
    expect(cayspin_ensemble_magnetizations(ensemble, magnetizations.data()) == CAYSPIN_OK);
  }));
  int64_t before = 0;
  others.push_back(until_done([&] {
    int64_t const steps = steps_of_all(ensemble);
    int64_t replicas = 0;
    double time = -1;
    expect(cayspin_ensemble_time(ensemble, &time) == CAYSPIN_OK);
    expect(cayspin_ensemble_replicas(ensemble, &replicas) == CAYSPIN_OK && replicas == 20);
    expect(before <= steps && steps <= count && static_cast<double>(steps) * 0.02 <= time + 1e-9);
    before = steps;
  }));
  for (int64_t i = 0; i < count; ++i) expect(cayspin_ensemble_step(ensemble, 1) == CAYSPIN_OK);
  std::vector<cayspin_minimum> found(20);
  expect(cayspin_ensemble_relax(ensemble, 1e-6, 100000, found.data()) == CAYSPIN_OK);
  done = true;
  for (auto& other : others) other.join();
  EXPECT_EQ(failures, 0);
  EXPECT_EQ(steps_of_all(ensemble), count);
}

}  // namespace
