// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "terms.hpp"

namespace cayspin::test {

// Rows longer and shorter than a pack; a periodic axis of two sites; different spacings.
inline std::vector<Lattice> const lattices{
    {{9, 3, 2}, {0.5, 0.8, 1.25}, {Boundary::open, Boundary::open, Boundary::open}},
    {{9, 3, 2}, {0.5, 0.8, 1.25}, {Boundary::periodic, Boundary::open, Boundary::periodic}},
    {{2, 1, 19}, {0.7, 1, 0.9}, {Boundary::periodic, Boundary::periodic, Boundary::open}}};

/// Checks H = -dE/dm of a term by differences of its total energy, and both H and E against
/// formulas written by hand.
template <class Backend>
class GradientTest : public ::testing::Test {
 protected:
  using Real = typename Backend::Real;
  using Spins = typename Backend::Spins;

  /// `term`: a field term or EffectiveField. Spins change their lengths here: E and H are defined
  /// for all vectors. `precision`: epsilon of the energy; that of float if a field or bonds are
  /// stored in float.
  template <class Term>
  static void check(std::string const& what, Lattice const& lattice, Term const& term,
                    ByHand const& by_hand, double t = 0, double precision = epsilon<double>) {
    typename Backend::Exec const exec;
    // Rounded to the field's precision, so that both sides start from equal numbers.
    auto const m = numbers_of(spins_of<Spins>(lattice, random_directions(lattice.sites(), 11)));
    auto const spins = spins_of<Spins>(lattice, m);
    Spins const result("result", lattice);
    evaluate_field(exec, term, spins, t, result);
    exec.fence();
    auto const field = numbers_of(result);
    Energy const total = energy(exec, term, spins, t);
    // All coefficients are below 8. Exchange adds six differences, each divided by the square of a
    // spacing, which is at least 1/4.
    double const field_size = 64, energy_size = total.magnitude + 1;
    EXPECT_NEAR(total.value, by_hand.energy(m), 16 * precision * energy_size) << what;

    // E is of degree 4 at most, so that this difference has only rounding errors, at any step.
    double const step = 0.5;
    for (std::int64_t site = 0; site < lattice.sites(); ++site) {
      Vec3<double> const h = at(field, site), expected = by_hand.field(m, site);
      double const found[3] = {h.x, h.y, h.z}, wanted[3] = {expected.x, expected.y, expected.z};
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(found[c], wanted[c], epsilon<Real> * field_size) << what << ", site " << site;
        if (site % 5 != 0 && site + 1 != lattice.sites()) continue;
        auto const energy_at = [&](double change) {
          auto moved = m;
          moved[3 * site + c] += change;
          copy_from_host(moved, spins);
          return energy(exec, term, spins, t).value;
        };
        double const slope = (8 * (energy_at(step) - energy_at(-step)) -
                              (energy_at(2 * step) - energy_at(-2 * step))) /
                             (12 * step);
        double const bound = epsilon<Real> * field_size + 16 * precision * energy_size / step;
        EXPECT_NEAR(found[c], -slope, bound) << what << ", site " << site << ", component " << c;
      }
    }
  }
};

}  // namespace cayspin::test
