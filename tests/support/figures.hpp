// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace cayspin::test {

/// A reference figure as printed, its value, and half a unit of its last digit.
struct Printed {
  explicit Printed(std::string const& digits) : text(digits), value(std::atof(digits.c_str())) {
    auto const exponent = digits.find('e');
    auto const mantissa = digits.substr(0, exponent);
    auto const point = mantissa.find('.');
    int decimals = point == std::string::npos ? 0 : static_cast<int>(mantissa.size() - point - 1);
    if (exponent != std::string::npos) decimals -= std::atoi(digits.c_str() + exponent + 1);
    half_unit = 0.5 * std::pow(10.0, -decimals);
  }
  std::string text;
  double value, half_unit = 0;
};

/// Prints a figure next to its reference, and expects agreement within `relative` and the rounding
/// of the reference's last digit.
inline void expect_figure(std::string const& what, double figure, std::string const& reference,
                          double relative = 0.01) {
  Printed const printed(reference);
  std::printf("    %-58s %.8g  (%s)\n", what.c_str(), figure, reference.c_str());
  EXPECT_NEAR(figure, printed.value, relative * std::abs(printed.value) + printed.half_unit)
      << what;
}

inline void expect_below(std::string const& what, double figure, double bound) {
  std::printf("    %-58s %.3g  (< %g)\n", what.c_str(), figure, bound);
  EXPECT_LT(figure, bound) << what;
}

/// Returns the least-squares slope of log(error) against log(dt).
inline double fitted_order(std::vector<double> const& dts, std::vector<double> const& errors) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  auto const n = static_cast<double>(dts.size());
  for (std::size_t i = 0; i < dts.size(); ++i) {
    double const x = std::log(dts[i]), y = std::log(errors[i]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

inline void expect_order(std::string const& what, double order, double expected, double tolerance) {
  std::printf("    %-58s %.3f  (%g +- %g)\n", what.c_str(), order, expected, tolerance);
  EXPECT_NEAR(order, expected, tolerance) << what;
}

/// Expects error(steps, dt) to be of order `expected` in dt = end_time / steps. `ladder` lists the
/// numbers of steps.
template <class Ladder, class Error>
void expect_convergence(std::string const& what, double end_time, Ladder const& ladder,
                        double expected, double tolerance, Error const& error) {
  std::vector<double> dts, errors;
  for (int const steps : ladder) {
    dts.push_back(end_time / steps);
    errors.push_back(error(steps, dts.back()));
  }
  std::printf("    %-30s errors %.2e .. %.2e\n", what.c_str(), errors.front(), errors.back());
  expect_order(what, fitted_order(dts, errors), expected, tolerance);
}

}  // namespace cayspin::test
