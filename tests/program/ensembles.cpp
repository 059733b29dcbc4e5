// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// [ensemble]: one file, in which each replica is bitwise identical to a separate run.
#include "program_test.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace cayspin::program::test {
namespace {

class Ensembles : public ProgramTest {
 protected:
  static constexpr std::int64_t replicas = 3;

  static std::string vary(std::string const& keys, std::int64_t count = replicas) {
    return fmt::format("[ensemble]\nreplicas = {}\n[ensemble.vary]\n{}", count, keys);
  }

  Outcome run_ensemble(std::string const& scene, Arguments const& more = {}) const {
    write("all.toml", scene);
    return expect_status(
        0, joined({"run", "all.toml", "--quiet", "--overwrite", "--output", "all.h5"}, more));
  }

  /// Returns the values of one replica in a dataset (frame, replica, ...).
  std::vector<double> of_replica(std::string const& name, std::int64_t replica) const {
    auto const [extents, values] = read_dataset("all.h5", name);
    std::int64_t row = 1;
    for (std::size_t axis = 2; axis < extents.size(); ++axis) row *= extents[axis];
    std::vector<double> found;
    for (std::int64_t frame = 0; frame < extents[0]; ++frame) {
      auto const from = values.begin() + (frame * extents[1] + replica) * row;
      found.insert(found.end(), from, from + row);
    }
    return found;
  }

