// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>

namespace cayspin::paper {

/// A CSV file that is written completely or not at all. Without a folder nothing is written.
class NumbersFile {
 public:
  NumbersFile(std::optional<std::filesystem::path> const& folder, std::string_view name,
              std::string_view columns);

  /// Adds a row with one cell per column. Texts must not contain quotes.
  template <class... Cells>
  void row(Cells const&... cells) {
    std::string line;
    ((line += cell(cells), line += ','), ...);
    line.back() = '\n';
    text_ += line;
  }

  /// Writes the file. Throws std::runtime_error with one line when it cannot be written.
  void write() const;

 private:
  static std::string cell(std::string_view text) { return fmt::format("\"{}\"", text); }
  static std::string cell(double number) { return fmt::format("{}", number); }

  std::optional<std::filesystem::path> path_;
  std::string text_;
};

}  // namespace cayspin::paper
