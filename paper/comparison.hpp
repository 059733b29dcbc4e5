// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "context.hpp"
#include "numbers_file.hpp"

#include <string_view>

namespace cayspin::paper {

/// Prints what each erratum changes: quantities computed with the printed formula and with the
/// corrected one. Also writes them to a CSV file.
class Comparison {
 public:
  explicit Comparison(Context const& context)
      : context(context),
        file_(context.folder, "errata.csv", "erratum,quantity,printed,corrected") {}

  /// Starts the rows of erratum `number`. `where`: its place in the paper. `printed`, `corrected`:
  /// the two formulas.
  void begin(int number, std::string_view where, std::string_view printed,
             std::string_view corrected);
  /// Prints a quantity as computed with both formulas.
  void row(std::string_view quantity, double printed, double corrected);
  void note(std::string_view text) const;
  void close() const { file_.write(); }

  Context context;

 private:
  NumbersFile file_;
  int number_ = 0;
};

void erratum_sign_of_rigid_body(Comparison& comparison);      // 1
void erratum_sigma(Comparison& comparison);                   // 2
void erratum_euler_correction(Comparison& comparison);        // 3
void erratum_power_of_dt(Comparison& comparison);             // 4
void erratum_heun_correction(Comparison& comparison);         // 5
void erratum_stages(Comparison& comparison);                  // 6
void erratum_series(Comparison& comparison);                  // 7
void erratum_second_order_condition(Comparison& comparison);  // 8
void erratum_table_and_figures(Comparison& comparison);       // 9

}  // namespace cayspin::paper
