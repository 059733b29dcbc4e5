// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The switching field of a uniaxial particle, after Stoner and Wohlfarth.
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"

#include <numbers>

using namespace cayspin;
using namespace cayspin::test;

namespace {

constexpr double anisotropy = 1.3;

/// Returns true if a spin near +z reverses in a field at an angle of psi to -z, which is ramped up
/// and then held.
bool switches(double strength, double psi) {
  auto const under = [&](double h) {
    return Slab{.lattice = Lattice::chain(1),
                .anisotropy = anisotropy,
                .applied = (-h) * Vector{std::sin(psi), 0, std::cos(psi)},
                .damping = 1};
  };
  auto spins = make_spins(Lattice::chain(1), [](auto, auto, auto) { return Vector{1e-3, 0, 1}; });
  Rkmk4 stepper(spins);
  for (int stage = 1; stage <= 20; ++stage)
    advance(stepper, under(strength * stage / 20).natural(), spins, 0.05, 400);
  advance(stepper, under(strength).natural(), spins, 0.1, 30000);
  return spin(spins, 0).z < 0;
}

TEST(StonerWohlfarth, SwitchingField) {
  struct Row {
    double degrees;
    char const* field;
  };
  for (auto const& [degrees, reference] :
       {Row{10, ".8759470435"}, Row{30, ".6812214042"}, Row{45, ".6500000000"}}) {
    double const psi = degrees * std::numbers::pi / 180;
    double const sum = std::pow(std::cos(psi), 2. / 3) + std::pow(std::sin(psi), 2. / 3);
    double const field = anisotropy * std::pow(sum, -1.5);
    expect_figure(std::to_string(static_cast<int>(degrees)) + " degrees, formula", field, reference,
                  0);
    EXPECT_FALSE(switches(0.9999 * field, psi)) << degrees;
    EXPECT_TRUE(switches(1.0001 * field, psi)) << degrees;
  }
}

}  // namespace
