// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// [[stage]]: a run in stages writes one file, bitwise identical to separate runs. It can be
// continued from any point.
#include "program_test.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>

namespace cayspin::program::test {
namespace {

class Stages : public ProgramTest {
 protected:
  static std::string const& three() {
    static std::string const stages = R"([[stage]]
name = "turned"
field.applied = [-0.2, 0.1, 0.4]
integrator = { method = "heun", dt = 0.01, steps = 30 }
[[stage]]
relax.torque = 1e-5
field.exchange = 1.5
[[stage]]
system.damping = 0.3
integrator = { method = "rkmk4", dt = 0.04, steps = 15 }
)";
    return stages;
  }

  std::vector<double> spins(std::string const& name, std::int64_t frame) const {
    auto const info = info_of(name);
    return io::read_spins(in_folder(name), info.header.shape, frame);
  }

  /// Continues from a file in a run without stages; returns the last spins.
  std::vector<double> by_hand(std::string const& from, Arguments const& changes) const {
    auto const outcome = start(joined(
        {"run", "chain.toml", "--quiet", "--output", "hand.h5", "--overwrite", "--restart", from},
        changes));
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return last_spins("hand.h5");
  }
};

TEST_F(Stages, HaveTheBitsOfRunsByHand) {
  for (std::string const precision : {"double", "single"}) {
    Arguments const same{"--precision", precision};
    auto const info = run(chain_scene() + three(), same);
    EXPECT_TRUE(info.complete);
    EXPECT_EQ(info.frame_steps, (std::vector<std::int64_t>{0, 10, 20, 25, 35, 45, 55, 55, 65, 70}));
    EXPECT_EQ(info.frame_stages, (std::vector<std::int64_t>{0, 0, 0, 0, 1, 1, 1, 2, 3, 3}));
    EXPECT_NEAR(info.frame_times[6], 25 * 0.02 + 30 * 0.01, 1e-15);
    EXPECT_EQ(info.frame_times[7], info.frame_times[6]);
    EXPECT_NEAR(info.frame_times[9], 25 * 0.02 + 30 * 0.01 + 15 * 0.04, 1e-15);
    EXPECT_EQ(info.header.scene_text, chain_scene() + three());

    output_of(
        joined({"run", "chain.toml", "--quiet", "--output", "first.h5", "--overwrite"}, same));
    EXPECT_EQ(last_spins("first.h5"), spins("out.h5", 3));
    auto const turned = "field.applied=[-0.2,0.1,0.4]", stiff = "field.exchange=1.5";
    auto const second = by_hand(
        "first.h5", joined(same, set(turned, "integrator={method='heun',dt=0.01,steps=80}")));
    EXPECT_EQ(second, spins("out.h5", 6));
    // `relax` normalises spins from a file, so the spins are not bitwise equal.
    output_of(joined(joined({"relax", "chain.toml", "--quiet", "--output", "relaxed.h5", "--torque",
                             "1e-5", "--overwrite"},
                            same),
                     set(turned, stiff, "initial={file='hand.h5'}")));
    EXPECT_LT(distance(last_spins("relaxed.h5"), spins("out.h5", 7)), 1e-3);
    auto const text = chain_scene() + three();
    run_into("third.h5", text.substr(0, text.find("[[stage]]\nsystem")), same);
    auto const third =
        by_hand("third.h5", joined(same, set(turned, stiff, "system.damping=0.3",
                                             "integrator={method='rkmk4',dt=0.04,steps=35}")));
    EXPECT_EQ(third, spins("out.h5", 9));
  }
}

TEST_F(Stages, SeeTheTimeOfTheWholeRun) {
  auto const one = run(chain_scene(), set("field.applied=['0.3*cos(7*t)','0.1','0.2*t']"));
  auto const whole = last_spins("out.h5");
  auto const scene = chain_scene() + "[[stage]]\nintegrator.steps = 12\n";
  run(scene, set("integrator.steps=13", "field.applied=['0.3*cos(7*t)','0.1','0.2*t']"));
  auto const staged = last_spins("out.h5");
  EXPECT_LT(distance(staged, whole), 1e-13);
  EXPECT_GT(distance(staged, spins("out.h5", 0)), 1e-3);
}

// Noise depends on the step counted over all stages.
TEST_F(Stages, GoOnWithTheNoise) {
  auto const heat = set("thermal={temperature=0.01,seed=5}", "field.applied=[0,0,1]");
  run(chain_scene(), heat);
  auto const whole = last_spins("out.h5");
  run(chain_scene() + "[[stage]]\nintegrator.steps = 12\n",
      joined(heat, set("integrator.steps=13")));
  EXPECT_EQ(last_spins("out.h5"), whole);
}

// Shortening a stage emulates a run interrupted in it.
TEST_F(Stages, GoOnInTheStageWhereTheyWereLeft) {
  auto const scene = chain_scene() + three();
  struct Left {
    std::string stages, key;
    int begin, steps;
  };
  auto const first = scene.substr(0, scene.find("[[stage]]"));
  auto const second = scene.substr(0, scene.find("[[stage]]\nrelax"));
  auto const third = scene.substr(0, scene.find("[[stage]]\nsystem"));
  for (std::string const change :
       {"output.every=5", "field.applied=['0.3*cos(7*t)','0.1','0.2']"}) {
    auto const same = set(change);
    run(scene, same);
    auto const whole = last_spins("out.h5");
    auto const info = info_of("out.h5");
    for (auto const& [text, key, begin, steps] :
         {Left{first, "integrator.steps", 0, 12}, Left{first, "integrator.steps", 0, 25},
          Left{second, "stage.0.integrator.steps", 25, 12},
          Left{second, "stage.0.integrator.steps", 25, 30},
          Left{third, "stage.0.integrator.steps", 25, 30},
          Left{scene, "stage.2.integrator.steps", 55, 7}}) {
      SCOPED_TRACE(fmt::format("{}, {} of {}", change, steps, key));
      run_into("part.h5", text, joined(same, set(fmt::format("{}={}", key, steps))));
      EXPECT_EQ(info_of("part.h5").frame_steps.back(), begin + steps);
      auto const outcome = run_into("on.h5", scene, joined({"--restart", "part.h5"}, same));
      EXPECT_EQ(outcome.status, 0) << outcome.errors;
      EXPECT_EQ(last_spins("on.h5"), whole);
      auto const on = info_of("on.h5");
      EXPECT_EQ(on.frame_steps.back(), info.frame_steps.back());
      EXPECT_EQ(on.frame_times.back(), info.frame_times.back());
      EXPECT_EQ(on.frame_stages.back(), 3);
    }
  }
}

// The continued run is interrupted in the same stage, and continued once more.
TEST_F(Stages, GoOnMoreThanOnce) {
  for (std::string const method : {"method='rkmk4'", "method='tsit5',tolerance=1e-9,max_dt=0.1"}) {
    auto const scene = chain_scene() +
                       "[[stage]]\nfield.applied = ['0.2*sin(9*t)', 0.1, 0.4]\nintegrator = {" +
                       method + ", dt=0.02, steps=200000}\n[[stage]]\nintegrator.steps = 10\n";
    write("scene.toml", scene);
    // The first checkpoint is stored in the second stage.
    auto const interrupted = [&](std::string const& name, Arguments const& more) {
      return start(joined({"run", "scene.toml", "--quiet", "--output", name + ".h5"},
                          joined(more, set("output.checkpoint_every='100 steps'"))),
                   {.interrupt_when = in_folder(name + ".checkpoint.h5")});
    };
    auto const first = interrupted("a", {});
    ASSERT_EQ(first.status, 130) << first.errors;
    EXPECT_EQ(info_of("a.h5").frame_stages.back(), 1);
    auto const second = interrupted("b", {"--restart", "a.h5"});
    ASSERT_EQ(second.status, 130) << second.errors;
    auto const left = info_of("b.h5").frame_steps.back();
    EXPECT_GT(left, info_of("a.h5").frame_steps.back());
    Arguments const last =
        joined({"--overwrite"}, set(fmt::format("stage.0.integrator.steps={}", left - 25 + 20)));
    start(joined({"run", "scene.toml", "--quiet", "--output", "c.h5", "--restart", "b.h5"}, last));
    output_of(joined({"run", "scene.toml", "--quiet", "--output", "whole.h5"}, last));
    EXPECT_EQ(last_spins("c.h5"), last_spins("whole.h5"));
    EXPECT_EQ(info_of("c.h5").frame_steps.back(), left + 30);
    EXPECT_EQ(info_of("c.h5").frame_times.back(), info_of("whole.h5").frame_times.back());
    for (auto const* const file : {"a", "b"}) {
      std::filesystem::remove(in_folder(file + std::string(".h5")));
      std::filesystem::remove(in_folder(file + std::string(".checkpoint.h5")));
    }
  }
}

TEST_F(Stages, MayEndEarlyAtRest) {
  auto const scene = chain_scene() + R"([[stage]]
field.applied = [0, 0, 0.4]
integrator.until_torque = 1e-3
[[stage]]
field.applied = [0.1, 0, 0]
integrator = { method = "rkmk4", dt = 0.02, steps = 10 }
)";
  auto const info = run(scene, set("integrator={method='rkmk4',dt=0.02,steps=100000,"
                                   "until_torque=1e-3}",
                                   "stage.0.integrator.steps=100000"));
  auto const steps = info.frame_steps;
  EXPECT_LT(steps.back(), 100000);
  EXPECT_EQ(info.frame_stages.back(), 2);
  EXPECT_EQ(steps.back() - steps[steps.size() - 2], 10);
  EXPECT_NEAR(info.frame_times.back(), 0.02 * static_cast<double>(steps.back()), 1e-9);
}

