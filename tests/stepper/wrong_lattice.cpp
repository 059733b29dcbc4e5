// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Spins of another lattice than the stepper's are refused in every call, before they are touched.
// tests/wrong_calls/steppers.cpp has steppers of every kind; here are both precisions.
#include "../support/backends.hpp"
#include "../support/wrong_call.hpp"

#include <cayspin/cayspin.hpp>

namespace cayspin::test {
namespace {

template <class Real>
class WrongLattice : public ::testing::Test {
 protected:
  using Spins = SpinField<Real, Kokkos::HostSpace>;
  Kokkos::DefaultHostExecutionSpace const exec_;
  LandauLifshitz<EffectiveField<Zeeman>> const generator_{EffectiveField(Zeeman{{1, 0, 0}}), 0.1};
  Spins const like_{"like", Lattice::chain(20)};
};
TYPED_TEST_SUITE(WrongLattice, Precisions, PrecisionName);

TYPED_TEST(WrongLattice, IsRefusedInEveryCall) {
  auto const& exec = this->exec_;
  auto const& generator = this->generator_;
  Rkmk4 rkmk4(this->like_);
  LieAdamsBashforth2 ab2(this->like_);
  for (auto const sites : {19, 21, 200}) {
    SCOPED_TRACE(sites);
    typename TestFixture::Spins spins("spins", Lattice::chain(sites));
    auto const before = copy_to_host(spins);
    Times const times{.begin = 0, .dt = 0.1, .steps = 5};
    expect_refused({
        {"Rkmk4, step", [&] { rkmk4.step(exec, generator, spins, 0, 0.1); }},
        {"Rkmk4, integrate", [&] { integrate(exec, rkmk4, generator, spins, times); }},
        {"Rkmk4, batch", [&] { rkmk4.batch(exec, generator, spins, 0, 0.1, 2); }},
        {"ab2, step", [&] { ab2.step(exec, generator, spins, 0, 0.1); }},
        {"ab2, integrate", [&] { integrate(exec, ab2, generator, spins, times); }},
        {"ab2, remember", [&] { ab2.remember(exec, generator, spins, 0, 0.1); }},
    });
    EXPECT_EQ(copy_to_host(spins), before);
  }
}

// Steps that batch does not take would be read from memory that a sweep does not have.
TYPED_TEST(WrongLattice, BatchesOfSweepsAreRefused) {
  typename TestFixture::Spins spins("spins", Lattice::cubic(8, 8, 8));
  Rkmk4 stepper(spins);
  stepper.use(Path::sweep);
  EXPECT_THROW(stepper.batch(this->exec_, this->generator_, spins, 0, 0.1, 2),
               std::invalid_argument);
}

}  // namespace
}  // namespace cayspin::test
