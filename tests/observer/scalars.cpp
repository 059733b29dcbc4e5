// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Sums and maxima over sites against plain loops, and NaN detected at every site.
#include "../support/backends.hpp"
#include "../support/larger.hpp"

#include <cayspin/cayspin.hpp>

#include <limits>

namespace cayspin::test {
namespace {

template <class Backend>
using Scalars = OnBackend<Backend>;
TYPED_TEST_SUITE(Scalars, Backends, BackendName);

// Returns spins with lengths from 0.5 to 1.5 and components of both signs.
std::vector<double> uneven(Lattice const& lattice, unsigned seed) {
  auto numbers = random_directions(lattice.sites(), seed);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] *= 0.5 + static_cast<double>(i / 3 % 11) / 10;
  return numbers;
}

TYPED_TEST(Scalars, AgainstPlainLoops) {
  using Spins = typename TypeParam::Spins;
  for (auto const& lattice :
       {Lattice::chain(1), Lattice::chain(7), Lattice::chain(16), Lattice::cubic(17, 3, 2),
        Lattice::square(33, 5), Lattice::chain(12345), Lattice::square(9000, 2)}) {
    auto const spins = spins_of<Spins>(lattice, uneven(lattice, 17));
    auto const m = numbers_of(spins);
    Vec3<double> const applied{0.3, -0.4, 1.2};
    Vec3<double> sum{0, 0, 0};
    double defect = 0, rate = 0;
    for (std::int64_t site = 0; site < lattice.sites(); ++site) {
      auto const spin = at(m, site), torque = cross(applied, spin);
      sum = sum + spin;
      defect = larger(defect, std::abs(std::sqrt(dot(spin, spin)) - 1));
      rate = larger(rate, std::sqrt(dot(torque, torque)));
    }
    auto const sites = static_cast<double>(lattice.sites());
    expect_near(magnetization(this->exec, spins), (1 / sites) * sum, 1e-14);
    EXPECT_NEAR(norm_defect(this->exec, spins), defect, 1e-15);
    LandauLifshitz const generator(EffectiveField(Zeeman{applied}), 0);
    EXPECT_NEAR(largest_rate(this->exec, generator, spins), rate, 1e-14);
    EXPECT_NEAR(energy(this->exec, generator, spins).value, -dot(sum, applied), 1e-14 * sites);
  }
}

// One pass gives the results of separate passes, over one block of rows and over many.
TYPED_TEST(Scalars, ASampleIsAllOfThem) {
  using Spins = typename TypeParam::Spins;
  for (auto const& lattice : {Lattice::chain(5), Lattice::cubic(37, 29, 23)}) {
    auto const spins = spins_of<Spins>(lattice, uneven(lattice, 29));
    EffectiveField const field(Exchange(lattice, 0.8), Zeeman{{0.3, -0.4, 1.2}});
    LandauLifshitz const generator(field, 0.2);
    Sample const seen = sample(this->exec, field, {7, 3.5, 0.5, false}, spins, generator);
    EXPECT_EQ(seen.step, 7);
    EXPECT_EQ(seen.time, 3.5);
    auto const total = energy(this->exec, field, spins);
    EXPECT_DOUBLE_EQ(seen.energy.value, total.value);
    EXPECT_DOUBLE_EQ(seen.energy.magnitude, total.magnitude);
    EXPECT_EQ(seen.norm_defect, norm_defect(this->exec, spins));
    EXPECT_EQ(seen.largest_rate, largest_rate(this->exec, generator, spins));
    auto const mean = magnetization(this->exec, spins);
    EXPECT_DOUBLE_EQ(seen.magnetization.x, mean.x);
    EXPECT_DOUBLE_EQ(seen.magnetization.y, mean.y);
    EXPECT_DOUBLE_EQ(seen.magnetization.z, mean.z);
    EXPECT_EQ(sample(this->exec, field, {}, spins).energy.value, seen.energy.value);
  }
}

TYPED_TEST(Scalars, AFieldAtRest) {
  typename TypeParam::Spins const spins("spins", Lattice::square(13, 2));
  LandauLifshitz const generator(EffectiveField(Zeeman{{0, 0, 2}}), 0.5);
  EXPECT_EQ(norm_defect(this->exec, spins), 0);
  EXPECT_EQ(largest_rate(this->exec, generator, spins), 0);
  EXPECT_EQ(magnetization(this->exec, spins).z, 1);
}

// One spin off the sphere, at each site in turn: the maximum is found in any lane, and the padding
// of a row does not count.
TYPED_TEST(Scalars, TheLargestDefectIsFoundAtEverySite) {
  auto const lattice = Lattice::square(19, 2);
  typename TypeParam::Spins const spins("spins", lattice);
  for (std::int64_t site = 0; site < lattice.sites(); ++site) {
    std::vector<double> m;
    for (std::int64_t i = 0; i < lattice.sites(); ++i)
      m.insert(m.end(), {0.0, 0.0, i == site ? 0.75 : 1.0});
    copy_from_host(m, spins);
    EXPECT_EQ(norm_defect(this->exec, spins), 0.25) << site;
    EXPECT_NEAR(magnetization(this->exec, spins).z, 1 - 0.25 / 38, 1e-15) << site;
  }
}

TYPED_TEST(Scalars, NumbersThatAreNoneAreFoundAtEverySite) {
  auto const lattice = Lattice::square(19, 2);
  auto const m = random_directions(lattice.sites(), 23);
  typename TypeParam::Spins const spins("spins", lattice);
  LandauLifshitz const generator(EffectiveField(Zeeman{{0.1, 0.2, 0.3}}), 0.5);
  for (std::int64_t site = 0; site < lattice.sites(); ++site)
    for (int c = 0; c < 3; ++c) {
      auto wrong = m;
      wrong[3 * site + c] = std::numeric_limits<double>::quiet_NaN();
      copy_from_host(wrong, spins);
      EXPECT_TRUE(std::isnan(norm_defect(this->exec, spins))) << site;
      EXPECT_TRUE(std::isnan(largest_rate(this->exec, generator, spins))) << site;
      EXPECT_TRUE(std::isnan(energy(this->exec, generator, spins).value)) << site;
      // Infinity is larger than all others, but NaN must take precedence.
      wrong[3 * site + c] = -std::numeric_limits<double>::infinity();
      copy_from_host(wrong, spins);
      EXPECT_EQ(norm_defect(this->exec, spins), std::numeric_limits<double>::infinity()) << site;
      wrong[(3 * site + 60) % wrong.size()] = std::numeric_limits<double>::quiet_NaN();
      copy_from_host(wrong, spins);
      EXPECT_TRUE(std::isnan(norm_defect(this->exec, spins))) << site;
    }
}

}  // namespace
}  // namespace cayspin::test
