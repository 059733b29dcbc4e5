// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string_view>
#include <utility>

namespace cayspin::simulation {

/// Writes a text to a stream. Unlike fmt::print, does not throw if the stream cannot be written: a
/// run must not end because its terminal has gone or the disk of its log is full. std::ferror()
/// tells whether a text was lost.
inline void write_text(std::FILE* stream, std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stream);
}

/// Writes a formatted text to standard error, as write_text() does.
template <class... Arguments>
void print_message(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_text(stderr, fmt::format(format, std::forward<Arguments>(arguments)...));
}

}  // namespace cayspin::simulation
