// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "bar.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace cayspin::program {
namespace {

// Returns the size of the terminal that standard output or standard error is. Returns zeros if
// neither is a terminal.
winsize terminal_size() {
  winsize size{};
  for (int const stream : {STDOUT_FILENO, STDERR_FILENO})
    if (size.ws_col == 0 && ::ioctl(stream, TIOCGWINSZ, &size) != 0) size = {};
  return size;
}

}  // namespace

bool is_terminal(std::FILE* stream) { return ::isatty(::fileno(stream)) == 1; }

std::string bar(double share) {
  constexpr int width = 24;
  int const filled = static_cast<int>(std::clamp(share, 0.0, 1.0) * width);
  return fmt::format("[{:#<{}}{:.<{}}]", "", filled, "", width - filled);
}

bool has_blocks() {
  for (char const* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    char const* const value = std::getenv(name);
    if (!value || *value == '\0') continue;
    std::string locale = value;
    std::ranges::transform(locale, locale.begin(), [](unsigned char c) { return std::tolower(c); });
    return locale.ends_with("utf-8") || locale.ends_with("utf8");
  }
  return false;
}

int terminal_lines() {
  auto const lines = terminal_size().ws_row;
  return lines > 0 ? lines : 24;
}

std::string fitted(std::string line) {
  auto const columns = terminal_size().ws_col;
  std::size_t const width = columns > 0 ? columns : 80;
  // Counts columns, not bytes: a continuation byte of UTF-8 takes no column.
  std::size_t column = 0;
  for (std::size_t byte = 0; byte < line.size(); ++byte) {
    if ((static_cast<unsigned char>(line[byte]) & 0xC0U) == 0x80U) continue;
    if (++column == width) return line.substr(0, byte);
  }
  return line;
}

}  // namespace cayspin::program
