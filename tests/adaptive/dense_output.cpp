// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The order of dense output (the spins within a step), and the continuity of spins and their rates
// at both ends of the step. The spins form a coupled chain, in which the rotations of a step do not
// commute.
#include "../order/chain.hpp"
#include "../support/backends.hpp"
#include "../support/larger.hpp"

#include <cayspin/stepper/tableau_dormand_prince8.hpp>

using namespace cayspin;
using namespace cayspin::test;

namespace {

template <class Stepper>
class WithinAStep {
 public:
  explicit WithinAStep(double damping) : slab_(coupled_chain(damping)) {}

  /// Returns the spins at fraction s of the first step, which has the length dt.
  Spins at(double s, double dt) const {
    auto spins = chain_start();
    Stepper stepper(spins, {.tolerance = 1, .first_dt = dt, .min_dt = dt, .max_dt = dt});
    stepper.step(Space(), slab_.natural(), spins, 0, s * dt);
    EXPECT_EQ(stepper.accepted_steps(), 1);
    return spins;
  }

  /// Expects the error within a step to be of order dense_order + 1 in the step's length. Measured
  /// with the lengths `longest`, longest / 2 and longest / 4.
  void expect_order(char const* name, int dense_order, double longest, double tolerance) const {
    for (double const s : {0.35, 0.8}) {
      SCOPED_TRACE(s);
      expect_convergence(name, longest, std::array{1, 2, 4}, dense_order + 1, tolerance,
                         [&](int, double dt) {
                           auto const exact = run<Rkmk<Spins, tableau::DormandPrince8>>(
                               slab_.natural(), chain_start(), s * dt / 64, 64);
                           return largest_distance(at(s, dt), exact);
                         });
    }
  }

  /// Expects difference quotients of the dense output at both ends of a step to equal the rates of
  /// the spins there.
  void expect_joined(char const* name, double dt, double tolerance) const {
    double const near = 1e-5;
    auto const start = chain_start();
    auto const end = run<typename Stepper::Plain>(slab_.natural(), start, dt, 1);
    expect_below(std::string(name) + ", rate at the start",
                 apart(slopes(start, at(near, dt), near * dt), rates(start)), tolerance);
    expect_below(std::string(name) + ", rate at the end",
                 apart(slopes(at(1 - near, dt), end, near * dt), rates(end)), tolerance);
  }

 private:
  static std::vector<double> slopes(Spins const& from, Spins const& to, double time) {
    auto const first = copy_to_host(from);
    std::vector<double> slopes(first.size());
    auto const second = copy_to_host(to);
    for (std::size_t i = 0; i < first.size(); ++i) slopes[i] = (second[i] - first[i]) / time;
    return slopes;
  }
  std::vector<double> rates(Spins const& spins) const {
    Spins const generators("generators", spins.lattice());
    evaluate_generator(Space(), slab_.natural(), spins, 0, generators);
    Space().fence();
    auto const m = numbers_of(spins), a = numbers_of(generators);
    std::vector<double> rates;
    for (std::int64_t site = 0; site < spins.sites(); ++site) {
      auto const rate = cross(test::at(a, site), test::at(m, site));
      rates.insert(rates.end(), {rate.x, rate.y, rate.z});
    }
    return rates;
  }
  static double apart(std::vector<double> const& a, std::vector<double> const& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = larger(largest, std::abs(a[i] - b[i]));
    return largest;
  }

  Slab slab_;
};

template <class Tableau>
struct Lie : AdaptiveRkmk<Spins, Tableau> {
  using Plain = Rkmk<Spins, Tableau>;
  using AdaptiveRkmk<Spins, Tableau>::AdaptiveRkmk;
};
template <class Tableau>
struct OnTheSphere : AdaptiveProjected<Spins, Tableau> {
  using Plain = ProjectedRungeKutta<Spins, Tableau>;
  using AdaptiveProjected<Spins, Tableau>::AdaptiveProjected;
};

class DenseOutput : public ::testing::TestWithParam<double> {};

TEST_P(DenseOutput, HasItsOrder) {
  double const damping = GetParam(), longest = 0.06 / (1 + damping);
  using namespace tableau;
  WithinAStep<Lie<BogackiShampine3>>(damping).expect_order("3(2)", 3, longest, 0.12);
  WithinAStep<Lie<DormandPrince5>>(damping).expect_order("5(4)", 4, longest, 0.12);
  WithinAStep<Lie<Tsitouras5>>(damping).expect_order("Tsitouras", 4, longest, 0.12);
  WithinAStep<OnTheSphere<DormandPrince5>>(damping).expect_order("projected", 4, longest, 0.12);
}

TEST_P(DenseOutput, JoinsTheStepAtItsEnds) {
  double const damping = GetParam(), dt = 0.2;
  using namespace tableau;
  WithinAStep<Lie<BogackiShampine3>>(damping).expect_joined("3(2)", dt, 1e-3);
  WithinAStep<Lie<DormandPrince5>>(damping).expect_joined("5(4)", dt, 1e-3);
  WithinAStep<Lie<Tsitouras5>>(damping).expect_joined("Tsitouras", dt, 1e-3);
  WithinAStep<OnTheSphere<DormandPrince5>>(damping).expect_joined("projected", dt, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Damping, DenseOutput, ::testing::Values(0.05, 1.0));

}  // namespace