  /// Expects a separate run of `scene` to be bitwise identical to the replica, in the datasets of
  /// frames and of samples.
  void expect_run(std::int64_t replica, std::string const& scene, Arguments const& more) const {
    write("one.toml", scene);
    auto const outcome =
        start(joined({"run", "one.toml", "--quiet", "--overwrite", "--output", "one.h5"}, more));
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    for (std::string const name : {"/spins", "/energy", "/norm_defect", "/magnetization",
                                   "/scalars/energy", "/scalars/magnetization"})
      EXPECT_EQ(of_replica(name, replica), read_dataset("one.h5", name).values)
          << name << " of replica " << replica;
    for (std::string const name : {"/time", "/step", "/scalars/time", "/scalars/step"})
      EXPECT_EQ(read_dataset("all.h5", name).values, read_dataset("one.h5", name).values) << name;
  }
};

TEST_F(Ensembles, HaveTheBitsOfTheirRuns) {
  auto const thermal = chain_scene() + "[thermal]\ntemperature = 0.05\nseed = 7\n";
  auto const values = vary(
      "\"field.applied.2\" = [0.1, 0.2, -0.5]\n\"thermal.temperature\" = { from = 0, to = 0.02 }\n"
      "\"system.damping\" = [0.1, 0.3, 0.2]\n\"field.exchange\" = [1, 0.5, 2.5]\n");
  for (std::string const method : {"rkmk4", "heun"})
    for (std::string const precision : {"double", "single"}) {
      auto const same = joined({"--precision", precision, "--threads", "1"},
                               set("integrator.method='" + method + "'", "output.scalars_every=2"));
      run_ensemble(thermal + values, same);
      auto const spins = read_dataset("all.h5", "/spins");
      EXPECT_EQ(spins.extents, (std::vector<std::int64_t>{4, replicas, 1, 3, 20, 3}));
      EXPECT_EQ(read_dataset("all.h5", "/vary/thermal.temperature").values,
                (std::vector<double>{0, 0.01, 0.02}));
      EXPECT_EQ(read_dataset("all.h5", "/vary/field.exchange").values,
                (std::vector<double>{1, 0.5, 2.5}));
      auto const own = [](std::string const& field, std::string const& temperature,
                          std::string const& damping, std::string const& exchange, int replica) {
        return set("field.applied.2=" + field, "thermal.temperature=" + temperature,
                   "system.damping=" + damping, "field.exchange=" + exchange,
                   fmt::format("thermal.seed={}", 7 + replica),
                   fmt::format("initial.random.seed={}", 3 + replica));
      };
      expect_run(0, thermal, joined(same, own("0.1", "0", "0.1", "1", 0)));
      expect_run(1, thermal, joined(same, own("0.2", "0.01", "0.3", "0.5", 1)));
      expect_run(2, thermal, joined(same, own("-0.5", "0.02", "0.2", "2.5", 2)));
    }
}

TEST_F(Ensembles, HaveTheirOwnNoiseIfOnlyTheyAreThermal) {
  auto const heun = set("integrator.method='heun'", "output.scalars_every=2");
  run_ensemble(chain_scene() + vary("\"thermal.temperature\" = [0.1, 0.1, 0.1]\n"), heun);
  for (int replica = 0; replica < 3; ++replica)
    expect_run(replica, chain_scene(),
               joined(heun, set("thermal.temperature=0.1", fmt::format("thermal.seed={}", replica),
                                fmt::format("initial.random.seed={}", 3 + replica))));
}

TEST_F(Ensembles, ChooseTheirOwnSteps) {
  Arguments const adaptive =
      set("integrator={method='tsit5',tolerance=1e-6,dt=0.1,steps=20}", "output.every=5");
  run_ensemble(chain_scene() + vary("\"field.exchange\" = [0.1, 1, 30]\n"), adaptive);
  for (int replica = 0; replica < 3; ++replica)
    expect_run(
        replica, chain_scene(),
        joined(adaptive, set(std::vector<std::string>{"field.exchange=0.1", "field.exchange=1",
                                                      "field.exchange=30"}[replica],
                             fmt::format("initial.random.seed={}", 3 + replica))));
}

// Small lattices with only nearest-neighbour terms are stepped as the columns of one lattice.
TEST_F(Ensembles, OfSmallLatticesHaveTheBitsOfTheirRuns) {
  std::mt19937 random(20);
  auto const one_of = [&](std::vector<std::string> const& choices) {
    return choices[random() % choices.size()];
  };
  constexpr std::int64_t many = 37;
  int compared = 0;
  for (int composition = 0; composition < 24; ++composition) {
    auto const shape =
        one_of({"[1]", "[1]", "[8]", "[1, 7]", "[1, 1, 6]", "[4, 5]", "[3, 1, 4]", "[100]"});
    auto const scene = fmt::format(
        R"([system]
kind = "llg"
damping = {}
[lattice]
shape = {}
boundary = {}
[field]
exchange = {}
{}
applied = [0.3, {}, 0.1]
[initial]
{}
[integrator]
method = "{}"
{}
dt = 0.02
steps = 13
[output]
every = 6
scalars_every = 5
)",
        one_of({"0", "0.1", "1.5"}), shape, one_of({"'open'", "'periodic'"}),
        one_of({"0.0", "1.0", "-0.7"}),
        one_of(
            {"", "anisotropy = { constant = 0.5, axis = [0, 3, 4] }",
             "anisotropy = [{ constant = 0.5, axis = [0, 0, 1] }, { constant = -0.2, axis = [0, 1, "
             "1] }]",
             "anisotropy = { cubic = 0.4, axes = [[1, 0, 0], [0, 1, 0]] }",
             "slab_demag = { normal = [1, 0, 0] }",
             "torque = { slonczewski = { damping_like = 0.2, field_like = 0.1, polarization = [0, "
             "1, 0] } }"}),
        one_of({"-0.2", "'sin(9 * t)'"}),
        one_of({"random = { seed = 3 }", "uniform = [1, 2, 3]", "expression = ['1', 'i', '0.3']"}),
        one_of({"rkmk4", "rkmk4", "heun", "euler", "ab2", "cf4", "series4", "rkmk5",
                "projected_rk4", "classical_heun"}),
        one_of({"", "", "compensated = true", "generator = 'tangent'",
                "isotropy = { constant = 0.3 }"}));
    std::string const noise = one_of({"", "[thermal]\ntemperature = 0.05\nseed = 7\n",
                                      "[thermal]\ntemperature = '0.1 * t'\nseed = 5\n"});
    bool const varies = noise.find("0.05") != noise.npos && random() % 2 == 0;
    write("all.toml", scene + noise + "[ensemble]\nreplicas = 1\n");
    auto const checked = start({"check", "all.toml"}).status;
    EXPECT_TRUE(checked == 0 || checked == 2) << checked << ": " << scene << noise;
    if (checked != 0) continue;  // e.g. a method that refuses noise
    Arguments const same{"--precision", one_of({"double", "single"}), "--threads",
                         one_of({"1", "2"})};
    // Some runs print a warning, for example of a large dt, so only the status is checked.
    write("all.toml",
          scene + noise +
              vary(varies ? "\"thermal.temperature\" = { from = 0, to = 0.3 }\n" : "", many));
    auto const outcome =
        start(joined({"run", "all.toml", "--quiet", "--overwrite", "--output", "all.h5"}, same));
    ASSERT_EQ(outcome.status, 0) << outcome.errors << scene << noise;
    ++compared;
    for (int const replica : {0, 1, 16, 36}) {
      Arguments own;
      if (scene.find("random") != scene.npos)
        own = set(fmt::format("initial.random.seed={}", 3 + replica));
      if (!noise.empty())
        own = joined(own, set(fmt::format("thermal.seed={}",
                                          (noise.find("0.05") == noise.npos ? 5 : 7) + replica)));
      if (varies) {
        double const share = replica / 36.0;
        own =
            joined(own, set(fmt::format("thermal.temperature={}", (1 - share) * 0 + share * 0.3)));
      }
      SCOPED_TRACE(scene + noise);
      expect_run(replica, scene + noise, joined(same, own));
    }
  }
  EXPECT_GT(compared, 5);  // `check` refuses the others
}

