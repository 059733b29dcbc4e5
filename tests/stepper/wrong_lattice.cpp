// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Spins of another lattice than the stepper's are refused in every call, before they are touched.
#include "../support/backends.hpp"

#include <cayspin/cayspin.hpp>

#include <cayspin_paper/rkmk4_as_printed.hpp>

#include <stdexcept>
#include <string>

namespace cayspin::test {
namespace {

template <class Real>
using HostSpins = SpinField<Real, Kokkos::HostSpace>;
using HostSpace = Kokkos::DefaultHostExecutionSpace;

template <class Real>
class WrongLattice : public ::testing::Test {
 protected:
  using Spins = HostSpins<Real>;
  LandauLifshitz<EffectiveField<Zeeman>> generator_{EffectiveField(Zeeman{{1, 0, 0}}), 0.1};
  LandauLifshitz<EffectiveField<Zeeman>> undamped_{EffectiveField(Zeeman{{1, 0, 0}}), 0.0};
  Spins like_{"like", Lattice::chain(20)};

  template <class Call>
  void expect_refused(char const* name, Spins& spins, Call const& call) {
    auto const before = copy_to_host(spins);
    try {
      call(spins);
      ADD_FAILURE() << name << " took spins of " << spins.sites() << " sites";
    } catch (std::invalid_argument const& error) {
      EXPECT_NE(std::string(error.what()).find("lattice"), std::string::npos) << error.what();
    }
    EXPECT_EQ(copy_to_host(spins), before) << name;
  }

  template <class Stepper, class Generator>
  void expect_step_refused(char const* name, Stepper&& stepper, Generator const& generator) {
    for (auto const sites : {19, 21, 200}) {
      Spins spins("spins", Lattice::chain(sites));
      expect_refused(name, spins, [&](Spins& of_others) {
        stepper.step(HostSpace(), generator, of_others, 0, 0.1);
      });
      expect_refused(name, spins, [&](Spins& of_others) {
        integrate(HostSpace(), stepper, generator, of_others, {.begin = 0, .dt = 0.1, .steps = 5});
      });
      if constexpr (requires { stepper.batch(HostSpace(), generator, spins, 0, 0.1, 2); })
        expect_refused(name, spins, [&](Spins& of_others) {
          stepper.batch(HostSpace(), generator, of_others, 0, 0.1, 2);
        });
      if constexpr (requires { stepper.remember(HostSpace(), generator, spins, 0, 0.1); })
        expect_refused(name, spins, [&](Spins& of_others) {
          stepper.remember(HostSpace(), generator, of_others, 0, 0.1);
        });
    }
  }
};
TYPED_TEST_SUITE(WrongLattice, Precisions, PrecisionName);

TYPED_TEST(WrongLattice, IsRefusedBySteppersOfBothPrecisions) {
  using S = HostSpins<TypeParam>;
  this->expect_step_refused("Rkmk4", Rkmk4<S>(this->like_), this->generator_);
  this->expect_step_refused("LieAdamsBashforth2", LieAdamsBashforth2<S>(this->like_),
                            this->generator_);
}

using WrongLatticeInDouble = WrongLattice<double>;

TEST_F(WrongLatticeInDouble, IsRefusedByEveryOtherStepper) {
  using S = HostSpins<double>;
  auto const expect = [&](char const* name, auto&& stepper) {
    expect_step_refused(name, stepper, generator_);
  };
  expect("LieEuler", LieEuler<S>(like_));
  expect("LieEuler, Analytic", LieEuler<S, isotropy::Analytic>(like_));
  expect("Compensated", Compensated<LieHeun<S>>(like_));
  expect("ProjectedHeun", ProjectedHeun<S>(like_));
  expect("ImplicitMidpoint", ImplicitMidpoint<S>(like_));
  expect("FieldExtrapolation3", FieldExtrapolation3<S>(like_));
  expect("RedBlack2", RedBlack2<S>(like_));
  expect("AdaptiveRkmk", AdaptiveRkmk<S, tableau::BogackiShampine3>(like_, {.tolerance = 1e-4}));
  expect("Rkmk4AsPrinted", Rkmk4AsPrinted<S>(like_));
  expect_step_refused("Series4", Series4<S>(like_), undamped_);
  expect_step_refused("EnergyProjection", EnergyProjection<LieHeun<S>>(like_, LieHeun<S>(like_)),
                      undamped_);
}

// Steps that batch does not take would be read from memory that a sweep does not have.
TYPED_TEST(WrongLattice, BatchesOfSweepsAreRefused) {
  using S = HostSpins<TypeParam>;
  S spins("spins", Lattice::cubic(8, 8, 8));
  Rkmk4 stepper(spins);
  stepper.use(Path::sweep);
  EXPECT_THROW(stepper.batch(HostSpace(), this->generator_, spins, 0, 0.1, 2),
               std::invalid_argument);
}

}  // namespace
}  // namespace cayspin::test
