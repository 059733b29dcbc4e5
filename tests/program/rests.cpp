// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// integrator.until_torque ends a run only at a minimum of the energy, although the torque is also
// small at a maximum or a saddle.
#include "program_test.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <random>

namespace cayspin::program::test {
namespace {

class Rests : public ProgramTest {
 protected:
  /// A scene whose spins must all relax to +z or -z.
  struct Trial {
    std::string scene;
    Arguments more = {};
    double end_z = 1;  // the spins' z at the end; 0: 1 or -1 at each site
  };

  /// Expects the run to end early, at a minimum.
  void expect_minimum(Trial const& trial) const {
    auto const info = run(trial.scene, joined(trial.more, {"--overwrite"}));
    auto const m = last_spins("out.h5");
    for (std::size_t i = 2; i < m.size(); i += 3) {
      double const z = trial.end_z == 0 ? std::abs(m[i]) : trial.end_z * m[i];
      ASSERT_GT(z, 0.999) << trial.scene << testing::PrintToString(trial.more);
    }
    EXPECT_LT(info.frame_steps.back(), 100000) << trial.scene;
  }

  static std::string scene(std::string const& lattice_and_field, std::string const& start,
                           double damping = 0.1, std::string const& method = "rkmk4",
                           double dt = 0.1) {
    char text[1000];
    std::snprintf(text, sizeof text,
                  "[system]\nkind = \"llg\"\ndamping = %g\n%s\n[initial]\n%s\n[integrator]\nmethod "
                  "= \"%s\"\n%s\nuntil_torque = 1e-6\n[output]\nevery = 1000000\n",
                  damping, lattice_and_field.c_str(), start.c_str(), method.c_str(),
                  method == "tsit5" ? "tolerance = 1e-7\ndt = 1\nsteps = 10000"
                                    : ("dt = " + std::to_string(dt) + "\nsteps = 100000").c_str());
    return text;
  }

  /// Returns an expression for spins at about this angle from a pole, in directions that vary from
  /// site to site.
  static std::string near_pole(double angle, unsigned seed, char const* pole = "-1") {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> phase(0, 6.28);
    char text[300];
    std::snprintf(text, sizeof text,
                  "expression = [\"%.3g*cos(%.3f+2.1*i+1.3*j)\", \"%.3g*sin(%.3f+2.1*i+1.3*j)\", "
                  "\"%s\"]",
                  angle, phase(engine), angle, phase(engine), pole);
    return text;
  }

