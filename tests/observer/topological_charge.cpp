// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The topological charge: whole numbers for known textures, and arbitrary spins against plain loops
// over plaquettes.
#include "../support/backends.hpp"

#include <cayspin/cayspin.hpp>

#include <numbers>
#include <random>

namespace cayspin::test {
namespace {

constexpr double pi = std::numbers::pi;

template <class Backend>
using TopologicalCharge = OnBackend<Backend>;
TYPED_TEST_SUITE(TopologicalCharge, Backends, BackendName);

Lattice film(std::int64_t nx, std::int64_t ny, Boundary boundary, std::int64_t nz = 1) {
  return Lattice::cubic(nx, ny, nz, 1, boundary);
}

/// Returns m = (sin(t) * cos(p), sin(t) * sin(p), cos(t)) in each plane, with [t, p] = angles(x,
/// y).
template <class Angles>
std::vector<double> by_angles(Lattice const& lattice, Angles const& angles) {
  std::vector<double> m;
  for (std::int64_t site = 0; site < lattice.sites(); ++site) {
    auto const [t, p] = angles(static_cast<double>(site % lattice.shape[0]),
                               static_cast<double>(site / lattice.shape[0] % lattice.shape[1]));
    m.insert(m.end(), {std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)});
  }
  return m;
}

/// Returns spins whose polar angle falls linearly from pi at the centre to 0 at `radius`. Their
/// azimuth is winding * (azimuth of the site) + helicity.
std::vector<double> texture(Lattice const& lattice, double radius, double winding,
                            double helicity) {
  auto const half = [&](std::size_t axis) {
    return 0.5 * static_cast<double>(lattice.shape[axis]);
  };
  return by_angles(lattice, [&](double i, double j) {
    double const x = i - half(0) + 0.3, y = j - half(1) + 0.4;
    return std::pair(pi * std::max(0.0, 1 - std::hypot(x, y) / radius),
                     winding * std::atan2(y, x) + helicity);
  });
}

std::vector<double> negative(std::vector<double> m) {
  for (double& number : m) number = -number;
  return m;
}

/// Returns half the solid angle of the triangle with these corners (L'Huilier's theorem), with its
/// sign.
double half_angle(Vec3<double> const& a, Vec3<double> const& b, Vec3<double> const& c) {
  auto const side = [](Vec3<double> const& u, Vec3<double> const& v) {
    auto const n = cross(u, v);
    return std::atan2(std::sqrt(dot(n, n)), dot(u, v));
  };
  double const ab = side(a, b), bc = side(b, c), ca = side(c, a), s = (ab + bc + ca) / 2;
  double const product =
      std::tan(s / 2) * std::tan((s - ab) / 2) * std::tan((s - bc) / 2) * std::tan((s - ca) / 2);
  double const angle = 2 * std::atan(std::sqrt(std::max(0.0, product)));
  return std::copysign(angle, dot(a, cross(b, c)));
}

/// Returns the charge of plane z, plaquette by plaquette.
double by_plaquettes(Lattice const& lattice, std::vector<double> const& m, std::int64_t z) {
  auto const nx = lattice.shape[0], ny = lattice.shape[1];
  auto const spin = [&](std::int64_t x, std::int64_t y) {
    return at(m, x % nx + nx * (y % ny + ny * z));
  };
  auto const last = [&](std::size_t axis) {
    auto const extent = lattice.shape[axis];
    return lattice.boundary[axis] == Boundary::periodic && extent > 1 ? extent : extent - 1;
  };
  double angle = 0;
  for (std::int64_t y = 0; y < last(1); ++y)
    for (std::int64_t x = 0; x < last(0); ++x)
      angle += half_angle(spin(x, y), spin(x + 1, y), spin(x, y + 1)) +
               half_angle(spin(x + 1, y + 1), spin(x, y + 1), spin(x + 1, y));
  return angle / (2 * pi);
}

TYPED_TEST(TopologicalCharge, SkyrmionsHaveWholeNumbers) {
  using Spins = typename TypeParam::Spins;
  for (auto const boundary : {Boundary::periodic, Boundary::open})
    for (double const helicity : {0.0, pi / 2, pi, 0.7}) {  // Neel, Bloch, Neel, between
      auto const lattice = film(37, 31, boundary);
      auto const charge = [&](std::vector<double> const& m) {
        return topological_charge(this->exec, spins_of<Spins>(lattice, m));
      };
      auto const skyrmion = texture(lattice, 13, 1, helicity);
      EXPECT_NEAR(charge(skyrmion), -1, 1e-12) << helicity;
      EXPECT_NEAR(charge(negative(skyrmion)), 1, 1e-12) << helicity;
      EXPECT_NEAR(charge(texture(lattice, 13, -1, helicity)), 1, 1e-12) << helicity;
      EXPECT_NEAR(charge(texture(lattice, 13, 2, helicity)), -2, 1e-12) << helicity;
    }
}

TYPED_TEST(TopologicalCharge, UniformSpinsHaveNone) {
  using Spins = typename TypeParam::Spins;
  for (auto const boundary : {Boundary::periodic, Boundary::open}) {
    auto const lattice = film(19, 5, boundary, 2);
    EXPECT_EQ(topological_charge(this->exec, Spins("up", lattice)), 0);
    std::vector<double> m;
    for (std::int64_t site = 0; site < lattice.sites(); ++site) m.insert(m.end(), {0.6, 0.0, -0.8});
    EXPECT_NEAR(topological_charge(this->exec, spins_of<Spins>(lattice, m)), 0, 1e-13);
  }
}

// The core covers a hemisphere: spins at the border lie in the plane and turn once around the
// equator.
TYPED_TEST(TopologicalCharge, AVortexHasHalf) {
  using Spins = typename TypeParam::Spins;
  auto const lattice = film(33, 30, Boundary::open);
  for (double const core : {1.0, -1.0})
    for (double const winding : {1.0, -1.0}) {
      auto const m = by_angles(lattice, [&](double i, double j) {
        double const x = i - 15.8, y = j - 14.7;
        double const from_core = pi / 2 * std::min(1.0, std::hypot(x, y) / 12);
        return std::pair(core > 0 ? from_core : pi - from_core,
                         winding * std::atan2(y, x) + pi / 2);
      });
      EXPECT_NEAR(topological_charge(this->exec, spins_of<Spins>(lattice, m)), core * winding / 2,
                  1e-12);
    }
}

// Rows a little shorter and longer than whole packs, and rows that are divided among threads.
TYPED_TEST(TopologicalCharge, AgainstPlainLoops) {
  using Spins = typename TypeParam::Spins;
  std::vector<Lattice> lattices{film(1, 1, Boundary::periodic), film(7, 1, Boundary::periodic),
                                film(1, 7, Boundary::periodic), film(2, 3, Boundary::periodic),
                                film(9000, 3, Boundary::open)};
  for (std::int64_t nx = 2; nx < 19; ++nx)
    for (auto const boundary : {Boundary::periodic, Boundary::open})
      lattices.push_back(film(nx, 5, boundary, 3));
  auto mixed = film(37, 29, Boundary::open, 4);
  mixed.boundary[0] = Boundary::periodic;
  lattices.push_back(mixed);
  std::swap(mixed.boundary[0], mixed.boundary[1]);
  lattices.push_back(mixed);
  for (auto const& lattice : lattices) {
    auto const spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 41));
    auto const m = numbers_of(spins);
    auto const name = std::to_string(lattice.shape[0]) + " x " + std::to_string(lattice.shape[1]);
    double const bound = 1e-13 * static_cast<double>(lattice.sites()) + 1e-12;
    double all = 0;
    for (std::int64_t z = 0; z < lattice.shape[2]; ++z) {
      double const expected = by_plaquettes(lattice, m, z);
      EXPECT_NEAR(topological_charge(this->exec, spins, z), expected,
                  epsilon<typename TypeParam::Real> * 1e3 + bound)
          << name;
      all += topological_charge(this->exec, spins, z);
    }
    EXPECT_NEAR(topological_charge(this->exec, spins), all, bound) << name;
    if (lattice.boundary[0] == Boundary::periodic && lattice.boundary[1] == Boundary::periodic) {
      EXPECT_NEAR(all, std::round(all), bound) << name;
    }
  }
}

