// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

namespace cayspin::simulation {
namespace {

constexpr std::array<char const*, 7> prefixes{"", "k", "M", "G", "T", "P", "E"};

std::pair<double, char const*> prefixed(double value) {
  std::size_t index = 0;
  while (value >= 999.5 && index + 1 < prefixes.size()) value /= 1000, ++index;
  return {value, prefixes[index]};
}

}  // namespace

std::string bytes_text(double bytes) {
  auto const [value, prefix] = prefixed(bytes);
  return fmt::format("{:.3g} {}B", value, prefix);
}

std::string bytes_text(std::int64_t bytes) { return bytes_text(static_cast<double>(bytes)); }

std::string duration_text(double seconds) {
  if (!(seconds < 3.2e9)) return "centuries";
  if (seconds < 59.5) return fmt::format("{:.3g} s", seconds);
  auto const total = static_cast<std::int64_t>(std::llround(seconds));
  if (total < 3600) return fmt::format("{} min {} s", total / 60, total % 60);
  if (total < 86400) return fmt::format("{} h {} min", total / 3600, total / 60 % 60);
  return fmt::format("{} d {} h", total / 86400, total / 3600 % 24);
}

std::string cells_text(std::array<std::int64_t, 3> const& shape, std::int64_t cell_sites) {
  auto text = fmt::format("{} x {} x {}", shape[0], shape[1], shape[2] / cell_sites);
  if (cell_sites > 1) text += fmt::format(" cells of {} sites", cell_sites);
  return text;
}

std::string sites_text(std::array<std::int64_t, 3> const& shape, std::int64_t cell_sites) {
  return cells_text(shape, cell_sites) + (cell_sites > 1 ? "" : " sites");
}

std::string rate_text(double per_second) {
  auto const [value, prefix] = prefixed(per_second);
  return fmt::format("{:.3g} {}", value, prefix);
}

std::string time_text(io::Units const& units, double time, int digits) {
  return fmt::format("{:.{}g}{}", time * units.time, digits, units.si ? " s" : "");
}

std::string energy_text(io::Units const& units, double energy, int digits) {
  return fmt::format("{:.{}g}{}", energy * units.energy, digits, units.si ? " J" : "");
}

std::string factor_text(io::Units const& units, io::AppliedComponent const& factor) {
  auto const* const expression = std::get_if<std::string>(&factor);
  if (expression == nullptr) return fmt::format("{:.6g}", std::get<double>(factor));
  return units.si ? fmt::format("{}, t in units of {:.6g} s", *expression, units.time)
                  : *expression;
}

std::string shell_word(std::string const& text) {
  if (!text.empty() && text.find_first_of(" \t\n'\"\\$`&|;<>()[]{}*?!#~=") == text.npos)
    return text;
  std::string word = "'";
  for (char const letter : text) {
    if (letter == '\'') word += "'\\'";
    word += letter;
  }
  return word + "'";
}

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

}  // namespace cayspin::simulation