TEST_F(Stages, BeginWithARelaxation) {
  auto const scene = R"([system]
kind = "llg"
damping = 0.5
[lattice]
shape = [1]
[field]
applied = [0, 0, 1]
[initial]
uniform = [1, 0, 0.2]
[[stage]]
relax = true
[[stage]]
field.applied = [1, 0, 0]
integrator = { method = "rkmk4", dt = 0.1, end = 5.0 }
)";
  auto const info = run(scene);
  EXPECT_EQ(info.frame_stages, (std::vector<std::int64_t>{0, 1, 2}));
  EXPECT_EQ(info.frame_steps, (std::vector<std::int64_t>{0, 0, 50}));
  auto const& m = info.frame_scalars[1].magnetization;
  EXPECT_NEAR(m[2], 1, 1e-12);
  // With damping a, m_x = tanh(a * t) from a start along z.
  EXPECT_NEAR(info.frame_scalars[2].magnetization[0], std::tanh(0.5 * 5), 1e-4);
}

// A checkpoint is stored between stages. A run whose last stage relaxes needs none at its end.
TEST_F(Stages, LeaveNoCheckpointAfterALastRest) {
  EXPECT_TRUE(run(chain_scene() + "[[stage]]\nrelax.torque = 1e-4\n").complete);
  EXPECT_FALSE(exists("out.checkpoint.h5"));
}

