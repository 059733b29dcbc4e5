// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The distribution of the random turns: moments over their 32 values, frequencies, independence of
// sites, steps and the two halves of a step's noise, and bitwise identical results for single sites
// and packs. Seeds are fixed; statistical limits are five standard errors.
#include "../support/backends.hpp"
#include "kept_of_direction.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/observer/thermal_noise.hpp>

#include <array>
#include <cmath>
#include <cstring>

namespace cayspin::test {
namespace {

using Vector = std::array<double, 3>;
using Columns = std::array<Vector, 3>;

/// Returns v of the rotation exp(v) with these columns; v is less than half a turn.
Vector logarithm(Columns const& columns) {
  Vector v;
  for (std::size_t c = 0; c < 3; ++c) {
    auto const next = (c + 1) % 3, last = (c + 2) % 3;
    v[c] = (columns[next][last] - columns[last][next]) / 2;
  }
  double const sine = std::hypot(v[0], v[1], v[2]);
  double const cosine = (columns[0][0] + columns[1][1] + columns[2][2] - 1) / 2;
  for (double& component : v) component *= sine > 0 ? std::atan2(sine, cosine) / sine : 1;
  return v;
}

/// Returns a moment of a standard normal variable: 0 for an odd power, and for an even one the
/// product of the odd numbers below it.
double normal_moment(int power) {
  if (power % 2 == 1) return 0;
  double product = 1;
  for (int i = 1; i < power; i += 2) product *= i;
  return product;
}

template <class Real>
class ThermalTurns : public ::testing::Test {};
TYPED_TEST_SUITE(ThermalTurns, Precisions, PrecisionName);

TYPED_TEST(ThermalTurns, HaveTheMomentsOfNormalNumbersUpToTheFifth) {
  double const s = 0.4;
  detail::RandomTurn<TypeParam, true> const turn(s * s);
  std::array<Vector, 32> cases;
  for (std::size_t code = 0; code < cases.size(); ++code) {
    Columns columns;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      auto const unit = [&](std::size_t c) { return TypeParam(c == axis ? 1 : 0); };
      // The bits that belong to the other half must have no effect.
      auto const bits = static_cast<typename detail::RandomTurn<TypeParam, true>::Bits>(code << 5U);
      auto const m = turn.template turned<5>(bits | 0xfc1fU, Vec3{unit(0), unit(1), unit(2)});
      columns[axis] = {m.x, m.y, m.z};
    }
    cases[code] = logarithm(columns);
  }
  double const tolerance = 20 * epsilon<TypeParam>;
  for (int i = 0; i <= 5; ++i)
    for (int j = 0; i + j <= 5; ++j)
      for (int k = 0; i + j + k <= 5; ++k) {
        double mean = 0;
        for (auto const& v : cases)
          mean += std::pow(v[0] / s, i) * std::pow(v[1] / s, j) * std::pow(v[2] / s, k) / 32;
        EXPECT_NEAR(mean, normal_moment(i) * normal_moment(j) * normal_moment(k), tolerance)
            << i << j << k;
      }
}

// Diffusion multiplies the mean by exp(-u). The error is of third order in u, so the weak order is
// 2.
TEST(ThermalTurn, IsDiffusionToTheThirdOrder) {
  double last = 0;
  for (double const u : {0.1, 0.05, 0.025, 0.0125}) {
    double const error = std::abs(kept_of_direction(u) - std::exp(-u));
    if (last > 0) {
      EXPECT_GT(std::log2(last / error), 2.9) << u;
      EXPECT_LT(std::log2(last / error), 3.1) << u;
    }
    last = error;
  }
}

/// Returns 0 for no turn, 1 to 6 for one about an axis, and 7 to 14 for one about a diagonal.
std::size_t kind_of(Vector const& v, double s) {
  auto const sign = [&](std::size_t c) { return std::size_t{v[c] < 0}; };
  double const length = std::hypot(v[0], v[1], v[2]);
  if (length < 1e-5) return 0;
  for (std::size_t c = 0; c < 3; ++c)
    if (std::abs(v[c]) > 0.9 * length) {
      EXPECT_NEAR(length, 2 * s, 1e-5);
      return 1 + 2 * c + sign(c);
    }
  for (double const component : v) EXPECT_NEAR(std::abs(component), std::sqrt(2.0) * s, 1e-5);
  return 7 + 4 * sign(0) + 2 * sign(1) + sign(2);
}
double probability(std::size_t kind) { return (kind == 0 ? 12 : kind < 7 ? 2 : 1) / 32.0; }

template <class Backend>
class ThermalSites : public ::testing::Test {};
TYPED_TEST_SUITE(ThermalSites, Backends, BackendName);

// The images of the three axes are the columns of each site's rotation.
TYPED_TEST(ThermalSites, TurnIndependently) {
  using Spins = typename TypeParam::Spins;
  using Half = typename ThermalNoise<Spins>::Half;
  typename TypeParam::Exec const exec;
  auto const lattice = Lattice::cubic(77, 31, 41);
  auto const sites = static_cast<std::size_t>(lattice.sites());
  double const u = 0.3, s = std::sqrt(u - u * u / 12);
  auto const turns_of = [&](std::int64_t step, Half half) {
    std::vector<double> numbers[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<double> start(3 * sites, 0);
      for (std::size_t i = axis; i < start.size(); i += 3) start[i] = 1;
      auto const spins = spins_of<Spins>(lattice, start);
      ThermalNoise<Spins>(spins, 0.5, {.temperature = 2, .seed = 77})
          .turn(exec, step, half, u, spins);
      exec.fence();
      numbers[axis] = numbers_of(spins);
    }
    std::vector<std::size_t> kinds(sites);
    for (std::size_t i = 0; i < sites; ++i) {
      Columns columns;
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t c = 0; c < 3; ++c) columns[axis][c] = numbers[axis][3 * i + c];
      kinds[i] = kind_of(logarithm(columns), s);
    }
    return kinds;
  };
  auto const after = turns_of(5, Half::after);
  // These pairs should be independent: the two halves, two steps, and sites `apart` from each
  // other.
  auto const expect_independent = [&](auto const& first, auto const& second, std::size_t apart) {
    std::vector<double> found(225);
    for (std::size_t i = 0; i < sites; ++i) ++found[15 * first[i] + second[(i + apart) % sites]];
    double chi_square = 0;
    for (std::size_t a = 0; a < 15; ++a)
      for (std::size_t b = 0; b < 15; ++b) {
        double const expected = static_cast<double>(sites) * probability(a) * probability(b);
        chi_square += std::pow(found[15 * a + b] - expected, 2) / expected;
      }
    EXPECT_NEAR(chi_square, 224, 5 * std::sqrt(2 * 224.0)) << apart;
  };
  expect_independent(turns_of(6, Half::before), after, 0);
  expect_independent(turns_of(5, Half::before), after, 0);
  expect_independent(turns_of(6, Half::after), after, 0);
  // Sites at these distances take their bits from different words, halves of words or counters, or
  // are in different registers or rows.
  for (std::size_t const apart : {1, 2, 8, 16, 32, 64, 128, 77, 77 * 31})
    expect_independent(after, after, apart);
}

