// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// On few spins, integrate() takes several steps in one launch; the results do not change.
#include "../support/backends.hpp"
#include "../support/mean_field.hpp"

#include <cayspin/cayspin.hpp>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace cayspin::test {
namespace {

/// Observer that stores the spins at steps 3, 10, 17, ... and at the last one.
template <class Spins>
struct Keep {
  std::vector<std::pair<std::int64_t, std::vector<double>>>* kept;

  bool due(Step const& step) const { return step.last || step.number % 7 == 3; }
  template <class Exec>
  void operator()(Exec const& exec, Step const& step, Spins const& spins) const {
    exec.fence();
    kept->emplace_back(step.number, numbers_of(spins));
  }
};

template <class Backend>
class Batches : public ::testing::Test {
 protected:
  using Spins = typename Backend::Spins;
  typename Backend::Exec exec;
  Lattice lattice = Lattice::square(13, 5);

  Spins start() const { return spins_of<Spins>(lattice, random_directions(lattice.sites(), 5)); }

  auto generator() const {
    return LandauLifshitz(
        EffectiveField{Exchange(lattice, 1), UniaxialAnisotropy(0.5, {0, 0.6, 0.8}),
                       Zeeman{{0.1, 0, 0.3}}},
        0.1);
  }

  // Compares a run by integrate() with steps taken one by one.
  template <class Stepper, class Generator>
  void expect_same(Generator const& generator, bool batches) {
    Times const times{0.25, 0.01, 60};
    auto spins = start();
    Stepper stepper(spins), by_hand(spins);
    EXPECT_EQ(stepper.takes_batches(exec, generator, spins), batches);
    std::vector<std::pair<std::int64_t, std::vector<double>>> kept, expected;
    auto const summary = integrate(exec, stepper, generator, spins, times, Keep<Spins>{&kept});
    EXPECT_EQ(summary.steps, 60);
    EXPECT_EQ(summary.evaluations, 60 * Stepper::evaluations);
    auto other = start();
    Keep<Spins> const keep{&expected};
    for (std::int64_t n = 0; n <= times.steps; ++n) {
      Step const now{n, times.at(n), times.dt, n == times.steps};
      if (keep.due(now)) keep(exec, now, other);
      if (!now.last) by_hand.step(exec, generator, other, now.time, times.dt);
    }
    EXPECT_EQ(kept, expected);
    EXPECT_EQ(kept.size(), 10u);
  }
};
TYPED_TEST_SUITE(Batches, Backends, BackendName);

TYPED_TEST(Batches, AreStepsToTheBit) {
  using Spins = typename TypeParam::Spins;
  this->template expect_same<LieEuler<Spins>>(this->generator(), true);
  this->template expect_same<LieHeun<Spins>>(orthogonal(this->generator()), true);
  this->template expect_same<Rkmk4<Spins>>(this->generator(), true);
}

// A device gives each team several small replicas or a larger one; the last team may have fewer.
TYPED_TEST(Batches, OfReplicasAreStepsToTheBit) {
  using Spins = typename TypeParam::Spins;
  auto const periodic = Boundary::periodic;
  for (auto const& one : {Lattice::chain(1).with_replicas(300), Lattice::chain(7).with_replicas(50),
                          Lattice::square(3, 4, 1, periodic).with_replicas(31),
                          Lattice::square(16, 12).with_replicas(5),
                          Lattice::cubic(5, 6, 7, 1, periodic).with_replicas(9),
                          Lattice::cubic(4, 3, 5).with_replicas(11), Lattice::chain(1000)}) {
    this->lattice = one;
    this->template expect_same<LieEuler<Spins>>(this->generator(), true);
    this->template expect_same<LieHeun<Spins>>(orthogonal(this->generator()), true);
    this->template expect_same<Rkmk4<Spins>>(this->generator(), true);
    this->template expect_same<ProjectedRk4<Spins>>(this->generator(), true);
    this->template expect_same<Compensated<LieHeun<Spins>>>(this->generator(), true);
    this->template expect_same<StereographicRungeKutta<Spins>>(this->generator(), true);
  }
}

// A device takes 1000 steps in a launch, and then the others.
TYPED_TEST(Batches, OfManyStepsAreStepsToTheBit) {
  using Spins = typename TypeParam::Spins;
  this->lattice = Lattice::chain(3);
  auto const generator = this->generator();
  auto spins = this->start(), other = this->start();
  LieHeun<Spins> stepper(spins), by_hand(other);
  stepper.batch(this->exec, generator, spins, 0, 0.01, 1003);
  for (int step = 0; step < 1003; ++step) by_hand.step(this->exec, generator, other, 0, 0.01);
  this->exec.fence();
  EXPECT_EQ(numbers_of(spins), numbers_of(other));
}

TYPED_TEST(Batches, AreNotTakenWhereTheGeneratorChanges) {
  using Spins = typename TypeParam::Spins;
  auto const turning = [](double t) { return Vec3<double>{std::cos(t), std::sin(t), 0}; };
  LandauLifshitz const generator(EffectiveField{TimeDependentZeeman(turning)}, 0.1);
  this->template expect_same<Rkmk4<Spins>>(generator, false);
  LandauLifshitz const by_mean(EffectiveField{MeanField(1)}, 0.1);
  this->template expect_same<LieEuler<Spins>>(by_mean, false);
}

// Runs as many threads as an H100: 33 times 8192.
struct LargeDevice {
  int concurrency() const { return 270'336; }
};

bool takes_in_teams(Lattice const& lattice) {
  return detail::ReplicaTeams::suit(LargeDevice(), RowLayout::of<double>(lattice));
}

TEST(ReplicaTeams, TakeSmallReplicas) {
  EXPECT_TRUE(takes_in_teams(Lattice::chain(1)));
  EXPECT_TRUE(takes_in_teams(Lattice::chain(1024)));
  EXPECT_FALSE(takes_in_teams(Lattice::chain(1025)));
  EXPECT_TRUE(takes_in_teams(Lattice::cubic(16, 16, 16).with_replicas(33)));
  EXPECT_FALSE(takes_in_teams(Lattice::cubic(16, 16, 16).with_replicas(32)));
  EXPECT_FALSE(takes_in_teams(Lattice::chain(4097).with_replicas(1000)));
}

TEST(ReplicaTeams, HaveOffsetsOf32Bits) {
  // A row of one site takes eight numbers, and one more plane has to fit.
  std::int64_t const most = (std::int64_t(1) << 28) - 2;
  EXPECT_TRUE(takes_in_teams(Lattice::chain(1).with_replicas(most)));
  EXPECT_FALSE(takes_in_teams(Lattice::chain(1).with_replicas(most + 1)));
}

TEST(ReplicaTeams, TakeFewStepsOfManySitesInALaunch) {
  auto const most_repeats = [](std::int64_t replicas) {
    auto const lattice = Lattice::chain(1024).with_replicas(replicas);
    return detail::ReplicaTeams::most_repeats(RowLayout::of<double>(lattice));
  };
  EXPECT_EQ(most_repeats(1), 1000);
  EXPECT_EQ(most_repeats(1 << 15), 32);
  EXPECT_EQ(most_repeats(1 << 20), 1);
  EXPECT_EQ(most_repeats((1 << 20) + 1), 1);
}

}  // namespace
}  // namespace cayspin::test
