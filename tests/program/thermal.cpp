// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// [thermal]: interruptions and observations of a run do not change a bit of it. Also the output of
// `check`.
#include "program_test.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace cayspin::program::test {
namespace {

class Thermal : public ProgramTest {
 protected:
  static std::string warm_scene() {
    return R"toml([system]
kind = "llg"
damping = 0.3
[lattice]
shape = [37, 4, 3]
boundary = ["periodic", "periodic", "open"]
[field]
exchange = 1.0
anisotropy = { constant = 0.5, axis = [1, 2, 3] }
applied = ["0.3*cos(7*t)", 0.1, 0.2]
[initial]
random = { seed = 3 }
[integrator]
method = "heun"
dt = 0.02
steps = 25
[thermal]
temperature = 0.7
seed = 12
[output]
every = 10
)toml";
  }

  std::vector<double> end_of(std::string const& file, Arguments const& more) const {
    auto const outcome = run_into(file, warm_scene(), more);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.errors, "");
    return last_spins(file);
  }
};

// Kernels over few sites run on one thread, so the lattice is large.
TEST_F(Thermal, BitsDependOnSeedAndTemperatureAlone) {
  for (std::string const precision : {"double", "single"}) {
    auto const with = [&](Arguments const& more) {
      return joined(more, {"--precision", precision, "--set", "lattice.shape=[37,16,8]"});
    };
    auto const whole = end_of("whole.h5", with({}));
    for (Arguments const& other :
         std::vector<Arguments>{{"--threads", "1"},
                                {"--space", default_space, "--threads", "2"},
                                {"--space", another_space},
                                set("output.every=1"),
                                set("output.scalars_every=3"),
                                set("output.checkpoint_every='4 steps'")})
      EXPECT_EQ(end_of("other.h5", with(other)), whole) << other[1];
    for (std::string const set : {"thermal.seed=13", "thermal.temperature=0.70001"})
      EXPECT_NE(end_of("other.h5", with({"--set", set})), whole) << set;
  }
}

TEST_F(Thermal, GoesOnAfterAnyStep) {
  for (std::string const precision : {"double", "single"}) {
    auto const whole = end_of("whole.h5", {"--precision", precision});
    for (int const cut : {1, 2, 12, 24}) {
      auto const at = "integrator.steps=" + std::to_string(cut);
      end_of("first.h5", {"--precision", precision, "--set", at});
      EXPECT_FALSE(exists("first.checkpoint.h5"));
      EXPECT_EQ(end_of("second.h5", {"--precision", precision, "--restart", "first.h5"}), whole)
          << cut;
    }
  }
}

TEST_F(Thermal, EveryOneStepMethodGoesAndKeepsLengths) {
  for (std::string const method :
       {"euler", "implicit_euler", "rkmk4", "rkmk64", "rkmk8", "cf4", "implicit_midpoint",
        "projected_heun", "red_black2", "red_black4"}) {
    end_of("out.h5", set("integrator.method='" + method + "'", "lattice.shape=[36,4,3]"));
    auto const defects = read_dataset("out.h5", "/norm_defect").values;
    EXPECT_LT(defects.back(), 1e-14) << method;
  }
}

// At temperature 0 no noise is applied.
TEST_F(Thermal, TemperatureZeroIsNoTemperature) {
  EXPECT_EQ(end_of("zero.h5", set("thermal.temperature=0")),
            end_of("none.h5", set("thermal={temperature=0,seed=4}")));
  auto cold = warm_scene();
  cold.erase(cold.find("[thermal]"), cold.find("[output]") - cold.find("[thermal]"));
  EXPECT_EQ(run_into("cold.h5", cold).status, 0);
  EXPECT_EQ(last_spins("zero.h5"), last_spins("cold.h5"));
}

// Noise may raise the energy of spins that start at equilibrium; values that are not finite still
// stop a run.
TEST_F(Thermal, TheGuardLetsEnergyRise) {
  Arguments const from_rest = set("initial={uniform=[0,0,1]}", "field={exchange=1.0}");
  end_of("out.h5", from_rest);
  auto const energies = read_dataset("out.h5", "/energy").values;
  EXPECT_GT(energies.back(), energies.front() + 10);
  auto const outcome = run_into(
      "failing.h5", warm_scene(),
      set("integrator.dt=0.125", "integrator.steps=7", "field.applied=[0,0,'1/(t-0.25)']"));
  EXPECT_EQ(outcome.status, 3) << outcome.errors;
  EXPECT_TRUE(contains(outcome.errors, "the last good frame is "));
}

TEST_F(Thermal, IsCheckedAndDescribed) {
  auto const scene = write("scene.toml", warm_scene());
  EXPECT_TRUE(contains_all(output_of({"check", scene}),
                           {"temperature 0.7, seed 12\n",
                            "noise       damping x temperature x dt = 0.0042, turns a spin by 0.13 "
                            "radians a step\n"}));
  EXPECT_TRUE(contains(output_of(joined({"check", scene}, set("lattice.moments=[4.0]"))),
                       "noise       gyromagnetic / moment x damping x temperature x dt = 0.00105, "
                       "turns a spin by 0.0648 radians a step\n"));
  auto const json = nlohmann::json::parse(output_of({"check", scene, "--json"}));
  EXPECT_EQ(json["temperature"], 0.7);
  EXPECT_NEAR(json["noise_turn"], 2 * std::sqrt(0.0042), 1e-15);
  EXPECT_TRUE(contains(output_of({"check", scene, "--set", "thermal.temperature=70"}),
                       "turns a spin by 1.3 radians a step, which is too large\n"));
  auto const outcome = run_into("out.h5", warm_scene(), set("thermal.temperature=70"));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(is_one_line(outcome.errors)) << outcome.errors;
  EXPECT_TRUE(contains(outcome.errors, "integrator.dt: 0.02 lets noise turn spins by 1.3 radians"));
}

TEST_F(Thermal, IsRefusedWhereItHasNoMeaning) {
  auto const scene = write("scene.toml", warm_scene()).string();
  for (auto const& [arguments, part] : std::vector<std::pair<Arguments, std::string>>{
           {{"relax", scene, "--output", "out.h5", "--set", "field.applied=[0.3,0.1,0.2]"},
            "thermal.temperature: an equilibrium has no temperature"},
           {{"trade", scene}, "thermal.temperature: trajectories at a temperature are random"},
           {{"advise", scene, "--error", "1e-4"}, "thermal.temperature: trajectories"}})
    expect_refused(arguments, part);
}

}  // namespace
}  // namespace cayspin::program::test