  static constexpr auto one_spin = "[lattice]\nshape = [1]\n[field]\napplied = [0, 0, 1]";
  static constexpr auto pair =
      "[lattice]\nshape = [2]\n[field]\nexchange = 0.3\napplied = [0, 0, 1]";
  static constexpr auto film =
      "[lattice]\nshape = [5, 4]\n[field]\nexchange = 0.5\nanisotropy = { constant = 0.5, axis = "
      "[0, 0, 1] }\napplied = [0, 0, 0.8]";
  // Two spins that are not coupled: one starts at or near the maximum, the other moves down.
  static constexpr auto apart = "[lattice]\nshape = [2]\n[field]\napplied = [0, 0, 1]";
};

TEST_F(Rests, AreNotMaxima) {
  expect_minimum({scene(one_spin, "uniform = [1e-9, 0, -1]")});
  for (double const angle : {1e-12, 1e-7, 1e-3}) {
    unsigned seed = static_cast<unsigned>(-std::log10(angle));
    expect_minimum({scene(one_spin, near_pole(angle, seed))});
    expect_minimum({scene(pair, near_pole(angle, seed + 1))});
    expect_minimum({scene(film, near_pole(angle, seed + 2))});
    expect_minimum({scene(film, near_pole(angle, seed + 3)), {"--precision", "single"}});
    // One of two uncoupled spins leaves the maximum long after the other.
    char start[200];
    std::snprintf(start, sizeof start, "expression = [\"i == 0 ? %g : 1\", \"0\", \"-1\"]", angle);
    expect_minimum({scene(apart, start)});
  }
}

TEST_F(Rests, AreNotSaddles) {
  // The hard axis is x, the easy one z, so y is a saddle, to which damping leads the spins.
  constexpr auto saddle =
      "[lattice]\nshape = [3]\n[field]\nexchange = 1\nanisotropy = [{ constant = 0.4, axis = [0, "
      "0, 1] }, { constant = -0.6, axis = [1, 0, 0] }]";
  for (double const angle : {1e-12, 1e-6}) {
    char start[200];
    std::snprintf(start, sizeof start, "expression = [\"0.3\", \"1\", \"%g\"]", angle);
    expect_minimum({scene(saddle, start), set("system.precession=false"), 0});
  }
}

// The second spin leaves its maximum long after the first has come to rest. The energy of the
// smaller moment has a small curvature.
TEST_F(Rests, AreNotMaximaOfSmallMoments) {
  for (std::string const moments : {"i == 0 ? 1 : 1e-3", "i == 0 ? 1000 : 1"})
    for (std::string const precision : {"double", "single"})
      expect_minimum(
          {scene("[lattice]\nshape = [2]\nmoments = \"" + moments +
                     "\"\n[field]\napplied = [0, 0, 1e-4]",
                 "expression = [\"i == 0 ? 1 : 1e-9\", \"0\", \"-1\"]", 0.5, "rkmk4", 500),
           {"--precision", precision}});
}

TEST_F(Rests, OfAFilmInSi) {
  // A field of .4 T opposite to the spins exceeds the anisotropy field of .25 T, so +z is a
  // maximum.
  auto const film = [](double angle) {
    char text[600];
    std::snprintf(
        text, sizeof text,
        "units = \"SI\"\n[system]\nkind = \"llg\"\n[material]\nalpha = 0.1\ndamping_form = \"gilbert\"\nMs = "
        "8e5\nA = 1.3e-11\nKu = 1e5\naxis = [0, 0, 1]\n[lattice]\nshape = [6, 6]\nspacing "
        "= 4e-9\n[field]\napplied = [0, 0, -0.4]\n[initial]\nuniform = [%g, 0, "
        "1]\n[integrator]\nmethod = \"rkmk4\"\ndt = 2e-13\nend = 2e-8\nuntil_torque = "
        "1e-6\n[output]\nevery = 1000000\n",
        angle);
    return std::string(text);
  };
  for (double const angle : {1e-9, 1e-5}) expect_minimum({film(angle), {}, -1});
}

TEST_F(Rests, ByMethods) {
  for (std::string const method :
       {"euler", "heun", "tsit5", "red_black2", "stiff2", "projected_rk4"})
    expect_minimum({scene(pair, near_pole(1e-9, 7), 0.2, method, 0.05)});
}

// Nothing moves a spin that is exactly at the maximum. The run reports that it ended there.
TEST_F(Rests, AtATopAreNamed) {
  write("top.toml", scene(apart, "expression = [\"i\", \"0\", \"-1\"]"));
  auto const outcome = start({"run", "top.toml", "--output", "top.h5"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(contains(outcome.output, "ended at a saddle or a maximum of the energy"));
  EXPECT_EQ(output_of({"run", "top.toml", "--quiet", "--output", "quiet.h5"}), "");
  EXPECT_EQ(info_of("top.h5").frame_steps.back(), 100000);
  // A run that starts at a minimum does not end early.
  auto const info = run(scene(one_spin, "uniform = [0, 0, 1]"), set("integrator.steps=50"));
  EXPECT_EQ(info.frame_steps.back(), 50);
}

TEST_F(Rests, AreTheSameAfterABreak) {
  auto const text = scene(apart, "expression = [\"i == 0 ? 1e-12 : 1\", \"0\", \"-1\"]");
  write("s.toml", text);
  Arguments const run_it{"run", "s.toml", "--quiet", "--output"};
  output_of(joined(run_it, {"whole.h5"}));
  auto const whole = info_of("whole.h5").frame_steps.back();
  for (std::int64_t const steps : {std::int64_t{1}, std::int64_t{1450}, whole - 1}) {
    Arguments const same{"--overwrite", "--set", "output.checkpoint_every='1000 steps'"};
    output_of(joined(joined(run_it, {"first.h5"}),
                     joined(same, set("integrator.steps=" + std::to_string(steps)))));
    output_of(joined(joined(run_it, {"second.h5"}), joined(same, {"--restart", "first.h5"})));
    EXPECT_EQ(info_of("second.h5").frame_steps.back(), whole) << steps;
    EXPECT_EQ(last_spins("second.h5"), last_spins("whole.h5"));
  }
}

// A long test, which runs with ctest -C long -L long.
TEST_F(Rests, DISABLED_FromManyStartsByAllMethods) {
  std::mt19937 engine(20);
  for (std::string const method : {"euler",
                                   "implicit_euler",
                                   "heun",
                                   "rkmk4",
                                   "rkmk64",
                                   "rkmk5",
                                   "rkmk86",
                                   "rkmk8",
                                   "series4",
                                   "ab2",
                                   "implicit_midpoint",
                                   "stiff2",
                                   "stiff4",
                                   "cf4",
                                   "red_black2",
                                   "red_black4",
                                   "tsit5",
                                   "projected_euler",
                                   "projected_heun",
                                   "projected_rk4",
                                   "projected_rk64",
                                   "projected_rk5"})
    for (int trial = 0; trial < 12; ++trial) {
      double const angle = std::pow(10.0, std::uniform_real_distribution<double>(-12, -3)(engine));
      auto const field = std::array{one_spin, pair, film}[trial % 3];
      if (method.starts_with("red_black") && field == one_spin) continue;
      bool const slow = method.ends_with("euler");
      expect_minimum({scene(field, near_pole(angle, engine()), 0.2, method, slow ? 0.02 : 0.05)});
    }
}

}  // namespace
}  // namespace cayspin::program::test
