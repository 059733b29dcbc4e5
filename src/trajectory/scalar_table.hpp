// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scalar_series.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::io {

/// Samples as a text table in mumax3's style: columns with names and units, separated by tabs, with
/// enough digits to restore every double. After each call the file holds complete lines.
class ScalarTable {
 public:
  struct Line {
    Sample sample;
    std::vector<double> more = {};  ///< as in MoreScalars
  };

  /// Creates the file with its header line. An existing file is an error unless `overwrite`.
  ScalarTable(std::filesystem::path path, bool in_si, bool overwrite, MoreScalars const& more = {});
  ~ScalarTable();
  ScalarTable(ScalarTable const&) = delete;
  ScalarTable& operator=(ScalarTable const&) = delete;

  /// Appends samples. On failure removes their lines and throws std::runtime_error.
  void append(std::vector<Line> const& samples);

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace cayspin::inline v0_2::io
