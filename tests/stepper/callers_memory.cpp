// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// With any method, integrate() and minimize() return the spins in their original memory. Steppers
// that continue from there give results that are bitwise identical to those of single steps.
#include "../support/backends.hpp"
#include "every_stepper.hpp"

#include <cayspin/minimize.hpp>

#include <random>
#include <stdexcept>

namespace cayspin::test {
namespace {

template <class Real>
class CallersMemory : public ::testing::Test {
 protected:
  using Field = SpinField<Real, Kokkos::HostSpace>;
  Slab slab{.lattice = Lattice::square(9, 2),
            .exchange = 1,
            .anisotropy = 0.3,
            .axis = {1, 2, 3},
            .applied = {0.5, -0.7, 0.9},
            .damping = 0.2};
  Field start() const {
    return spins_of<Field>(slab.lattice, random_directions(slab.lattice.sites(), 5));
  }
};
TYPED_TEST_SUITE(CallersMemory, Precisions, PrecisionName);

/// Expects spins in their original memory, and that a handle copied at the start still refers to
/// them.
template <class Field>
class WhereTheyLie {
 public:
  explicit WhereTheyLie(Field const& spins) : copy_(spins), data_(spins.array().data) {}

  void expect_same(Field const& spins, std::string const& what) const {
    EXPECT_EQ(spins.array().data, data_) << what;
    EXPECT_EQ(copy_.array().data, data_) << what;
    EXPECT_EQ(copy_to_host(copy_), copy_to_host(spins)) << what;
  }

 private:
  Field copy_;
  typename Field::value_type const* data_;
};

TYPED_TEST(CallersMemory, IsWhereEveryIntegrationEnds) {
  using Field = typename TestFixture::Field;
  std::mt19937 engine(3);
  for_each_stepper<Field>([&](std::string const& name, auto const& make, Takes) {
    auto const generator = this->slab.natural();
    auto spins = this->start(), by_hand = this->start();
    WhereTheyLie const before(spins);
    auto stepper = make(spins), reference = make(by_hand);
    std::int64_t first = 0;
    double const dt = 0.03125;
    for (int piece = 0; piece < 5; ++piece) {
      std::int64_t const steps = engine() % 4;
      integrate(Host(), stepper, generator, spins, Times{0, dt, first + steps, first, true});
      for (std::int64_t n = first; n < first + steps; ++n)
        reference.step(Host(), generator, by_hand, static_cast<double>(n) * dt, dt);
      first += steps;
      auto const what = name + " after step " + std::to_string(first);
      EXPECT_EQ(copy_to_host(spins), copy_to_host(by_hand)) << what;
      before.expect_same(spins, what);
    }
    // A stepper of another kind moves these spins in between.
    Rkmk4 other(spins);
    integrate(Host(), other, generator, spins, Times{0, dt, 1});
    integrate(Host(), stepper, generator, spins, Times{0, dt, 3});
    before.expect_same(spins, name + " after another stepper");
  });
}

TYPED_TEST(CallersMemory, IsWhereAnIntegrationEndsThatThrows) {
  auto spins = this->start(), by_hand = this->start();
  auto const generator = this->slab.natural();
  WhereTheyLie const before(spins);
  LieEuler stepper(spins), reference(by_hand);
  auto const fail = [](auto const&, Step const& step, auto const&) {
    if (step.number == 3) throw std::runtime_error("an observer fails");
  };
  EXPECT_THROW(integrate(Host(), stepper, generator, spins, Times{0, 0.1, 9}, fail),
               std::runtime_error);
  for (int n = 0; n < 3; ++n) reference.step(Host(), generator, by_hand, 0.1 * n, 0.1);
  EXPECT_EQ(copy_to_host(spins), copy_to_host(by_hand));
  before.expect_same(spins, "after an exception");
}

TYPED_TEST(CallersMemory, IsWhereAMinimizationEnds) {
  using Field = typename TestFixture::Field;
  Minimizer<Field> minimizer(this->start());
  auto spins = this->start();
  WhereTheyLie const before(spins);
  for (int evaluations : {3, 4, 5, 6, 7, 1000}) {
    minimizer.minimize(Host(), this->slab.field(), spins,
                       {.torque = 1e-3, .evaluations = evaluations});
    before.expect_same(spins, std::to_string(evaluations) + " evaluations");
  }
}

// A copy of a stepper would share the original's fields, but not its other members.
TYPED_TEST(CallersMemory, SteppersAreMovedAndNotCopied) {
  using Field = typename TestFixture::Field;
  auto const like = this->start();
  for_each_stepper<Field>([&](std::string const& name, auto const& make, Takes) {
    using Stepper = decltype(make(like));
    static_assert(!std::is_copy_constructible_v<Stepper> && !std::is_copy_assignable_v<Stepper>);
    static_assert(std::is_move_constructible_v<Stepper> && std::is_move_assignable_v<Stepper>);
    EXPECT_FALSE(name.empty());
  });
}

}  // namespace
}  // namespace cayspin::test
