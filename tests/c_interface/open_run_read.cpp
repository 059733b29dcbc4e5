// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Two threads open scenes, run them, write files and read them, all at the same time.
// CAYSPIN_ROUNDS: number of repetitions.
#include "../program/program_test.hpp"
#include "../support/watchdog.hpp"
#include "c_interface_test.hpp"

#include <pthread.h>
#include <sys/wait.h>

#include <array>
#include <atomic>
#include <barrier>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

using namespace cayspin::test;

namespace {

std::atomic<int> forks = 0;
int const counted = ::pthread_atfork([] { ++forks; }, nullptr, nullptr);

std::string chain(std::string const& initial, std::string const& more) {
  return "[system]\nkind = \"llg\"\ndamping = 0.1\n[lattice]\nshape = [12, 3]\n"
         "[field]\nexchange = 1.0\napplied = [0.1, 0.2, 0.3]\n[initial]\n" +
         initial + "\n[integrator]\nmethod = \"ab2\"\ndt = 0.02\nsteps = 60\n[output]\n" + more;
}

/// The scenes of one thread of the test. The thread runs `scene`, which writes `file`, and opens
/// `from_file`, a scene that starts from that file.
struct Course {
  cayspin_precision precision;
  std::string file, scene, from_file;
  std::array<std::vector<double>, 2> expected = {};  // results of a round without the other thread

  /// Returns the spins at the end of a run that writes the file, and the initial spins of the scene
  /// that starts from it. The two differ only by the rounding of a normalisation.
  std::array<std::vector<double>, 2> round() const {
    auto const simulation = open(scene, precision);
    EXPECT_EQ(cayspin_run(simulation.get(), file.c_str(), 1), CAYSPIN_OK) << cayspin_last_error();
    auto const again = open(from_file, precision);
    return {spins_of(simulation.get()), spins_of(again.get())};
  }
};

class OpenRunRead : public cayspin::program::test::ProgramTest {
 protected:
  Course course(cayspin_precision precision, std::string const& name, std::string const& initial,
                std::string const& more) const {
    auto const file = in_folder(name).string();
    Course course{precision, file, chain(initial, more),
                  chain("file = \"" + file + "\"", "every = 60")};
    course.expected = course.round();
    auto const& [ran, read] = course.expected;
    for (std::size_t i = 0; i < ran.size(); ++i) EXPECT_NEAR(ran[i], read[i], 1e-6);
    return course;
  }

  std::array<Course, 2> courses() const {
    auto const first = course(CAYSPIN_DOUBLE, "a.h5", "random = { seed = 3 }",
                              "every = 1\ncheckpoint_every = \"20 steps\"");
    auto const start = "file = \"" + in_folder("start.h5").string() + "\"";
    std::filesystem::copy(first.file, in_folder("start.h5"));
    return {first, course(CAYSPIN_SINGLE, "b.h5", start, "every = 2\nscalars_every = 1")};
  }
};

TEST_F(OpenRunRead, TwoThreadsAtTheSameTime) {
  auto const* const text = std::getenv("CAYSPIN_ROUNDS");
  int const rounds = text ? std::atoi(text) : 100;
  auto const both = courses();
  Watchdog watchdog("two threads of the C interface");
  std::barrier begin(2);
  auto const work = [&](Course const& course) {
    for (int round = 0; round < rounds; ++round) {
      begin.arrive_and_wait();
      EXPECT_EQ(course.round(), course.expected) << "round " << round;
      watchdog.progress();
    }
  };
  std::thread first(work, both[0]), second(work, both[1]);
  first.join();
  second.join();
}

TEST_F(OpenRunRead, NoProcessIsStarted) {
  int const before = forks;
  ASSERT_EQ(counted, 0);
  auto const [first, second] = courses();
  EXPECT_EQ(second.round(), second.expected);
  EXPECT_EQ(forks, before);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

}  // namespace
