// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Spin waves of crystals with known frequencies. If all sublattices have the same amplitude, cones
// of any opening turn rigidly, so the frequencies are exact for large amplitudes, too.
#include "../support/antiferromagnet.hpp"
#include "../support/evaluate.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/crystal.hpp>
#include <cayspin/field/field_of_moments.hpp>
#include <cayspin/field/pair_couplings.hpp>
#include <cayspin/stepper/tableau_dormand_prince8.hpp>

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

namespace cayspin::test {
namespace {

constexpr double pi = std::numbers::pi, opening = 0.7;
using Complex = std::complex<double>;
using Cells = std::array<std::int64_t, 3>;
constexpr std::array<Boundary, 3> closed{Boundary::periodic, Boundary::periodic,
                                         Boundary::periodic};

template <class Backend>
class Magnons : public ::testing::Test {
 protected:
  using Real = typename Backend::Real;
  using Spins = typename Backend::Spins;
  using Memory = typename Backend::MemorySpace;

  static constexpr bool is_double = std::is_same_v<Real, double>;
  typename Backend::Exec exec;

  /// Returns the spins at time `end`.
  template <class Field>
  std::vector<double> run(Lattice const& lattice, Field const& field,
                          std::vector<double> const& start, double end, int steps) {
    auto spins = spins_of<Spins>(lattice, start);
    Rkmk<Spins, tableau::DormandPrince8> stepper(spins);
    integrate(exec, stepper, LandauLifshitz(field, 0), spins, Times{0, end / steps, steps});
    return numbers_of(spins);
  }

