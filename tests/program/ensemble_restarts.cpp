// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// --restart with [ensemble]: two runs in sequence are bitwise identical to one run.
#include "program_test.hpp"

#include <fmt/format.h>

#include <random>
#include <string>
#include <vector>

namespace cayspin::program::test {
namespace {

class EnsembleRestarts : public ProgramTest {
 protected:
  static std::string ensemble(int replicas, std::string const& keys = {}) {
    return fmt::format("[ensemble]\nreplicas = {}\n[ensemble.vary]\n{}", replicas, keys);
  }

  Outcome run(Arguments const& more) const {
    return start(joined({"run", "all.toml", "--quiet", "--overwrite"}, more));
  }

  /// Returns the last frame of a dataset (frame, ...).
  std::vector<double> last(std::string const& file, std::string const& name) const {
    auto const [extents, values] = read_dataset(file, name);
    return {values.end() - static_cast<std::ptrdiff_t>(values.size()) / extents[0], values.end()};
  }
};

TEST_F(EnsembleRestarts, HaveTheBitsOfOneRun) {
  std::mt19937 random(4);
  auto const one_of = [&](std::vector<std::string> const& choices) {
    return choices[random() % choices.size()];
  };
  for (int composition = 0; composition < 16; ++composition) {
    bool const is_crystal = composition % 4 == 3;
    // From 16 replicas on, small lattices without `couplings` are stepped as the columns of one
    // lattice.
    auto const many = one_of({"3", "17", "40"});
    auto const noise = one_of({"", "[thermal]\ntemperature = 0.05\nseed = 7\n"});
    auto const scene =
        fmt::format(
            "[system]\nkind = \"llg\"\ndamping = 0.1\n[lattice]\nshape = {}\n{}[field]\n"
            "{}\napplied = [0.3, 'sin(9 * t)', 0.1]\n[initial]\nrandom = {{ seed = 3 }}\n"
            "[integrator]\nmethod = \"{}\"\ndt = 0.02\nsteps = 13\n[output]\nevery = 4\n"
            "scalars_every = 3\n",
            is_crystal ? "[4, 3, 2]" : one_of({"[1]", "[20]", "[3, 1, 4]", "[3, 4, 2]"}),
            is_crystal ? "crystal = \"bcc\"\n" : "",
            is_crystal ? "couplings = { shells = [1.0] }" : "exchange = 1.0",
            one_of({"rkmk4", "heun", "cf4"})) +
        noise;
    auto const varied = one_of({"", "\"system.damping\" = { from = 0.1, to = 0.4 }\n",
                                noise.empty() ? ""
                                              : "\"thermal.temperature\" = { from = 0, to = "
                                                "0.3 }\n"});
    write("all.toml", scene + ensemble(std::stoi(many), varied));
    SCOPED_TRACE(scene + varied + many);
    Arguments const same{"--precision", one_of({"double", "single"}), "--threads",
                         one_of({"1", "2"})};
    ASSERT_EQ(run(joined(same, {"--output", "whole.h5"})).status, 0);
    ASSERT_EQ(run(joined(same, {"--output", "part.h5", "--set", "integrator.steps=6"})).status, 0);
    auto const outcome = run(joined(same, {"--output", "rest.h5", "--restart", "part.h5"}));
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_EQ(read_dataset("rest.h5", "/step").values, (std::vector<double>{6, 8, 12, 13}));
    EXPECT_EQ(read_dataset("rest.h5", "/scalars/step").values, (std::vector<double>{6, 9, 12, 13}));
    for (std::string const name : {"/spins", "/energy", "/norm_defect", "/magnetization", "/time",
                                   "/scalars/energy", "/scalars/time"})
      EXPECT_EQ(last("rest.h5", name), last("whole.h5", name)) << name;
    auto const first = read_dataset("rest.h5", "/spins").values, before = last("part.h5", "/spins");
    EXPECT_TRUE(std::equal(before.begin(), before.end(), first.begin()));
  }
}

TEST_F(EnsembleRestarts, AfterAnInterruptHaveTheBitsOfOneRun) {
  write("all.toml", chain_scene() + ensemble(3));
  Arguments const steps = set("integrator.steps=20000", "output.every=50");
  auto const outcome = start(joined({"run", "all.toml", "--quiet", "--output", "part.h5"}, steps),
                             {.interrupt_after = 0.1, .interrupt_when = in_folder("part.h5")});
  ASSERT_EQ(outcome.status, 130);
  ASSERT_EQ(run(joined(steps, {"--output", "rest.h5", "--restart", "part.h5"})).status, 0);
  ASSERT_EQ(run(joined(steps, {"--output", "whole.h5"})).status, 0);
  EXPECT_EQ(last("rest.h5", "/spins"), last("whole.h5", "/spins"));
}

// In SI the reduced unit of time depends on alpha, so it differs between replicas.
TEST_F(EnsembleRestarts, WithVariedDampingInSiHaveTheBitsOfOneRun) {
  write("all.toml", R"(units = "SI"
[material]
Ms = 8e5
A = 1.3e-11
alpha = 0.1
damping_form = "gilbert"
[system]
kind = "llg"
[lattice]
shape = [6, 5]
spacing = [4e-9, 4e-9, 3e-9]
[field]
slab_demag = { normal = [0, 0, 1] }
[initial]
random = { seed = 5 }
[integrator]
method = "heun"
dt = 1e-13
steps = 13
[output]
every = 3
)" + ensemble(2, "\"material.alpha\" = { from = 0.2, to = 0.5 }\n"));
  ASSERT_EQ(run({"--output", "whole.h5"}).status, 0);
  ASSERT_EQ(run({"--output", "part.h5", "--set", "integrator.steps=6"}).status, 0);
  auto const outcome = run({"--output", "rest.h5", "--restart", "part.h5"});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  for (std::string const name : {"/spins", "/energy", "/time", "/step"})
    EXPECT_EQ(last("rest.h5", name), last("whole.h5", name)) << name;
}

