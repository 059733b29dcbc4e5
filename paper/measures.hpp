// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "comparison.hpp"
#include "random_bodies.hpp"
#include "statistics.hpp"

#include <limits>

namespace cayspin::paper {

inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Errors below this are rounding, and have no order.
inline constexpr double order_round_off = 1e-12;

/// The two step sizes between which most orders of the errata are measured.
inline constexpr double coarse_dt = 0.05, fine_dt = 0.025;

inline std::vector<Body> errata_bodies(Context const& context) {
  return draw_bodies({Law::Shape::triaxial}, context.bodies, context.seed);
}

template <class Measure>
std::vector<double> of_each(std::vector<Body> const& bodies, Measure const& measure) {
  std::vector<double> values;
  for (auto const& body : bodies) values.push_back(measure(body));
  return values;
}

/// Returns the median over the bodies of measure(body).
template <class Measure>
double median_of(std::vector<Body> const& bodies, Measure const& measure) {
  return quantile(of_each(bodies, measure), 0.5);
}

/// Returns the median order of the errors measure_at(dt)(body), from coarse_dt to fine_dt.
template <class MeasureAt>
double median_order(std::vector<Body> const& bodies, MeasureAt const& measure_at) {
  return quantile(
      orders(of_each(bodies, measure_at(coarse_dt)), of_each(bodies, measure_at(fine_dt)),
             coarse_dt / fine_dt, order_round_off),
      0.5);
}

}  // namespace cayspin::paper
