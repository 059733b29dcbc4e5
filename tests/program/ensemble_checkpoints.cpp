// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Checkpoints with [ensemble]: a run that was killed continues with the bits of one that was not.
#include "io/ensemble_checkpoint.hpp"
#include "program_test.hpp"

#include <fmt/format.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <tuple>
#include <vector>

namespace cayspin::program::test {
namespace {

class EnsembleCheckpoints : public ProgramTest {
 protected:
  static std::string ensemble(int replicas, std::string const& keys = {}) {
    return fmt::format("[ensemble]\nreplicas = {}\n[ensemble.vary]\n{}", replicas, keys);
  }

  static Arguments run_of(std::string const& file, Arguments const& more = {}) {
    return joined({"run", "all.toml", "--quiet", "--overwrite", "--output", file}, more);
  }

  std::filesystem::path checkpoint_of(std::string const& file) const {
    return io::checkpoint_beside(in_folder(file));
  }

  /// Starts a run into part.h5, kills it by SIGKILL after its first checkpoint, and returns the
  /// checkpoint's step.
  std::int64_t kill(Arguments const& more) const {
    auto const checkpoint = checkpoint_of("part.h5");
    std::filesystem::remove(checkpoint);
    auto const process = begin(run_of("part.h5", more));
    EXPECT_TRUE(eventually([&] { return std::filesystem::exists(checkpoint); }));
    EXPECT_EQ(end(process, SIGKILL), 128 + SIGKILL);
    return io::read_ensemble_checkpoint(checkpoint).header.step;
  }

  /// Returns the last frame of a dataset (frame, ...).
  std::vector<double> last(std::string const& file, std::string const& name) const {
    auto const [extents, values] = read_dataset(file, name);
    return {values.end() - static_cast<std::ptrdiff_t>(values.size()) / extents[0], values.end()};
  }

