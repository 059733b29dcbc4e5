// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Runs on several ranks that are refused, fail, are interrupted or lose a rank.
#include "files/available_memory.hpp"
#include "io/checkpoint.hpp"
#include "io/scene.hpp"
#include "on_ranks.hpp"
#include "simulation/plan.hpp"

#include <sys/types.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <random>
#include <set>
#include <thread>
#include <utility>
#include <vector>

namespace cayspin::program::test {
namespace {

/// Returns the processes that `parent` started.
std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> found;
  for (auto const& entry : fs::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "stat");
    pid_t child = 0, its_parent = 0;
    std::string name, state;
    if (file >> child >> name >> state >> its_parent && its_parent == parent)
      found.push_back(child);
  }
  return found;
}
TEST_F(OnRanks, AreRefusedInOneLine) {
  auto const scene = write("scene.toml", film("[7, 9, 13]", "method = \"rkmk4\""));
  auto const refused = [&](Arguments const& more, std::string const& part) {
    SCOPED_TRACE(part);
    expect_refused(start_on(2, run_of(scene, "out.h5", more)), part);
    EXPECT_FALSE(fs::exists(in_folder("out.h5")));
  };
  refused({"--ranks", "1,4"}, "--ranks 1,4: accepted:");
  refused({"--ranks", "many"}, "--ranks many: accepted: two numbers");
  refused({"--set", "lattice.shape=[7,9,-1]"}, "lattice.shape");
  refused({"--set", "integrator.method='rkmk4_as_printed'"},
          "integrator.method: runs only on one rank");
  refused({"--set", "initial={expression=['0','0','k-12']}"}, "the spin of site (0, 0, 12)");
  refused({"--restart", "nothing.h5"}, "nothing.h5");
  refused({"--space", "nowhere"}, "--space nowhere");
  refused({"--device", "1000"}, "--device 1000: ");
  refused({"--no-such-option"}, "--no-such-option");
  expect_refused(start_on(2, run_of(scene, "no/such/folder/out.h5")), "no/such/folder");
  expect_refused(start(run_of(scene, "out.h5", {"--ranks", "1,2"})),
                 "--ranks 1,2: the run has one");
  expect_refused(start_on(2, {"check", scene}), "check runs on one rank; accepted: run");
  expect_refused(start_on(2, {"relax", scene, "--set", "field.applied=[0,0,1]"}),
                 "relax runs on one rank; accepted: run");

  auto const other = write("other.toml", film("[7, 9, 13]", "method = \"heun\""));
  Treatment launcher;
  launcher.program = CAYSPIN_MPIEXEC;
  for (auto const& of_second : {run_of(other, "out.h5"), run_of(scene, "other.h5"),
                                run_of(scene, "out.h5", {"--space", "serial"}),
                                run_of(scene, "out.h5", {"--ranks", "1,2"})}) {
    Arguments both = launch(1, run_of(scene, "out.h5"));
    both.push_back(":");
    auto const second = launch(1, of_second);
    both.insert(both.end(), second.begin(), second.end());
    expect_refused(start(both, launcher), "the ranks were given different scenes or options");
  }
}

TEST_F(OnRanks, SayOnceThatOneHasTooLittleMemory) {
  // A rank's field is 131 MB. The start is uniform, because expressions of all sites take long.
  auto const scene =
      write("scene.toml", film("[256, 256, 160]", "method = \"rkmk4\"", "uniform = [0, 0, 1]"));
  expect_too_little_memory(run_of(scene, "out.h5"));
}

// Only ranks with a part need memory. The restart file is of another lattice, and so ends the run
// before it allocates any.
TEST_F(OnRanks, LeaveTheMemoryOfIdleOnesToTheOthers) {
  std::string const method = "method = \"rkmk4\"";
  auto const large = [&](std::int64_t planes) {
    return film(fmt::format("[200, 200, {}]", planes), method);
  };
  auto const bytes = [&](std::int64_t planes) {
    auto const scene = io::parse_scene(large(planes), "large.toml");
    return simulation::make_plan(scene, simulation::Precision::double_precision).memory.total();
  };
  auto const available = io::available_memory();
  std::int64_t planes = 8;
  while (bytes(planes) < available * 2 / 5) planes += planes / 4;  // up to half of it
  auto const small = write("small.toml", film("[7, 9, 13]", method));
  ASSERT_EQ(start(run_of(small, "small.h5")).status, 0);
  auto const outcome = start_on(4, run_of(write("large.toml", large(planes)), "out.h5",
                                          {"--ranks", "1,1", "--restart", "small.h5"}));
  EXPECT_TRUE(contains(outcome.errors, "small.h5: its lattice is "));
}

