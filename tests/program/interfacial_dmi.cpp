// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The interfacial Dzyaloshinskii-Moriya interaction in scenes: a free spiral, the energy bond by
// bond, and H = -dE/dm, shown by the energy that an undamped run conserves.
#include "program_test.hpp"

#include <array>
#include <cmath>

namespace cayspin::program::test {
namespace {

using Vector = std::array<double, 3>;

class InterfacialDmi : public ProgramTest {
 protected:
  /// `lattice`, `field`, `integrator` and `initial` are the lines of these tables.
  static std::string scene(double damping, std::string const& lattice, std::string const& field,
                           std::string const& integrator,
                           std::string const& initial = "random = { seed = 3 }") {
    return "[system]\nkind = \"llg\"\ndamping = " + std::to_string(damping) + "\n[lattice]\n" +
           lattice + "[field]\n" + field + "[initial]\n" + initial + "\n[integrator]\n" +
           integrator;
  }
};

TEST_F(InterfacialDmi, AFreeSpiralTurnsByItsAngle) {
  // With open ends the spins turn about e x n by the angle atan(D * spacing / A) per bond along e.
  auto const spiral = scene(1, "shape = [24]\nspacing = [0.5]\n",
                            "exchange = 0.75\ndmi = { interfacial = 0.6, normal = [0, 0, 1] }\n",
                            "method = \"rkmk4\"\ndt = 0.05\nsteps = 20000\n",
                            "expression = [\"sin(-0.3*i)\", \"0\", \"cos(-0.3*i)\"]");
  for (auto const& [precision, tolerance] :
       {std::pair{"double", 1e-9}, std::pair{"single", 1e-4}}) {
    run(spiral, {"--precision", precision});
    auto const m = last_spins("out.h5");
    for (std::size_t i = 0; i + 1 < 24; ++i) {
      double const turn = std::remainder(
          std::atan2(m[3 * i + 3], m[3 * i + 5]) - std::atan2(m[3 * i], m[3 * i + 2]),
          2 * std::acos(-1.0));
      EXPECT_NEAR(turn, -std::atan(0.6 * 0.5 / 0.75), tolerance) << precision << ", bond " << i;
    }
  }
}

TEST_F(InterfacialDmi, EnergyIsThatOfTheBonds) {
  constexpr int nx = 5, ny = 4;
  Vector const n{0.6, 0, 0.8};
  run(scene(0.1, "shape = [5, 4]\nspacing = [0.5, 2.0]\nboundary = [\"open\", \"periodic\"]\n",
            "dmi = { interfacial = 0.7, normal = [1.5, 0, 2.0] }\n",
            "method = \"rkmk4\"\ndt = 0.01\nsteps = 0\n"));
  auto const m = last_spins("out.h5");
  auto const spin = [&](int i, int j) {
    auto const at = static_cast<std::size_t>(3 * (i + nx * (j % ny)));
    return Vector{m[at], m[at + 1], m[at + 2]};
  };
  auto const dot = [](Vector const& a, Vector const& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  // Each bond from m to m' along e adds D / spacing * (m_n m'_e - m_e m'_n) to the energy.
  double expected = 0;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      auto const bond = [&](Vector const& next, std::size_t axis, double spacing) {
        auto const here = spin(i, j);
        return 0.7 / spacing * (dot(here, n) * next[axis] - here[axis] * dot(next, n));
      };
      if (i + 1 < nx) expected += bond(spin(i + 1, j), 0, 0.5);
      expected += bond(spin(i, j + 1), 1, 2.0);
    }
  EXPECT_NEAR(read_dataset("out.h5", "/energy").values.front(), expected, 1e-13 * nx * ny);
  EXPECT_GT(std::abs(expected), 0.1);
}

TEST_F(InterfacialDmi, UndampedRunsConserveTheEnergy) {
  for (std::string const method : {"rkmk4", "red_black4", "series4"}) {
    double errors[2];
    for (int i = 0; i < 2; ++i) {
      run(scene(
              0, "shape = [6, 4, 2]\n",
              "exchange = 1.0\ndmi = { interfacial = 0.7, normal = [0.6, 0, 0.8] }\n"
              "applied = [0.1, 0.2, 0.3]\n",
              "method = \"" + method + "\"\nend = 1.0\ndt = " + (i == 0 ? "0.02" : "0.01") + "\n"),
          {"--overwrite"});
      auto const energy = read_dataset("out.h5", "/energy").values;
      errors[i] = std::abs(energy.back() - energy.front());
    }
    EXPECT_LT(errors[0], 1e-3) << method;
    EXPECT_LT(errors[1], 0.15 * errors[0] + 1e-12) << method;
  }
}

}  // namespace
}  // namespace cayspin::program::test
