// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/sweep.hpp"
#include "reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace cayspin::inline v0_2::io {
namespace {

constexpr std::string_view accepted = "key.path=VALUE,VALUE,... with TOML values";

// Returns the byte at which each column of a line starts, and the end of the line. Columns count
// code points.
std::vector<std::size_t> columns_of(std::string_view line) {
  std::vector<std::size_t> columns;
  for (std::size_t byte = 0; byte < line.size(); ++byte)
    if ((static_cast<unsigned char>(line[byte]) & 0xC0U) != 0x80U) columns.push_back(byte);
  columns.push_back(line.size());
  return columns;
}

std::string_view trimmed(std::string_view text) {
  auto const begin = text.find_first_not_of(" \t");
  auto const end = text.find_last_not_of(" \t");
  return begin == text.npos ? std::string_view() : text.substr(begin, end - begin + 1);
}

// Returns the values with quotes around bare words. Commas inside brackets, braces and quotes do
// not separate values.
std::string with_quoted_words(std::string_view values) {
  std::string text;
  char quote = 0;
  int depth = 0;
  std::size_t begin = 0;
  auto const add = [&](std::size_t end) {
    auto const value = values.substr(begin, end - begin);
    auto const word = trimmed(value);
    auto const blanks = static_cast<std::size_t>(word.empty() ? 0 : word.data() - value.data());
    text += value.substr(0, blanks);
    text += detail::as_toml_value(word);
    text += value.substr(blanks + word.size());
  };
  for (std::size_t at = 0; at < values.size(); ++at) {
    char const c = values[at];
    if (quote != 0) {
      if (c == '\\' && quote == '"') ++at;
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    } else if (c == ',' && depth == 0) {
      add(at);
      text += ',';
      begin = at + 1;
    }
  }
  add(values.size());
  return text;
}

}  // namespace

SweptKey read_swept_key(std::string const& assignment) {
  auto const place = detail::one_line("--over " + assignment);
  auto const equals = assignment.find('=');
  SweptKey swept;
  std::ranges::copy_if(assignment.substr(0, equals), std::back_inserter(swept.key),
                       [](char c) { return c != ' '; });
  if (equals == std::string::npos || swept.key.empty() ||
      assignment.find('\n') != std::string::npos)
    detail::fail(place, "", "not a key with values", accepted);

  // The values are parsed as a TOML array, because the parser then tells where each value starts.
  auto const line =
      "value = [" + with_quoted_words(std::string_view(assignment).substr(equals + 1));
  toml::table parsed;
  try {
    parsed = toml::parse(line + "]\n", place);  // throws if the values end in a comment
    parsed = toml::parse(line + "\n]\n", place);
  } catch (toml::parse_error const& error) {
    detail::fail(place, "", fmt::format("the values are not TOML ({})", error.description()),
                 "values with commas between them; a string that is more than a word needs its "
                 "quotes");
  }
  auto const* const array = parsed["value"].as_array();
  if (!array || parsed.size() != 1 || array->empty())
    detail::fail(place, "", "not a list of values", accepted);
  auto const columns = columns_of(line);
  auto const begin_of = [&](std::size_t i) {
    if (i == array->size()) return line.size();
    std::size_t const column = array->get(i)->source().begin.column;  // counted from 1
    return columns[std::min(column - 1, columns.size() - 1)];
  };
  std::set<std::string_view> seen;
  bool numeric = true;
  for (std::size_t i = 0; i < array->size(); ++i) {
    auto const& node = *array->get(i);
    auto const begin = begin_of(i);
    auto value = trimmed(std::string_view(line).substr(begin, begin_of(i + 1) - begin));
    if (value.ends_with(',')) value = trimmed(value.substr(0, value.size() - 1));
    if (!seen.insert(value).second)
      detail::fail(place, "", fmt::format("the value {} stands twice", value), "distinct values");
    swept.values.emplace_back(value);
    numeric = numeric && node.is_number();
    if (numeric) swept.numbers.push_back(detail::value_of(node));
  }
  if (!numeric) swept.numbers.clear();
  return swept;
}

std::int64_t SweepHeader::runs() const {
  std::int64_t runs = 1;
  for (auto const& key : keys) runs *= static_cast<std::int64_t>(key.values.size());
  return runs;
}

std::vector<std::size_t> SweepHeader::indices(std::int64_t run) const {
  if (run < 0 || run >= runs())
    throw std::invalid_argument(
        fmt::format("run {} of a sweep of {} runs; accepted: 0 to {}", run, runs(), runs() - 1));
  std::vector<std::size_t> indices(keys.size());
  auto rest = static_cast<std::size_t>(run);
  for (std::size_t key = keys.size(); key-- > 0;) {
    indices[key] = rest % keys[key].values.size();
    rest /= keys[key].values.size();
  }
  return indices;
}

std::vector<std::string> SweepHeader::overrides(std::int64_t run) const {
  std::vector<std::string> overrides;
  auto const chosen = indices(run);
  for (std::size_t key = 0; key < keys.size(); ++key)
    overrides.push_back(keys[key].key + "=" + keys[key].values[chosen[key]]);
  return overrides;
}

}  // namespace cayspin::inline v0_2::io
