// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "bar.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>

namespace cayspin::program {

bool is_terminal(std::FILE* stream) { return ::isatty(::fileno(stream)) == 1; }

std::string bar(double share) {
  constexpr int width = 24;
  int const filled = static_cast<int>(std::clamp(share, 0.0, 1.0) * width);
  return fmt::format("[{:#<{}}{:.<{}}]", "", filled, "", width - filled);
}

std::string fitted(std::string line) {
  winsize size{};
  bool const known = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  std::size_t const width = known ? size.ws_col : 80;
  if (line.size() >= width) line.resize(width - 1);
  return line;
}

}  // namespace cayspin::program
