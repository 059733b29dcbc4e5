// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin modes in SI: Kittel's frequency and the decay of uniform magnetizations, from their
// demagnetising factors.
#include "modes_test.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

namespace cayspin::program::test {
namespace {

using Factors = std::array<double, 3>;

constexpr double mu0 = 1.25663706127e-6, gamma = 1.76e11, Ms = 8e5;

struct KittelModes : Modes {
  /// Expects the uniform mode of spins along z in the field `applied`, in T, with Gilbert damping.
  /// `size`: the keys of the lattice.
  void expect_mode(std::string const& size, std::string const& demag, Factors const& factors,
                   double applied, Arguments const& more) const {
    double const bx = applied + mu0 * Ms * (factors[0] - factors[2]),
                 by = applied + mu0 * Ms * (factors[1] - factors[2]);
    for (double const alpha : {0.0, 0.01, 0.7}) {
      auto const outcome = modes(fmt::format(R"toml(units = "SI"
[material]
Ms = 8e5
A = 1.3e-11
alpha = {}
damping_form = "gilbert"
gamma = 1.76e11
[system]
kind = "llg"
[lattice]
{}
[field]
applied = [0, 0, {}]
{}
[initial]
uniform = [0, 0, 1]
)toml",
                                             alpha, size, applied, demag),
                                 joined({"--at-rest", "--overwrite", "--quiet"}, more));
      ASSERT_EQ(outcome.status, 0) << outcome.errors;
      double const slowed = gamma / (1 + alpha * alpha), half = alpha * (bx + by) / 2;
      double const angular = slowed * std::sqrt((1 + alpha * alpha) * bx * by - half * half);
      double const frequency = angular / (2 * std::numbers::pi);
      EXPECT_NEAR(numbers("frequency").at(0) / frequency, 1, 1e-12) << demag << alpha;
      EXPECT_NEAR(numbers("decay").at(0) / angular, slowed * half / angular, 1e-12)
          << demag << alpha;
    }
  }
};

// Lorentz' field of a cubic lattice adds the same to all directions, so only differences of the
// factors count.
TEST_F(KittelModes, OfBodiesWithDemagnetizingFactors) {
  struct Body {
    Factors factors;
    double applied;
  };
  double const third = 1. / 3;
  for (auto const& [factors, applied] : {Body{{third, third, third}, 0.4},  // a sphere
                                         Body{{0, 0, 1}, 1.3},  // a film, magnetised across it
                                         Body{{1, 0, 0}, 0.4},  // a film, magnetised in its plane
                                         Body{{0.2, 0.5, 0.3}, 0.4}}) {  // an ellipsoid
    auto const demag = fmt::format("dipoles = {{ demagnetizing_factors = [{}, {}, {}] }}",
                                   factors[0], factors[1], factors[2]);
    std::string const lattice = "shape = [2, 2, 2]\nspacing = 5e-9\nboundary = \"periodic\"";
    expect_mode(lattice, demag, factors, applied, {"--count", "1", "--tolerance", "1e-12"});
    expect_mode(lattice, demag, factors, applied, {"--wave-vector", "0,0,0"});
  }
}

// Factor along c of a box with the edges a, b and c (Aharoni, J. Appl. Phys. 83, 3432 (1998)).
double factor_of_box(double a, double b, double c) {
  double const r = std::sqrt(a * a + b * b + c * c);
  double const ab = std::hypot(a, b), bc = std::hypot(b, c), ac = std::hypot(a, c);
  auto const ratio = [](double length, double edge) {
    return std::log((length - edge) / (length + edge));
  };
  double const sum = (b * b - c * c) / (2 * b * c) * ratio(r, a) +
                     (a * a - c * c) / (2 * a * c) * ratio(r, b) - b / (2 * c) * ratio(ab, a) -
                     a / (2 * c) * ratio(ab, b) + c / (2 * a) * ratio(bc, b) +
                     c / (2 * b) * ratio(ac, a) + 2 * std::atan(a * b / (c * r)) +
                     (a * a * a + b * b * b - 2 * c * c * c) / (3 * a * b * c) +
                     (a * a + b * b - 2 * c * c) / (3 * a * b * c) * r + c / (a * b) * (ac + bc) -
                     (ab * ab * ab + bc * bc * bc + ac * ac * ac) / (3 * a * b * c);
  return sum / std::numbers::pi;
}

TEST_F(KittelModes, OfOneCellWithTheFactorsOfABox) {
  Factors const factors{factor_of_box(3, 2, 4), factor_of_box(2, 4, 3), factor_of_box(4, 3, 2)};
  EXPECT_NEAR(factors[0] + factors[1] + factors[2], 1, 1e-14);
  expect_mode("shape = [1]\nspacing = [4e-9, 3e-9, 2e-9]", "demag = true", factors, 0.9, {});
  double const third = 1. / 3;
  expect_mode("shape = [1]\nspacing = 5e-9", "demag = true", {third, third, third}, 0.1, {});
}

}  // namespace
}  // namespace cayspin::program::test
