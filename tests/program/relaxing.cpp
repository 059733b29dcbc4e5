// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin relax to one equilibrium or to one for each field of a list: its file, and refusals.
#include "io/ovf.hpp"
#include "program_test.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace cayspin::program::test {
namespace {

struct Relax : ProgramTest {
  std::string const scene = R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [12, 10]
[field]
exchange = 40.0
anisotropy = { constant = 0.1, axis = [1, 0, 0] }
slab_demag = { normal = [0, 0, 1] }
[initial]
random = { seed = 3 }
)toml";

  Outcome relax(std::string const& text, Arguments const& more = {}) const {
    return start(joined({"relax", write("scene.toml", text), "--output", "out.h5"}, more));
  }
};

// The spin of the small moment starts at the maximum of its energy, without torque.
TEST_F(Relax, TurnsASpinOfASmallMoment) {
  auto const outcome = relax(R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [2]
moments = "i == 0 ? 1 : 1e-3"
[field]
applied = [0, 0, 1e-4]
[initial]
expression = ["0", "0", "i == 0 ? 1 : -1"]
)toml");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  auto const spins = read_dataset("out.h5", "/spins").values;
  EXPECT_NEAR(spins.at(2), 1, 1e-6);
  EXPECT_NEAR(spins.at(5), 1, 1e-3);  // max |m x H| is below 1e-6 where H is 1e-4
}

TEST_F(Relax, FindsTheStateOfAFilm) {
  for (std::string const precision : {"double", "single"}) {
    auto const outcome = relax(scene, {"--precision", precision, "--overwrite"});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_TRUE(contains(outcome.output, "1 of 1: converged after "));
    auto const info = info_of("out.h5");
    EXPECT_TRUE(info.complete);
    ASSERT_TRUE(info.cost.relaxed);
    EXPECT_TRUE(info.cost.relaxed->converged);
    EXPECT_LT(info.cost.relaxed->torque, 1e-6);
    EXPECT_LE(info.cost.evaluations, 105);
    ASSERT_EQ(info.frames, 1);
    EXPECT_NEAR(info.frame_scalars[0].energy, -0.05 * 120, 1e-6);
    EXPECT_NEAR(std::abs(info.frame_scalars[0].magnetization[0]), 1, 1e-6);
    EXPECT_EQ(last_spins("out.h5").size(), 360U);
  }
  EXPECT_TRUE(contains(output_of({"info", "out.h5"}), "at rest      yes, max |m x H| = "));
}

// Where moments differ, relax searches repeatedly until the torque is small enough. All searches
// share the limit of evaluations.
TEST_F(Relax, EndsAtAnyLimitOfEvaluations) {
  auto const file = write("scene.toml", R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [2, 2, 2]
crystal = "bcc"
moments = [1, 0.2]
[field]
anisotropy = { constant = 1.0, axis = [0, 0, 1] }
applied = [0.1, 0.2, 0.3]
[initial]
random = { seed = 1 }
)toml");
  int converged = 0;
  for (int evaluations = 1; evaluations <= 40; ++evaluations) {
    auto const outcome = start({"relax", file, "--output", "out.h5", "--overwrite", "--torque",
                                "1e-6", "--evaluations", std::to_string(evaluations)});
    if (outcome.status == 0)
      ++converged;
    else
      EXPECT_EQ(outcome.status, 3) << evaluations << ": " << outcome.errors;
  }
  EXPECT_GT(converged, 0);
  EXPECT_LT(converged, 40);
}

