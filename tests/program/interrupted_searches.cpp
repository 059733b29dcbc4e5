// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Ctrl-C ends searches for modes, waves and paths, which write no file then.
#include "program_test.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace cayspin::program::test {
namespace {

struct InterruptedSearch : ProgramTest {
  std::string const film = R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [64, 64]
boundary = ["periodic", "open"]
[field]
exchange = 10.0
anisotropy = { constant = 0.1, axis = [1, 0, 0] }
slab_demag = { normal = [0, 0, 1] }
[initial]
uniform = [1, 0, 0]
)toml";

  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (auto const& entry : std::filesystem::directory_iterator(folder_))
      if (auto const name = entry.path().filename().string(); name != "stdout" && name != "stderr")
        names.push_back(name);
    std::ranges::sort(names);
    return names;
  }

  /// Starts a command that would take minutes, and interrupts it `seconds` after it can be.
  void expect_interrupted(Arguments const& arguments, std::string const& end,
                          double seconds = 0.1) const {
    auto const before = files();
    auto const outcome =
        start(arguments, {.interrupt_after = seconds, .interrupt_when_caught = true});
    EXPECT_EQ(outcome.status, 130);
    EXPECT_TRUE(is_one_line(outcome.errors));
    EXPECT_TRUE(outcome.errors.ends_with("scene.toml: interrupted; " + end + "\n"))
        << outcome.errors;
    EXPECT_EQ(outcome.output, "");
    EXPECT_EQ(files(), before);
  }
};

TEST_F(InterruptedSearch, OfModes) {
  Arguments const modes{"modes", write("scene.toml", film)};
  std::string const end = "no file was written";
  // During the first vectors of the search, and later.
  for (double const seconds : {0.02, 0.5})
    expect_interrupted(joined(modes, {"--at-rest", "--count", "64", "--tolerance", "1e-15"}), end,
                       seconds);
  expect_interrupted(joined(modes, {"--torque", "1e-12", "--set", "lattice.shape=[512, 512]",
                                    "--set", "initial={ random = { seed = 3 } }"}),
                     end);
  expect_interrupted(joined(modes, {"--set", "lattice.shape=[32, 8]", "--set",
                                    "torque.slonczewski={ damping_like = 0.1, polarization = [1, "
                                    "0, 0] }"}),
                     end, 0.02);
}

TEST_F(InterruptedSearch, OfWaves) {
  expect_interrupted({"modes", write("scene.toml", film), "--wave-vector", "0,0,0", "--wave-vector",
                      "0.5,0,0", "--points", "100000"},
                     "no file was written");
}

TEST_F(InterruptedSearch, OfAPath) {
  auto const scene = write("scene.toml", film);
  for (std::string const x : {"1", "-1"})
    expect_status(0, {"relax", scene, "--output", x == "1" ? "a.h5" : "b.h5", "--quiet", "--set",
                      "initial={ uniform = [" + x + ", 0, 0] }"});
  std::string const end = "nothing is written";
  expect_interrupted({"path", scene, "--from", "a.h5", "--to", "b.h5", "--images", "64"}, end);
  expect_interrupted({"path", scene, "--from", "a.h5", "--modes", "100"}, end);
}

}  // namespace
}  // namespace cayspin::program::test
