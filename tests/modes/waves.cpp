// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Spin waves of periodic lattices with known frequencies; most are degenerate.
#include "modes.hpp"

#include <numbers>

namespace cayspin::test {
namespace {

template <class Backend>
class WaveModes : public ModesTest<Backend> {
 protected:
  /// Calls visit(k) for all wave vectors, in radians per site.
  template <class Visit>
  static void for_each_wave(Lattice const& lattice, Visit const& visit) {
    auto const& [nx, ny, nz] = lattice.shape;
    double const turn = 2 * std::numbers::pi;
    for (std::int64_t z = 0; z < nz; ++z)
      for (std::int64_t y = 0; y < ny; ++y)
        for (std::int64_t x = 0; x < nx; ++x) visit({turn * x / nx, turn * y / ny, turn * z / nz});
  }
};
TYPED_TEST_SUITE(WaveModes, Backends, BackendName);

double stiffness(double a, Vec3<double> const& k) {
  return 2 * a * (3 - std::cos(k.x) - std::cos(k.y) - std::cos(k.z));
}

TYPED_TEST(WaveModes, OfAFerromagnetInThreeDimensions) {
  double const a = 0.8, anisotropy = 0.1, h = 0.05;
  for (auto const& shape :
       std::vector<std::array<std::int64_t, 3>>{{9, 1, 1}, {12, 10, 1}, {6, 5, 4}}) {
    auto lattice = Lattice::cubic(shape[0], shape[1], shape[2], 1, Boundary::periodic);
    EffectiveField const field(Exchange(lattice, a), UniaxialAnisotropy(anisotropy, {0, 0, 1}),
                               Zeeman{{0, 0, h}});
    std::vector<double> all;
    this->for_each_wave(
        lattice, [&](Vec3<double> const& k) { all.push_back(h + anisotropy + stiffness(a, k)); });
    auto const m = this->uniform(lattice, {0, 0, 1});
    for (double const damping : {0.0, 0.02})
      this->expect_frequencies(normal_modes(this->exec, LandauLifshitz(field, damping), m), all,
                               damping);
    auto const curvatures = lowest_curvatures(this->exec, field, m, {.count = 12});
    ASSERT_EQ(curvatures.curvatures.size(), 12);
    std::ranges::sort(all);
    for (std::size_t i = 0; i < 12; ++i)
      EXPECT_NEAR(curvatures.curvatures[i].value, all[i / 2], this->accurate * all[i / 2]) << i;
  }
}

// Along the magnetization, bulk Dzyaloshinskii-Moriya interaction splits waves of opposite
// directions.
TYPED_TEST(WaveModes, AreNotReciprocalWithDmi) {
  double const a = 0.8, d = 0.3, h = 0.2;
  auto const lattice = Lattice::chain(24, 1, Boundary::periodic);
  EffectiveField const field(Exchange(lattice, a), BulkDmi(lattice, d), Zeeman{{h, 0, 0}});
  std::vector<double> all;
  this->for_each_wave(lattice, [&](Vec3<double> const& k) {
    all.push_back(h + 2 * a * (1 - std::cos(k.x)) + 2 * d * std::sin(k.x));
  });
  auto const m = this->uniform(lattice, {1, 0, 0});
  this->expect_frequencies(normal_modes(this->exec, LandauLifshitz(field, 0.0), m), all, 0);
}

// w = sqrt((2 * J + K)^2 - (2 * J * cos(k))^2), which a field h along the easy axis splits into
// w + h and |w - h|.
TYPED_TEST(WaveModes, OfAnAntiferromagnetInAField) {
  double const j = 1, anisotropy = 0.1, h = 0.07;
  auto const lattice = Lattice::chain(20, 1, Boundary::periodic);
  EffectiveField const field(Exchange(lattice, -j), UniaxialAnisotropy(anisotropy, {0, 0, 1}),
                             Zeeman{{0, 0, h}});
  std::vector<double> all, start;
  for (int i = 0; i < 20; ++i)
    for (double const c : {0.0, 0.0, i % 2 == 0 ? 1.0 : -1.0}) start.push_back(c);
  for (int i = 0; i < 10; ++i) {
    double const k = 2 * std::numbers::pi * i / 20;
    double const w = std::sqrt(std::pow(2 * j + anisotropy, 2) - std::pow(2 * j * std::cos(k), 2));
    all.push_back(std::abs(w - h));
    all.push_back(w + h);
  }
  auto const m = spins_of<typename TestFixture::Spins>(lattice, start);
  this->expect_frequencies(normal_modes(this->exec, LandauLifshitz(field, 0.0), m), all, 0);
}

// There is no torque against a turn of all spins together in the easy plane: the rate of this mode
// is 0. All other modes are waves.
TYPED_TEST(WaveModes, HaveAZeroModeInAnEasyPlane) {
  double const a = 0.8, hard = 0.5;
  auto const lattice = Lattice::chain(16, 1, Boundary::periodic);
  EffectiveField const field(Exchange(lattice, a), UniaxialAnisotropy(-hard, {0, 0, 1}));
  auto const m = this->uniform(lattice, {1, 0, 0});
  auto const found = normal_modes(this->exec, LandauLifshitz(field, 0.0), m);
  ASSERT_EQ(found.end, ModesEnd::converged);
  ASSERT_EQ(found.modes.size(), 8);
  std::vector<double> all, rates;
  for (int i = 1; i < 16; ++i) {
    double const b = 2 * a * (1 - std::cos(2 * std::numbers::pi * i / 16));
    all.push_back(std::sqrt(b * (b + hard)));
  }
  std::ranges::sort(all);
  double const none = std::sqrt(this->epsilon);
  for (auto const& mode : found.modes) {
    double const rate = std::hypot(mode.frequency, mode.decay);
    if (rate > 10 * none) rates.push_back(mode.frequency);
  }
  EXPECT_LT(rates.size(), found.modes.size());
  EXPECT_GE(rates.size(), found.modes.size() - 2);
  for (std::size_t i = 0; i < rates.size(); ++i)
    EXPECT_NEAR(rates[i], all[i], 10 * this->accurate) << i;
}

// The number of evaluations hardly grows with the number of sites.
TYPED_TEST(WaveModes, TakeAsManyEvaluationsOnFineLattices) {
  std::int64_t least = 0, most = 0;
  for (std::int64_t const n : {16, 32, 64}) {
    double const spacing = 16.0 / n;
    auto const lattice = Lattice::square(n, n, spacing);
    EffectiveField const field(Exchange(lattice, 4), UniaxialAnisotropy(0.1, {1, 0, 0}),
                               SlabDemag({0, 0, 1}, 1.0));
    auto const found =
        normal_modes(this->exec, LandauLifshitz(field, 0.01), this->uniform(lattice, {1, 0, 0}));
    EXPECT_EQ(found.end, ModesEnd::converged) << n;
    least = least == 0 ? found.evaluations : std::min(least, found.evaluations);
    most = std::max(most, found.evaluations);
  }
  EXPECT_LE(most, 1.5 * least);
}

}  // namespace
}  // namespace cayspin::test
