// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/evaluate.hpp"

#include <cayspin/cayspin.hpp>

#include <functional>
#include <string>
#include <vector>

namespace cayspin::test {

inline Vec3<double> unit(Vec3<double> const& v) { return normalized(v, "a test's vector"); }

/// A term's field H at a site and its energy E, computed on the host by simple formulas. The spins
/// are an array (sites, 3).
struct ByHand {
  std::function<Vec3<double>(std::vector<double> const&, std::int64_t site)> field;
  std::function<double(std::vector<double> const&)> energy;
};

/// A pair of neighbours along an axis; a periodic axis of extent 2 has each of its pairs twice.
struct Bond {
  std::int64_t from, to;
  double spacing;
  Vec3<double> along;  // the axis
};

inline std::vector<Bond> bonds(Lattice const& lattice) {
  std::vector<Bond> all;
  auto const& n = lattice.shape;
  std::int64_t const stride[3] = {1, n[0], n[0] * n[1]};
  Vec3<double> const along[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int axis = 0; axis < 3; ++axis)
    for (std::int64_t site = 0; site < lattice.sites(); ++site) {
      std::int64_t const index = site / stride[axis] % n[axis];
      bool const end = index + 1 == n[axis];
      if (n[axis] == 1 || (end && lattice.boundary[axis] == Boundary::open)) continue;
      std::int64_t const next = end ? site - (n[axis] - 1) * stride[axis] : site + stride[axis];
      all.push_back({site, next, lattice.spacing[axis], along[axis]});
    }
  return all;
}

/// Returns a term that acts site by site: H(m) and E(m).
inline ByHand each_site(std::function<Vec3<double>(Vec3<double> const&)> field,
                        std::function<double(Vec3<double> const&)> energy) {
  return {[field](auto const& m, std::int64_t site) { return field(at(m, site)); },
          [energy](auto const& m) {
            double sum = 0;
            for (std::size_t site = 0; site < m.size() / 3; ++site) sum += energy(at(m, site));
            return sum;
          }};
}

/// Returns a term that is a sum over bonds. A bond adds field(bond, m, other, sign) to H at both of
/// its sites: m is the spin of the site, `other` that at the other end, and `sign` is 1 at
/// bond.from and -1 at bond.to. It adds energy(bond, first, second) to E.
template <class AnyBond, class Field, class Energy>
ByHand each_bond(std::vector<AnyBond> const& bonds, Field const& field, Energy const& energy) {
  return {[=](std::vector<double> const& m, std::int64_t site) {
            Vec3<double> h{0, 0, 0};
            for (auto const& bond : bonds) {
              if (bond.from == site) h += field(bond, at(m, site), at(m, bond.to), 1.0);
              if (bond.to == site) h += field(bond, at(m, site), at(m, bond.from), -1.0);
            }
            return h;
          },
          [=](std::vector<double> const& m) {
            double sum = 0;
            for (auto const& bond : bonds) sum += energy(bond, at(m, bond.from), at(m, bond.to));
            return sum;
          }};
}

/// `constant`: returns the constant of a bond.
inline ByHand exchange_by_hand(Lattice const& lattice,
                               std::function<double(Bond const&)> const& constant) {
  return each_bond(
      bonds(lattice),
      [=](auto const& bond, auto const& m, auto const& other, double) {
        return constant(bond) / (bond.spacing * bond.spacing) * (other - m);
      },
      [=](auto const& bond, auto const& a, auto const& b) {
        return 0.5 * constant(bond) * dot(b - a, b - a) / (bond.spacing * bond.spacing);
      });
}

inline ByHand exchange_by_hand(Lattice const& lattice, double constant) {
  return exchange_by_hand(lattice, [=](Bond const&) { return constant; });
}

/// E = sum over bonds of (m x m').vector.
inline ByHand dmi_by_hand(Lattice const& lattice,
                          std::function<Vec3<double>(Bond const&)> const& vector) {
  return each_bond(
      bonds(lattice),
      [=](auto const& bond, auto const&, auto const& other, double sign) {
        return sign * cross(vector(bond), other);
      },
      [=](auto const& bond, auto const& a, auto const& b) {
        return dot(cross(a, b), vector(bond));
      });
}

inline ByHand cubic_by_hand(double k, Vec3<double> const& axis1, Vec3<double> const& axis2) {
  Vec3<double> const e[3] = {unit(axis1), unit(axis2), cross(unit(axis1), unit(axis2))};
  return each_site(
      [=](auto const& m) {
        Vec3<double> h{0, 0, 0};
        for (auto const& axis : e) {
          double const along = dot(m, axis);
          h = h + 2 * k * along * (along * along - dot(m, m)) * axis;
        }
        return h;
      },
      [=](auto const& m) {
        double sum = dot(m, m) * dot(m, m);
        for (auto const& axis : e) sum -= std::pow(dot(m, axis), 4);
        return 0.5 * k * sum;
      });
}

inline ByHand anisotropy_by_hand(double k, Vec3<double> const& axis) {
  auto const e = unit(axis);
  return each_site([=](auto const& m) { return (k * dot(m, e)) * e; },
                   [=](auto const& m) { return -0.5 * k * dot(m, e) * dot(m, e); });
}

inline ByHand zeeman_by_hand(Vec3<double> const& applied) {
  return each_site([=](auto const&) { return applied; },
                   [=](auto const& m) { return -dot(m, applied); });
}

inline ByHand slab_by_hand(Vec3<double> const& normal, double strength) {
  return anisotropy_by_hand(-strength, normal);
}

}  // namespace cayspin::test
