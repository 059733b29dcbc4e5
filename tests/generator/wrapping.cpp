// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A user's generator around another one: Forwarding supplies everything that is done before
// kernels.
#include "../support/backends.hpp"

#include <cayspin/cayspin.hpp>

namespace cayspin::test {
namespace {

/// A generator with twice the A of another one.
template <class Inner>
class Doubled : public Forwarding<Doubled<Inner>, Inner> {
 public:
  explicit Doubled(Inner inner) : inner_(std::move(inner)) {}
  template <class Stencil>
  KOKKOS_FUNCTION auto operator()(Stencil const& stencil) const {
    return 2 * inner_(stencil);
  }
  template <class Make>
  auto with_parts(Make const& make) const {
    auto prepared = make(inner_);
    return Doubled<decltype(prepared)>(std::move(prepared));
  }
  template <class Test>
  bool all_parts(Test const& test) const {
    return test(inner_);
  }

 private:
  Inner inner_;
};

template <class Backend>
class Wrapping : public ::testing::Test {
 protected:
  using Spins = typename Backend::Spins;
  typename Backend::Exec exec;
  Lattice lattice = Lattice::square(13, 4);
  Spins spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 17));

  /// Expects a step with the doubled generator to equal a step of twice the length with the plain
  /// generator.
  template <class Field>
  void expect_doubled(Field const& field) const {
    LandauLifshitz const generator(field, 0.2);
    auto const before = numbers_of(spins);
    auto twice = spins_of<Spins>(lattice, before), once = spins_of<Spins>(lattice, before);
    LieEuler(twice).step(exec, Doubled(generator), twice, 0.75, 0.0625);
    LieEuler(once).step(exec, generator, once, 0.75, 0.125);
    exec.fence();
    EXPECT_EQ(numbers_of(twice), numbers_of(once));
    EXPECT_NE(numbers_of(once), before);
  }
};
TYPED_TEST_SUITE(Wrapping, Backends, BackendName);

TYPED_TEST(Wrapping, PreparesWhatItIsMadeOf) {
  this->expect_doubled(EffectiveField(Exchange(this->lattice, 1), Zeeman{{0, 1, 2}}));
  this->expect_doubled(EffectiveField(TimeDependentZeeman([](double t) {
    return Vec3<double>{t, 0, 1};
  })));
  this->expect_doubled(EffectiveField(HostField(this->spins, SlabDemagOnHost({1, 0, 0}))));
}

TYPED_TEST(Wrapping, SaysWhenItMayBePrepared) {
  auto const says = [&](auto const& field, bool stationary, bool by_time) {
    Doubled const generator(LandauLifshitz(field, 0.2));
    EXPECT_EQ(detail::is_stationary(generator, this->exec, this->spins), stationary);
    EXPECT_EQ(detail::needs_only_time(generator, this->exec, this->spins), by_time);
    EXPECT_EQ(detail::is_stationary(orthogonal(generator), this->exec, this->spins), stationary);
  };
  says(EffectiveField(Exchange(this->lattice, 1), Zeeman{{0, 1, 2}}), true, true);
  TimeDependentZeeman const turning([](double t) { return Vec3<double>{t, 0, 1}; });
  says(EffectiveField(Exchange(this->lattice, 1), turning), false, true);
  HostField const on_host(this->spins, SlabDemagOnHost({1, 0, 0}));
  says(EffectiveField(Zeeman{{0, 1, 2}}, on_host), false, false);
}

}  // namespace
}  // namespace cayspin::test
