// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "situation.hpp"

#include <cayspin/vec3.hpp>

#include <cmath>
#include <numbers>

namespace cayspin::extremes {

/// Components of the initial spin, across and along the field.
inline constexpr double across = 0.6, along = 0.8;

/// Returns the angle by which the exact solution turns from 0 to `time`, in radians.
inline long double exact_angle(Setting const& setting, bool body, long double time) {
  if (setting.switched_on_at > 0) time = std::fmax(time - setting.switched_on_at, 0.0L);
  return (body ? -along : 1.0L) * setting.field * time;
}

/// Returns the exact solution at `time`. While the field is on, the azimuth of a spin grows as
/// field * time, and tan(theta / 2) falls as exp(-damping * field * time). A rigid body only turns.
inline Vec3<double> exact_end(Setting const& setting, bool body, long double time) {
  if (setting.along_field) return {0, 0, 1};
  long double const angle =
      std::fmod(exact_angle(setting, body, time), 2 * std::numbers::pi_v<long double>);
  long double const fall = body ? 0 : setting.damping * std::fabs(exact_angle(setting, body, time));
  long double const half = across / (1 + along) * std::exp(-fall);  // tan(theta / 2)
  long double const s = 2 * half / (1 + half * half), c = (1 - half * half) / (1 + half * half);
  return {static_cast<double>(s * std::cos(angle)), static_cast<double>(s * std::sin(angle)),
          static_cast<double>(c)};
}

}  // namespace cayspin::extremes
