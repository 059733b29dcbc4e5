// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "program/program_test.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace cayspin::program::test {

namespace fs = std::filesystem;

inline int setting(char const* name, int usual) {
  char const* const asked = std::getenv(name);
  return asked ? std::atoi(asked) : usual;
}
/// Fixture that runs mpiexec -n RANKS cayspin ARGUMENTS...
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

  /// Expects two files to contain equal runs: bitwise identical frames and samples, and equal
  /// numbers of steps and evaluations.
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

  /// Runs on two ranks, one of which has only 300 MB. Expects one line about memory.
  void expect_too_little_memory(Arguments const& arguments) const {
    Treatment launcher;
    launcher.program = CAYSPIN_MPIEXEC;
    for (int const poor : {0, 1}) {
      SCOPED_TRACE(poor);
      Arguments both;
      for (int rank = 0; rank < 2; ++rank) {
        auto const run = launch(1, arguments);
        both.insert(both.end(), run.begin(), run.begin() + 2);
        if (rank == poor)
          both.insert(both.end(), {"sh", "-c", "ulimit -v 300000; exec \"$0\" \"$@\""});
        both.insert(both.end(), run.begin() + 2, run.end());
        if (rank == 0) both.push_back(":");
      }
      expect_refused(start(both, launcher), "memory");
    }
  }
};

/// `start`: the contents of [initial].
inline std::string film(std::string const& shape, std::string const& integrator,
                        std::string const& start = R"toml(expression = [
"cos(5*x + 2*y)", "sin(3*z + y)", "x - 0.3*k"])toml") {
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
{}
[integrator]
{}
dt = 0.02
steps = 30
[output]
every = 10
scalars_every = 5
)toml",
                     shape, start, integrator);
}
}  // namespace cayspin::program::test
