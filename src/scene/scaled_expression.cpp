// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"

#include <fmt/format.h>

#include <cctype>

namespace cayspin::io::detail {
namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool begins_name(char c) { return c == '_' || std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool in_name(char c) { return begins_name(c) || is_digit(c); }
bool begins_exponent(char c) { return c == 'e' || c == 'E'; }

// Where the number, the name or the single character that begins at `from` ends.
std::size_t end_of_token(std::string_view text, std::size_t from) {
  std::size_t end = from;
  auto const at = [&](std::size_t i) { return i < text.size() ? text[i] : ' '; };
  if (begins_name(at(end))) {
    while (in_name(at(end))) ++end;
    return end;
  }
  if (!is_digit(at(end)) && at(end) != '.') return from + 1;
  while (is_digit(at(end)) || at(end) == '.') ++end;
  if (!begins_exponent(at(end))) return end;
  auto const digits = at(end + 1) == '+' || at(end + 1) == '-' ? end + 2 : end + 1;
  if (!is_digit(at(digits))) return end;
  for (end = digits; is_digit(at(end));) ++end;
  return end;
}

}  // namespace

std::string scaled_expression(std::string_view text, double time, double field) {
  std::string scaled = "(";
  for (std::size_t at = 0; at < text.size();) {
    auto const end = end_of_token(text, at);
    auto const token = text.substr(at, end - at);
    if (token == "t")
      scaled += fmt::format("({}*t)", time);
    else
      scaled += token;
    at = end;
  }
  return scaled + fmt::format(")/{}", field);
}

}  // namespace cayspin::io::detail
