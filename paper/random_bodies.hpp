// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/generator/rigid_body.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace cayspin::paper {

using Vector = Vec3<double>;

/// A free rigid body and its initial angular momentum.
struct Body {
  std::array<double, 3> moments;  // principal moments of inertia
  std::array<Vector, 3> axes;     // principal axes, right-handed
  Vector start;                   // on the unit sphere
  cayspin::detail::SymmetricMatrix<double> inverse_inertia;

  Vector velocity(Vector const& m) const { return inverse_inertia * m; }
  double energy(Vector const& m) const { return 0.5 * dot(m, velocity(m)); }
};

/// Distribution of bodies and starts: principal moments of inertia uniform in [least, largest]. The
/// paper draws them at random without saying how.
struct Law {
  enum class Shape {
    triaxial,
    axisymmetric,      // two equal moments
    nearly_spherical,  // two equal moments, the third within 15 % of them
    separatrix         // triaxial, starts on the separatrix instead of anywhere on the sphere
  };
  Shape shape;
  double least = 1.25, largest = 3.75;
};

/// Describes the distribution in one line.
std::string describe(Law const& law);

/// Returns equal bodies for equal seeds, on every machine up to the rounding of sin and cos.
std::vector<Body> draw_bodies(Law const& law, std::int64_t count, std::uint64_t seed);

/// Returns a body whose principal axes are x, y and z.
Body principal_body(std::array<double, 3> const& moments, Vector const& start);

}  // namespace cayspin::paper
