// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scalar_series.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace cayspin::inline v0_1::io {

/// Samples as a text table in mumax3's style: columns with names and units, separated by tabs, and
/// digits that give every double back. The file holds whole lines at every moment.
class ScalarTable {
 public:
  /// Creates the file with the line of names. A file that exists is an error unless `overwrite`.
  ScalarTable(std::filesystem::path path, bool in_si, bool overwrite);
  ~ScalarTable();
  ScalarTable(ScalarTable const&) = delete;
  ScalarTable& operator=(ScalarTable const&) = delete;

  /// Throws std::runtime_error, with the lines of these samples taken back.
  void append(std::vector<Sample> const& samples);

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace cayspin::inline v0_1::io