// The threads share the replicas: kernels, transforms and noise of one replica run on one thread.
TEST_F(Ensembles, HaveTheSameBitsSideBySide) {
  auto const scene = chain_scene() + "[thermal]\ntemperature = 0.05\nseed = 7\n" +
                     vary("\"field.applied.2\" = { from = 0.1, to = 2 }\n", 9);
  for (std::string const demag : {"false", "true"}) {
    auto const with = set("field={exchange=1.0,applied=[0,0,0.1],demag=" + demag + "}",
                          "integrator.steps=40", "output.every=7");
    run_ensemble(scene, joined(with, {"--threads", "1"}));
    auto const alone = read_dataset("all.h5", "/spins").values;
    for (int i = 0; i < 3; ++i) {
      run_ensemble(scene, joined(with, {"--threads", "2"}));
      EXPECT_EQ(read_dataset("all.h5", "/spins").values, alone) << "demag " << demag;
    }
  }
}

TEST_F(Ensembles, NameTheReplicaWhoseNumbersFail) {
  auto const scene =
      chain_scene() + vary("\"field.applied.2\" = [0.1, 1e300, 0.2, 1e300, 0.3]\n", 5);
  write("all.toml", scene);
  for (std::string const threads : {"1", "2"}) {
    auto const outcome = start(joined(
        {"run", "all.toml", "--quiet", "--overwrite", "--output", "all.h5", "--threads", threads},
        set("integrator.method='classical_euler'", "integrator.steps=1000", "output.every=30")));
    EXPECT_EQ(outcome.status, 3) << outcome.errors;
    EXPECT_TRUE(contains(outcome.errors, "replica 1: ")) << outcome.errors;
    EXPECT_TRUE(contains(outcome.errors, "the last good frame is 0 in ")) << outcome.errors;
    for (double const number : read_dataset("all.h5", "/spins").values)
      ASSERT_TRUE(std::isfinite(number));
  }
}

TEST_F(Ensembles, OfCrystalsLieSiteBySite) {
  auto const crystal = chain_scene() + vary("\"field.couplings.shells.0\" = [1, 2, 3]\n");
  Arguments const of_crystal = set("lattice={shape=[3,2,2],crystal='bcc',boundary='periodic'}",
                                   "field={couplings={shells=[1.0]},applied=[0,0,0.5]}");
  run_ensemble(crystal, of_crystal);
  EXPECT_EQ(read_dataset("all.h5", "/spins").extents,
            (std::vector<std::int64_t>{4, replicas, 2, 2, 2, 3, 3}));
  for (int replica = 0; replica < 3; ++replica)
    expect_run(replica, chain_scene(),
               joined(of_crystal, set(fmt::format("field.couplings.shells.0={}", replica + 1),
                                      fmt::format("initial.random.seed={}", 3 + replica))));
}