  void expect_same_end(std::string const& one, std::string const& other) const {
    for (std::string const name : {"/spins", "/energy", "/norm_defect", "/magnetization", "/time",
                                   "/step", "/scalars/energy"})
      EXPECT_EQ(last(one, name), last(other, name)) << name;
  }
};

TEST_F(EnsembleCheckpoints, ContinueAKilledRunWithItsBits) {
  std::string const noise = "[thermal]\ntemperature = 0.05\nseed = 7\n";
  std::string const damping = "'system.damping' = { from = 0.1, to = 0.4 }\n";
  // From 16 replicas on, small lattices are stepped as the columns of a few lattices, how many
  // depends on the number of threads.
  for (auto const& [integrator, tables, small] :
       {std::tuple{"method='rkmk4'", ensemble(3, damping), false},
        {"method='ab2'", ensemble(3, damping), false},
        {"method='ab2'", ensemble(40), true},
        {"method='rkmk4',compensated=true", ensemble(40), true},
        {"method='heun'", noise + ensemble(40), true},
        {"method='dp5',tolerance=1e-6", ensemble(3, damping), false},
        {"method='stiff2_adaptive',tolerance=1e-6", ensemble(2, damping), true}}) {
    SCOPED_TRACE(integrator + tables);
    write("all.toml", chain_scene() + tables);
    auto const same = joined(set(fmt::format("integrator={{{},dt=0.001,steps=40000}}", integrator),
                                 "output.every=40000"),
                             small ? set("lattice.shape=[6]") : Arguments{});
    auto const step =
        kill(joined(same, {"--threads", "2", "--set", "output.checkpoint_every='500 steps'"}));
    ASSERT_GT(step, 0);
    EXPECT_EQ(step % 500, 0);
    auto const rest = joined(same, {"--threads", "1", "--restart", "part.h5"});
    expect_status(0, run_of("rest.h5", rest));
    expect_status(0, run_of("whole.h5", same));
    EXPECT_EQ(read_dataset("rest.h5", "/step").values.front(), static_cast<double>(step));
    expect_same_end("rest.h5", "whole.h5");
  }
}

// An interrupt leaves replicas at different steps: on one thread, some have not begun. A replica of
// dp5 takes only milliseconds, so there are many. The columns of ab2 take a tenth of a second for
// 40000 steps.
TEST_F(EnsembleCheckpoints, ContinueAnInterruptedRunWithItsBits) {
  for (auto const& [integrator, steps, replicas, threads] :
       {std::tuple{"method='dp5',tolerance=1e-6", 40000, 30, "1"},
        {"method='ab2'", 400000, 40, "2"}}) {
    SCOPED_TRACE(integrator);
    write("all.toml", chain_scene() + ensemble(replicas));
    auto const same = set(fmt::format("integrator={{{},dt=0.001,steps={}}}", integrator, steps),
                          fmt::format("output.every={}", steps), "lattice.shape=[20]");
    std::filesystem::remove(in_folder("part.h5"));
    auto const outcome = start(
        run_of("part.h5", joined(same, {"--threads", threads, "--set",
                                        fmt::format("output.checkpoint_every='{} steps'", steps)})),
        {.interrupt_after = 0.02, .interrupt_when = in_folder("part.h5")});
    ASSERT_EQ(outcome.status, 130) << outcome.errors;
    ASSERT_TRUE(exists("part.checkpoint.h5"));
    expect_status(0, run_of("rest.h5", joined(same, {"--restart", "part.h5"})));
    expect_status(0, run_of("whole.h5", same));
    expect_same_end("rest.h5", "whole.h5");
    auto const changed = joined(same, set("field.applied=[0,0,0.2]", "initial.random.seed=4"));
    auto const other = start(run_of("b.h5", joined(changed, {"--restart", "part.h5"})));
    EXPECT_TRUE(other.status == 0 || contains(other.errors, "it was interrupted")) << other.errors;
  }
}

// Replica 0 is at rest long before the others.
TEST_F(EnsembleCheckpoints, KeepReplicasThatHaveEnded) {
  write("all.toml", macrospin_scene() + ensemble(3, "'system.damping' = [1.0, 0.01, 0.02]\n"));
  auto const same = set("integrator={method='rkmk4',dt=0.01,end=2000,until_torque=1e-4}",
                        "output={every=200000}");
  auto const step = kill(joined(same, set("output.checkpoint_every='2000 steps'")));
  auto const info = io::read_ensemble_checkpoint(checkpoint_of("part.h5"));
  auto const states = io::read_replica_states(checkpoint_of("part.h5"), info, {0, 3});
  EXPECT_TRUE(states[0].has_ended);
  EXPECT_LT(states[0].step, step);
  EXPECT_FALSE(states[1].has_ended);
  EXPECT_EQ(states[1].step, step);
  expect_status(0, run_of("rest.h5", joined(same, {"--restart", "part.h5"})));
  expect_status(0, run_of("whole.h5", same));
  expect_same_end("rest.h5", "whole.h5");
  // When all have ended, a restart has nothing more to do.
  expect_status(0, run_of("more.h5", joined(same, {"--restart", "rest.h5"})));
  expect_same_end("more.h5", "whole.h5");
  EXPECT_EQ(read_dataset("more.h5", "/step").values.size(), 1u);
  expect_refused(run_of("b.h5", joined(same, {"--restart", "part.h5", "--set",
                                              "integrator.until_torque=1e-6"})),
                 "some of its replicas have ended early");
}

TEST_F(EnsembleCheckpoints, AreStoredWhereTheyAreNeeded) {
  write("all.toml", chain_scene() + ensemble(3));
  auto const to = [](std::string const& method, int steps) {
    return set(fmt::format("integrator={{method='{}',dt=0.02,steps={}}}", method, steps));
  };
  expect_status(
      0, run_of("part.h5", joined(to("rkmk4", 12), set("output.checkpoint_every='5 steps'"))));
  EXPECT_FALSE(exists("part.checkpoint.h5")) << "the last frame is it";
  expect_status(0, run_of("never.h5", joined(to("ab2", 12), set("output.checkpoint_every=0"))));
  EXPECT_FALSE(exists("never.checkpoint.h5"));
  expect_refused(run_of("rest.h5", joined(to("ab2", 25), {"--restart", "never.h5"})),
                 "never.checkpoint.h5 is not there; accepted: a file with its checkpoint\n");
  expect_status(0, run_of("part.h5", to("ab2", 12)));
  expect_status(0, run_of("whole.h5", to("ab2", 25)));
  expect_status(0, run_of("rest.h5", joined(to("ab2", 25), {"--restart", "part.h5"})));
  expect_same_end("rest.h5", "whole.h5");
  // A checkpoint is enough, and another method takes only its spins.
  std::filesystem::remove(in_folder("part.h5"));
  Arguments const from_checkpoint{"--restart", "part.checkpoint.h5"};
  expect_status(0, run_of("rest.h5", joined(to("ab2", 25), from_checkpoint)));
  expect_same_end("rest.h5", "whole.h5");
  auto const other = start(run_of("rest.h5", joined(to("heun", 25), from_checkpoint)));
  EXPECT_EQ(other.status, 0);
  EXPECT_TRUE(contains(other.errors, "these keys differ from its scene: integrator.method"));
  // The checkpoint may be replaced, and a new run removes it.
  expect_status(0, run_of("part.h5", to("rkmk4", 12)));
  EXPECT_FALSE(exists("part.checkpoint.h5"));
  write("kept.checkpoint.h5", "kept");
  expect_refused({"run", "all.toml", "--quiet", "--output", "kept.h5"},
                 "kept.checkpoint.h5: cannot write the file: it exists");
}

TEST_F(EnsembleCheckpoints, AreRefusedInOneLine) {
  write("all.toml", chain_scene() + ensemble(3));
  write("one.toml", chain_scene());
  Arguments const ab2 = set("integrator.method='ab2'");
  auto const on = joined(ab2, set("integrator.steps=40"));
  expect_status(0, run_of("part.h5", ab2));
  auto const refused = [&](Arguments const& more, std::string const& part) {
    SCOPED_TRACE(part);
    expect_refused(joined({"run", "all.toml", "--output", "rest.h5"}, joined(on, more)), part);
    EXPECT_FALSE(exists("rest.h5"));
  };
  Arguments const from_checkpoint{"--restart", "part.checkpoint.h5"};
  refused(joined(from_checkpoint, set("ensemble.replicas=4")),
          "it has 3 replicas, and the scene has 4");
  refused(joined(from_checkpoint, {"--precision", "single"}), "its spins are in double precision");
  refused(joined(from_checkpoint, set("lattice.shape.0=21")), "its lattice is");
  expect_refused(joined({"run", "one.toml", "--output", "rest.h5"}, joined(on, from_checkpoint)),
                 "part.checkpoint.h5: it is of an ensemble");
  expect_refused(run_of("part.h5", joined(on, from_checkpoint)), "would replace it");
  expect_refused({"info", "part.checkpoint.h5"}, "it is the checkpoint of an ensemble; accepted: ");

  // One byte of a spin of the last replica is changed.
  auto const checkpoint = checkpoint_of("part.h5");
  auto const info = io::read_ensemble_checkpoint(checkpoint);
  auto const state = io::read_replica_states(checkpoint, info, {2, 1}).front();
  std::array<char, sizeof(double)> spin{};
  std::memcpy(spin.data(), &state.fields.at("spins").at(4), sizeof(double));
  auto bytes = text_of("part.checkpoint.h5");
  auto const at = bytes.find(std::string(spin.data(), spin.size()));
  ASSERT_NE(at, bytes.npos);
  bytes[at] = static_cast<char>(bytes[at] ^ 1);
  std::ofstream(checkpoint, std::ios::binary) << bytes;
  refused({"--restart", "part.h5"}, "its bytes are not those written");
  expect_status(0, run_of("other.h5", ab2));
  std::filesystem::copy_file(checkpoint_of("other.h5"), checkpoint,
                             std::filesystem::copy_options::overwrite_existing);
  expect_status(0, run_of("rest.h5", joined(on, {"--restart", "part.h5"})));
  expect_status(0, run_of("other.h5", joined(ab2, set("system.damping=0.2"))));
  std::filesystem::copy_file(checkpoint_of("other.h5"), checkpoint,
                             std::filesystem::copy_options::overwrite_existing);
  std::filesystem::remove(in_folder("rest.h5"));
  refused({"--restart", "part.h5"}, "part.checkpoint.h5 is of another scene");
}

// The scene's text stays the same, but not its file of occupied sites.
TEST_F(EnsembleCheckpoints, OfOtherVacanciesAreRefused) {
  auto const occupy = [&](std::string const& values) {
    write("mask.ovf",
          "# OOMMF OVF 2.0\n# meshtype: rectangular\n# valuedim: 1\n# xnodes: 4\n# ynodes: 1\n"
          "# znodes: 1\n# Begin: Data Text\n" +
              values + "\n# End: Data Text\n");
  };
  write("all.toml", chain_scene() + ensemble(3));
  for (std::string const method : {"rkmk4", "ab2"}) {
    SCOPED_TRACE(method);
    auto const same =
        set("integrator.method='" + method + "'", "lattice={shape=[4],occupied={file='mask.ovf'}}");
    occupy("1 1 0 1");
    expect_status(0, run_of("part.h5", same));
    auto const on = joined(same, {"--set", "integrator.steps=40", "--restart", "part.h5"});
    expect_status(0, run_of("rest.h5", on));
    occupy("1 0 1 1");
    expect_refused(
        run_of("rest.h5", on),
        "its site (1, 0, 0) holds a spin, that of the scene's lattice.occupied is vacant");
  }
}

}  // namespace
}  // namespace cayspin::program::test
