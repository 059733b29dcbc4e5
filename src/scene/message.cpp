// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace cayspin::io::detail {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      std::size_t const replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text;
}

void fail(std::string_view place, std::string_view key, std::string_view what,
          std::string_view accepted) {
  std::string line(place);
  if (!key.empty()) line += fmt::format(": {}", key);
  line += fmt::format(": {}", what);
  if (!accepted.empty()) line += fmt::format("; accepted: {}", accepted);
  throw SceneError(one_line(std::move(line)));
}

std::string did_you_mean(std::string_view word, std::span<std::string_view const> known) {
  if (word.size() > 64) return {};
  std::string_view best;
  std::size_t best_distance = 3;
  for (auto const candidate : known) {
    auto const distance = edit_distance(word, candidate);
    if (distance < best_distance && distance < candidate.size()) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best.empty() ? std::string{} : fmt::format(", did you mean \"{}\"?", best);
}

}  // namespace cayspin::io::detail