// A spin falls at a rate proportional to its damping, so replicas come to rest at different times.
TEST_F(Ensembles, EndEachByItself) {
  auto const scene = macrospin_scene();
  Arguments const until =
      set("integrator.until_torque=1e-4", "integrator.end=400", "output={every=1000000}");
  run_ensemble(scene + vary("\"system.damping\" = [1.0, 0.3]\n", 2), until);
  auto const last = [&](std::string const& name) {
    auto const values = read_dataset(name, "/spins").values;
    return std::vector<double>(values.end() - 3, values.end());
  };
  write("one.toml", scene);
  for (int replica = 0; replica < 2; ++replica) {
    output_of(
        joined({"run", "one.toml", "--quiet", "--overwrite", "--output", "one.h5"},
               joined(until, set(replica == 0 ? "system.damping=1.0" : "system.damping=0.3"))));
    auto const all = of_replica("/spins", replica);
    EXPECT_EQ(std::vector<double>(all.end() - 3, all.end()), last("one.h5")) << replica;
  }
}

TEST_F(Ensembles, AreRelaxedEachToItsOwnEquilibrium) {
  // Stoner-Wohlfarth with the field across the easy axis: m_x = h / K.
  write("film.toml", R"([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [2, 2]
[field]
exchange = 1.0
anisotropy = { constant = 1.0, axis = [0, 0, 1] }
applied = [0.0, 0, 0]
[initial]
uniform = [0.1, 0, 1]
)" + vary("\"field.applied.0\" = { from = 0.2, to = 0.8 }\n", 4));
  auto const said = output_of({"relax", "film.toml", "-o", "all.h5", "--torque", "1e-10"});
  EXPECT_TRUE(contains(said, "all.h5: 4 of 4 replicas converged")) << said;
  EXPECT_EQ(read_dataset("all.h5", "/converged").values, std::vector<double>(4, 1));
  auto const m = read_dataset("all.h5", "/magnetization").values;
  for (std::size_t replica = 0; replica < 4; ++replica)
    EXPECT_NEAR(m[3 * replica], 0.2 + 0.2 * static_cast<double>(replica), 1e-9);
  auto const evaluations = read_dataset("all.h5", "/evaluations").values;
  for (double const count : evaluations) EXPECT_GT(count, 1);
  auto const info = output_of({"info", "all.h5"});
  EXPECT_TRUE(contains_all(info, {"an ensemble of 4 replicas", "vary field.applied.0 0.2 to 0.8",
                                  "replica 3    energy", "converged    4 of 4 replicas"}))
      << info;
}

TEST_F(Ensembles, AreCheckedWithTheShapeOfTheirStart) {
  write("one.toml", chain_scene());
  output_of(
      joined({"run", "one.toml", "--quiet", "--output", "one.h5"}, set("lattice.occupied='i!=1'")));
  write("all.toml", chain_scene() + vary("\"field.exchange\" = [1, 2, 3]\n"));
  for (std::string const command : {"check", "run"}) {
    auto const outcome = start(
        joined({command, "all.toml"}, set("initial={file='one.h5'}", "output.file='all.h5'")));
    EXPECT_EQ(outcome.status, 0) << command << ": " << outcome.errors;
  }
}

TEST_F(Ensembles, AreNoStartOfACrystal) {
  run_ensemble(chain_scene() + vary("\"field.exchange\" = [1, 2]\n", 2));
  auto const shape = read_dataset("all.h5", "/spins").extents;
  write("crystal.toml", chain_scene());
  expect_refused(joined({"run", "crystal.toml", "--output", "b.h5"},
                        set(fmt::format("lattice={{shape=[{},{},{}],crystal='bcc'}}", shape[4],
                                        shape[3], shape[2]),
                            "field={couplings={shells=[1.0]}}", "initial={file='all.h5'}")),
                 "it is the file of an ensemble");
}