TEST_F(Stages, KeepTheFramesBeforeAFailure) {
  write("scene.toml", chain_scene() + "[[stage]]\nintegrator.dt = 50.0\n");
  auto const outcome = start({"run", "scene.toml", "--quiet", "--output", "out.h5"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(contains(outcome.errors, "the last good frame is 3 in out.h5 (step 25"))
      << outcome.errors;
  auto const info = info_of("out.h5");
  EXPECT_FALSE(info.complete);
  EXPECT_EQ(info.frames, 4);
  write("scene.toml", chain_scene() + "[[stage]]\nrelax.evaluations = 3\n");
  auto const relaxed = start({"run", "scene.toml", "--quiet", "--output", "out.h5", "--overwrite"});
  EXPECT_EQ(relaxed.status, 3);
  EXPECT_TRUE(contains(relaxed.errors, "stage 1: relax: stopped at the limit of "))
      << relaxed.errors;
  EXPECT_TRUE(contains(relaxed.errors, "the last good frame is 3 in out.h5 (step 25"))
      << relaxed.errors;
  EXPECT_EQ(info_of("out.h5").frames, 4);
}

TEST_F(Stages, AreCheckedOneByOne) {
  write("scene.toml", chain_scene() + three());
  auto const text = output_of({"check", "scene.toml"});
  EXPECT_TRUE(
      contains_all(text, {"stage 0", "stage 1 (turned) from step 25, t = 0.5",
                          "stage 2     from step 55, t = 0.8", "to max |m x H| < 1e-05",
                          "stage 3     from step 55", "15 steps of 0.04, to t = 1.4", "10 frames"}))
      << text;
  auto const json = nlohmann::json::parse(output_of({"check", "scene.toml", "--json"}));
  auto const& stages = json.at("stages");
  ASSERT_EQ(stages.size(), 4U);
  EXPECT_EQ(stages[3].at("begin_step"), 55);
  EXPECT_GT(stages[3].at("stable_dt"), 0);
  EXPECT_TRUE(stages[2].contains("relax"));
  EXPECT_FALSE(json.contains("notes"));
}

TEST_F(Stages, AreCheckedForTermsThatTheyTakeAway) {
  write("scene.toml", R"(system = { kind = "llg", damping = 0.1 }
lattice = { shape = [4] }
[field]
anisotropy = [{ constant = 0.5, axis = [0, 0, 1] }, { constant = 0.25, axis = [1, 0, 0] }]
[torque]
slonczewski = { damping_like = 0.1, polarization = [1, 0, 0] }
zhang_li = { velocity = [0.2, 0, 0] }
[initial]
random = { seed = 1 }
[integrator]
method = "heun"
dt = 0.01
steps = 3
[[stage]]
field.anisotropy = [{ constant = 0.5, axis = [0, 0, 1] }]
[[stage]]
field.anisotropy = []
torque.slonczewski.damping_like = 0
torque.zhang_li.velocity = [0, 0, 0]
[[stage]]
system.damping = 0.2
)");
  auto const text = output_of({"check", "scene.toml"});
  auto const of_stage = [&](int stage) {
    auto const begin = text.find(fmt::format("stage {} ", stage));
    return text.substr(begin, text.find(fmt::format("stage {} ", stage + 1)) - begin);
  };
  EXPECT_TRUE(contains(of_stage(1), "anisotropy  ")) << text;
  EXPECT_FALSE(contains(of_stage(1), "anisotropy  none")) << text;
  EXPECT_FALSE(contains(of_stage(1), "torque")) << text;
  EXPECT_TRUE(contains_all(of_stage(2), {"anisotropy  none\n", "torque      none\n"})) << text;
  EXPECT_FALSE(contains(of_stage(3), "none")) << text;
}

TEST_F(Stages, HaveTheNotesOfAllStages) {
  write("noted.toml", R"([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [4]
[field]
exchange = 1.0
[initial]
uniform = [1, 0, 0]
[integrator]
method = "heun"
dt = 0.01
steps = 5
[[stage]]
field.mu0 = 2
)");
  auto const noted = nlohmann::json::parse(output_of({"check", "noted.toml", "--json"}));
  ASSERT_EQ(noted.at("notes").size(), 1U);
  EXPECT_TRUE(contains(noted.at("notes")[0].get<std::string>(), "noted.toml:15: field.mu0"));
}

TEST_F(Stages, AreSweptAndNotTraded) {
  write("scene.toml", chain_scene() + three());
  output_of({"sweep", "scene.toml", "--quiet", "--output", "sweep.h5", "--over",
             "stage.2.system.damping=0.1,0.3"});
  auto const swept = read_dataset("sweep.h5", "runs/0001/spins");
  run(chain_scene() + three());
  EXPECT_EQ(read_dataset("out.h5", "spins").values, swept.values);
  for (Arguments const& command : {Arguments{"trade"}, {"advise", "--error", "1e-3"}})
    expect_refused(joined(command, {"scene.toml"}),
                   "no run in stages; accepted: a scene without [[stage]]");
  expect_refused({"relax", "scene.toml", "--output", "a.h5"}, "takes no run in stages");
}

TEST_F(Stages, RefuseARestartInAStageThatIsNotThere) {
  run(chain_scene() + three());
  write("scene.toml", chain_scene() + "[[stage]]\nsystem.damping = 0.2\n");
  expect_refused({"run", "scene.toml", "--quiet", "--output", "on.h5", "--restart", "out.h5"},
                 "--restart out.h5: ");
  write("scene.toml", chain_scene() + three());
  expect_refused({"run", "scene.toml", "--quiet", "--output", "on.h5", "--restart", "out.h5"},
                 "it ends at step 70, the scene at step 70");
}

}  // namespace
}  // namespace cayspin::program::test
