// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The program writes equal numbers on several ranks and on one.
#include "on_ranks.hpp"
#include "simulation/random_run.hpp"

#include <array>
#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

namespace cayspin::program::test {
namespace {

TEST_F(OnRanks, WriteTheSameFile) {
  auto const scene = write("scene.toml", film("[7, 9, 13]", "method = \"rkmk4\""));
  for (std::string const precision : {"double", "single"}) {
    Arguments const in_precision{"--precision", precision};
    ASSERT_EQ(start(run_of(scene, "one.h5", in_precision)).status, 0);
    // If there are chunks, the first rank receives a frame in pieces of whole chunks.
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
      EXPECT_EQ(outcome.errors, one_idle ? "warning: 1 of 4 ranks has nothing to do: a part needs "
                                           "at least 4 rows or planes\n"
                                         : "");
      EXPECT_EQ(outcome.output, "");
      expect_same("one.h5", "other.h5");
    }
  }
}

TEST_F(OnRanks, HaveASlabOnTheHost) {
  for (auto const& [multirate, substeps] : {std::pair{"false", 1}, {"true", 2}}) {
    SCOPED_TRACE(fmt::format("multirate {}", multirate));
    auto const method = fmt::format("method = \"rkmk4\"\nsubsteps = {}", substeps);
    auto const scene = write("scene.toml", film("[7, 9, 13]", method));
    Arguments const slab{
        "--set",
        fmt::format("field.slab_demag={{normal=[1,0,0],where='host',multirate={}}}", multirate)};
    ASSERT_EQ(start(run_of(scene, "one.h5", slab)).status, 0);
    for (auto const& [ranks, cut] : {std::pair{3, "1,3"}, {2, "2,1"}, {4, "2,2"}}) {
      SCOPED_TRACE(cut);
      auto in_parts = slab;
      in_parts.insert(in_parts.end(), {"--ranks", cut});
      auto const outcome = start_on(ranks, run_of(scene, "other.h5", in_parts));
      ASSERT_EQ(outcome.status, 0) << outcome.errors;
      expect_same("one.h5", "other.h5");
    }
  }
}

// Walls across the parts, and walls along them.
TEST_F(OnRanks, FollowAWallAndSumRegionsAndTerms) {
  for (auto const& [axis, shape, wall] : {std::tuple{"y", "[3, 40, 8]", "j - 23"},
                                          {"z", "[3, 8, 40]", "k - 23"},
                                          {"x", "[40, 8, 9]", "i - 23"}}) {
    SCOPED_TRACE(axis);
    auto const scene =
        write("scene.toml", fmt::format(R"toml(
system = {{ kind = "llg", damping = 0.1 }}
lattice = {{ shape = {}, follow = {{ axis = "{}", quantity = "mz" }}, regions = "{} % 2 + 4" }}
initial = {{ expression = ["1/cosh({})", "0.3", "-tanh({})"] }}
integrator = {{ method = "rkmk4", dt = 0.02, steps = 60 }}
output = {{ every = 20, scalars_every = 10, regions = true, terms = true }}
[field]
exchange = 1.0
anisotropy = {{ constant = 1.0, axis = [0, 0, 1] }}
applied = [0, 0, 0.2]
)toml",
                                        shape, axis, *axis == 'y' ? "k" : "j", wall, wall));
    ASSERT_EQ(start(run_of(scene, "one.h5")).status, 0);
    EXPECT_GT(read_dataset("one.h5", "scalars/shift").values.back(), 2);
    for (auto const& [ranks, cut] : {std::pair{2, "1,2"}, {2, "2,1"}}) {
      SCOPED_TRACE(cut);
      auto const outcome = start_on(ranks, run_of(scene, "other.h5", {"--ranks", cut}));
      ASSERT_EQ(outcome.status, 0) << outcome.errors;
      expect_same("one.h5", "other.h5");
      for (char const* dataset : {"scalars/shift", "shift", "scalars/region_magnetization",
                                  "scalars/region_energy", "scalars/term_energy"})
        EXPECT_EQ(read_dataset("other.h5", dataset).values, read_dataset("one.h5", dataset).values)
            << dataset;
    }
  }
}

