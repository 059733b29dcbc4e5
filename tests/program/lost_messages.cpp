// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Standard streams that are closed or cannot be written.
#include "io/sweep.hpp"
#include "program_test.hpp"

#include <fcntl.h>
#include <pty.h>
#include <unistd.h>

#include <string>

namespace cayspin::program::test {
namespace {

class LostMessages : public ProgramTest {
 protected:
  /// Starts the program with redirections in the syntax of the shell.
  Outcome redirected(std::string const& command, std::string const& redirections) const {
    return start({"-c", "exec '" CAYSPIN_PROGRAM "' " + command + " " + redirections},
                 {.program = "/bin/sh"});
  }
};

TEST_F(LostMessages, ChangeNoStatus) {
  run(chain_scene());
  for (char const* const errors : {"2> /dev/full", "2>&-"}) {
    EXPECT_EQ(redirected("run missing.toml", errors).status, 2) << errors;
    auto const warned = redirected(
        "run chain.toml --quiet --overwrite --restart out.h5 --set integrator.steps=30 --set "
        "field.exchange=1.1",
        errors);
    EXPECT_EQ(warned.status, 0) << errors;
  }
}

TEST_F(LostMessages, AreNotWrittenIntoTheFileOfResults) {
  std::string fields;
  for (int i = 0; i < 60; ++i) fields += "[0.3,0," + std::to_string(0.01 * i) + "],";
  auto const outcome =
      redirected("relax spin.toml --output rest.h5 --set 'field.applied=[" + fields + "]'", ">&-");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(contains(outcome.errors, "standard output: cannot write"));
  EXPECT_EQ(info_of("rest.h5").frames, 60);
}

// A sweep in the background goes on when its terminal is closed.
TEST_F(LostMessages, EndNoSweep) {
  int terminal = -1, line = -1;
  ASSERT_EQ(::openpty(&terminal, &line, nullptr, nullptr, nullptr), 0);
  ::close(terminal);  // writing to the other end is now an error
  pid_t const child = ::fork();
  if (child == 0) {
    ::dup2(line, STDOUT_FILENO);
    ::dup2(::open("/dev/null", O_WRONLY), STDERR_FILENO);
    if (::chdir(folder_.c_str()) != 0) ::_exit(121);
    ::execl(CAYSPIN_PROGRAM, "cayspin", "sweep", "chain.toml", "--output", "all.h5", "--jobs", "1",
            "--threads", "1", "--over", "system.damping=0.1,0.2,0.3", nullptr);
    ::_exit(122);
  }
  ::close(line);
  EXPECT_EQ(end(child, 0), 2);
  EXPECT_TRUE(io::read_sweep(in_folder("all.h5")).complete);
}

}  // namespace
}  // namespace cayspin::program::test