// tests/python/observables.py expects the same charges for the same spins.
TYPED_TEST(TopologicalCharge, TheNumbersOfThePackage) {
  using Spins = typename TypeParam::Spins;
  auto const charge = [&](Boundary along_x, Boundary along_y) {
    auto lattice = film(7, 5, along_x);
    lattice.boundary[1] = along_y;
    auto const m = by_angles(lattice, [](double x, double y) {
      return std::pair(1.1 * x - 0.9 * y, 0.7 * x + 0.3 * y * y);
    });
    return topological_charge(this->exec, spins_of<Spins>(lattice, m));
  };
  double const bound = std::max(1e-12, 30 * epsilon<typename TypeParam::Real>);
  EXPECT_NEAR(charge(Boundary::open, Boundary::open), -0.10304446296151243, bound);
  EXPECT_NEAR(charge(Boundary::periodic, Boundary::open), -0.3669102399005671, bound);
  EXPECT_NEAR(charge(Boundary::open, Boundary::periodic), -0.8933656985875352, bound);
}

// Lengths do not matter, even where single precision rounds them.
TYPED_TEST(TopologicalCharge, SpinsOfAnyLength) {
  using Spins = typename TypeParam::Spins;
  auto const lattice = film(23, 17, Boundary::periodic);
  auto m = texture(lattice, 8, 1, 0.3);
  for (std::size_t i = 0; i < m.size(); ++i) m[i] *= 0.5 + static_cast<double>(i / 3 % 7);
  EXPECT_NEAR(topological_charge(this->exec, spins_of<Spins>(lattice, m)), -1, 1e-12);
}

