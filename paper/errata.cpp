// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "comparison.hpp"
#include "random_bodies.hpp"

#include <cmath>

namespace cayspin::paper {
namespace {

std::string short_text(double value) {
  if (std::isnan(value)) return "-";
  double const size = std::abs(value);
  return size == 0 || (size >= 0.01 && size < 1000) ? fmt::format("{:.4g}", value)
                                                    : fmt::format("{:.2e}", value);
}

}  // namespace

void Comparison::begin(int number, std::string_view where, std::string_view printed,
                       std::string_view corrected) {
  number_ = number;
  fmt::print("\n{}. {}\n   printed:   {}\n   corrected: {}\n   {:<72} {:>10} {:>10}\n", number,
             where, printed, corrected, "", "printed", "corrected");
}

void Comparison::row(std::string_view quantity, double printed, double corrected) {
  fmt::print("   {:<72} {:>10} {:>10}\n", quantity, short_text(printed), short_text(corrected));
  file_.row(number_, quantity, printed, corrected);
}

void Comparison::note(std::string_view text) const { fmt::print("   {}\n", text); }

void errata(Context const& context) {
  Comparison comparison(context);
  fmt::print(
      "\nErrata, each measured as printed and as corrected; medians over {} bodies where no other "
      "is named:\n{}\n",
      context.bodies, describe({Law::Shape::triaxial}));
  erratum_sign_of_rigid_body(comparison);
  erratum_sigma(comparison);
  erratum_euler_correction(comparison);
  erratum_power_of_dt(comparison);
  erratum_heun_correction(comparison);
  erratum_stages(comparison);
  erratum_series(comparison);
  erratum_second_order_condition(comparison);
  erratum_table_and_figures(comparison);
  comparison.close();
}

}  // namespace cayspin::paper
