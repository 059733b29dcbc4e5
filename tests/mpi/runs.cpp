// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The program on several ranks writes the numbers that it writes on one.
#include "program/program_test.hpp"
#include "simulation/random_run.hpp"

#include <cayspin/io/checkpoint.hpp>

#include <fmt/format.h>
#include <sys/types.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <set>
#include <sstream>
#include <thread>
#include <tuple>

namespace cayspin::program::test {
namespace {

namespace fs = std::filesystem;

int setting(char const* name, int usual) {
  char const* const asked = std::getenv(name);
  return asked ? std::atoi(asked) : usual;
}

/// The processes that a process started.
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

/// mpiexec -n RANKS cayspin ARGUMENTS...
class OnRanks : public ProgramTest {
 protected:
  Arguments launch(int ranks, Arguments const& arguments) const {
    Arguments all{"-n", std::to_string(ranks), CAYSPIN_PROGRAM};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return all;
  }
  Outcome start_on(int ranks, Arguments const& arguments) const {
    Treatment launcher;
    launcher.program = CAYSPIN_MPIEXEC;
    return start(launch(ranks, arguments), launcher);
  }

  static Arguments run_of(std::string const& scene, std::string const& output,
                          Arguments const& more = {}) {
    Arguments all{"run", scene, "--quiet", "--overwrite", "--output", output};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  /// What two files say of a run is the same: all frames and samples, to the bit, and the counts.
  void expect_same(std::string const& one, std::string const& other) const {
    auto const first = io::read_info(in_folder(one)), second = io::read_info(in_folder(other));
    EXPECT_TRUE(second.complete);
    EXPECT_EQ(second.frame_steps, first.frame_steps);
    EXPECT_EQ(second.cost.evaluations, first.cost.evaluations);
    for (char const* dataset : {"spins", "scalars/energy", "scalars/magnetization",
                                "scalars/norm_defect", "scalars/time"})
      EXPECT_EQ(read_dataset(other, dataset).values, read_dataset(one, dataset).values) << dataset;
  }

  void expect_refused(Outcome const& outcome, std::string const& part, int status = 2) const {
    EXPECT_EQ(outcome.status, status);
    EXPECT_TRUE(is_one_line(outcome.errors)) << outcome.errors;
    EXPECT_TRUE(contains(outcome.errors, part));
  }
};

std::string film(std::string const& shape, std::string const& integrator) {
  return fmt::format(R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = {}
boundary = ["open", "periodic", "open"]
[field]
exchange = 1.0
anisotropy = {{ constant = 0.7, axis = [1, 2, 3] }}
applied = ["0.5*cos(7*t)", "0.1", "0.4"]
[initial]
expression = ["cos(5*x + 2*y)", "sin(3*z + y)", "x - 0.3*k"]
[integrator]
{}
dt = 0.02
steps = 30
[output]
every = 10
scalars_every = 5
)toml",
                     shape, integrator);
}

TEST_F(OnRanks, WriteTheSameFile) {
  auto const scene = write("scene.toml", film("[7, 9, 13]", "method = \"rkmk4\""));
  for (std::string const precision : {"double", "single"}) {
    Arguments const in_precision{"--precision", precision};
    ASSERT_EQ(start(run_of(scene, "one.h5", in_precision)).status, 0);
    // In chunks, the first rank takes a frame by pieces of whole ones.
    for (auto const& [ranks, threads, cut, chunk] :
         {std::tuple{1, "2", "", "13"}, std::tuple{2, "1", "", "13"},
          std::tuple{2, "2", "2,1", "1"}, std::tuple{3, "1", "", "2"},
          std::tuple{4, "1", "2,2", "2"}, std::tuple{4, "1", "1,3", "1"}}) {
      SCOPED_TRACE(fmt::format("{} ranks, {} threads, {}, chunk {}", ranks, threads, cut, chunk));
      Arguments more{"--precision", precision, "--threads",
                     threads,       "--set",   std::string("output.chunk=") + chunk};
      if (*cut) more.insert(more.end(), {"--ranks", cut});
      auto const outcome = start_on(ranks, run_of(scene, "other.h5", more));
      EXPECT_EQ(outcome.status, 0) << outcome.errors;
      bool const one_idle = std::string(cut) == "1,3";
      EXPECT_EQ(outcome.errors, one_idle ? "warning: 1 of 4 ranks have no part: one has at least 4 "
                                           "rows or planes\n"
                                         : "");
      EXPECT_EQ(outcome.output, "");
      expect_same("one.h5", "other.h5");
    }
  }
}

TEST_F(OnRanks, AverageOverLayers) {
  auto const scene = write("scene.toml", film("[7, 9, 13]", "method = \"rkmk4\""));
  for (std::string const normal : {"[0, 1, 0]", "[0, 0, 1]"}) {
    Arguments more{"--set", fmt::format("field.slab_demag={{normal={},average='layer'}}", normal)};
    ASSERT_EQ(start(run_of(scene, "one.h5", more)).status, 0);
    more.insert(more.end(), {"--ranks", ""});
    for (std::string const cut : {"1,3", "2,1", "2,2"}) {
      SCOPED_TRACE(normal + ", " + cut);
      more.back() = cut;
      auto const outcome = start_on(cut == "2,2"   ? 4
                                    : cut == "2,1" ? 2
                                                   : 3,
                                    run_of(scene, "other.h5", more));
      ASSERT_EQ(outcome.status, 0) << outcome.errors;
      expect_same("one.h5", "other.h5");
    }
  }
}

TEST_F(OnRanks, RunEveryShippedScene) {
  for (auto const& entry : fs::directory_iterator(CAYSPIN_SCENES)) {
    if (entry.path().extension() != ".toml") continue;
    SCOPED_TRACE(entry.path().filename());
    auto const scene = entry.path().string();
    auto const text = (std::ostringstream() << std::ifstream(scene).rdbuf()).str();
    auto const short_run = text.find("\nend =") != std::string::npos ? "" : "x";
    Arguments more;
    if (*short_run) more = {"--set", "integrator.steps=40"};
    ASSERT_EQ(start(run_of(scene, "one.h5", more)).status, 0);
    std::vector<std::pair<int, std::string>> divisions{{3, ""}};
    if (setting("CAYSPIN_ALL_DIVISIONS", 0))
      divisions.insert(divisions.end(), {{1, ""}, {2, "1,2"}, {2, "2,1"}, {4, ""}, {4, "2,2"}});
    for (auto const& [ranks, cut] : divisions) {
      SCOPED_TRACE(fmt::format("{} ranks, {}", ranks, cut));
      auto in_parts = more;
      if (!cut.empty()) in_parts.insert(in_parts.end(), {"--ranks", cut});
      auto const outcome = start_on(ranks, run_of(scene, "other.h5", in_parts));
      if (contains(text, "method = \"stiff")) {
        expect_refused(outcome, "runs on one rank alone");
        continue;
      }
      // A chain or a film is not divided along every axis.
      if (!cut.empty() && contains(outcome.errors, "--ranks " + cut + ": accepted:")) continue;
      ASSERT_EQ(outcome.status, 0) << outcome.errors;
      expect_same("one.h5", "other.h5");
    }
  }
}

TEST_F(OnRanks, RunRandomScenesOfEveryMethod) {
  using simulation::test::RandomRun;
  static constexpr char const* shapes[] = {"[13, 24]", "[5, 3, 22]", "[4, 18, 14]", "[1, 1, 30]",
                                           "[34, 20, 1]"};
  int const wanted = setting("CAYSPIN_RANDOM_SCENES", 40);
  int scenes = 0, refused = 0;
  std::set<std::string_view> methods;
  auto const variants = simulation::variants();
  for (int draw = 0; scenes < wanted && draw < 20 * wanted && !HasFailure(); ++draw) {
    RandomRun random(static_cast<std::uint64_t>(setting("CAYSPIN_SEED", 1)), draw);
    auto const& variant = variants[(7 * static_cast<std::size_t>(draw)) % variants.size()];
    auto const scene = write("scene.toml", random.scene(variant));
    std::string const precision = random.one_in(2) ? "single" : "double";
    int const ranks = 2 + static_cast<int>(random.below(3));
    Arguments const same{"--precision", precision, "--set",
                         fmt::format("lattice.shape={}", shapes[random.below(5)])};
    SCOPED_TRACE(fmt::format("draw {}, {} ranks, {}", draw, ranks, same.back()));
    if (start(run_of(scene, "one.h5", same)).status != 0) continue;  // has no meaning, or fails
    auto const outcome = start_on(ranks, run_of(scene, "other.h5", same));
    if (outcome.status == 2 && variant.ghosts == 0) {
      EXPECT_TRUE(contains(outcome.errors, "runs on one rank alone")) << outcome.errors;
      ++refused;
      continue;
    }
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    expect_same("one.h5", "other.h5");
    if (HasFailure()) std::printf("%s\n", random.scene(variant).c_str());
    methods.insert(variant.method->word);
    ++scenes;
  }
  std::printf("    %d scenes of %zu methods, %d of a method for one rank\n", scenes, methods.size(),
              refused);
  EXPECT_EQ(scenes, wanted);
}

TEST_F(OnRanks, GoOnFromFilesOfOtherRanks) {
  for (std::string const method :
       {"method = \"rkmk4\"", "method = \"ab2\"", "method = \"rkmk4\"\ncompensated = true",
        "method = \"tsit5\"\ntolerance = 1e-5"}) {
    SCOPED_TRACE(method);
    auto const scene = write("scene.toml", film("[5, 8, 13]", method));
    // An adaptive method ends at the last of its steps: all is compared with runs cut alike.
    auto const in_parts = [&](std::array<int, 3> const& ranks, std::string const& name) {
      std::string before;
      for (int part = 0; part < 3; ++part) {
        auto const file = fmt::format("{}_{}.h5", name, part);
        Arguments more{"--set", fmt::format("integrator.steps={}", 10 * (part + 1))};
        if (!before.empty()) more.insert(more.end(), {"--restart", before});
        auto const arguments = run_of(scene, file, more);
        int const on = ranks[static_cast<std::size_t>(part)];
        auto const outcome = on == 1 ? start(arguments) : start_on(on, arguments);
        ASSERT_EQ(outcome.status, 0) << outcome.errors;
        before = file;
      }
    };
    in_parts({1, 1, 1}, "one");
    in_parts({3, 2, 1}, "many");
    for (int part = 0; part < 3; ++part)
      expect_same(fmt::format("one_{}.h5", part), fmt::format("many_{}.h5", part));
    if (method.find("tsit5") != std::string::npos) continue;
    ASSERT_EQ(start(run_of(scene, "whole.h5")).status, 0);
    EXPECT_EQ(last_spins("many_2.h5"), last_spins("whole.h5"));
  }
}

// The noise of a site is that of its place in the whole lattice, also where a run goes on.
TEST_F(OnRanks, HaveTheNoiseOfOneRank) {
  auto const scene = write("scene.toml", film("[35, 8, 13]", "method = \"rkmk4\""));
  for (auto const& [method, precision] : {std::pair{"heun", "single"}, std::pair{"rkmk4", "double"},
                                          std::pair{"red_black2", "double"}}) {
    SCOPED_TRACE(method);
    Arguments const same{"--precision", precision,
                         "--set",       "thermal={temperature=0.5,seed=3}",
                         "--set",       fmt::format("integrator.method='{}'", method)};
    auto const with = [&](Arguments more) {
      more.insert(more.end(), same.begin(), same.end());
      return more;
    };
    ASSERT_EQ(start(run_of(scene, "one.h5", same)).status, 0);
    for (auto const& [ranks, cut] :
         {std::pair{2, "2,1"}, std::pair{3, "1,3"}, std::pair{4, "2,2"}}) {
      auto const outcome = start_on(ranks, run_of(scene, "many.h5", with({"--ranks", cut})));
      ASSERT_EQ(outcome.status, 0) << outcome.errors;
      expect_same("one.h5", "many.h5");
    }
    ASSERT_EQ(start_on(3, run_of(scene, "begin.h5", with({"--set", "integrator.steps=13"}))).status,
              0);
    ASSERT_EQ(start_on(2, run_of(scene, "end.h5", with({"--restart", "begin.h5"}))).status, 0);
    EXPECT_EQ(last_spins("end.h5"), last_spins("one.h5"));
  }
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
          "integrator.method: runs on one rank alone");
  for (std::string const slab : {"normal=[1,0,0]", "normal=[0,0,1],where='host'"})
    refused({"--set", fmt::format("field.slab_demag={{{},average='layer'}}", slab)},
            "field.slab_demag.average: runs on one rank alone");
  refused({"--set", "initial={expression=['0','0','k-12']}"}, "the spin of site (0, 0, 12)");
  refused({"--restart", "nothing.h5"}, "nothing.h5");
  refused({"--space", "nowhere"}, "--space nowhere");
  refused({"--no-such-option"}, "--no-such-option");
  expect_refused(start_on(2, run_of(scene, "no/such/folder/out.h5")), "no/such/folder");
  expect_refused(start(run_of(scene, "out.h5", {"--ranks", "1,2"})),
                 "--ranks 1,2: the run has one");
  expect_refused(start_on(2, {"check", scene}), "check runs on one rank; accepted: run");