// If some corners of a triangle are antiparallel, the formula for its angle divides round-off by
// round-off.
TYPED_TEST(TopologicalCharge, AntiparallelSpinsEncloseNothing) {
  using Spins = typename TypeParam::Spins;
  for (auto const boundary : {Boundary::open, Boundary::periodic}) {
    auto const lattice = film(37, 26, boundary);
    std::mt19937 engine(3);
    for (int direction = 0; direction < 5; ++direction) {
      auto const m = random_directions(1, 7 + static_cast<unsigned>(direction));
      std::vector<double> numbers;
      for (std::int64_t site = 0; site < lattice.sites(); ++site) {
        double const sign = engine() % 2 == 0 ? 1 : -1;
        for (double const number : m) numbers.push_back(sign * number);
      }
      EXPECT_NEAR(topological_charge(this->exec, spins_of<Spins>(lattice, numbers)), 0, 1e-12);
    }
  }
}

TYPED_TEST(TopologicalCharge, NumbersThatAreNoneAreFoundAtEverySite) {
  using Spins = typename TypeParam::Spins;
  auto const lattice = film(19, 2, Boundary::open);
  auto const m = random_directions(lattice.sites(), 23);
  for (std::int64_t site = 0; site < lattice.sites(); ++site) {
    auto wrong = m;
    wrong[3 * site + site % 3] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isnan(topological_charge(this->exec, spins_of<Spins>(lattice, wrong))));
  }
}

TYPED_TEST(TopologicalCharge, WrongCalls) {
  using Spins = typename TypeParam::Spins;
  Spins const spins("spins", film(4, 4, Boundary::open, 2));
  EXPECT_THROW(topological_charge(this->exec, spins, 2), std::invalid_argument);
  EXPECT_THROW(topological_charge(this->exec, spins, -1), std::invalid_argument);
  EXPECT_THROW(topological_charge(this->exec, Spins()), std::invalid_argument);
  EXPECT_THROW(topological_charge(this->exec, Spins(), 0), std::invalid_argument);
}

}  // namespace
}  // namespace cayspin::test
