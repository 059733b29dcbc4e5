// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "initial_state.hpp"

#include "site_expression.hpp"

#include <cmath>
#include <numbers>

namespace cayspin::inline v0_2::io::detail {
namespace {

using cayspin::detail::scalar_product;
using cayspin::detail::vector_product;

struct SineCosine {
  double sine, cosine;
};

// Returns sine and cosine of the angle 2 atan(q). They are exact if q is 0, 1 or infinite.
SineCosine of_twice_atan(double q) {
  bool const is_obtuse = q > 1;
  double const tangent = is_obtuse ? 1 / q : q;
  double const square = 1 + tangent * tangent;
  double const cosine = (1 - tangent) * (1 + tangent) / square;
  return {2 * tangent / square, is_obtuse ? -cosine : cosine};
}

// Returns sinh(R/w) / sinh(r/w) without overflow of a sinh; infinite if r is 0.
double quotient_of_sinh(double R, double r, double w) {
  return std::exp((R - r) / w) * (std::expm1(-2 * R / w) / std::expm1(-2 * r / w));
}

struct SpinOfState {
  Lattice const& lattice;
  std::array<std::int64_t, 3> const& site;

  // Returns the vector to the site from a point given in fractions of the lattice. With
  // `across_ends`, the vector crosses a periodic end of x or y if that way is shorter.
  Triple way_from(Triple const& point, bool across_ends = false) const {
    auto const values = site_values(lattice, site);
    auto const sites = static_cast<std::int64_t>(lattice.basis.size());
    Triple way{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double fraction = values[axis] - point[axis];
      if (across_ends && axis < 2 && lattice.boundary[axis] == BoundaryKind::periodic)
        fraction -= std::round(fraction);
      auto const cells = static_cast<double>(lattice.shape[axis] / (axis == 2 ? sites : 1));
      for (std::size_t c = 0; c < 3; ++c)
        way[c] += fraction * cells * lattice.cell[axis][c] * lattice.spacing[c];
    }
    return way;
  }

  // Position of a site relative to an axis along z.
  struct FromAxis {
    double x, y, r;

    // Returns a vector from its radial, azimuthal (counter-clockwise) and z components.
    Triple vector(double radial, double azimuthal, double z) const {
      if (r == 0) return {0, 0, z};
      return {(radial * x - azimuthal * y) / r, (radial * y + azimuthal * x) / r, z};
    }
  };
  FromAxis from_axis(std::array<double, 2> const& center) const {
    auto const [x, y, z] = way_from({center[0], center[1], 0.5}, true);
    return {x, y, std::sqrt(x * x + y * y)};
  }

  Triple operator()(VortexState const& vortex) const {
    auto const at = from_axis(vortex.center);
    auto const [sine, cosine] = of_twice_atan(std::min(at.r / vortex.radius, 1.0));
    return at.vector(0, static_cast<double>(vortex.circulation) * sine,
                     static_cast<double>(vortex.polarity) * cosine);
  }

  Triple operator()(SkyrmionState const& skyrmion) const {
    auto const at = from_axis(skyrmion.center);
    auto const [sine, cosine] =
        of_twice_atan(quotient_of_sinh(skyrmion.radius, at.r, skyrmion.width));
    double const in_plane = static_cast<double>(skyrmion.chirality) * sine;
    return at.vector(skyrmion.bloch ? 0 : in_plane, skyrmion.bloch ? in_plane : 0,
                     -static_cast<double>(skyrmion.polarity) * cosine);
  }

  Triple operator()(TwoDomainsState const& domains) const {
    Triple middle{0.5, 0.5, 0.5};
    middle[domains.axis] = domains.position;
    double const u = way_from(middle)[domains.axis] / domains.width;
    double const tanh = std::tanh(u), sech = 1 / std::cosh(u);
    Triple m;
    for (std::size_t c = 0; c < 3; ++c) {
      double const a = domains.directions[0][c], b = domains.directions[1][c];
      m[c] = ((1 - tanh) * a + (1 + tanh) * b) / 2 + sech * (domains.wall[c] - (a + b) / 2);
    }
    return m;
  }

  Triple operator()(HelixState const& helix) const {
    double const turns = scalar_product(way_from({0, 0, 0}), helix.direction) / helix.period;
    double const angle = 2 * std::numbers::pi * turns + helix.phase;
    auto const& n = helix.normal;
    // At angle 0, a spin is along the projection of z onto the plane normal to n, or along x if n
    // is along z.
    bool const is_along_z = n[0] * n[0] + n[1] * n[1] < 1e-12;
    auto const side = vector_product(n, is_along_z ? Triple{1, 0, 0} : Triple{0, 0, 1});
    auto const begin = vector_product(side, n);
    Triple m;
    for (std::size_t c = 0; c < 3; ++c)
      m[c] = std::cos(angle) * begin[c] + std::sin(angle) * side[c];
    return m;
  }
};

}  // namespace

Triple spin_of_state(InitialState const& state, Lattice const& lattice,
                     std::array<std::int64_t, 3> const& site) {
  return std::visit(SpinOfState{lattice, site}, state);
}

}  // namespace cayspin::inline v0_2::io::detail
