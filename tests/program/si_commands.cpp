// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Commands and messages for scenes in SI.
#include "si_scene.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <csignal>
#include <regex>

namespace cayspin::program::test {
namespace {

TEST_F(SiScene, CheckPrintsBothKindsOfNumbers) {
  auto const scene = write("scene.toml", film("method = \"rkmk4\"\ndt = 1e-13\nsteps = 25",
                                              "[\"0.1*cos(1e10*t)\", 0, 0.02]"));
  EXPECT_TRUE(contains_all(
      output_of({"check", scene}),
      {"units       SI; one reduced unit is 6.15746661e-12 s, 4e-09 m, 1.00530965 T, ",
       "material    Ms = 800000 A/m, A = 1.3e-11 J/m, Ku = 50000 J/m^3, D = 0.001 J/m^2, "
       "alpha = 0.3 (Gilbert), gamma = 1.760859e+11 rad/(s T)\n",
       "x: spacing 4e-09 m", "y: spacing 5e-09 m", "exchange    H = 2.02052 Lap(m)\n",
       "applied     (0.1*cos(1e10*t), 0, 0.02) T, H = (",
       "25 steps of 1e-13 s (0.0162404454), to t = 2.5e-12 s (0.406011134)\n"}));
  auto const json = nlohmann::json::parse(output_of({"check", scene, "--json"}));
  double const unit = json.at("time_unit");
  EXPECT_EQ(unit, units().time_unit());
  EXPECT_EQ(json.at("units"), "SI");
  EXPECT_NEAR(json.at("dt"), 1e-13, 1e-27);
  EXPECT_NEAR(json.at("reduced").at("dt"), units().time(1e-13), 1e-15);
  EXPECT_EQ(json.at("stable_dt"), double(json.at("reduced").at("stable_dt")) * unit);
  EXPECT_EQ(json.at("energy_unit"), units().energy_unit());
  EXPECT_TRUE(contains(output_of(joined({"check", scene}, set("thermal={temperature=300}"))),
                       "temperature 300 K (0.08583"));
  // The stable dt that is printed can be used as integrator.dt.
  auto const typed = output_of(
      {"check", scene, "--json", "--set", text("integrator.dt=", double(json.at("stable_dt")))});
  EXPECT_NEAR(nlohmann::json::parse(typed).at("dt"), json.at("stable_dt"), 1e-25);
}

TEST_F(SiScene, CheckPrintsCrystalsAndCurrentsInSi) {
  auto const said = [&](std::string const& material, std::string const& lattice,
                        std::string const& more) {
    return output_of(
        {"check", write("more.toml", "units = 'SI'\nmaterial = { " + material +
                                         ", alpha = 0.1, damping_form = 'gilbert' }\n"
                                         "system = { kind = 'llg' }\nlattice = { " +
                                         lattice + " }\n" + more +
                                         "\ninitial = { uniform = [1, 0, 0] }\n"
                                         "integrator = { method = 'rkmk4', dt = 1e-16, "
                                         "steps = 1 }\noutput = { file = 'o.h5' }\n")});
  };
  auto const crystal = said("mu_s = { bohr_magnetons = [2, 0.5] }",
                            "shape = [4, 4, 4], crystal = 'bcc', spacing = 3e-10",
                            "field = { couplings = { shells = [7.05e-21, -1e-22] }, anisotropy = [ "
                            "{ cubic = 2e-24, axes = [[1, 0, 0], [0, 1, 0]], site = 1 }, { "
                            "constant = { meV = 0.1 }, axis = [0, 0, 1] } ] }");
  EXPECT_TRUE(
      contains_all(crystal, {"mu_s = 1.854802e-23 J/T", "mu_s [1.8548e-23, 4.63701e-24] J/T",
                             "couplings   14 bonds of a cell, up to 7.05e-21 J\n",
                             " (Kc = 2e-24 J), site 1\n", "e = (0, 0, 1) (K = 1.60218e-23 J)\n"}));
  auto const film =
      said("Ms = 8e5, A = '1.3e-11*(1+x)', Ku = 500, axis = [0, 0, 1], D_bulk = 1e-3",
           "shape = [8, 4], spacing = [4e-9, 5e-9, 3e-9]",
           "field = { anisotropy = { cubic = 4.8e4, axes = [[1, 0, 0], [0, 1, 0]] } }\n"
           "torque = { zhang_li = { current_density = [1e12, 0, '1e12*t'], polarization = 0.4 }, "
           "slonczewski = { field_like = 0.01, polarization = [0, 0, 1] } }");
  EXPECT_TRUE(contains_all(
      film, {"A = 1.3e-11*(1+x) J/m, Ku = 500 J/m^3, D_bulk = 0.001 J/m^2, alpha = 0.1 (Gilbert)",
             "Lap(m), times 1.55425e+11 (1.3e-11*(1+x))\n", " (K = 500 J/m^3)\n",
             " (Kc = 48000 J/m^3)\n", "torque      Zhang-Li, u = (-28.9755, ", ") m/s, xi = 0\n",
             "torque      Slonczewski, damping-like 0, field-like 0.01 (T), p = (0, 0, 1)\n"}));
  EXPECT_TRUE(contains_all(
      said("Ms = { regions = [4e5, 8e5] }", "shape = [8, 4], spacing = 4e-9, regions = 'i % 2'",
           "torque = { zhang_li = { current_density = [1e12, 0, 0], polarization = 0.4 } }"),
      {"Zhang-Li, u = (-28.9755, ", ") m/s / (Ms / 800000 A/m), xi = 0\n"}));
}

// The applied field is printed as typed, too; other expressions only with t in reduced units.
TEST_F(SiScene, CheckPrintsTheUnitOfTInFactors) {
  auto const scene =
      write("scene.toml", film("method = \"heun\"\ndt = 1e-13\nsteps = 25", "[0, 0, 0.02]"));
  auto const said = output_of(
      joined({"check", scene},
             set("thermal={temperature='300*exp(-t/1e-12)'}", "field.in_time={exchange='1+t/1e-9'}",
                 "field.sources=[{profile=[0,0,0.1],time='sin(1e9*t)'}]")));
  for (std::string const begin :
       {", times (300*exp(-(", "exchange times (1+(", "H = (0, 0, 0.1) T times (sin(1e9*("}) {
    auto const at = said.find(begin);
    ASSERT_NE(at, std::string::npos) << begin << said;
    auto const line = said.substr(at, said.find('\n', at) - at);
    EXPECT_TRUE(contains(line, "*t)")) << line;
    EXPECT_TRUE(contains(line, "), t in units of 6.15747e-12 s")) << line;
  }
}

TEST_F(SiScene, RestartComparesTimesInSeconds) {
  auto const scene = [&](char const* steps) {
    return film(std::string("method = \"rkmk4\"\ndt = 1e-13\nsteps = ") + steps,
                "[\"0.3*cos(1e12*t)\", 0.1, 0.2]");
  };
  run(scene("12"));
  std::filesystem::rename(in_folder("out.h5"), in_folder("first.h5"));
  auto const info = run(scene("25"), {"--restart", "first.h5"});
  EXPECT_EQ(info.frame_steps, (std::vector<std::int64_t>{12, 20, 25}));
  EXPECT_NEAR(info.frame_times.front(), 1.2e-12, 1e-26);
  auto const again = [&](std::string const& text_of_scene) {
    return Arguments{"run",      write("again.toml", text_of_scene),
                     "--quiet",  "--restart",
                     "first.h5", "--output",
                     "other.h5"};
  };
  expect_refused(joined(again(scene("25")), set("integrator.dt=2.5e-13")),
                 "its step 12 is at t = 1.2e-12 s, not at that many steps of dt = 2.5e-13 s");
  expect_refused(joined(again(chain_scene()), set("lattice.shape=[12,5]")),
                 "it is in SI units; accepted: the units of the scene");
}

TEST_F(SiScene, MessagesHaveSeconds) {
  auto const scene =
      write("scene.toml", film("method = \"euler\"\ndt = 5e-12\nsteps = 1000", "[0.02, 0, 0.1]"));
  auto const outcome = start({"run", scene, "--quiet"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(contains(outcome.errors, "integrator.dt: 5e-12 s is above the stable"));
  auto const swept = start({"sweep", scene, "--output", "sweep.h5", "--over", "material.alpha=0.3",
                            "--set", "integrator.refuse_unstable=true"});
  EXPECT_EQ(swept.status, 2);
  EXPECT_TRUE(contains(swept.errors, "integrator.dt: 5e-12 s is above the stable"));
  auto const failure = behind_warning(outcome.errors);
  EXPECT_TRUE(contains(failure, "e-12 s: the energy rose by") ||
              contains(failure, "e-11 s: the energy rose by"));
  EXPECT_TRUE(contains_all(failure, {" J, from ", " J, where damping", " s)"}));

  auto const small = start(
      {"run", scene, "--quiet", "--output", "small.h5", "--set",
       "integrator={method='tsit5',tolerance=1e-9,dt=5e-12,steps=2,min_dt=4e-12,max_dt=4e-12}"});
  EXPECT_EQ(small.status, 3);
  EXPECT_TRUE(contains(small.errors, "integrator.tolerance: from t = 0 s it needs a step below "));
  EXPECT_TRUE(contains(small.errors,
                       " s, and integrator.min_dt is 4e-12 s; accepted: a larger tolerance, or a "
                       "smaller min_dt; "));

  auto const pole = start({"run", scene, "--quiet", "--output", "pole.h5", "--set",
                           "field.applied=['t > 1e-9 ? 1/0 : 0.1',0,0]"});
  EXPECT_EQ(pole.status, 2);
  EXPECT_TRUE(contains(pole.errors, "field.applied: is not finite at t = 1.00"));
  EXPECT_TRUE(contains(pole.errors, " s; accepted: finite numbers for all of the run"));
}

TEST_F(SiScene, ProgressOfARunHasUnits) {
  auto const process = begin({"run",
                              write("scene.toml", film("method = \"rkmk4\"\ndt = 1e-13\n"
                                                       "steps = 1000000000",
                                                       "[0.02, 0, 0.1]")),
                              "--quiet", "--threads", "1", "--output", "out.h5", "--set",
                              "output.every=1000000000"});
  ASSERT_TRUE(eventually([&] { return exists("out.h5"); }));
  EXPECT_EQ(end(process, SIGTERM), 130);
  auto const line = std::regex("\nprogress     step [0-9]+ of 1000000000 .*, t = [0-9.e-]+ s\n");
  EXPECT_TRUE(std::regex_search(output_of({"info", "out.h5"}), line));
}

TEST_F(SiScene, UntilTorqueIsInTesla) {
  auto const info = run(atom("until_torque = 1e-4\n[output]\nscalars_every = 1\n"),
                        set("integrator.end=1e-8", "integrator.dt=1e-12"));
  EXPECT_TRUE(info.complete);
  EXPECT_LT(info.frame_times.back(), 1e-8);
  auto const m = last_spins("out.h5");
  double const torque = std::hypot(m[0], m[1]) * 1.0;
  EXPECT_LT(torque, 1e-4);
  // A step multiplies the torque by this exponential, so the run ended at the first step whose
  // torque was small enough.
  EXPECT_GT(torque, 1e-4 * std::exp(-0.1 * gamma_e * 1.05e-12 / 1.01));
}

// The choice of a method depends on the machine, and so does whether a warning about dt appears.
TEST_F(SiScene, AChosenMethodKeepsTheScenesTimes) {
  auto const run_by = [&](std::string const& text_of_scene, Arguments const& more) {
    auto const spins = end_of(text_of_scene, joined(more, {"--threads", "1"}));
    expect_times("/time", 1e-11);
    return spins;
  };
  auto const scene =
      film("method = \"auto\"\nerror = 1e-3\ndt = 1e-12\nend = 2e-11", "[0.02, 0, 0.1]");
  auto const spins = run_by(scene, {});
  auto const header = info_of("out.h5").header;
  EXPECT_TRUE(contains(header.resolved_scene, "dt = "));
  EXPECT_EQ(run_by(header.resolved_scene, {}), spins);
  auto const exact =
      run_by(scene, set("integrator={method='rkmk8',dt=1e-14,end=2e-11}", "output.every=1000"));
  EXPECT_LT(distance(exact, spins), 2e-3);
}

TEST_F(SiScene, AdviceIsInSeconds) {
  auto const scene = write("scene.toml", film("method = \"rkmk4\"\ndt = 1e-13\nend = 5e-12\n"
                                              "until_torque = 1e-9",
                                              "[0.02, 0, 0.1]"));
  auto const advice =
      output_of({"advise", scene, "--error", "1e-3", "--threads", "1", "--precision", "double"});
  auto const command = advice.substr(advice.find("run it"));
  auto const begin = command.find("integrator={");
  auto const typed = command.substr(begin, command.find('\'', begin) - begin);
  auto const json = nlohmann::json::parse(
      output_of({"check", scene, "--json", "--set", typed, "--set", "output.every=1"}));
  EXPECT_NEAR(double(json.at("dt")) * double(json.at("steps")), 5e-12, 1e-20) << typed;
  auto const torque = typed.find("until_torque=") + 13;
  EXPECT_NEAR(std::stod(typed.substr(torque)), 1e-9, 1e-23) << typed;

  auto const all = nlohmann::json::parse(
      output_of({"trade", scene, "--json", "--seconds", "0.1", "--threads", "1", "--precision",
                 "double", "--set", "integrator.end=1e-12"}));
  EXPECT_EQ(all.at("units"), "SI");
  EXPECT_NEAR(all.at("end"), 1e-12, 1e-25);
  for (auto const& method : all.at("methods"))
    for (auto const& rung : method.at("rungs"))
      if (rung.contains("dt")) {
        EXPECT_LE(rung.at("dt").get<double>(), 1.0001e-12) << method.at("method");
      }
}

}  // namespace
}  // namespace cayspin::program::test