/// Expects sites computed one by one, as on devices, to turn as in packs.
template <class Real, class Turns, class Numbers>
void expect_turns_of_packs(Turns const& turns, Numbers const& numbers) {
  using Spins = SpinField<Real, Kokkos::HostSpace>;
  using Kernel = detail::TurnAtRandom<Real, Turns, Numbers>;
  auto const lattice = Lattice::cubic(77, 5, 3);
  auto const start = random_directions(lattice.sites(), 3);
  auto const packs = spins_of<Spins>(lattice, start), sites = spins_of<Spins>(lattice, start);
  auto const on = [&](Spins const& spins) {
    return Kernel{spins.array(), spins.output(false), numbers, turns, true, true};
  };
  Kokkos::DefaultHostExecutionSpace const exec;
  detail::for_each_site<Real>(exec, "packs", packs.layout(), on(packs));
  using Index = std::int32_t;
  detail::DeviceTiles const tiles(77, sites.layout().all());
  detail::TileLoop<Index, detail::OnDeviceSite<Real, Kernel>> const loop{
      {on(sites)}, detail::DeviceLayout<Index>(sites.layout()), tiles};
  for (Index thread = 0; thread < tiles.thread_count(); ++thread) loop(thread);
  exec.fence();
  EXPECT_EQ(numbers_of(sites), numbers_of(packs));
  EXPECT_NE(numbers_of(sites), start);
}

TYPED_TEST(ThermalTurns, OfSitesOneByOneAreThoseOfPacks) {
  using Turn = detail::OneTurn<TypeParam, true>;
  using Numbers = detail::NumbersOfSites<true>;
  Turn const turn{detail::RandomTurn<TypeParam, true>(0.2)};
  constexpr std::uint64_t seed = 0x123456789abcdefULL, draw = 1ULL << 40U;
  expect_turns_of_packs<TypeParam>(
      turn, Numbers{{seed, draw}, 0, 0, 5, 3, Numbers::places_of_row(77), 0});
  expect_turns_of_packs<TypeParam>(turn, detail::NumbersOfColumns<true>{{seed, draw}, 16});
}

// Some processors look the cases up, others compute them.
TYPED_TEST(ThermalTurns, AreTheSameLookedUpAndComputed) {
  using Value = detail::Pack<TypeParam>;
  constexpr int lanes = detail::host_lanes<TypeParam>;
  using Bits = typename detail::RandomTurn<TypeParam, true>::Bits;
  detail::RandomTurn<TypeParam, true> const looked_up(0.2);
  detail::RandomTurn<TypeParam, false> const computed(0.2);
  for (Bits first = 0; first < 32; first += lanes) {
    Bits codes[std::size_t{lanes}];
    for (Bits lane = 0; lane < lanes; ++lane) codes[lane] = (first + lane) * 33;
    typename detail::LanesOf<Bits, lanes>::type numbers;
    std::memcpy(&numbers, codes, sizeof numbers);
    Vec3<Value> const m{Value(TypeParam(0.6)), Value(TypeParam(0)), Value(TypeParam(-0.8))};
    auto const a = looked_up.template turned<5>(numbers, m),
               b = computed.template turned<5>(numbers, m);
    EXPECT_TRUE(detail::holds_everywhere(a.x == b.x)) << first;
    EXPECT_TRUE(detail::holds_everywhere(a.y == b.y)) << first;
    EXPECT_TRUE(detail::holds_everywhere(a.z == b.z)) << first;
  }
}

}  // namespace
}  // namespace cayspin::test
