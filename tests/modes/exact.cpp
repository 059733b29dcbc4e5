// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Known modes: those of one spin, with damping of any strength and at a saddle, and of a chain.
#include "../support/larger.hpp"
#include "modes.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>

namespace cayspin::test {
namespace {

/// H is 2 m_z along z, and not a number for spins that are not along z.
struct NoneBesideTheAxis {
  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const& m = stencil.center();
    Value const none(std::numeric_limits<float>::quiet_NaN());
    return Vec3<Value>{Value(0.0), Value(0.0),
                       select<Value>(dot(m, m) == m.z * m.z, Value(2.0) * m.z, none)};
  }
  template <class Stencil>
  KOKKOS_FUNCTION auto energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value const z = stencil.center().z;
    return Value(-z * z);
  }
};

template <class Backend>
class MacrospinModes : public ModesTest<Backend> {};
TYPED_TEST_SUITE(MacrospinModes, Backends, BackendName);

TYPED_TEST(MacrospinModes, AreNotFoundWhereTheFieldIsNotANumber) {
  auto const m = this->uniform(Lattice::chain(1), {0, 0, 1});
  EffectiveField const field(NoneBesideTheAxis{});
  EXPECT_NE(lowest_curvatures(this->exec, field, m).end, ModesEnd::converged);
  EXPECT_NE(normal_modes(this->exec, LandauLifshitz(field, 0.1), m).end, ModesEnd::converged);
}

// With the curvatures bx along x and by along y,
// rate^2 + damping * (bx + by) * rate + (1 + damping^2) * bx * by = 0.
TYPED_TEST(MacrospinModes, AreThoseOfKittelWithDamping) {
  double const bx = 1.05, by = 0.35;
  EffectiveField const field(SlabDemag({1, 0, 0}, bx - by), UniaxialAnisotropy(0.3, {0, 0, 1}),
                             Zeeman{{0, 0, 0.05}});
  auto const m = this->uniform(Lattice::chain(1), {0, 0, 1});
  for (double const damping : {0.0, 1e-3, 0.3, 1.0, 5.0}) {
    auto const found = normal_modes(this->exec, LandauLifshitz(field, damping), m);
    ASSERT_EQ(found.end, ModesEnd::converged) << damping;
    double const half = damping * (bx + by) / 2;
    double const square = (1 + damping * damping) * bx * by - half * half;
    if (square > 0) {
      ASSERT_EQ(found.modes.size(), 1) << damping;
      EXPECT_NEAR(found.modes[0].frequency, std::sqrt(square), this->accurate) << damping;
      EXPECT_NEAR(found.modes[0].decay, half, this->accurate) << damping;
    } else {
      ASSERT_EQ(found.modes.size(), 2) << damping;
      double const root = std::sqrt(-square);
      for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(found.modes[i].frequency, 0) << damping;
        EXPECT_NEAR(found.modes[i].decay, half + (i == 0 ? -root : root), 10 * this->accurate);
      }
    }
  }
}

// About <111>, the field of a cubic anisotropy is not affine in the spins, and both curvatures are
// -4/3 of its constant.
TYPED_TEST(MacrospinModes, OfACubicAnisotropyAreAccurate) {
  double const part = 1 / std::sqrt(3.0), constant = -0.75;
  EffectiveField const field(CubicAnisotropy(constant, {1, 0, 0}, {0, 1, 0}));
  auto const m = this->uniform(Lattice::chain(1), {part, part, part});
  using Real = typename TestFixture::Real;
  double const accurate = 64 * std::pow(std::numeric_limits<Real>::epsilon(), 0.8);
  auto const found = normal_modes(this->exec, LandauLifshitz(field, 0.0), m);
  ASSERT_EQ(found.modes.size(), 1);
  EXPECT_NEAR(found.modes[0].frequency, -4 * constant / 3, accurate);
  for (auto const& one : lowest_curvatures(this->exec, field, m, {.count = 2}).curvatures)
    EXPECT_NEAR(one.value, -4 * constant / 3, accurate);
}