  auto const other = write("other.toml", film("[7, 9, 13]", "method = \"heun\""));
  Arguments both = launch(1, run_of(scene, "out.h5"));
  both.push_back(":");
  auto const second = launch(1, run_of(other, "out.h5"));
  both.insert(both.end(), second.begin(), second.end());
  Treatment launcher;
  launcher.program = CAYSPIN_MPIEXEC;
  expect_refused(start(both, launcher), "the ranks were given different scenes");
}

TEST_F(OnRanks, SayOnceThatOneHasTooLittleMemory) {
  auto const scene = write("scene.toml", film("[256, 256, 160]", "method = \"rkmk4\""));
  Treatment launcher;
  launcher.program = CAYSPIN_MPIEXEC;
  for (int const poor : {0, 1}) {
    SCOPED_TRACE(poor);
    Arguments both;
    for (int rank = 0; rank < 2; ++rank) {
      auto const run = launch(1, run_of(scene, "out.h5"));
      both.insert(both.end(), run.begin(), run.begin() + 2);
      // A field is 131 MB, and no program can have 300.
      if (rank == poor)
        both.insert(both.end(), {"sh", "-c", "ulimit -v 300000; exec \"$0\" \"$@\""});
      both.insert(both.end(), run.begin() + 2, run.end());
      if (rank == 0) both.push_back(":");
    }
    auto const outcome = start(both, launcher);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(is_one_line(outcome.errors)) << outcome.errors;
    EXPECT_TRUE(outcome.errors.find("memory") != std::string::npos) << outcome.errors;
  }
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
  Treatment interrupted;
  interrupted.program = CAYSPIN_MPIEXEC;
  interrupted.interrupt_after = 0.3;
  interrupted.interrupt_when = in_folder("out.h5");
  // A launcher that is interrupted itself may lose the statuses of its ranks: each leaves its own.
  auto command = launch(3, run_of(scene, "out.h5", {"--set", "integrator.steps=1000000"}));
  command.insert(command.begin() + 2,
                 {"sh", "-c", "trap : INT; \"$@\"; echo $? > status.$$", "sh"});
  auto const outcome = start(command, interrupted);
  int ended = 0;
  for (auto const& entry : fs::directory_iterator(folder_)) {
    if (entry.path().stem() != "status") continue;
    int status = 0;
    std::ifstream(entry.path()) >> status;
    EXPECT_EQ(status, 130) << entry.path();
    ++ended;
  }
  EXPECT_EQ(ended, 3);
  auto const line = outcome.errors.find("interrupted after step ");
  ASSERT_NE(line, std::string::npos) << outcome.errors;
  EXPECT_EQ(outcome.errors.find("interrupted after step ", line + 1), std::string::npos);
  auto const info = io::read_info(in_folder("out.h5"));
  EXPECT_FALSE(info.complete);
  EXPECT_EQ(std::stoll(outcome.errors.substr(line + 23)), info.frame_steps.back());
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