TEST_F(OnRanks, SayOnceThatNumbersFailed) {
  auto const scene = write("scene.toml", film("[7, 9, 13]", "method = \"euler\""));
  auto const outcome = start_on(
      3, run_of(scene, "out.h5", {"--set", "field.applied=[0,0,1]", "--set", "integrator.dt=0.3"}));
  EXPECT_EQ(outcome.status, 3);
  auto const after_warning = outcome.errors.find('\n') + 1;
  EXPECT_TRUE(contains(outcome.errors.substr(0, after_warning), "warning: "));
  auto const failure = outcome.errors.substr(after_warning);
  EXPECT_TRUE(is_one_line(failure)) << failure;
  EXPECT_TRUE(contains(failure, "energy rose by"));
  EXPECT_TRUE(contains(failure, "last good frame is "));
}

TEST_F(OnRanks, EndTogetherWhenInterrupted) {
  auto const scene = write("scene.toml", film("[16, 33, 8]", "method = \"rkmk4\""));
  // A rank without a part waits for the others, and then ends with 0.
  for (auto const& [ranks, expected] :
       {std::pair{3, std::multiset{130, 130, 130}}, {4, {0, 130, 130, 130}}}) {
    SCOPED_TRACE(ranks);
    auto const name = fmt::format("on_{}", ranks), file = name + ".h5";
    Treatment interrupted;
    interrupted.program = CAYSPIN_MPIEXEC;
    interrupted.interrupt_after = 0.3;
    interrupted.interrupt_when = in_folder(file);
    // An interrupted launcher may lose the statuses of its ranks, so each rank stores its own.
    auto command =
        launch(ranks, run_of(scene, file, {"--ranks", "3,1", "--set", "integrator.steps=1000000"}));
    command.insert(command.begin() + 2,
                   {"sh", "-c", "trap : INT; \"$@\"; echo $? > " + name + ".status.$$", "sh"});
    auto const outcome = start(command, interrupted);
    std::multiset<int> statuses;
    for (auto const& entry : fs::directory_iterator(folder_)) {
      if (entry.path().stem() != name + ".status") continue;
      int status = -1;
      std::ifstream(entry.path()) >> status;
      statuses.insert(status);
    }
    EXPECT_EQ(statuses, expected);
    auto const line = outcome.errors.find("interrupted after step ");
    ASSERT_NE(line, std::string::npos) << outcome.errors;
    EXPECT_EQ(outcome.errors.find("interrupted after step ", line + 1), std::string::npos);
    auto const info = io::read_info(in_folder(file));
    EXPECT_FALSE(info.complete);
    EXPECT_EQ(std::stoll(outcome.errors.substr(line + 23)), info.frame_steps.back());
  }
}

TEST_F(OnRanks, SurviveTheDeathOfOne) {
  auto const scene = write(
      "scene.toml", film("[16, 33, 8]", "method = \"ab2\"") + "checkpoint_every = \"20 steps\"\n");
  Arguments const longer{"--set", "integrator.steps=100000", "--set", "output.every=10"};
  std::mt19937 random(5);
  int const kills = setting("CAYSPIN_RANK_KILLS", 5);
  for (int kill = 0; kill < kills; ++kill) {
    SCOPED_TRACE(kill);
    auto const name = fmt::format("{}.h5", kill);
    auto const process = begin(launch(3, run_of(scene, name, longer)), CAYSPIN_MPIEXEC);
    auto const checkpoint = io::checkpoint_beside(in_folder(name));
    ASSERT_TRUE(eventually([&] { return fs::exists(checkpoint); }));
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 500));
    std::vector<pid_t> ranks;
    for (pid_t const proxy : children_of(process))
      for (pid_t const rank : children_of(proxy)) ranks.push_back(rank);
    ASSERT_EQ(ranks.size(), 3u);
    ::kill(ranks[random() % 3], SIGKILL);
    auto const began = std::chrono::steady_clock::now();
    EXPECT_NE(end(process, 0), 0);
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(20));
    auto const info = io::read_info(in_folder(name));
    EXPECT_FALSE(info.complete);
    ASSERT_GT(info.frames, 0);
    auto const step = io::CheckpointReader(checkpoint).header().step;
    auto const to = fmt::format("integrator.steps={}", std::max(step, info.frame_steps.back()) + 5);
    auto const outcome = start_on(2, run_of(scene, "on.h5", {"--restart", name, "--set", to}));
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
  }
}
}  // namespace
}  // namespace cayspin::program::test