TEST_F(EnsembleRestarts, NameWhatDiffers) {
  write("all.toml", chain_scene() + ensemble(3));
  ASSERT_EQ(run({"--output", "part.h5", "--set", "integrator.steps=5"}).status, 0);
  auto const outcome = start({"run", "all.toml", "--quiet", "--output", "rest.h5", "--restart",
                              "part.h5", "--set", "system.damping=0.7"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.errors,
            "warning: --restart part.h5: these keys differ from its scene: system.damping\n");
}

// Noise depends on the numbers of the steps, which another dt would change.
TEST_F(EnsembleRestarts, WithNoiseInAnyReplicaNeedTheSameDt) {
  write("all.toml", chain_scene() + ensemble(2, "\"thermal.temperature\" = [0, 0.1]\n"));
  ASSERT_EQ(run({"--output", "part.h5", "--set", "integrator.steps=4"}).status, 0);
  Arguments const restart{"run",     "all.toml",  "--quiet", "--output",
                          "rest.h5", "--restart", "part.h5"};
  expect_refused(joined(restart, {"--set", "integrator.dt=0.01"}),
                 "accepted: the dt it was run with\n");
  EXPECT_EQ(start(restart).status, 0);
}

TEST_F(EnsembleRestarts, AreRefusedInOneLine) {
  write("one.toml", chain_scene());
  write("all.toml", chain_scene() + ensemble(3));
  expect_status(0, {"run", "one.toml", "--quiet", "--output", "one.h5"});
  ASSERT_EQ(run({"--output", "part.h5", "--set", "integrator.steps=5"}).status, 0);
  auto const refused = [&](Arguments const& more, std::string const& part) {
    expect_refused(joined({"run", "all.toml", "--quiet", "--output", "rest.h5"}, more), part);
    EXPECT_FALSE(exists("rest.h5"));
    EXPECT_FALSE(exists("rest.h5.partial"));
  };
  Arguments const from_part{"--restart", "part.h5"};
  refused({"--restart", "one.h5"}, "--restart one.h5: it is of a scene without [ensemble]");
  refused({"--restart", "none.h5"}, "none.h5");
  refused({"--restart", "all.toml"}, "all.toml");
  refused(joined(from_part, {"--set", "ensemble.replicas=4"}),
          "it has 3 replicas, and the scene has 4");
  refused(joined(from_part, {"--precision", "single"}), "its spins are in double precision");
  refused(joined(from_part, {"--set", "lattice.shape.0=21"}), "its lattice is");
  refused(joined(from_part, {"--set", "integrator.steps=5"}), "it ends at step 5, the scene at");
  refused(joined(from_part, {"--set", "integrator.dt=0.3"}), "not at that many steps of dt");
  expect_refused({"run", "all.toml", "--overwrite", "--output", "part.h5", "--restart", "part.h5"},
                 "part.h5: the command reads it, and would replace it");
  expect_refused({"run", "one.toml", "--output", "rest.h5", "--restart", "part.h5"},
                 "part.h5: it is of an ensemble; accepted: a scene with [ensemble]");
  for (auto const& method :
       {"{method='tsit5',tolerance=1e-6,dt=0.1,steps=20}", "{method='ab2',dt=0.01,steps=20}"}) {
    Arguments const with_memory =
        set(fmt::format("integrator={}", method), "output.checkpoint_every=0");
    ASSERT_EQ(
        run(joined(with_memory, {"--output", "memory.h5", "--set", "integrator.steps=5"})).status,
        0);
    refused(joined(with_memory, {"--restart", "memory.h5"}), "needs more than its frames");
  }
}

}  // namespace
}  // namespace cayspin::program::test
