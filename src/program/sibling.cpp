// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "simulation/failure.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace cayspin::program {
namespace {

std::filesystem::path self(char** argv) {
  std::error_code unknown;
  auto const path = std::filesystem::read_symlink("/proc/self/exe", unknown);
  return unknown ? std::filesystem::path(argv[0]) : path;
}

}  // namespace

void become_sibling(std::string const& name, char** argv) {
  auto const path = self(argv).parent_path() / name;
  argv[1] = argv[0];  // its own name for itself, in place of the command
  ::execv(path.c_str(), argv + 1);
  throw simulation::UsageError(
      fmt::format("{}: cannot be started: {} (the build puts it beside cayspin)", path.string(),
                  std::strerror(errno)));
}

void become_script(std::string const& name, char** argv) {
  auto const program = self(argv);
  auto path = (program.parent_path().parent_path() / "share/cayspin/python" / name).string();
  if (::access(path.c_str(), R_OK) != 0)
    throw simulation::UsageError(fmt::format("{}: {} (the build and the installation put it there)",
                                             path, std::strerror(errno)));
  char const* const chosen = std::getenv("CAYSPIN_PYTHON");
  ::setenv("CAYSPIN_PROGRAM", program.c_str(), 0);  // for what starts runs
  std::string python = chosen && *chosen != '\0' ? chosen : CAYSPIN_PYTHON;
  argv[0] = python.data();
  argv[1] = path.data();
  ::execvp(python.c_str(), argv);
  throw simulation::UsageError(
      fmt::format("{}: cannot be started: {}; accepted: a Python with h5py and matplotlib in "
                  "CAYSPIN_PYTHON",
                  python, std::strerror(errno)));
}

}  // namespace cayspin::program
