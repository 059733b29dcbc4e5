// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Compares the evaluations that integrate() counts with those that fields count.
#include "../support/backends.hpp"
#include "every_stepper.hpp"

namespace cayspin::test {
namespace {

/// H = m_z / 2 along z, computed by host code that counts its calls.
struct CountingSolver {
  static constexpr int degree = 2;
  std::int64_t* calls;
  template <class Field>
  void operator()(Field const& spins, Field const& field, double) const {
    ++*calls;
    for (std::int64_t site = 0; site < spins.sites(); ++site)
      field.set(site, {0, 0, spins.get(site).z / 2});
  }
};

/// A term that kernels evaluate. It counts the calls, one for each pack.
struct CountingTerm {
  static constexpr int degree = 2;
  std::int64_t* calls;
  template <class Stencil>
  VectorOf<Stencil> field(Stencil const& stencil) const {
    ++*calls;
    using Value = typename Stencil::value_type;
    return {Value(0), Value(0), Value(Value(0.5) * stencil.center().z)};
  }
  template <class Stencil>
  ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return Value(-0.25) * stencil.center().z * stencil.center().z;
  }
};

template <class Real>
class Counts : public ::testing::Test {
 protected:
  using Field = SpinField<Real, Kokkos::HostSpace>;
  Lattice lattice = Lattice::chain(2);

  /// `evaluations` returns the number of evaluations that the field has counted so far.
  template <class Make, class Generator, class Calls>
  void expect_counted(std::string const& what, Make const& make, Generator const& generator,
                      Calls const& evaluations) {
    auto spins = spins_of<Field>(lattice, random_directions(lattice.sites(), 5));
    auto stepper = make(spins);
    std::int64_t first = 0;
    for (std::int64_t const steps : {0, 1, 2, 10}) {
      std::int64_t const before = evaluations();
      auto const summary = integrate(Host(), stepper, generator, spins,
                                     Times{0, 0.05, first + steps, first, first > 1});
      EXPECT_EQ(summary.evaluations, evaluations() - before) << what << ", steps " << steps;
      first += steps;
    }
  }
};
TYPED_TEST_SUITE(Counts, Precisions, PrecisionName);

TYPED_TEST(Counts, AreCallsOfANonlocalField) {
  using Field = typename TestFixture::Field;
  for_each_stepper<Field>([&](std::string const& name, auto const& make, Takes takes) {
    if (!takes.nonlocal) return;
    std::int64_t calls = 0;
    auto const all = [&] { return calls; };
    HostField<Field, CountingSolver> const nonlocal(this->lattice, CountingSolver{&calls});
    this->expect_counted(
        name, make, LandauLifshitz(EffectiveField(nonlocal, Exchange(this->lattice, 1)), 0.1), all);
  });
}

TYPED_TEST(Counts, AreCallsOfATermInKernels) {
  using Field = typename TestFixture::Field;
  for_each_stepper<Field>([&](std::string const& name, auto const& make, Takes takes) {
    if (!takes.counts_fields) return;
    std::int64_t calls = 0;
    LandauLifshitz const generator(EffectiveField(CountingTerm{&calls}, Zeeman{{0, 1, 0}}), 0.1);
    Field const spins("spins", this->lattice), output("output", this->lattice);
    evaluate_generator(Host(), generator, spins, 0, output);
    std::int64_t const each = calls;
    this->expect_counted(name, make, generator, [&] { return calls / each; });
  });
}

}  // namespace
}  // namespace cayspin::test