  /// Starts with the transverse part wave(cell, site) of each spin, and expects it to turn by
  /// frequency * end. Spins of the site `down` of a cell have m_z < 0.
  template <class Field>
  void expect_turns(Crystal const& crystal, Cells const& cells, Field const& field,
                    std::function<Complex(Cells const&, int)> const& wave, double frequency,
                    int down = -1) {
    auto const lattice = crystal.lattice(cells, closed);
    auto const sites = static_cast<int>(crystal.basis.size());
    std::vector<double> start;
    std::vector<Complex> amplitude;
    for (std::int64_t plane = 0; plane < lattice.shape[2]; ++plane)
      for (std::int64_t j = 0; j < cells[1]; ++j)
        for (std::int64_t i = 0; i < cells[0]; ++i) {
          auto const site = static_cast<int>(plane % sites);
          auto const a = wave({i, j, plane / sites}, site);
          double const z = std::sqrt(1 - std::norm(a));
          amplitude.push_back(a);
          start.insert(start.end(), {a.real(), a.imag(), site == down ? -z : z});
        }
    // The wave turns by 2.3 radians, or for 20 units of time if it is slower. A field of 10, the
    // largest in these tests, turns a spin by 0.25 radians in a step.
    double const end = std::min(2.3 / std::abs(frequency), 20.0);
    int const steps = static_cast<int>(std::ceil(end * 10 / 0.25));
    auto const numbers = run(lattice, field, start, end, steps);
    double const allowed = is_double ? 1e-11 : 100 * steps * epsilon<Real>;
    for (std::size_t site = 0; site < amplitude.size(); ++site) {
      auto const expected = amplitude[site] * std::polar(1.0, frequency * end);
      EXPECT_NEAR(numbers[3 * site], expected.real(), allowed) << site;
      EXPECT_NEAR(numbers[3 * site + 1], expected.imag(), allowed) << site;
    }
  }
};
TYPED_TEST_SUITE(Magnons, Backends, BackendName);

/// Returns bonds between two sites of the basis, one for each cell offset.
std::vector<Coupling> bonds(std::array<int, 2> between,
                            std::vector<std::array<int, 3>> const& offsets, double exchange,
                            std::array<double, 3> const& D = {}) {
  std::vector<Coupling> made;
  for (auto const& offset : offsets) made.push_back(Coupling::of(between, offset, exchange, D));
  return made;
}
std::vector<Coupling> operator+(std::vector<Coupling> a, std::vector<Coupling> const& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::vector<Coupling> bcc_bonds(double exchange) {
  std::vector<std::array<int, 3>> offsets;
  for (int i : {-1, 0})
    for (int j : {-1, 0})
      for (int k : {-1, 0}) offsets.push_back({i, j, k});
  return bonds({0, 1}, offsets, exchange);
}
std::vector<Coupling> honeycomb_bonds(double exchange) {
  return bonds({0, 1}, {{0, 0, 0}, {-1, 0, 0}, {0, -1, 0}}, exchange);
}

// omega = (8 * J - J_k) * cos(opening), with J_k = 8 * J * cos(kx / 2) * cos(ky / 2) * cos(kz / 2).
TYPED_TEST(Magnons, OfABodyCentredCrystal) {
  Cells const cells{24, 6, 5};
  auto const crystal = Crystal::bcc();
  PairCouplings<typename TestFixture::Memory> const field(crystal.lattice(cells, closed),
                                                          bcc_bonds(1.25));
  for (Cells const& mode : {Cells{1, 0, 0}, {5, 2, 1}, {12, 3, 4}}) {
    double k[3], product = 8 * 1.25;
    for (int a = 0; a < 3; ++a) {
      k[a] = 2 * pi * static_cast<double>(mode[a]) / static_cast<double>(cells[a]);
      product *= std::cos(k[a] / 2);
    }
    this->expect_turns(
        crystal, cells, field,
        [&](Cells const& cell, int site) {
          auto const r = crystal.position(cell, static_cast<std::size_t>(site));
          return std::polar(std::sin(opening), k[0] * r[0] + k[1] * r[1] + k[2] * r[2]);
        },
        (8 * 1.25 - product) * std::cos(opening));
  }
}

// omega = J * (3 -+ |f|) * cos(opening), where f is the sum of exp(i k.delta) over the offsets
// delta of the three neighbours.
TYPED_TEST(Magnons, OfAHoneycomb) {
  Cells const cells{18, 12, 1};
  auto const crystal = Crystal::honeycomb();
  PairCouplings<typename TestFixture::Memory> const field(crystal.lattice(cells, closed),
                                                          honeycomb_bonds(0.5));
  for (Cells const& mode : {Cells{1, 0, 0}, {4, 5, 0}, {9, 6, 0}})
    for (double const branch : {1.0, -1.0}) {
      double const a = 2 * pi * static_cast<double>(mode[0]) / 18,
                   b = 2 * pi * static_cast<double>(mode[1]) / 12;
      auto const f = 1.0 + std::polar(1.0, -a) + std::polar(1.0, -b);  // offsets of cells
      this->expect_turns(
          crystal, cells, field,
          [&](Cells const& cell, int site) {
            auto const phase = a * static_cast<double>(cell[0]) + b * static_cast<double>(cell[1]);
            auto const amplitude = std::polar(std::sin(opening), phase);
            return site == 0 ? amplitude : branch * amplitude * std::conj(f) / std::abs(f);
          },
          0.5 * (3 - branch * std::abs(f)) * std::cos(opening));
    }
}

// At the corner K of the Brillouin zone, one sublattice can precess while the other is at rest. A
// Dzyaloshinskii-Moriya vector of length D between second neighbours, along z for bonds that go
// round a hexagon in one direction, and along -z for the other direction, splits the two
// frequencies by 6 * sqrt(3) * D * cos(opening).
TYPED_TEST(Magnons, OfAHoneycombWithAGap) {
  Cells const cells{12, 12, 1};
  constexpr double D = 0.04;
  auto const crystal = Crystal::honeycomb();
  std::vector<std::array<int, 3>> const round{{1, 0, 0}, {-1, 1, 0}, {0, -1, 0}};
  auto const couplings = honeycomb_bonds(0.5) + bonds({0, 0}, round, 0, {0, 0, D}) +
                         bonds({1, 1}, round, 0, {0, 0, -D});
  PairCouplings<typename TestFixture::Memory> const field(crystal.lattice(cells, closed),
                                                          couplings);
  double found[2] = {};
  for (int const moving : {0, 1}) {
    double const a = 2 * pi / 3, b = -2 * pi / 3;
    double sines = 0;
    for (auto const& offset : round) sines += std::sin(a * offset[0] + b * offset[1]);
    double const of_D = 2 * (moving == 0 ? D : -D) * sines;
    found[moving] = 3 * 0.5 - of_D * std::cos(opening);
    this->expect_turns(
        crystal, cells, field,
        [&](Cells const& cell, int site) {
          auto const phase = a * static_cast<double>(cell[0]) + b * static_cast<double>(cell[1]);
          return site == moving ? std::polar(std::sin(opening), phase) : Complex(0);
        },
        found[moving]);
  }
  EXPECT_NEAR(std::abs(found[0] - found[1]), 6 * std::sqrt(3.0) * D * std::cos(opening), 1e-14);
}

// The flat band of a kagome lattice: omega = 6 * J * cos(opening) at any k. Here the phases of the
// three sites of a cell differ by a third of a turn.
TYPED_TEST(Magnons, OfAKagome) {
  Cells const cells{9, 8, 1};
  auto const crystal = Crystal::kagome();
  auto const couplings = bonds({0, 1}, {{0, 0, 0}, {-1, 0, 0}}, 0.75) +
                         bonds({0, 2}, {{0, 0, 0}, {0, -1, 0}}, 0.75) +
                         bonds({1, 2}, {{0, 0, 0}, {1, -1, 0}}, 0.75);
  PairCouplings<typename TestFixture::Memory> const field(crystal.lattice(cells, closed),
                                                          couplings);
  this->expect_turns(
      crystal, cells, field,
      [&](Cells const&, int site) { return std::polar(std::sin(opening), 2 * pi / 3 * site); },
      6 * 0.75 * std::cos(opening));
  this->expect_turns(
      crystal, cells, field,
      [&](Cells const&, int site) { return std::polar(std::sin(opening), -2 * pi / 3 * site); },
      6 * 0.75 * std::cos(opening));
}

// At small openings |omega| = sqrt((h + K)^2 - (h * gamma)^2), with h = 8 * |J| and
// gamma = cos(kx / 2) * cos(ky / 2) * cos(kz / 2). omega is positive if spins up have the larger
// amplitude, and negative if spins down do.
TYPED_TEST(Magnons, OfAnAntiferromagnet) {
  Cells const cells{24, 6, 5};
  constexpr double J = -0.75, h = 8 * -J, K = 0.5;
  auto const crystal = Crystal::bcc();
  using Couplings = PairCouplings<typename TestFixture::Memory>;
  EffectiveField const field{Couplings(crystal.lattice(cells, closed), bcc_bonds(J)),
                             UniaxialAnisotropy(K, {0, 0, 1})};
  for (Cells const& mode : {Cells{1, 0, 0}, {5, 2, 1}, {11, 1, 2}}) {
    double k[3], gamma = 1;
    for (int a = 0; a < 3; ++a) {
      k[a] = 2 * pi * static_cast<double>(mode[a]) / static_cast<double>(cells[a]);
      gamma *= std::cos(k[a] / 2);
    }
    auto const cone = AntiferromagneticCone::of(h, K, gamma, opening);
    EXPECT_NEAR(AntiferromagneticCone::of(h, K, gamma, 1e-6).frequency,
                AntiferromagneticCone::of_small_opening(h, K, gamma), 1e-11);
    for (int const moving : {0, 1})  // the sublattice of larger amplitude
      this->expect_turns(
          crystal, cells, field,
          [&](Cells const& cell, int site) {
            auto const r = crystal.position(cell, static_cast<std::size_t>(site));
            return std::polar(site == moving ? std::sin(opening) : cone.smaller,
                              k[0] * r[0] + k[1] * r[1] + k[2] * r[2] + (site == moving ? 0 : pi));
          },
          moving == 0 ? cone.frequency : -cone.frequency, 1);
  }
}

// Two sublattices rotate about the constant L = sum of (mu / g) * m, at the rate
// 8 * J * g * g' * |L| / (mu * mu').
TYPED_TEST(Magnons, OfAFerrimagnet) {
  Cells const cells{9, 4, 3};
  auto const crystal = Crystal::bcc();
  auto const lattice = crystal.lattice(cells, closed);
  using Memory = typename TestFixture::Memory;
  std::vector<double> const moments{1.5, 0.7}, g{1.1, 0.8};
  EffectiveField<PairCouplings<Memory>> const terms{
      PairCouplings<Memory>(lattice, bcc_bonds(-0.6))};
  FieldOfMoments const field(terms, CellMoments<Memory>(lattice, moments, g));
  Vec3<double> const m[2] = {normalized(Vec3<double>{0.3, -0.5, 0.8}, "a test's vector"),
                             normalized(Vec3<double>{0.4, 0.1, -0.7}, "a test's vector")};
  Vec3<double> const L = (moments[0] / g[0]) * m[0] + (moments[1] / g[1]) * m[1];
  double const length = std::sqrt(dot(L, L));
  double const rate = 8 * -0.6 * g[0] * g[1] * length / (moments[0] * moments[1]);
  double const end = 2.3 / std::abs(rate);
  std::vector<double> start;
  for (std::int64_t plane = 0; plane < lattice.shape[2]; ++plane)
    for (int site = 0; site < 36; ++site)
      start.insert(start.end(), {m[plane % 2].x, m[plane % 2].y, m[plane % 2].z});
  int const steps = 64;
  auto const numbers = this->run(lattice, field, start, end, steps);
  double const allowed =
      TestFixture::is_double ? 1e-11 : 100 * steps * epsilon<typename TestFixture::Real>;
  auto const turned = [&](Vec3<double> const& v) {  // by rate * end about L
    Vec3<double> const e = (1 / length) * L;
    double const angle = rate * end;
    return std::cos(angle) * v + std::sin(angle) * cross(e, v) +
           ((1 - std::cos(angle)) * dot(e, v)) * e;
  };
  for (std::int64_t site = 0; site < lattice.sites(); ++site) {
    SCOPED_TRACE(site);
    expect_near(at(numbers, site), turned(m[site / 36 % 2]), allowed);
  }
}

}  // namespace
}  // namespace cayspin::test