TEST_F(OnRanks, RunEveryShippedScene) {
  int compared = 0;
  for (auto const& entry : fs::directory_iterator(CAYSPIN_SCENES)) {
    if (entry.path().extension() != ".toml") continue;
    SCOPED_TRACE(entry.path().filename());
    auto const scene = entry.path().string();
    auto const text = (std::ostringstream() << std::ifstream(scene).rdbuf()).str();
    if (!contains(text, "[integrator]")) continue;  // `relax` runs on one rank
    auto const short_run = text.find("\nend =") != std::string::npos ? "" : "x";
    Arguments more;
    if (*short_run) more = {"--set", "integrator.steps=40"};
    // A crystal's stages wait for those of the other ranks, which is slow if ranks share a core.
    if (contains(text, "crystal ="))
      more = {"--set", contains(text, "\"SI\"") ? "integrator.end=2e-14" : "integrator.end=5"};
    if (contains(text, "\ndemag =")) more = {"--set", "integrator.end=2e-11"};
    ASSERT_EQ(start(run_of(scene, "one.h5", more)).status, 0);
    std::vector<std::pair<int, std::string>> divisions{{3, ""}};
    if (setting("CAYSPIN_ALL_DIVISIONS", 0))
      divisions.insert(divisions.end(), {{1, ""}, {2, "1,2"}, {2, "2,1"}, {4, ""}, {4, "2,2"}});
    for (auto const& [ranks, cut] : divisions) {
      SCOPED_TRACE(fmt::format("{} ranks, {}", ranks, cut));
      auto in_parts = more;
      if (!cut.empty()) in_parts.insert(in_parts.end(), {"--ranks", cut});
      auto const outcome = start_on(ranks, run_of(scene, "other.h5", in_parts));
      if (ranks > 1 && contains(text, "method = \"stiff")) {
        expect_refused(outcome, "runs only on one rank");
        continue;
      }
      // A chain or a film cannot be divided along every axis.
      if (!cut.empty() && contains(outcome.errors, "--ranks " + cut + ": accepted:")) continue;
      ASSERT_EQ(outcome.status, 0) << outcome.errors;
      expect_same("one.h5", "other.h5");
      ++compared;
    }
  }
  EXPECT_GE(compared, 20);
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
    // Steps by a prime larger than the number of variants, so that each is drawn once per round.
    auto const& variant = variants[(10007 * static_cast<std::size_t>(draw)) % variants.size()];
    auto const text = random.scene(variant);
    auto const scene = write("scene.toml", text);
    std::string const precision = random.one_in(2) ? "single" : "double";
    int const ranks = 2 + static_cast<int>(random.below(3));
    Arguments const same{"--precision", precision, "--set",
                         fmt::format("lattice.shape={}", shapes[random.below(5)])};
    SCOPED_TRACE(fmt::format("draw {}, {} ranks, {}", draw, ranks, same.back()));
    auto const status = start(run_of(scene, "one.h5", same)).status;
    EXPECT_TRUE(status == 0 || status == 2 || status == 3) << status << '\n' << text;
    if (status != 0) continue;  // invalid, or fails
    auto const outcome = start_on(ranks, run_of(scene, "other.h5", same));
    if (outcome.status == 2 && variant.ghosts == 0) {
      EXPECT_TRUE(contains(outcome.errors, "runs only on one rank")) << outcome.errors;
      ++refused;
      continue;
    }
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    expect_same("one.h5", "other.h5");
    if (HasFailure()) std::printf("%s\n", text.c_str());
    methods.insert(variant.method->word);
    ++scenes;
  }
  std::printf("    %d scenes of %zu methods, %d of a method for one rank\n", scenes, methods.size(),
              refused);
  EXPECT_EQ(scenes, wanted);
  if (wanted >= 40) {
    EXPECT_GT(methods.size(), 8U);
  }
}

// Exchange makes this slab stiff, so that the methods for one rank are by far the fastest.
TEST_F(OnRanks, ChooseAMethodThatRunsOnSeveral) {
  auto const scene = write("scene.toml", R"toml(
[system]
kind = "llg"
damping = 0.5
[lattice]
shape = [1, 1, 100]
spacing = [1, 1, 0.01]
[field]
exchange = 1.0
anisotropy = { constant = 1.0, axis = [1, 0, 0] }
applied = [0.05, 0.05, 0.0]
slab_demag = { normal = [0, 0, 1] }
[initial]
expression = ["0.8", "0.5 + 0.1*cos(2*pi*z)", "0.3 + 0.2*cos(pi*z)"]
[integrator]
method = "auto"
error = 1e-3
dt = 0.0125
end = 0.125
[output]
every = 5
)toml");
  ASSERT_EQ(start(run_of(scene, "one.h5")).status, 0);
  EXPECT_TRUE(contains(info_of("one.h5").header.resolved_scene, "stiff"));
  auto const outcome = start_on(2, run_of(scene, "two.h5"));
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors.find("nothing to do"), std::string::npos) << outcome.errors;
  EXPECT_LT(distance(last_spins("two.h5"), last_spins("one.h5")), 4e-3);
  auto const checked = start({"check", scene, "--ranks", "1,2"});
  EXPECT_EQ(checked.status, 0) << checked.errors;
  // A restart on several ranks chooses again if the earlier run on one rank chose a method for one.
  Arguments const longer{"--set", "integrator.end=0.25"};
  ASSERT_EQ(start(run_of(scene, "whole.h5", longer)).status, 0);
  auto restarted = longer;
  restarted.insert(restarted.end(), {"--restart", "one.h5"});
  auto const rest = start_on(2, run_of(scene, "rest.h5", restarted));
  EXPECT_EQ(rest.status, 0) << rest.errors;
  EXPECT_FALSE(contains(info_of("rest.h5").header.resolved_scene, "stiff"));
  EXPECT_LT(distance(last_spins("rest.h5"), last_spins("whole.h5")), 4e-3);
}

TEST_F(OnRanks, GoOnFromFilesOfOtherRanks) {
  for (std::string const method :
       {"method = \"rkmk4\"", "method = \"ab2\"", "method = \"rkmk4\"\ncompensated = true",
        "method = \"tsit5\"\ntolerance = 1e-5"}) {
    SCOPED_TRACE(method);
    auto const scene = write("scene.toml", film("[5, 8, 13]", method));
    // An adaptive method shortens its last steps to end at the end of a run, so only runs that end
    // at equal times are compared.
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

// The noise of a site depends on its place in the whole lattice, also in a continued run.
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
}  // namespace
}  // namespace cayspin::program::test
