// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A stepper restored from the checkpoint of another continues bitwise like the other, with equal
// counts, and a continued run is bitwise identical to a single run.
#include "../order/chain.hpp"

#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

using namespace cayspin;
using namespace cayspin::test;

namespace {

using isotropy::FiniteDifferenceBackward;

Slab const damped_chain = coupled_chain(0.2);

template <class Of>
Of made_like(typename Of::spins_type const& spins) {
  if constexpr (AdaptiveStepper<Of>)
    return Of(spins, StepOptions{.tolerance = 1e-4, .end = 20 * 0.05});
  else
    return Of(spins);
}

template <class Stepper>
class Checkpoints : public ::testing::Test {};
template <class Real>
using Field = SpinField<Real, Space::memory_space>;
using Kinds =
    ::testing::Types<LieAdamsBashforth2<Field<double>>, LieAdamsBashforth2<Field<float>>,
                     LieEuler<Field<double>, FiniteDifferenceBackward>,
                     Compensated<Rkmk4<Field<double>>>, Compensated<Rkmk4<Field<float>>>,
                     AdaptiveRkmk<Field<double>>, AdaptiveRkmk<Field<float>>,
                     AdaptiveStereographic<Field<double>, tableau::BogackiShampine3>,
                     AdaptiveProjected<Field<double>>, StiffGauss2<Field<double>>,
                     StiffGauss2<Field<float>>, StiffGauss4<Field<double>>,
                     AdaptiveStiffGauss2<Field<double>>, AdaptiveStiffGauss2<Field<float>>>;
TYPED_TEST_SUITE(Checkpoints, Kinds);

template <class Stepper>
std::tuple<std::int64_t, std::int64_t> counts(Stepper const& stepper) {
  if constexpr (AdaptiveStepper<Stepper>)
    return {stepper.accepted_steps(), stepper.rejected_steps()};
  else if constexpr (requires { stepper.evaluations_done(); })
    return {stepper.evaluations_done(), 0};
  else
    return {0, 0};
}

// The run is interrupted after various steps, among them the first ones of multistep methods, and
// at times within a step of adaptive ones.
TYPED_TEST(Checkpoints, GoOnAsTheRunWouldHave) {
  static_assert(remembers_steps<TypeParam>);
  using Spins = typename TypeParam::spins_type;
  constexpr std::int64_t steps = 20;
  auto const start = [] {
    Spins spins("spins", damped_chain.lattice);
    copy_from_host(copy_to_host(random_spins(damped_chain.lattice, 5)), spins);
    return spins;
  };
  auto const go = [](TypeParam& stepper, Spins& spins, std::int64_t from, std::int64_t to) {
    integrate(Space{}, stepper, damped_chain.natural(), spins, Times{0, 0.05, to, from, from > 0});
  };
  Spins in_one_piece = start();
  TypeParam uncut = made_like<TypeParam>(in_one_piece);
  go(uncut, in_one_piece, 0, steps);
  for (std::int64_t const cut : {1, 2, 3, 4, 7, 13}) {
    SCOPED_TRACE("cut after " + std::to_string(cut) + " steps");
    Spins whole = start();
    TypeParam first = made_like<TypeParam>(whole);
    go(first, whole, 0, cut);
    CheckpointInMemory checkpoint;
    serialize(first, checkpoint);
    checkpoint.close();
    Spins second = start();
    copy_from_host(copy_to_host(whole), second);
    TypeParam other = made_like<TypeParam>(second);
    // Takes steps of another run, whose memory in `other` the checkpoint replaces.
    Spins elsewhere = start();
    go(other, elsewhere, 0, 5);
    serialize(other, checkpoint);
    go(first, whole, cut, steps);
    go(other, second, cut, steps);
    EXPECT_EQ(copy_to_host(whole), copy_to_host(in_one_piece));
    EXPECT_EQ(copy_to_host(second), copy_to_host(whole));
    EXPECT_EQ(counts(other), counts(first));
  }
}

/// A checkpoint that changes the number stored under one name.
class Altered final : public Checkpoint {
 public:
  Altered(Checkpoint& right, std::string name, double value)
      : right_(right), name_(std::move(name)), value_(value) {}
  bool restores() const override { return true; }
  void number(std::string const& name, double& value) override {
    right_.number(name, value);
    if (name == name_) value = value_;
  }
  void field(std::string const& name, std::vector<double>& numbers) override {
    right_.field(name, numbers);
  }

 private:
  Checkpoint& right_;
  std::string name_;
  double value_;
};

template <class Make, class Generator>
void expect_counts_are_checked(Make const& make, Generator const& generator,
                               std::vector<std::string> const& names) {
  Field<double> spins = random_spins(damped_chain.lattice, 5);
  auto stepper = make(spins), other = make(spins);
  for (int n = 0; n < 5; ++n) stepper.step(Space{}, generator, spins, 0.05 * n, 0.05);
  CheckpointInMemory checkpoint;
  serialize(stepper, checkpoint);
  checkpoint.close();
  for (auto const& name : names)
    for (double const wrong : {1000.0, -1.0, 0.5, 1e300, std::nan("")}) {
      Altered altered(checkpoint, name, wrong);
      EXPECT_THROW(serialize(other, altered), std::invalid_argument) << name << ' ' << wrong;
    }
  serialize(other, checkpoint);
}

TEST(Checkpoint, CountsThatNoStepperHasAreRefused) {
  using Spins = Field<double>;
  auto const natural = damped_chain.natural();
  expect_counts_are_checked([](Spins const& like) { return StiffGauss2(like); }, natural,
                            {"known", "exchange_known"});
  expect_counts_are_checked([](Spins const& like) { return StiffGauss4(like); }, natural,
                            {"known"});
  SlowField const multirate(Spins("like", damped_chain.lattice), SlabDemag({1, 0, 0}, 0.4));
  LandauLifshitz const generator(EffectiveField(Exchange(damped_chain.lattice, 1), multirate), 0.2);
  expect_counts_are_checked(
      [&](Spins const& like) { return Multirate(like, Rkmk4<Spins>(like), multirate); }, generator,
      {"known"});
}

TEST(Checkpoint, HoldsNothingOfAnotherLattice) {
  using Stepper = LieAdamsBashforth2<Field<double>>;
  Field<double> const small("spins", Lattice::chain(4));
  Field<double> spins("spins", Lattice::chain(8));
  Stepper stepper(spins), other(small);
  stepper.step(Space{}, damped_chain.natural(), spins, 0, 0.1);
  CheckpointInMemory checkpoint;
  serialize(stepper, checkpoint);
  checkpoint.close();
  EXPECT_THROW(serialize(other, checkpoint), std::invalid_argument);
  // Two replicas of the same lattice need twice the numbers.
  Stepper two(Field<double>("spins", Lattice::chain(8).with_replicas(2)));
  EXPECT_THROW(serialize(two, checkpoint), std::invalid_argument);
  CheckpointInMemory empty;
  empty.close();
  EXPECT_THROW(serialize(stepper, empty), std::out_of_range);
}

}  // namespace
