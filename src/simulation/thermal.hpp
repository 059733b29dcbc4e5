// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "failure.hpp"
#include "io/expression.hpp"
#include "io/scene.hpp"
#include "text.hpp"

#include <cayspin/units.hpp>

#include <fmt/format.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace cayspin::simulation {

/// Returns true if the steps of a scene have thermal noise.
inline bool is_thermal(io::Scene const& scene) {
  return scene.thermal && scene.thermal->temperature > 0;
}

/// Returns the temperature in the scene's units (reduced, or kelvin), without the factors that
/// depend on the site or on t.
inline double typed_temperature(io::Scene const& scene) {
  double const reduced = scene.thermal->temperature;
  return scene.units.si ? reduced * scene.units.energy / units::boltzmann : reduced;
}

/// The temperature at t in reduced units, without its factors that depend on the site. Throws
/// NumbersFailed if it is negative or not finite.
class TemperatureInTime {
 public:
  /// `units`: the scene's, for error messages.
  TemperatureInTime(io::Thermal const& thermal, io::Units const& units)
      : temperature_(thermal.temperature), units_(units) {
    if (auto const* const text = std::get_if<std::string>(&thermal.in_time))
      expression_.emplace(*text, std::vector<std::string>{"t"});
    else
      temperature_ *= std::get<double>(thermal.in_time);
  }

  bool depends_on_time() const { return expression_.has_value(); }
  double operator()(double t) const {
    if (!expression_) return temperature_;
    double factor = -1;
    try {
      factor = (*expression_)(&t);
    } catch (std::runtime_error const&) {
      fail("is not finite", t);
    }
    if (!(factor >= 0)) fail("is negative", t);
    return factor * temperature_;
  }

 private:
  [[noreturn]] void fail(char const* what, double t) const {
    throw NumbersFailed(
        fmt::format("thermal.temperature: {} at t = {}", what, time_text(units_, t)));
  }

  double temperature_;
  io::Units units_;
  std::optional<io::Expression> expression_;
};

}  // namespace cayspin::simulation
