// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <vector>

namespace cayspin::paper {

/// Returns the value below which the fraction `q` of the values lies; NaN when there are none.
double quantile(std::vector<double> values, double q);

double mean(std::vector<double> const& values);

/// Median, and the range that holds nine tenths of the values.
struct Spread {
  double low, median, high;  // 5, 50, 95 %
};
Spread spread(std::vector<double> const& values);

/// Returns means of ten consecutive values each: samples of the paper's statistic. With fewer than
/// ten values, returns their mean.
std::vector<double> means_of_ten(std::vector<double> const& values);

/// Returns the order log(coarse / fine) / log(step_ratio) for each pair of errors that are both
/// above `round_off`; other pairs are left out.
std::vector<double> orders(std::vector<double> const& coarse, std::vector<double> const& fine,
                           double step_ratio, double round_off);

/// Returns the least-squares slope of log(error) against log(dt).
double fitted_order(std::vector<double> const& dts, std::vector<double> const& errors);

}  // namespace cayspin::paper
