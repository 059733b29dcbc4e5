// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A user's generator around another one: Forwarding supplies everything that is done before
// kernels.
#include "../support/backends.hpp"

#include <cayspin/cayspin.hpp>

#include <cmath>
#include <type_traits>

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

/// A generator around another one, without Forwarding and without needs_only_time.
template <class Inner>
struct Plain {
  Inner inner;
  static constexpr bool depends_on_time = Inner::depends_on_time;

  template <class Exec, class Spins>
  bool is_stationary(Exec const& exec, Spins const& spins) const {
    return inner.is_stationary(exec, spins);
  }
  template <class Exec, class Spins>
  auto prepare(Exec const& exec, Spins const& spins, double t) const {
    auto ready = inner.prepare(exec, spins, t);
    return Plain<decltype(ready)>{ready};
  }
  template <class Stencil>
  KOKKOS_FUNCTION auto operator()(Stencil const& stencil) const {
    return inner(stencil);
  }
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

// One part of the field depends only on time, and the other on the spins of each stage.
TYPED_TEST(Wrapping, WithoutForwardingHasTheFieldOfEachStage) {
  using Spins = typename TestFixture::Spins;
  HostField const on_host(this->spins, SlabDemagOnHost({1, 0, 0}));
  TimeDependentZeeman const turning([](double t) {
    return Vec3<double>{std::cos(t), std::sin(t), 0.5};
  });
  LandauLifshitz const inner(EffectiveField(on_host, turning), 0.2);
  Plain<std::remove_const_t<decltype(inner)>> const plain{inner};
  EXPECT_FALSE(detail::needs_only_time(plain, this->exec, this->spins));
  auto const after = [&](auto const& generator, auto make_stepper) {
    auto spins = spins_of<Spins>(this->lattice, numbers_of(this->spins));
    auto stepper = make_stepper(spins);
    integrate(this->exec, stepper, generator, spins, {0, 0.25, 4});
    this->exec.fence();
    return numbers_of(spins);
  };
  auto const adaptive = [](Spins const& like) {
    return AdaptiveRkmk<Spins, tableau::Tsitouras5>(like, {.tolerance = 1e-3});
  };
  auto const fixed = [](Spins const& like) { return Rkmk4<Spins>(like); };
  EXPECT_EQ(after(plain, adaptive), after(inner, adaptive));
  EXPECT_EQ(after(plain, fixed), after(inner, fixed));
}

}  // namespace
}  // namespace cayspin::test
