// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Dear fields in the program's commands.
#include "program_test.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <string>

namespace cayspin::program::test {
namespace {

class DearFields : public ProgramTest {
 protected:
  DearFields() {
    write("scene.toml", R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [9, 7]
[field]
exchange = 0.5
applied = [0.1, 0.2, 0.3]
slab_demag = { normal = [1, 0, 0], where = "host", dear = true }
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

TEST_F(DearFields, RunAndGoOnWithTheSameBits) {
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

TEST_F(DearFields, NeedTheirCheckpoint) {
  run("first.h5", joined(steps_of_12, set("output.checkpoint_every=0")));
  expect_refused({"run", "scene.toml", "--output", "second.h5", "--restart", "first.h5"},
                 "the run needs more than its frames");
}

TEST_F(DearFields, AreChecked) {
  EXPECT_TRUE(
      contains_all(output_of({"check", "scene.toml"}),
                   {"dear: computed on the host once a step", "rkmk4 in 3 substeps", "order 3",
                    "1 evaluation of the dear field and 24 of the others per step"}));
  auto const numbers = nlohmann::json::parse(output_of({"check", "scene.toml", "--json"}));
  EXPECT_EQ(numbers.at("order"), 3);
  EXPECT_EQ(numbers.at("evaluations_per_step"), 24);
  // Order 3 would widen lines, at the same cost.
  auto const at_small_damping = nlohmann::json::parse(
      output_of(joined({"check", "scene.toml", "--json"}, set("system.damping=0.008"))));
  EXPECT_EQ(at_small_damping.at("order"), 4);
  EXPECT_EQ(at_small_damping.at("evaluations_per_step"), 24);
}

// Evaluated once a step or in each stage: all come to the same spins.
TEST_F(DearFields, AreTraded) {
  auto const trade = nlohmann::json::parse(output_of(
      {"trade", "scene.toml", "--json", "--seconds", "0.2", "--precision", "double", "--threads",
       "1", "--set", "integrator={method='tsit5',tolerance=1e-3,dt=0.1,steps=10}"}));
  std::map<std::string, nlohmann::json> ladders;
  for (auto const& method : trade["methods"]) ladders[method["method"]] = method["rungs"];
  for (std::string const name :
       {"rkmk4", "rkmk4, dear, 1 substep", "rkmk4 tangent, dear, 4 substeps",
        "projected_rk4, dear, 2 substeps", "tsit5"})
    EXPECT_TRUE(ladders.contains(name)) << name;
  for (std::string const name : {"tsit5, dear, 2 substeps", "ab2, dear, 2 substeps"})
    EXPECT_FALSE(ladders.contains(name)) << name;
  for (std::int64_t const substeps : {1, 2}) {
    auto const& rungs = ladders.at("rkmk4, dear, " + std::to_string(substeps) +
                                   (substeps > 1 ? " substeps" : " substep"));
    ASSERT_GE(rungs.size(), 2u);
    EXPECT_LT(rungs.back()["error"].get<double>(), 0.5 * rungs.front()["error"].get<double>());
    for (auto const& rung : rungs) {
      // Of the other terms: in two passes but for the first step.
      auto const steps = std::llround(1 / rung["dt"].get<double>());
      EXPECT_EQ(rung["evaluations"], 4 * substeps * (2 * steps - 1));
    }
  }
}

// Whichever is faster here: one evaluation a step, or one in each stage.
TEST_F(DearFields, AreChosenForAnError) {
  run("exact.h5",
      set("field.slab_demag.dear=false", "integrator={method='rkmk8',dt=0.01,steps=200}"));
  for (std::string const error : {"1e-3", "1e-5"}) {
    run("out.h5", {"--overwrite", "--threads", "1", "--set",
                   "integrator={method='auto',error=" + error + ",dt=0.1,end=2}"});
    EXPECT_LT(distance(last_spins("out.h5"), last_spins("exact.h5")), 2 * std::stod(error));
    auto const header = info_of("out.h5").header;
    EXPECT_TRUE(contains(header.scene_text, "dear = true"));
    auto const choice = [](std::string const& resolved) {
      EXPECT_TRUE(contains(resolved, "dear = true") || !contains(resolved, "substeps")) << resolved;
      auto const method = resolved.find("method = ");
      return resolved.substr(method, resolved.find(',', method) - method) +
             (contains(resolved, "dear = true") ? " dear" : "");
    };
    // Takes up the choice, and goes on to another end.
    run("longer.h5", {"--overwrite", "--restart", "out.h5", "--set",
                      "integrator={method='auto',error=" + error + ",dt=0.1,end=3}"});
    EXPECT_EQ(choice(info_of("longer.h5").header.resolved_scene), choice(header.resolved_scene));
  }
}

TEST_F(DearFields, AdviseRefusesSubstepsWithoutOne) {
  expect_refused(
      {"advise", "scene.toml", "--error", "1e-3", "--set", "field.slab_demag={normal=[1,0,0]}"},
      "integrator.substeps: no term of the field is dear");
}

}  // namespace
}  // namespace cayspin::program::test