// In a field along its easy axis, a uniform film switches at |h| = K.
TEST_F(Relax, FollowsAHysteresis) {
  std::string fields;
  for (int i = 10; i >= -10; --i) fields += "[" + std::to_string(0.03 * i) + ", 0, 0.0003], ";
  auto const outcome = relax(scene, {"--quiet", "--set", "field.applied=[" + fields + "]", "--set",
                                     "initial={ uniform = [1, 0.02, 0] }"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
  auto const info = info_of("out.h5");
  ASSERT_EQ(info.frames, 21);
  for (std::size_t frame = 0; frame < 21; ++frame) {
    double const h = 0.03 * (10 - static_cast<double>(frame));
    EXPECT_EQ(info.frame_steps[frame], static_cast<std::int64_t>(frame));
    EXPECT_NEAR(info.frame_scalars[frame].magnetization[0], h > -0.1 ? 1 : -1, 1e-5) << h;
  }
}

std::string const si_scene = R"toml(units = "SI"
[material]
Ms = 8e5
A = 1.3e-11
alpha = 0.02
damping_form = "gilbert"
[system]
kind = "llg"
[lattice]
shape = [8, 6]
spacing = 5e-9
[initial]
uniform = [1, 0.1, 0.2]
)toml";

// In SI: a field of Ms / 2 along z tilts a thin film to m_z = H / Ms.
TEST_F(Relax, InSi) {
  auto const outcome = relax(si_scene + R"toml([field]
applied = [0.0, 1e-4, 0.502654824574367]
slab_demag = { normal = [0, 0, 1] }
)toml",
                             {"--torque", "1e-9"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_TRUE(contains(outcome.output, " T, energy "));
  auto const info = info_of("out.h5");
  EXPECT_LT(info.cost.relaxed->torque, 1e-9);
  EXPECT_NEAR(info.frame_scalars[0].magnetization[2], 0.5, 2e-4);
}

// `relax` takes no steps, so it refuses no method or tolerance.
TEST_F(Relax, IgnoresTheIntegrator) {
  for (std::string const precision : {"double", "single"}) {
    Arguments const same{"--precision", precision, "--overwrite"};
    ASSERT_EQ(relax(scene, same).status, 0);
    auto const spins = last_spins("out.h5");
    for (std::string const integrator :
         {"method = \"auto\"\nerror = 1e-4\ndt = 0.1\nend = 1\n",
          "method = \"tsit5\"\ntolerance = 1e-9\ndt = 0.1\nend = 1\n",
          "method = \"implicit_midpoint\"\ndt = 1e9\nend = 1e9\nrefuse_unstable = true\n"}) {
      auto const outcome = relax(scene + "[integrator]\n" + integrator, same);
      ASSERT_EQ(outcome.status, 0) << integrator << outcome.errors;
      EXPECT_EQ(last_spins("out.h5"), spins) << integrator;
    }
  }
}

TEST_F(Relax, SaysWhenItDoesNotConverge) {
  auto const outcome = relax(scene, {"--evaluations", "12"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_TRUE(contains(outcome.output, "1 of 1: stopped at the limit of 1"));
  EXPECT_TRUE(contains(outcome.errors, ": not converged: evaluation limit reached\n"));
  auto const info = info_of("out.h5");
  EXPECT_TRUE(info.complete);
  EXPECT_FALSE(info.cost.relaxed->converged);
  EXPECT_GT(info.cost.relaxed->torque, 1e-6);
}

// Along the hard axis of a film the torque vanishes, too, but the energy has a saddle.
TEST_F(Relax, KeepsASaddleOnDemand) {
  for (bool const keeps : {false, true}) {
    Arguments options{"--overwrite", "--set", "initial={ uniform = [0, 1, 0] }"};
    if (keeps) options.push_back("--keep-saddles");
    EXPECT_EQ(relax(scene, options).status, 0);
    auto const info = info_of("out.h5");
    EXPECT_NEAR(info.frame_scalars[0].energy, keeps ? 0 : -0.05 * 120, 1e-6);
  }
}

// A checkpoint that an earlier run left beside the output is refused, or removed by --overwrite.
TEST_F(Relax, LeavesNoCheckpointOfAnother) {
  write("out.checkpoint.h5", "of another run");
  EXPECT_EQ(relax(scene).status, 2);
  EXPECT_FALSE(exists("out.h5"));
  EXPECT_EQ(relax(scene, {"--overwrite"}).status, 0);
  EXPECT_FALSE(exists("out.checkpoint.h5"));
}

TEST_F(Relax, IsExported) {
  ASSERT_EQ(relax(scene).status, 0);
  EXPECT_EQ(output_of({"export", "out.h5", "--ovf", "ovf"}), "ovf/out_000000.ovf\n");
  EXPECT_TRUE(exists("ovf/out_000000.ovf"));
}

TEST_F(Relax, KeepsTheStatesBeforeAFieldThatIsNotFinite) {
  auto const outcome =
      relax(scene, {"--json", "--set", "field.applied=[[0.3, 0, 0.001], [0, 0, 1.7e308]]"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_TRUE(contains(outcome.errors, "is not finite; out.h5 has 1 of 2 states"));
  auto const found = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(found.at("frames"), 1);
  EXPECT_EQ(found.at("converged"), false);
  EXPECT_EQ(found.at("searches").size(), 1U);
  EXPECT_TRUE(contains(output_of({"info", "out.h5"}), "no: interrupted or failed"));
}

// An equilibrium has a number, but no time.
TEST_F(Relax, HasNoTimes) {
  ASSERT_EQ(relax(si_scene + "[field]\napplied = [[0, 0, 0.1], [0, 0, 0.2]]\n").status, 0);
  auto const said = output_of({"info", "out.h5"});
  EXPECT_TRUE(contains(said, "state 1: energy ")) << said;
  EXPECT_FALSE(contains(said, "t = ")) << said;
  output_of({"export", "out.h5", "--ovf", "ovf"});
  EXPECT_EQ(io::read_ovf(in_folder("ovf/out_000001.ovf")).description.at(0), "Equilibrium: 1");
}

// `check` describes what relax would do with a scene that only relax accepts.
TEST_F(Relax, IsChecked) {
  std::string const list = "field.applied=[[0.3, 0, 0.001], [0, 0, 0.001], [-0.3, 0, 0.001]]";
  auto const file = write("scene.toml", scene);
  auto const said = output_of({"check", file, "--set", list});
  EXPECT_TRUE(contains_all(
      said, {"H = h in turn, 3 of them: h = (0.3, 0, 0.001) to (-0.3, 0, 0.001)",
             "relax       L-BFGS preconditioned by exchange, until max |m x H| is below the "
             "--torque of cayspin relax; each field starts at the state found before\n",
             "search ", "output      3 frames, "}));
  for (std::string const part : {"stable dt", "method", "per step"})
    EXPECT_FALSE(contains(said, part)) << part;
  auto const without = output_of(
      {"check", file, "--set", "field={ applied = [0.1, 0, 0] }", "--precision", "single"});
  EXPECT_TRUE(
      contains_all(without, {"relax       L-BFGS without exchange", "output      1 frame, "}));

  auto const json = nlohmann::json::parse(
      output_of({"check", file, "--json", "--set", list, "--set", "lattice.shape=[120, 100]"}));
  EXPECT_EQ(json.at("states"), 3);
  EXPECT_EQ(json.at("sites"), 12000);
  EXPECT_TRUE(json.at("stable_dt").is_null());
  EXPECT_TRUE(json.at("evaluations_per_step").is_null());
  EXPECT_EQ(json.at("work_bytes"), 24 * json.at("spins_bytes").get<std::int64_t>());
  auto const single = nlohmann::json::parse(
      output_of({"check", file, "--json", "--set", list, "--precision", "single"}));
  EXPECT_EQ(single.at("work_bytes"), 26 * single.at("spins_bytes").get<std::int64_t>());
  double const frames = 3 * 12000 * 3 * 8;
  EXPECT_GT(json.at("file_bytes").get<double>(), frames);
  EXPECT_LT(json.at("file_bytes").get<double>(), frames + 3 * 200);
  ASSERT_EQ(relax(scene, set(list, "lattice.shape=[120, 100]")).status, 0);
  EXPECT_GT(static_cast<double>(std::filesystem::file_size(in_folder("out.h5"))), frames);

  // A list of fields makes this a scene for relax, even with [integrator]; without a list it is one
  // for run.
  std::string const integrator = "[integrator]\nmethod = \"rkmk4\"\ndt = 0.1\nsteps = 50\n";
  auto const both = write("scene.toml", scene + integrator);
  EXPECT_TRUE(contains(output_of({"check", both, "--set", list}), "output      3 frames, "));
  EXPECT_TRUE(contains(output_of({"check", both}), "stable dt"));
}

TEST_F(Relax, IsCheckedInSi) {
  auto const file = write("scene.toml", si_scene + R"toml([field]
applied = [[0.02, 0.0, 0.0], [-0.05, 0.0, 0.0]]
)toml");
  EXPECT_TRUE(contains(output_of({"check", file}),
                       "H = h T in turn, 2 of them: h = (0.02, 0, 0) to (-0.05, 0, 0)"));
  auto const json = nlohmann::json::parse(output_of({"check", file, "--json"}));
  EXPECT_EQ(json.at("units"), "SI");
  EXPECT_EQ(json.at("states"), 2);
}

TEST_F(Relax, IsRefusedByCheck) {
  auto const file = write("scene.toml", scene);
  for (auto const& [more, says] : std::vector<std::pair<Arguments, std::string>>{
           {{"--ranks", "1,2"}, "--ranks 1,2: the scene is for cayspin relax, which runs on one"},
           {set("thermal={ temperature = 1, seed = 2 }"),
            "thermal.temperature: an equilibrium has"}}) {
    expect_refused(joined({"check", file}, more), says);
  }
  // Rigid bodies cannot be relaxed, so [integrator] is required.
  auto const body = write("body.toml",
                          "[system]\nkind = \"rigid_body\"\ninertia = [1, 2, 3]\n"
                          "[lattice]\nshape = [1]\n[initial]\nuniform = [1, 0, 0]\n");
  EXPECT_TRUE(contains(start({"check", body}).errors, "integrator: is missing"));
}

// With a small moment, the bound on the gradient is smaller than Minimizer::least_bound.
TEST_F(Relax, TakesTheLeastTorqueWithAnyMoment) {
  for (std::string const moment : {"0.5", "1e-3"}) {
    auto const outcome =
        relax(scene, joined({"--torque", "1e-150", "--evaluations", "200", "--overwrite"},
                            set("lattice.moments=[" + moment + "]", "lattice.shape=[4,3]")));
    EXPECT_TRUE(outcome.status == 0 || outcome.status == 3) << outcome.errors;
  }
}

TEST_F(Relax, RefusesInOneLine) {
  write("scene.toml", scene);
  for (auto const& [more, part] : std::vector<std::pair<Arguments, std::string>>{
           {set("field.applied=[\"t\", 0, 0]"), "field.applied: depends on t"},
           {set("field.applied=[[1, 0]]"), "field.applied[0]: has 2 entries"},
           {set("field.applied=[[1, 0, 0], 2]"), "field.applied[1]: 2 is an integer"},
           {set("system={ kind = \"rigid_body\", inertia = [1, 2, 3] }"), "lattice.shape"},
           {set("integrator.dt=-1"), "integrator"},
           {{"--torque", "0"}, "--torque 0; accepted: a number of at least 1e-150"},
           {{"--torque", "nan"}, "--torque nan; accepted: a number of at least 1e-150"},
           {{"--torque", "1e-200"}, "--torque 1e-200; accepted: a number of at least"}}) {
    expect_refused(joined({"relax", "scene.toml", "--output", "out.h5"}, more), part);
    EXPECT_FALSE(exists("out.h5")) << part;
  }
  auto const missing = run_into("out.h5", scene);
  EXPECT_EQ(missing.status, 2);
  EXPECT_TRUE(contains_all(
      missing.errors, {"integrator: is missing", "only cayspin relax, modes and path go without"}));
  auto const listed =
      run_into("out.h5", scene + "[integrator]\nmethod = \"rkmk4\"\ndt = 0.1\nsteps = 1\n",
               set("field.applied=[[1, 0, 0]]"));
  EXPECT_EQ(listed.status, 2);
  EXPECT_TRUE(contains(listed.errors, "a list of fields is for cayspin relax"));
}

}  // namespace
}  // namespace cayspin::program::test
