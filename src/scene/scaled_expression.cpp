// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "sections.hpp"

#include <fmt/format.h>

#include <cctype>

namespace cayspin::inline v0_1::io::detail {
namespace {

bool begins_name(char c) { return c == '_' || std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool in_name(char c) { return begins_name(c) || std::isdigit(static_cast<unsigned char>(c)) != 0; }

// Where the name or the single character that begins at `from` ends. The exponent of a number is
// taken for a name, which does no harm: it is not the variable.
std::size_t end_of_token(std::string_view text, std::size_t from) {
  std::size_t end = from + 1;
  if (begins_name(text[from]))
    while (end < text.size() && in_name(text[end])) ++end;
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

}  // namespace cayspin::inline v0_1::io::detail
