// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/key_path.hpp"
#include "io/toml_string.hpp"
#include "sections.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

namespace cayspin::inline v0_2::io::detail {
namespace {

// Splits a path at its dots, except those between quotes.
std::vector<std::string> split_path(std::string_view path) {
  std::vector<std::string> keys(1);
  char quote = 0;
  for (char const c : path) {
    if (c == quote) {
      quote = 0;
    } else if (quote == 0 && (c == '"' || c == '\'')) {
      quote = c;
    } else if (quote == 0 && c == '.') {
      keys.emplace_back();
    } else if (c != ' ') {
      keys.back() += c;
    }
  }
  return keys;
}

std::optional<std::size_t> as_index(std::string_view text) {
  std::size_t index = 0;
  auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return index;
}

// Returns true for a value that can only be a file name: /a, ~/a, ./a, ../a.
bool begins_a_path(std::string_view value) {
  return value.starts_with('/') || value.starts_with('~') || value.starts_with("./") ||
         value.starts_with("../");
}

bool is_toml(std::string_view value) {
  try {
    static_cast<void>(toml::parse(fmt::format("value = {}\n", value)));
    return true;
  } catch (toml::parse_error const&) {
    return false;
  }
}

// Returns true for a word or a file name without quotes. A file name may begin with a dot or a
// digit.
bool is_bare_word(std::string_view value) {
  constexpr std::array not_strings{"true", "false", "inf", "nan"};
  if (value.empty() || std::ranges::find(not_strings, value) != not_strings.end()) return false;
  if (begins_a_path(value))
    return std::ranges::none_of(value, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  auto const is_letter = [](unsigned char c) { return std::isalpha(c) != 0 || c == '_'; };
  bool const has_its_characters = std::ranges::all_of(value, [&](unsigned char c) {
    return is_letter(c) || std::isdigit(c) != 0 || c == '-' || c == '.' || c == '/';
  });
  if (!has_its_characters) return false;
  if (is_letter(static_cast<unsigned char>(value[0]))) return true;
  return value[0] != '-' && std::ranges::any_of(value, is_letter) && !is_toml(value);
}

// Parses one value, with the override as its source, which messages name. Words may lack quotes,
// because a shell removes them.
toml::table parse_value(std::string const& place, std::string_view value) {
  toml::table parsed;
  value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
  try {
    parsed = toml::parse(fmt::format("value = {}\n", as_toml_value(value)), place);
  } catch (toml::parse_error const& error) {
    fail(place, "", fmt::format("the value is not TOML ({})", error.description()),
         "key.path=VALUE with a TOML value; a string that is more than a word needs its "
         "quotes");
  }
  if (parsed.size() != 1) {
    fail(place, "", "more than one value", "key.path=VALUE with one TOML value");
  }
  return parsed;
}

// Moves the value, because a copied TOML node loses its source, which messages name.
void put(toml::node& parent, std::string const& key, toml::node&& value, std::string const& place) {
  std::move(value).visit([&](auto&& typed) {
    if (auto* const table = parent.as_table()) {
      table->insert_or_assign(key, std::move(typed));
    } else {
      auto& array = *parent.as_array();
      auto const index = as_index(key);
      if (!index || *index >= array.size()) {
        fail(place, "", fmt::format("\"{}\" is not an entry of an array of {}", key, array.size()),
             "an index from 0");
      }
      array.replace(array.cbegin() + static_cast<std::ptrdiff_t>(*index), std::move(typed));
    }
  });
}

}  // namespace

std::string as_toml_value(std::string_view value) {
  return is_bare_word(value) ? toml_string(value) : std::string(value);
}

void apply_override(toml::table& root, std::string const& assignment) {
  auto const place = one_line("--set " + assignment);
  auto const equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    fail(place, "", "not an assignment", "key.path=VALUE");
  }
  auto const keys = split_path(std::string_view(assignment).substr(0, equals));
  auto value = parse_value(place, std::string_view(assignment).substr(equals + 1));

  toml::node* parent = &root;
  for (std::size_t n = 0; n < keys.size(); ++n) {
    auto const& key = keys[n];
    if (key.empty()) fail(place, "", "an empty key in the path", "key.path=VALUE");
    if (!parent->is_table() && !parent->is_array()) {
      fail(place, "", fmt::format("\"{}\" is neither a table nor an array", keys[n - 1]),
           "the path of a scene key");
    }
    if (n + 1 == keys.size()) {
      put(*parent, key, std::move(*value.get("value")), place);
      return;
    }
    toml::node* child = nullptr;
    if (auto* const table = parent->as_table()) {
      child = table->get(key);
      if (child == nullptr) {
        put(*parent, key, std::move(*parse_value(place, "{}").get("value")), place);
        child = table->get(key);
        child->as_table()->is_inline(false);
      }
    } else if (auto const index = as_index(key); index) {
      child = parent->as_array()->get(*index);
    }
    if (child == nullptr) {
      fail(place, "",
           fmt::format("\"{}\" is not an entry of an array of {}", key, parent->as_array()->size()),
           "an index from 0");
    }
    parent = child;
  }
}

}  // namespace cayspin::inline v0_2::io::detail

namespace cayspin::inline v0_2::io {

std::string plain_path(std::string_view path) {
  auto keys = detail::split_path(path);
  for (auto& key : keys)
    if (auto const index = detail::as_index(key)) key = fmt::to_string(*index);
  return fmt::format("{}", fmt::join(keys, "."));
}

std::string toml_string(std::string_view text) {
  std::ostringstream quoted;
  toml::value<std::string> const value{std::string(text)};
  quoted << toml::toml_formatter(value, toml::format_flags::none);
  return quoted.str();
}

}  // namespace cayspin::inline v0_2::io
