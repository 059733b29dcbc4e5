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
  Outcome command(Arguments arguments, Arguments const& more = {}) const {
    arguments.insert(arguments.begin() + 1, write("scene.toml", R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [9, 7]
[field]
exchange = 0.5
applied = [0.1, 0.2, 0.3]
slab_demag = { normal = [1, 0, 0], average = "layer", dear = true }
[initial]
random = { seed = 5 }
[integrator]
method = "rkmk4"
substeps = 3
dt = 0.1
steps = 20
)toml"));
    arguments.insert(arguments.end(), more.begin(), more.end());
    return start(arguments);
  }
  Outcome run(std::string const& file, Arguments const& more = {}) const {
    return command({"run", "--quiet", "--output", file}, more);
  }
  Arguments const steps_of_12{"--set", "integrator.steps=12"};
};

TEST_F(DearFields, RunAndGoOnWithTheSameBits) {
  for (std::string const precision : {"double", "single"}) {
    Arguments const same{"--overwrite", "--precision", precision, "--set",
                         "output.checkpoint_every='4 steps'"};
    auto const with = [&](Arguments more) {
      more.insert(more.end(), same.begin(), same.end());
      return more;
    };
    EXPECT_EQ(run("whole.h5", with({})).errors, "");
    EXPECT_EQ(run("first.h5", with(steps_of_12)).errors, "");
    EXPECT_EQ(run("second.h5", with({"--restart", "first.h5", "--space", another_space})).errors,
              "");
    EXPECT_EQ(last_spins("second.h5"), last_spins("whole.h5"));
    auto const whole = io::read_info(in_folder("whole.h5"));
    EXPECT_EQ(whole.cost.evaluations, 3 * 4 * (1 + 2 * 19));
    EXPECT_EQ(io::read_info(in_folder("second.h5")).cost.evaluations, 3 * 4 * 2 * 8);
  }
  // It is the same physics as the field at each stage.
  EXPECT_EQ(
      run("plain.h5", {"--set", "field.slab_demag.dear=false", "--set", "integrator.substeps=1",
                       "--set", "integrator.dt=0.01", "--set", "integrator.steps=200"})
          .errors,
      "");
  EXPECT_EQ(run("fine.h5", {"--set", "integrator.dt=0.02", "--set", "integrator.steps=100"}).errors,
            "");
  EXPECT_LT(distance(last_spins("fine.h5"), last_spins("plain.h5")), 1e-4);
  EXPECT_GT(distance(last_spins("fine.h5"), last_spins("plain.h5")), 1e-12);
}

TEST_F(DearFields, NeedTheirCheckpoint) {
  auto more = steps_of_12;
  more.insert(more.end(), {"--set", "output.checkpoint_every=0"});
  EXPECT_EQ(run("first.h5", more).errors, "");
  auto const outcome = run("second.h5", {"--restart", "first.h5"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_TRUE(contains(outcome.errors, "the run needs more than its frames"));
}

TEST_F(DearFields, AreChecked) {
  auto const text = command({"check"});
  EXPECT_EQ(text.status, 0) << text.errors;
  for (char const* const part :
       {"dear: computed on the host once a step", "rkmk4 in 3 substeps", "order 3",
        "1 evaluation of the dear field and 24 of the others per step"})
    EXPECT_TRUE(contains(text.output, part));
  auto const numbers = nlohmann::json::parse(command({"check", "--json"}).output);
  EXPECT_EQ(numbers.at("order"), 3);
  EXPECT_EQ(numbers.at("evaluations_per_step"), 24);
}

// Evaluated once a step or in each stage: all come to the same spins.
TEST_F(DearFields, AreTraded) {
  auto const outcome =
      command({"trade", "--json", "--seconds", "0.2", "--precision", "double", "--threads", "1",
               "--set", "integrator={method='tsit5',tolerance=1e-3,dt=0.1,steps=10}"});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  auto const trade = nlohmann::json::parse(outcome.output);
  std::map<std::string, nlohmann::json> ladders;
  for (auto const& method : trade["methods"]) ladders[method["method"]] = method["rungs"];
  for (std::string const name :
       {"rkmk4", "rkmk4, dear, 1 substep", "rkmk4 tangent, dear, 4 substeps",
        "projected_rk4, dear, 2 substeps", "tsit5"})
    EXPECT_TRUE(ladders.contains(name)) << name;
  for (std::string const name : {"tsit5, dear, 2 substeps", "fx4, dear, 2 substeps"})
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
  EXPECT_EQ(run("exact.h5", {"--set", "field.slab_demag.dear=false", "--set",
                             "integrator={method='rkmk8',dt=0.01,steps=200}"})
                .errors,
            "");
  for (std::string const error : {"1e-3", "1e-5"}) {
    EXPECT_EQ(run("out.h5", {"--overwrite", "--threads", "1", "--set",
                             "integrator={method='auto',error=" + error + ",dt=0.1,end=2}"})
                  .errors,
              "");
    EXPECT_LT(distance(last_spins("out.h5"), last_spins("exact.h5")), 2 * std::stod(error));
    auto const header = io::read_info(in_folder("out.h5")).header;
    EXPECT_TRUE(contains(header.scene_text, "dear = true"));
    auto const choice = [](std::string const& resolved) {
      EXPECT_TRUE(contains(resolved, "dear = true") || !contains(resolved, "substeps")) << resolved;
      auto const method = resolved.find("method = ");
      return resolved.substr(method, resolved.find(',', method) - method) +
             (contains(resolved, "dear = true") ? " dear" : "");
    };
    // Takes up the choice, and goes on to another end.
    EXPECT_EQ(run("longer.h5", {"--overwrite", "--restart", "out.h5", "--set",
                                "integrator={method='auto',error=" + error + ",dt=0.1,end=3}"})
                  .errors,
              "");
    EXPECT_EQ(choice(io::read_info(in_folder("longer.h5")).header.resolved_scene),
              choice(header.resolved_scene));
  }
}

TEST_F(DearFields, AreRefusedInOneLine) {
  std::vector<std::pair<Arguments, std::string>> const wrong{
      {{"advise", "--error", "1e-3", "--set", "field.slab_demag={normal=[1,0,0]}"},
       "integrator.substeps: no term of the field is dear"},
      {{"check", "--ranks", "1,2"}, "the method runs on one rank alone"},
      {{"check", "--set", "integrator.method='ab2'"}, "\"ab2\" takes no dear field"},
      {{"run", "--output", "out.h5", "--set", "integrator={method='tsit5',tolerance=1e-3,end=1}"},
       "\"tsit5\" takes no dear field"},
      {{"check", "--set", "field.slab_demag={normal=[1,0,0]}"},
       "integrator.substeps: no term of the field is dear"},
      {{"run", "--output", "out.h5", "--set", "integrator.substeps=0"}, "integrator.substeps: 0"}};
  for (auto const& [arguments, part] : wrong) {
    auto const outcome = command(arguments);
    EXPECT_EQ(outcome.status, 2) << part;
    EXPECT_TRUE(is_one_line(outcome.errors)) << outcome.errors;
    EXPECT_TRUE(contains(outcome.errors, part));
  }
  EXPECT_FALSE(std::filesystem::exists(in_folder("out.h5")));
}

}  // namespace
}  // namespace cayspin::program::test
