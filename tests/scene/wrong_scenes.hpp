// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Tables of keys that make a scene wrong, with the expected messages.
#pragma once

#include "scene_file.hpp"

#include <algorithm>

namespace cayspin::inline v0_2::io::test {

inline std::string trimmed(std::string_view text) {
  auto const begin = text.find_first_not_of(" \n");
  auto const end = text.find_last_not_of(" \n");
  return begin == text.npos ? std::string() : std::string(text.substr(begin, end - begin + 1));
}

inline std::vector<std::string> split(std::string_view text, std::string_view at) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    auto const end = std::min(text.find(at, begin), text.size());
    parts.emplace_back(text.substr(begin, end - begin));
    begin = end + at.size();
  }
  return parts;
}

/// The lines of a scene. Replaces keys, and finds their lines.
class SceneText {
 public:
  explicit SceneText(std::string_view text) : lines_(split(trimmed(text), "\n")) {}

  /// Types "table.key = VALUE", or "name = VALUE" for a whole table or a key above all tables. An
  /// empty VALUE removes the key.
  void type(std::string const& key, std::string const& value) {
    auto const path = split(key, ".");
    if (path.size() == 1) {
      if (auto const table = header(key); table < lines_.size())
        lines_.erase(at(table), at(end_of_table(table + 1)));
      if (auto const line = find(key, 0); line < lines_.size()) lines_.erase(at(line));
      if (!value.empty()) lines_.insert(lines_.begin(), key + " = " + value);
      return;
    }
    if (header(path[0]) == lines_.size()) lines_.push_back('[' + path[0] + ']');
    auto const begin = header(path[0]) + 1;
    auto const typed = value.empty() ? std::string() : path[1] + " = " + value;
    if (auto const line = find(path[1], begin); line < lines_.size())
      lines_[line] = typed;
    else
      lines_.insert(at(begin), typed);
  }

  /// Returns the line number that an error message about `key` should give: the line of the key;
  /// without one, the line of its table; without that, 1.
  std::size_t line_of(std::string_view key) const {
    auto const path = split(key.substr(0, key.find('[')), ".");
    if (auto const line = find(path[0], 0); line < lines_.size()) return line + 1;
    auto const table = header(path[0]);
    if (table == lines_.size()) return 1;
    auto const line = path.size() > 1 ? find(path[1], table + 1) : lines_.size();
    return (line < lines_.size() ? line : table) + 1;
  }

  std::string text() const {
    std::string all;
    for (auto const& line : lines_) all += line + '\n';
    return all;
  }

 private:
  std::vector<std::string>::const_iterator at(std::size_t line) const {
    return lines_.begin() + static_cast<std::ptrdiff_t>(line);
  }
  std::size_t header(std::string const& table) const {
    return static_cast<std::size_t>(std::ranges::find(lines_, '[' + table + ']') - lines_.begin());
  }
  std::size_t end_of_table(std::size_t line) const {
    while (line < lines_.size() && !lines_[line].starts_with('[')) ++line;
    return line;
  }
  /// Returns the line of a key in the table that starts at `begin`, or the number of lines if it
  /// has none.
  std::size_t find(std::string const& name, std::size_t begin) const {
    auto const end = end_of_table(begin);
    for (auto line = begin; line < end; ++line)
      if (lines_[line].starts_with(name + " =")) return line;
    return lines_.size();
  }

  std::vector<std::string> lines_;
};

/// Returns the rows of a table; a line that starts with a space continues the previous row.
inline std::vector<std::string> rows_of(std::string_view table) {
  std::vector<std::string> rows;
  for (auto const& line : split(trimmed(table), "\n"))
    if (line.starts_with(' '))
      rows.back() += line;
    else
      rows.push_back(line);
  return rows;
}

/// Each row has columns separated by " | ":
/// - keys to type, "key = VALUE; ..", which make the scene wrong;
/// - start of the message, after file and line; if it begins with ".", "[" or ":", the
///   last key stands before it;
/// - text that the message contains;
/// - any text, if the message does not say what is accepted; without this column, it must.
/// The message must be one line and name the line of the key.
inline void expect_refused(std::string_view scene, std::string_view table) {
  for (auto const& row : rows_of(table)) {
    SCOPED_TRACE(row);
    auto const columns = split(row, " | ");
    SceneText text(scene);
    std::string key;
    for (auto const& assignment : split(columns[0], "; ")) {
      auto const equals = assignment.find('=');
      key = trimmed(assignment.substr(0, equals));
      text.type(key, trimmed(assignment.substr(equals + 1)));
    }
    auto says = trimmed(columns.at(1));
    if (says.find_first_of(".[:") == 0) says = key + says;
    auto const line = text.line_of(says.substr(0, says.find(':')));
    auto const message = refusal_of(text.text());
    auto const begin = "scene.toml:" + std::to_string(line) + ": " + says;
    EXPECT_TRUE(message.starts_with(begin)) << message << "\nexpected: " << begin;
    EXPECT_EQ(message.find("; accepted: ") != message.npos, columns.size() < 4) << message;
    if (columns.size() > 2) expect_holds(message, trimmed(columns[2]));
  }
}

}  // namespace cayspin::inline v0_2::io::test
