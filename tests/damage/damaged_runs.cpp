// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The program on damaged files: it reads the original content, or refuses the file with one line.
// CAYSPIN_DAMAGED_RUNS and CAYSPIN_SEED: number of files, and the seed.
#include "damaged_bytes.hpp"
#include "inertia_file.hpp"
#include "program/program_test.hpp"

namespace cayspin::program::test {
namespace {

using cayspin::test::Chance;
using cayspin::test::damaged;
using cayspin::test::number_from;
using cayspin::test::read_bytes;
using cayspin::test::write_bytes;
namespace fs = std::filesystem;

std::string const bodies = R"([system]
kind = "rigid_body"
inertia = { file = "damaged.h5" }
[lattice]
shape = [60]
[initial]
uniform = [0, 0, 1]
[integrator]
method = "rkmk4"
dt = 0.01
steps = 5
)";

class DamagedRuns : public ProgramTest {
 protected:
  DamagedRuns() { write("chain.toml", chain_scene()); }

  static Arguments with(Arguments arguments, Arguments const& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  static Arguments run_to(char const* file, Arguments const& more = {}) {
    return with({"run", "chain.toml", "--quiet", "--threads", "1", "--overwrite", "--output", file},
                more);
  }

  /// Runs the program. After 20 s of processor time a signal ends it, in case of an endless loop.
  Outcome started(Arguments const& arguments) const {
    return start(arguments, {.seconds_limit = 20});
  }

  // A command that reads damaged.h5, perhaps with damaged.checkpoint.h5.
  struct Use {
    char const* name;
    Arguments arguments;
    char const* output;      ///< the file whose last spins are compared; nullptr: standard output
    bool is_checked = true;  ///< the file has checksums: it is refused, or read as it was written
  };

  std::string result(Use const& use, Outcome const& outcome) const {
    if (!use.output) return outcome.output;
    std::string text;
    auto const spins = last_spins(use.output);
    text.assign(reinterpret_cast<char const*>(spins.data()), sizeof(double) * spins.size());
    return text;
  }

  void expect_right_or_refused(Use const& use, fs::path const& whole, long files) {
    auto const bytes = read_bytes(whole);
    bool const is_checkpoint = whole.string().ends_with(".checkpoint.h5");
    auto const target = in_folder(is_checkpoint ? "damaged.checkpoint.h5" : "damaged.h5");
    write_bytes(target, bytes);
    auto const right = started(use.arguments);
    ASSERT_EQ(right.status, 0) << use.name << ": " << right.errors;
    auto const expected = result(use, right);
    auto& counts = counts_[use.name];
    for (long file = 0; file < files; ++file) {
      auto const changed = damaged(bytes, chance_);
      write_bytes(target, changed);
      auto const outcome = started(use.arguments);
      bool const is_refused = outcome.status == 2 || (!use.is_checked && outcome.status == 3);
      bool const is_right = outcome.status == 0 && result(use, outcome) == expected;
      if (is_refused) {
        ++counts["refused"];
        EXPECT_TRUE(is_one_line(outcome.errors)) << use.name;
        continue;
      }
      bool const is_fine =
          outcome.status == 0 && outcome.errors.empty() && (is_right || !use.is_checked);
      ++counts[is_right ? "right" : is_fine ? "changed, without a checksum" : "WRONG"];
      if (is_fine) continue;
      auto const kept = fs::temp_directory_path() / ("cayspin_wrong_" + target.filename().string());
      write_bytes(kept, changed);
      ADD_FAILURE() << use.name << ": status " << outcome.status << ", \"" << outcome.errors
                    << "\", kept as " << kept;
    }
  }

  long files_ = number_from("CAYSPIN_DAMAGED_RUNS", 60);
  Chance chance_{static_cast<std::uint64_t>(number_from("CAYSPIN_SEED", 1))};
  cayspin::test::OutcomeCounts counts_;
};

TEST_F(DamagedRuns, TrajectoriesAndCheckpointsAreRightOrRefused) {
  ASSERT_EQ(started(run_to("plain.h5", {"--set", "integrator.steps=12"})).status, 0);
  ASSERT_EQ(started(run_to("memory.h5",
                           {"--set", "integrator.steps=12", "--set", "integrator.method='ab2'"}))
                .status,
            0);
  ASSERT_TRUE(fs::exists(in_folder("memory.checkpoint.h5")));
  auto const again = run_to("again.h5", {"--restart", "damaged.h5"});
  auto const plain = in_folder("plain.h5");
  expect_right_or_refused({"info", {"info", "damaged.h5"}, nullptr}, plain, files_ / 4);
  expect_right_or_refused({"--restart", again, "again.h5"}, plain, files_ / 4);
  expect_right_or_refused(
      {"initial.file", run_to("again.h5", {"--set", "initial={file='damaged.h5'}"}), "again.h5"},
      plain, files_ / 4);
  write_bytes(in_folder("damaged.h5"), read_bytes(in_folder("memory.h5")));
  expect_right_or_refused(
      {"--restart, its checkpoint", with(again, {"--set", "integrator.method='ab2'"}), "again.h5"},
      in_folder("memory.checkpoint.h5"), files_ / 4);
  cayspin::test::print_and_expect_both(counts_);
}

TEST_F(DamagedRuns, InertiaOfAnotherMakerEndsWithoutASignal) {
  write("bodies.toml", bodies);
  auto const path = in_folder("inertia.h5");
  cayspin::test::write_inertia(path, 60);
  Use const use{
      "inertia.file",
      {"run", "bodies.toml", "--quiet", "--threads", "1", "--overwrite", "--output", "again.h5"},
      "again.h5",
      false};
  expect_right_or_refused(use, path, files_ / 4);
  cayspin::test::print_and_expect_both(counts_);
}

}  // namespace
}  // namespace cayspin::program::test
