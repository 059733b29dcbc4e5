// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// docs/reference/command_line.md and --help name the same options.
#include "program_test.hpp"

#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace cayspin::program::test {
namespace {

using ReferencePage = ProgramTest;

std::set<std::string> options_in(std::string const& text) {
  std::regex const option("--[a-z]+");
  std::set<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), option), end; at != end; ++at)
    found.insert(at->str());
  found.erase("--help");
  return found;
}

// Returns the synopsis of each command at the head of the page. A synopsis ends at the next
// `cayspin`.
std::map<std::string, std::string> synopses() {
  std::ifstream page(std::string(CAYSPIN_DOCS) + "/reference/command_line.md");
  std::map<std::string, std::string> all;
  std::string line, command;
  while (std::getline(page, line) && !line.starts_with("##")) {
    if (!line.starts_with("    ")) continue;
    if (line.starts_with("    cayspin ")) std::istringstream(line.substr(12)) >> command;
    all[command] += line;
  }
  return all;
}

TEST_F(ReferencePage, HasTheOptionsOfEveryCommand) {
  auto const page = synopses();
  int commands = 0;
  for (auto const& [command, synopsis] : page) {
    if (command == "help" || command.starts_with('-')) continue;
    if (!has_reproduce && command == "reproduce") continue;
    EXPECT_EQ(options_in(synopsis), options_in(output_of({command, "--help"}))) << command;
    ++commands;
  }
  EXPECT_EQ(commands, has_reproduce ? 15 : 14);
}

}  // namespace
}  // namespace cayspin::program::test
