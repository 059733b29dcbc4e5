// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Progress on a terminal.
#include "program_test.hpp"

#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>

namespace cayspin::program::test {
namespace {

class Terminal : public ProgramTest {
 protected:
  /// Returns all output of the program on a terminal, with standard output in a file if one is
  /// given. Expects success.
  std::string on_terminal(Arguments const& arguments, char const* output = nullptr,
                          unsigned short lines = 40) const {
    winsize const size{lines, 100, 0, 0};
    int terminal = -1;
    pid_t const child = ::forkpty(&terminal, nullptr, nullptr, &size);
    if (child == 0) {
      if (::chdir(folder_.c_str()) != 0) ::_exit(121);
      if (output && !std::freopen(output, "w", stdout)) ::_exit(121);
      std::vector<char*> words{const_cast<char*>("cayspin")};
      for (auto const& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
      words.push_back(nullptr);
      ::execv(CAYSPIN_PROGRAM, words.data());
      ::_exit(122);
    }
    std::string written;
    std::array<char, 4096> piece{};
    for (ssize_t count = 0; (count = ::read(terminal, piece.data(), piece.size())) > 0;)
      written.append(piece.data(), static_cast<std::size_t>(count));
    EXPECT_EQ(end(child, 0), 0) << written;
    ::close(terminal);
    return written;
  }
};

TEST_F(Terminal, ARunHasABarFromItsFirstStepOn) {
  EXPECT_TRUE(contains_all(
      on_terminal({"run", "chain.toml"}),
      {"\r[........................] step 0 of 25\x1b[K", "chain.h5: 25 steps, 4 frames in"}));
  EXPECT_EQ(on_terminal({"run", "chain.toml", "--quiet", "--overwrite"}), "");
}

TEST_F(Terminal, ASweepHasABarForEachRunAndTakesThemAway) {
  Arguments const arguments{"sweep",    "chain.toml",
                            "--output", "all.h5",
                            "--jobs",   "2",
                            "--set",    "output.every=1000000",
                            "--over",   "integrator.steps=50000,50001,50002"};
  auto const written = on_terminal(arguments);
  EXPECT_TRUE(contains_all(
      written, {" %  run 0000  integrator.steps=50000", " %  run 0001  integrator.steps",
                "0 of 3 runs", "\x1b[3A\r\x1b[J", "3 of 3  run 000", "all.h5: 3 runs"}));
  EXPECT_FALSE(contains(written.substr(written.rfind("3 of 3")), "[#"));
  EXPECT_EQ(on_terminal(joined(arguments, {"--quiet", "--overwrite"})), "");
}

TEST_F(Terminal, BarsOfASweepFitOnTheScreen) {
  auto const written = on_terminal(
      {"sweep", "chain.toml", "--output", "all.h5", "--jobs", "4", "--threads", "1", "--set",
       "output.every=1000000", "--over", "integrator.steps=50000,50001,50002,50003"},
      nullptr, 4);
  EXPECT_TRUE(contains(written, "\x1b[3A\r\x1b[J"));
  for (char const* beyond : {"\x1b[4A", "\x1b[5A"}) EXPECT_FALSE(contains(written, beyond));
}

TEST_F(Terminal, TradeHasABarBesideItsResult) {
  auto const written = on_terminal({"trade", "chain.toml", "--json", "--seconds", "0.01",
                                    "--threads", "1", "--precision", "double"},
                                   "result.json");
  EXPECT_TRUE(contains_all(written, {"[#", " left  "}));
  EXPECT_TRUE(written.ends_with("\r\x1b[K"));
}

TEST_F(Terminal, AdviceHasABarUnlessItIsToBeQuiet) {
  Arguments const arguments{"advise",    "chain.toml", "--error",     "1e-3",
                            "--threads", "1",          "--precision", "double"};
  EXPECT_TRUE(contains_all(on_terminal(arguments), {" so far, at most 2 s  ", "\r\x1b[Kscene "}));
  EXPECT_FALSE(contains(on_terminal(joined(arguments, {"--quiet"})), "\x1b"));
}

// Half blocks: the foreground colours the upper half of a character, the background the lower half.
TEST_F(Terminal, CheckDrawsTheStartWhereColoursAreThere) {
  Arguments const film =
      set("lattice.shape=[4,4]", "initial={expression=['x < 0.5 ? 1 : 0','0','x < 0.5 ? 0 : 1']}");
  auto const check = [&](char const* term, char const* colorterm, char const* no_color) {
    ::setenv("LC_ALL", "C.UTF-8", 1);
    ::setenv("TERM", term, 1);
    ::setenv("COLORTERM", colorterm, 1);
    ::setenv("NO_COLOR", no_color, 1);
    return on_terminal(joined({"check", "spin.toml"}, film));
  };
  // Spins along +x are red, those along +z light grey; each colour takes 16 of 32 columns.
  auto const all = check("xterm", "truecolor", "");
  std::string const red = "\x1b[38;2;255;0;0m\x1b[48;2;255;0;0m▀",
                    grey = "\x1b[38;2;230;230;230m\x1b[48;2;230;230;230m▀";
  EXPECT_TRUE(contains(all, red + grey));
  EXPECT_FALSE(contains(all, grey + red));
  std::size_t halves = 0;
  for (std::size_t at = 0; (at = all.find("▀", at)) != std::string::npos; ++at) ++halves;
  EXPECT_EQ(halves, 32U * 16U);
  EXPECT_TRUE(contains(check("xterm-256color", "", ""), "\x1b[38;5;196m\x1b[48;5;196m▀"));
  EXPECT_FALSE(contains(check("dumb", "", ""), "▀"));
  EXPECT_FALSE(contains(check("xterm", "truecolor", "1"), "▀"));
}

}  // namespace
}  // namespace cayspin::program::test
