// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "context.hpp"
#include "ensemble.hpp"
#include "numbers_file.hpp"

#include <string_view>
#include <vector>

namespace cayspin::paper {

/// One method of a table, with the values printed in the paper for each dt. NaN: the paper has a
/// misprint, from which the value cannot be recovered.
struct Column {
  std::string_view name;
  MethodChoice choice;
  std::vector<double> paper;
};

/// One ensemble of a table.
struct Block {
  std::string_view name;
  Law law;
  double end;  // end of the time interval, which starts at 0
  std::vector<double> dts;
  std::vector<Column> columns;
};

/// Printed table of largest energy errors: the paper's next to our median, our range, and the range
/// of means over ten bodies (the paper's statistic). It also has the order of the means from one dt
/// to the next.
class EnergyTable {
 public:
  /// `name`: name of the CSV file, without .csv.
  EnergyTable(Context const& context, std::string_view name, std::string_view title);
  void add(Block const& block);
  /// Prints a paragraph that explains why numbers differ.
  void note(std::string_view text) const;
  /// Writes the file.
  void close() const { file_.write(); }

 private:
  Context context_;
  NumbersFile file_;
};

}  // namespace cayspin::paper