// Spins along the easy axis of an open chain have the curvatures k + 2 * A * (1 - cos(pi * p / n)),
// each of them twice. If exchange is so strong that products with the Hessian are not accurate
// enough, the search must not claim to have converged.
TYPED_TEST(MacrospinModes, OfAStiffChainAreAccurateOrNotConverged) {
  constexpr std::int64_t n = 64;
  auto const lattice = Lattice::chain(n);
  auto const m = this->uniform(lattice, {0, 0, 1});
  for (double const stiff : {100.0, 1e3, 1e4}) {
    EffectiveField const field(Exchange(lattice, stiff), UniaxialAnisotropy(1, {0, 0, 1}));
    auto const found = lowest_curvatures(this->exec, field, m);
    if (stiff < 1e3 || this->epsilon < 1e-10) {
      EXPECT_EQ(found.end, ModesEnd::converged) << stiff;
    }
    if (found.end != ModesEnd::converged) continue;
    ASSERT_EQ(found.curvatures.size(), 8) << stiff;
    for (std::size_t i = 0; i < 8; ++i) {
      auto const p = static_cast<double>(i / 2);
      double const exact = 1 + 2 * stiff * (1 - std::cos(std::numbers::pi * p / n));
      EXPECT_LT(found.curvatures[i].error, 3.5e-3) << stiff << ' ' << i;
      EXPECT_NEAR(found.curvatures[i].value / exact, 1, 1e-2) << stiff << ' ' << i;
      EXPECT_NEAR(found.curvatures[i].value, exact, found.curvatures[i].value_error)
          << stiff << ' ' << i;
    }
  }
}

// Without precession, each direction has a different decay.
TYPED_TEST(MacrospinModes, DecayWithoutPrecession) {
  EffectiveField const field(SlabDemag({1, 0, 0}, 0.7), Zeeman{{0, 0, 0.4}});
  auto const m = this->uniform(Lattice::chain(1), {0, 0, 1});
  auto const found = normal_modes(this->exec, LandauLifshitz(field, 0.5, false), m);
  ASSERT_EQ(found.modes.size(), 2);
  EXPECT_NEAR(found.modes[0].decay, 0.5 * 0.4, this->accurate);
  EXPECT_NEAR(found.modes[1].decay, 0.5 * 1.1, this->accurate);
  EXPECT_EQ(found.modes[0].frequency, 0);
}

// At a saddle there are two motions without oscillation: one grows, and one decays at the same
// rate.
TYPED_TEST(MacrospinModes, GrowAtASaddle) {
  double const h = 0.2, k = 0.9;
  EffectiveField const field(UniaxialAnisotropy(k, {0, 0, 1}), Zeeman{{h, 0, 0}});
  auto const m = this->uniform(Lattice::chain(1), {1, 0, 0});
  auto const found = normal_modes(this->exec, LandauLifshitz(field, 0.0), m);
  ASSERT_EQ(found.end, ModesEnd::converged);
  ASSERT_EQ(found.modes.size(), 2);
  double const rate = std::sqrt(h * (k - h));
  EXPECT_NEAR(std::abs(found.modes[0].decay), rate, this->accurate);
  EXPECT_NEAR(found.modes[0].decay, -found.modes[1].decay, this->accurate);
  auto const curvatures = lowest_curvatures(this->exec, field, m);
  ASSERT_EQ(curvatures.curvatures.size(), 2);
  EXPECT_NEAR(curvatures.curvatures[0].value, h - k, this->accurate);
  EXPECT_NEAR(curvatures.curvatures[1].value, h, this->accurate);
  for (auto const& one : curvatures.curvatures) {
    EXPECT_GT(one.value_error, 0);
    EXPECT_LT(one.value_error, this->accurate);
  }
}

// The longest vector of a mode has length 1. Each spin moves on an ellipse; the ratio of the axes
// is the square root of the ratio of the curvatures.
TYPED_TEST(MacrospinModes, HaveShapesOfLengthOne) {
  EffectiveField const field(SlabDemag({1, 0, 0}, 0.7), Zeeman{{0, 0, 0.4}});
  auto const m = this->uniform(Lattice::chain(3), {0, 0, 1});
  auto const found = normal_modes(this->exec, LandauLifshitz(field, 0.0), m, {.count = 1});
  ASSERT_EQ(found.modes.size(), 1);
  auto const x = copy_to_host(found.modes[0].real), y = copy_to_host(found.modes[0].imaginary);
  double longest = 0;
  for (std::size_t i = 0; i < x.size(); i += 3) {
    double const along_x = std::hypot(x[i], y[i]), along_y = std::hypot(x[i + 1], y[i + 1]);
    EXPECT_NEAR(along_x / along_y, std::sqrt(0.4 / 1.1), 1e3 * this->accurate);
    EXPECT_EQ(x[i + 2], 0);
    // Spins turn about the field in the right-handed sense.
    EXPECT_LT(x[i] * y[i + 1] - y[i] * x[i + 1], 0);
    longest = larger(longest, std::hypot(along_x, along_y));
  }
  EXPECT_NEAR(longest, 1, 8 * this->epsilon);
}

