// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "simulation/failure.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace cayspin::program {

void become_sibling(std::string const& name, char** argv) {
  std::error_code unknown;
  auto const self = std::filesystem::read_symlink("/proc/self/exe", unknown);
  auto const path = (unknown ? std::filesystem::path(argv[0]) : self).parent_path() / name;
  argv[1] = argv[0];  // its own name for itself, in place of the command
  ::execv(path.c_str(), argv + 1);
  throw simulation::UsageError(
      fmt::format("{}: cannot be started: {} (the build puts it beside cayspin)", path.string(),
                  std::strerror(errno)));
}

}  // namespace cayspin::program
