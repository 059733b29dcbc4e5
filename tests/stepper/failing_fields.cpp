// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A field that throws at any evaluation of a step leaves the spins unchanged.
#include "../support/backends.hpp"
#include "every_stepper.hpp"

#include <stdexcept>

namespace cayspin::test {
namespace {

/// H = 9 * m_z along z, computed by host code that throws after a number of calls.
struct FailingSolver {
  static constexpr int degree = 2;
  int* left;
  template <class Field>
  void operator()(Field const& spins, Field const& field, double) const {
    if ((*left)-- == 0) throw std::runtime_error("the solver fails");
    for (std::int64_t site = 0; site < spins.sites(); ++site)
      field.set(site, {0, 0, 9 * spins.get(site).z});
  }
};

template <class Real>
class FailingFields : public ::testing::Test {};
TYPED_TEST_SUITE(FailingFields, Precisions, PrecisionName);

TYPED_TEST(FailingFields, LeaveTheSpinsAsTheyWere) {
  using Field = SpinField<TypeParam, Kokkos::HostSpace>;
  auto const lattice = Lattice::chain(5);
  auto const fails_everywhere = [&](std::string const& name, auto const& make, double dt,
                                    auto const& check) {
    int left = 0;
    LandauLifshitz const generator(
        EffectiveField(HostField<Field, FailingSolver>(lattice, FailingSolver{&left}),
                       Exchange(lattice, 1)),
        0.1);
    for (int calls = 0; calls < 200; ++calls) {
      left = 1000000;
      auto spins = spins_of<Field>(lattice, random_directions(5, 3));
      auto stepper = make(spins);
      stepper.step(Host(), generator, spins, 0, dt / 64);
      auto const before = copy_to_host(spins);
      left = calls;
      try {
        stepper.step(Host(), generator, spins, dt / 64, dt);
        // The step ended before the call that fails.
        EXPECT_GT(calls, 0) << name << " does not call the solver";
        check(stepper);
        return;
      } catch (std::runtime_error const&) {
        EXPECT_EQ(copy_to_host(spins), before) << name << ", fails at call " << calls;
      }
    }
    ADD_FAILURE() << name << " does not end";
  };
  for_each_stepper<Field>([&](std::string const& name, auto const& make, Takes takes) {
    if (takes.nonlocal) fails_everywhere(name, make, 0.05, [](auto const&) {});
  });
  // This step is halved, and its second half fails, too.
  fails_everywhere(
      "StiffGauss2, halved", [](Field const& like) { return StiffGauss2(like); }, 0.6,
      [](auto const& stepper) { EXPECT_GT(stepper.halvings_done(), 0); });
}

}  // namespace
}  // namespace cayspin::test