TEST_F(Ensembles, AreChecked) {
  write("all.toml", chain_scene() + vary("\"field.exchange\" = [1, 2, 3]\n"));
  EXPECT_TRUE(contains(output_of({"check", "all.toml"}),
                       "3 replicas, which vary in field.exchange; the lines below describe the "
                       "first replica, and the memory of one\n"));
}

TEST_F(Ensembles, AreRefusedInOneLine) {
  auto const refused = [&](std::string const& table, std::string const& part,
                           Arguments const& more = {}) {
    write("all.toml", chain_scene() + table);
    expect_refused(joined({"run", "all.toml", "--output", "all.h5"}, more), part);
    EXPECT_FALSE(exists("all.h5")) << table;
    EXPECT_FALSE(exists("all.h5.partial")) << table;
  };
  refused("[ensemble]\nvary = {}\n", "ensemble.replicas: is missing");
  refused("[ensemble]\nreplicas = 0\n", "ensemble.replicas: 0 is too small");
  refused("[ensemble]\nreplicas = 2\ncopies = 3\n", "ensemble.copies: unknown key");
  refused(vary("\"lattice.spacing\" = [1, 2, 3]\n"), "must be the same in all replicas");
  refused(vary("\"integrator.dt\" = [1, 2, 3]\n"), "must be the same in all replicas");
  refused(vary("\"field.exchange\" = [1, 2]\n"), "accepted: as many numbers as replicas");
  refused(vary("\"field.exchange\" = { from = 1 }\n"), "to: is missing");
  refused(vary("\"field.exchange\" = 'x'\n"), "as many numbers as replicas");
  refused(vary("\"field.exchang\" = [1, 2, 3]\n"), "ensemble.vary: in replica 0: field.exchang");
  refused(vary("\"system.damping\" = [0, 0.1, -1]\n"),
          "ensemble.vary: in replica 2: system.damping: -1 is negative");
  refused(vary(""), "integrator.method: \"auto\" does not go with an ensemble",
          set("integrator={method='auto',error=1e-3,end=1.0}"));
  for (std::string const key : {"thermal.seed", "initial.random.seed"})
    refused(vary("") + "[thermal]\ntemperature = 0.1\n",
            key + ": 9223372036854775806 is too large for 3 replicas",
            set(key + "=9223372036854775806"));
  refused(vary(""), "output.terms: does not go with an ensemble", set("output.terms=true"));
  refused(vary(""), "output.chunk: does not go with an ensemble", set("output.chunk=1"));
  refused(vary("") + "[[stage]]\nrelax = true\n", "stage: does not go with an ensemble");
  write("all.toml", chain_scene() + vary(""));
  for (Arguments const& command :
       {Arguments{"trade", "all.toml"}, Arguments{"modes", "all.toml"},
        Arguments{"run", "all.toml", "--ranks", "1,1", "-o", "all.h5"},
        Arguments{"sweep", "all.toml", "--over", "system.damping=1,2", "-o", "sweep.h5"}})
    expect_refused(command, "takes no ensemble");
}

TEST_F(Ensembles, KeepWholeFramesWhenInterrupted) {
  write("all.toml", chain_scene() + vary(""));
  auto const outcome = start({"run", "all.toml", "--quiet", "--output", "all.h5", "--set",
                              "integrator.steps=2000000", "--set", "output.every=50"},
                             {.interrupt_after = 0.3, .interrupt_when = in_folder("all.h5")});
  EXPECT_EQ(outcome.status, 130);
  EXPECT_TRUE(is_one_line(outcome.errors)) << outcome.errors;
  EXPECT_TRUE(contains(outcome.errors, "interrupted after step "));
  auto const info = output_of({"info", "all.h5"});
  EXPECT_TRUE(contains(info, "complete     no")) << info;
  for (double const number : read_dataset("all.h5", "/spins").values)
    ASSERT_FALSE(std::isnan(number));
}

}  // namespace
}  // namespace cayspin::program::test
