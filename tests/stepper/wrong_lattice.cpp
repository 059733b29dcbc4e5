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

TYPED_TEST(WrongLattice, IsRefusedByEveryStepper) {
  using S = HostSpins<TypeParam>;
  auto const& like = this->like_;
  auto const expect = [&](char const* name, auto&& stepper) {
    this->expect_step_refused(name, stepper, this->generator_);
  };
  expect("LieEuler", LieEuler<S>(like));
  expect("LieEuler, Analytic", LieEuler<S, isotropy::Analytic>(like));
  expect("LieEuler, FiniteDifference", LieEuler<S, isotropy::FiniteDifference>(like));
  expect("LieEuler, backward", LieEuler<S, isotropy::FiniteDifferenceBackward>(like));
  expect("LieHeun", LieHeun<S>(like));
  expect("Rkmk4", Rkmk4<S>(like));
  expect("StereographicRungeKutta", StereographicRungeKutta<S>(like));
  expect("CommutatorFree4", CommutatorFree4<S>(like));
  expect("Compensated", Compensated<Rkmk4<S>>(like));
  expect("ProjectedRk4", ProjectedRk4<S>(like));
  expect("LieAdamsBashforth2", LieAdamsBashforth2<S>(like));
  expect("ImplicitLieEuler", ImplicitLieEuler<S>(like));
  expect("ImplicitMidpoint", ImplicitMidpoint<S>(like));
  expect("FieldExtrapolation4", FieldExtrapolation4<S>(like));
  expect("RedBlack2", RedBlack2<S>(like));
  expect("AdaptiveRkmk", AdaptiveRkmk(like, {.tolerance = 1e-4}));
  expect("Rkmk4AsPrinted", Rkmk4AsPrinted<S>(like));
  this->expect_step_refused("Series4", Series4<S>(like), this->undamped_);
  this->expect_step_refused("EnergyProjection", EnergyProjection<LieHeun<S>>(like, LieHeun<S>(like)),
                            this->undamped_);
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
