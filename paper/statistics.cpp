// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace cayspin::paper {

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  auto const place = values.begin() + std::llround(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

double mean(std::vector<double> const& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Spread spread(std::vector<double> const& values) {
  return {quantile(values, 0.05), quantile(values, 0.5), quantile(values, 0.95)};
}

std::vector<double> means_of_ten(std::vector<double> const& values) {
  if (values.size() < 10) return {mean(values)};
  std::vector<double> means;
  for (auto from = values.begin(); values.end() - from >= 10; from += 10)
    means.push_back(mean({from, from + 10}));
  return means;
}

std::vector<double> orders(std::vector<double> const& coarse, std::vector<double> const& fine,
                           double step_ratio, double round_off) {
  std::vector<double> result;
  for (std::size_t i = 0; i < coarse.size(); ++i)
    if (coarse[i] > round_off && fine[i] > round_off)
      result.push_back(std::log(coarse[i] / fine[i]) / std::log(step_ratio));
  return result;
}

double fitted_order(std::vector<double> const& dts, std::vector<double> const& errors) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  auto const n = static_cast<double>(dts.size());
  for (std::size_t i = 0; i < dts.size(); ++i) {
    double const x = std::log(dts[i]), y = std::log(errors[i]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace cayspin::paper
