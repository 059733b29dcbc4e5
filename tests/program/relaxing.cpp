// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin relax: a state of rest, or one for each field of a list, its file, and how it ends.
#include "program_test.hpp"

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
    Arguments arguments{"relax", write("scene.toml", text), "--output", "out.h5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return start(arguments);
  }
};

TEST_F(Relax, FindsTheStateOfAFilm) {
  for (std::string const precision : {"double", "single"}) {
    auto const outcome = relax(scene, {"--precision", precision, "--overwrite"});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_TRUE(contains(outcome.output, "1 of 1: converged after "));
    auto const info = io::read_info(in_folder("out.h5"));
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
  auto const info = start({"info", "out.h5"});
  EXPECT_TRUE(contains(info.output, "at rest      yes, max |m x H| = "));
}

// Along the easy axis a uniform film switches at |h| = K.
TEST_F(Relax, FollowsAHysteresis) {
  std::string fields;
  for (int i = 10; i >= -10; --i) fields += "[" + std::to_string(0.03 * i) + ", 0, 0.0003], ";
  auto const outcome = relax(scene, {"--quiet", "--set", "field.applied=[" + fields + "]", "--set",
                                     "initial={ uniform = [1, 0.02, 0] }"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
  auto const info = io::read_info(in_folder("out.h5"));
  ASSERT_EQ(info.frames, 21);
  for (std::size_t frame = 0; frame < 21; ++frame) {
    double const h = 0.03 * (10 - static_cast<double>(frame));
    EXPECT_EQ(info.frame_steps[frame], static_cast<std::int64_t>(frame));
    EXPECT_NEAR(info.frame_scalars[frame].magnetization[0], h > -0.1 ? 1 : -1, 1e-5) << h;
  }
}

// In SI: a field along z of half of Ms turns a thin film by half: m_z = H / Ms.
TEST_F(Relax, InSi) {
  auto const outcome = relax(R"toml(units = "SI"
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
[field]
applied = [0.0, 1e-4, 0.502654824574367]
slab_demag = { normal = [0, 0, 1] }
[initial]
uniform = [1, 0.1, 0.2]
)toml",
                             {"--torque", "1e-9"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_TRUE(contains(outcome.output, " T, energy "));
  auto const info = io::read_info(in_folder("out.h5"));
  EXPECT_LT(info.cost.relaxed->torque, 1e-9);
  EXPECT_NEAR(info.frame_scalars[0].magnetization[2], 0.5, 2e-4);
}

TEST_F(Relax, SaysWhenItDoesNotConverge) {
  auto const outcome = relax(scene, {"--evaluations", "12"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_TRUE(contains(outcome.errors, "1 of 1 states not converged, the first for: evaluation"));
  auto const info = io::read_info(in_folder("out.h5"));
  EXPECT_TRUE(info.complete);
  EXPECT_FALSE(info.cost.relaxed->converged);
  EXPECT_GT(info.cost.relaxed->torque, 1e-6);
}

// What an earlier run left beside the file is not taken for the file's own.
TEST_F(Relax, LeavesNoCheckpointOfAnother) {
  write("out.checkpoint.h5", "of another run");
  EXPECT_EQ(relax(scene).status, 2);
  EXPECT_FALSE(std::filesystem::exists(in_folder("out.h5")));
  EXPECT_EQ(relax(scene, {"--overwrite"}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(in_folder("out.checkpoint.h5")));
}

TEST_F(Relax, RefusesInOneLine) {
  struct Case {
    std::string text;
    Arguments more;
    std::string says;
  };
  for (auto const& [text, more, says] : std::vector<Case>{
           {scene, {"--set", "field.applied=[\"t\", 0, 0]"}, "field.applied: depends on t"},
           {scene, {"--set", "field.applied=[[1, 0]]"}, "field.applied"},
           {scene, {"--set", "field.applied=[[1, 0, 0], 2]"}, "field.applied"},
           {scene,
            {"--set", "system={ kind = \"rigid_body\", inertia = [1, 2, 3] }"},
            "lattice.shape"},
           {scene, {"--set", "integrator.dt=-1"}, "integrator"},
           {scene, {"--torque", "0"}, "--torque"}}) {
    auto const outcome = relax(text, more);
    EXPECT_EQ(outcome.status, 2) << says;
    EXPECT_TRUE(is_one_line(outcome.errors));
    EXPECT_TRUE(contains(outcome.errors, says));
    EXPECT_FALSE(std::filesystem::exists(in_folder("out.h5"))) << says;
  }
  auto const listed = scene + "[integrator]\nmethod = \"rkmk4\"\ndt = 0.1\nsteps = 1\n";
  auto const run = start({"run", write("scene.toml", listed), "--output", "out.h5", "--set",
                          "field.applied=[[1, 0, 0]]"});
  EXPECT_EQ(run.status, 2);
  EXPECT_TRUE(contains(run.errors, "a list of fields is for cayspin relax"));
}

}  // namespace
}  // namespace cayspin::program::test
