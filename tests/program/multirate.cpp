// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Expensive fields (multirate) in the program's commands.
#include "program_test.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <string>

namespace cayspin::program::test {
namespace {

class MultirateFields : public ProgramTest {
 protected:
  MultirateFields() {
    write("scene.toml", R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [9, 7]
[field]
exchange = 0.5
applied = [0.1, 0.2, 0.3]
slab_demag = { normal = [1, 0, 0], where = "host", multirate = true }
[initial]
random = { seed = 5 }
[integrator]
method = "rkmk4"
substeps = 3
dt = 0.1
steps = 20
)toml");
  }
  void run(std::string const& file, Arguments const& more = {}) const {
    output_of(joined({"run", "scene.toml", "--quiet", "--output", file}, more));
  }
  Arguments const steps_of_12 = set("integrator.steps=12");
};

TEST_F(MultirateFields, RunAndGoOnWithTheSameBits) {
  for (std::string const precision : {"double", "single"}) {
    Arguments const same{"--overwrite", "--precision", precision, "--set",
                         "output.checkpoint_every='4 steps'"};
    run("whole.h5", same);
    run("first.h5", joined(same, steps_of_12));
    run("second.h5", joined(same, {"--restart", "first.h5", "--space", another_space}));
    EXPECT_EQ(last_spins("second.h5"), last_spins("whole.h5"));
    auto const whole = info_of("whole.h5");
    EXPECT_EQ(whole.cost.evaluations, 3 * 4 * (1 + 2 * 19));
    EXPECT_EQ(info_of("second.h5").cost.evaluations, 3 * 4 * 2 * 8);
  }
}

TEST_F(MultirateFields, NeedTheirCheckpoint) {
  run("first.h5", joined(steps_of_12, set("output.checkpoint_every=0")));
  expect_refused({"run", "scene.toml", "--output", "second.h5", "--restart", "first.h5"},
                 "the run needs more than its frames");
}

TEST_F(MultirateFields, AreChecked) {
  EXPECT_TRUE(
      contains_all(output_of({"check", "scene.toml"}),
                   {"multirate: computed on the host once a step", "rkmk4 in 3 substeps", "order 3",
                    "1 evaluation of the expensive field and 24 of the others per step"}));
  auto const numbers = nlohmann::json::parse(output_of({"check", "scene.toml", "--json"}));
  EXPECT_EQ(numbers.at("order"), 3);
  EXPECT_EQ(numbers.at("evaluations_per_step"), 24);
  // At small damping, order 3 would broaden resonance lines, and order 4 costs no more.
  auto const at_small_damping = nlohmann::json::parse(
      output_of(joined({"check", "scene.toml", "--json"}, set("system.damping=0.008"))));
  EXPECT_EQ(at_small_damping.at("order"), 4);
  EXPECT_EQ(at_small_damping.at("evaluations_per_step"), 24);
}

// `trade` tries the expensive field once per step, with several substeps, and in every stage.
TEST_F(MultirateFields, AreTraded) {
  auto const trade = nlohmann::json::parse(output_of(
      {"trade", "scene.toml", "--json", "--seconds", "0.2", "--precision", "double", "--threads",
       "1", "--set", "integrator={method='tsit5',tolerance=1e-3,dt=0.1,steps=10}"}));
  std::map<std::string, nlohmann::json> ladders;
  for (auto const& method : trade["methods"]) ladders[method["method"]] = method["rungs"];
  for (std::string const name :
       {"rkmk4", "rkmk4, multirate, 1 substep", "rkmk4 tangent, multirate, 4 substeps",
        "projected_rk4, multirate, 2 substeps", "tsit5"})
    EXPECT_TRUE(ladders.contains(name)) << name;
  for (std::string const name : {"tsit5, multirate, 2 substeps", "ab2, multirate, 2 substeps"})
    EXPECT_FALSE(ladders.contains(name)) << name;
  for (std::int64_t const substeps : {1, 2}) {
    auto const& rungs = ladders.at("rkmk4, multirate, " + std::to_string(substeps) +
                                   (substeps > 1 ? " substeps" : " substep"));
    ASSERT_GE(rungs.size(), 2u);
    EXPECT_LT(rungs.back()["error"].get<double>(), 0.5 * rungs.front()["error"].get<double>());
    for (auto const& rung : rungs) {
      // Evaluations of the other terms: a step takes its substeps twice, but the first step only
      // once.
      auto const steps = std::llround(1 / rung["dt"].get<double>());
      EXPECT_EQ(rung["evaluations"], 4 * substeps * (2 * steps - 1));
    }
  }
}

// "auto" evaluates the expensive field once per step or in each stage, whichever is faster.
TEST_F(MultirateFields, AreChosenForAnError) {
  run("exact.h5",
      set("field.slab_demag.multirate=false", "integrator={method='rkmk8',dt=0.01,steps=200}"));
  for (std::string const error : {"1e-3", "1e-5"}) {
    run("out.h5", {"--overwrite", "--threads", "1", "--set",
                   "integrator={method='auto',error=" + error + ",dt=0.1,end=2}"});
    EXPECT_LT(distance(last_spins("out.h5"), last_spins("exact.h5")), 2 * std::stod(error));
    auto const header = info_of("out.h5").header;
    EXPECT_TRUE(contains(header.scene_text, "multirate = true"));
    auto const choice = [](std::string const& resolved) {
      EXPECT_TRUE(contains(resolved, "multirate = true") || !contains(resolved, "substeps"))
          << resolved;
      auto const method = resolved.find("method = ");
      return resolved.substr(method, resolved.find(',', method) - method) +
             (contains(resolved, "multirate = true") ? " multirate" : "");
    };
    // A restart to a later end keeps the earlier choice.
    run("longer.h5", {"--overwrite", "--restart", "out.h5", "--set",
                      "integrator={method='auto',error=" + error + ",dt=0.1,end=3}"});
    EXPECT_EQ(choice(info_of("longer.h5").header.resolved_scene), choice(header.resolved_scene));
  }
}

TEST_F(MultirateFields, AdviseRefusesSubstepsWithoutOne) {
  expect_refused(
      {"advise", "scene.toml", "--error", "1e-3", "--set", "field.slab_demag={normal=[1,0,0]}"},
      "integrator.substeps: no term of the field is expensive");
}

}  // namespace
}  // namespace cayspin::program::test