TYPED_TEST(MacrospinModes, RefuseWhatCannotBe) {
  auto const m = this->uniform(Lattice::chain(2), {0, 0, 1});
  EffectiveField const field(Zeeman{{0, 0, 1}});
  EXPECT_THROW(normal_modes(this->exec, LandauLifshitz(field, 0.0, false), m),
               std::invalid_argument);
  EXPECT_THROW(normal_modes(this->exec, LandauLifshitz(field, 0.1), m, {.count = 0}),
               std::invalid_argument);
  EXPECT_THROW(normal_modes(this->exec, LandauLifshitz(field, 0.1), m, {.count = 129}),
               std::invalid_argument);
  EXPECT_THROW(normal_modes(this->exec, LandauLifshitz(field, 0.1), m, {.tolerance = std::nan("")}),
               std::invalid_argument);
  EXPECT_THROW(normal_modes(this->exec, LandauLifshitz(field, 0.1), m, {.evaluations = 0}),
               std::invalid_argument);
  using Real = typename TestFixture::Real;
  using Memory = typename TestFixture::Spins::memory_space;
  for (auto const& other : {Lattice::chain(1), Lattice::square(1, 2)}) {
    Turning<Real, Memory> const turning{{"precession", other, Real(1)}, {"damping", other}};
    EXPECT_THROW(normal_modes(this->exec, field, turning, m), std::invalid_argument);
    EXPECT_THROW(bloch_modes(this->exec, field, turning, m, {{0, 0, 0}}), std::invalid_argument);
  }
  auto const ring = Lattice::chain(2, 1, Boundary::periodic);
  Turning<Real, Memory> const turning{{"precession", ring, Real(1)}, {"damping", ring}};
  for (double const k : {std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(
        bloch_modes(this->exec, field, turning, this->uniform(ring, {0, 0, 1}), {{k, 0, 0}}),
        std::invalid_argument);
}

// An isotropic open chain with the exchange -A has w = 2 * A * sin(pi * p / n), equal for p and
// n - p, and zero modes that drift: the chain turns freely, and the angle of a turn may grow in
// proportion to time.
TYPED_TEST(MacrospinModes, AreWavesInAnIsotropicAntiferromagnet) {
  for (std::int64_t const n : {6, 8, 16}) {
    auto const lattice = Lattice::chain(n);
    std::vector<double> numbers;
    for (std::int64_t i = 0; i < n; ++i)
      for (double const c : {0.6, 0.0, 0.8}) numbers.push_back(i % 2 == 0 ? c : -c);
    auto const m = spins_of<typename TestFixture::Spins>(lattice, numbers);
    EffectiveField const field(Exchange(lattice, -1.0));
    auto const found = normal_modes(this->exec, LandauLifshitz(field, 0.0), m, {.count = 8});
    EXPECT_EQ(found.end, ModesEnd::converged) << n;
    EXPECT_GE(found.modes.size(), static_cast<std::size_t>(std::min<std::int64_t>(8, n)));
    int waves = 0;
    for (auto const& mode : found.modes) {
      if (mode.frequency < 0.1) continue;
      ++waves;
      double nearest = 1;
      for (std::int64_t p = 1; p <= n / 2; ++p)
        nearest = std::min(nearest, std::abs(mode.frequency - 2 * std::sin(std::numbers::pi *
                                                                           double(p) / double(n))));
      EXPECT_LT(nearest, this->accurate) << n << ": " << mode.frequency;
      EXPECT_LT(std::abs(mode.decay), this->accurate) << n;
    }
    EXPECT_GE(waves, 4) << n;
  }
}

// No pivot of this Hessian is as small as its least eigenvalue, which belongs to a zero mode.
TEST(Pencil, AZeroModeLeavesTheOthersAccurate) {
  Eigen::Matrix4d turning = Eigen::Matrix4d::Zero(), basis = Eigen::Matrix4d::Identity();
  turning(0, 1) = turning(2, 3) = 1;
  turning(1, 0) = turning(3, 2) = -1;
  double const angle = 1e-4;
  basis(0, 0) = basis(3, 3) = std::cos(angle);
  basis(0, 3) = std::sin(angle);
  basis(3, 0) = -std::sin(angle);
  Eigen::Vector4d const curvatures(1e-15, 0.5, 2, 3);
  detail::Pencil<double> pencil;
  pencil.hessian = basis.transpose() * curvatures.asDiagonal() * basis;
  pencil.turning = basis.transpose() * turning * basis;
  auto const modes = pencil.slowest_modes(true, 1e-3);
  ASSERT_FALSE(modes.empty());
  EXPECT_LT(std::abs(modes.front().rate), 1e-6);
  EXPECT_NEAR(modes.back().rate.imag(), std::sqrt(6), 2e-13);
}

}  // namespace
}  // namespace cayspin::test
