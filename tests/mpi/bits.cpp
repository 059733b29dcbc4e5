// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A lattice divided among ranks gives results that are bitwise identical to those of a single rank:
// spins, sums and maxima, and the decisions of adaptive steps.
#include "../support/backends.hpp"
#include "../support/mean_field.hpp"
#include "divisions.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/observer/thermal_noise.hpp>

#include <cayspin_paper/series4.hpp>

#include <bit>
#include <cmath>
#include <string>

namespace cayspin::test {
namespace {

/// An equation with a rotating field.
struct Turning {
  static auto generator_on(Lattice const& lattice) {
    return LandauLifshitz(
        EffectiveField(Exchange(lattice, 0.4), UniaxialAnisotropy(0.3, {0.6, 0, 0.8}),
                       TimeDependentZeeman([](double t) {
                         return Vec3<double>{std::cos(t), std::sin(t), 0.3};
                       })),
        0.1);
  }
};
/// An equation with a field that does not depend on t.
struct Still {
  static auto generator_on(Lattice const& lattice) {
    return LandauLifshitz(
        EffectiveField(Exchange(lattice, 0.4), UniaxialAnisotropy(0.3, {0.6, 0, 0.8}),
                       Zeeman{{0.3, -0.2, 1}}),
        0.1);
  }
};
/// An equation with a field that needs all spins, on all ranks.
struct OfAllSpins {
  static auto generator_on(Lattice const& lattice) {
    return LandauLifshitz(EffectiveField(Exchange(lattice, 0.4), MeanField(0.7)), 0.1);
  }
};

template <class Backend>
class EqualBits : public ::testing::Test {
 protected:
  using Spins = typename Backend::Spins;
  using Real = typename Backend::Real;

  /// Expects runs on divided lattices, with ghosts of this depth, to be bitwise identical to runs
  /// on one rank. make(spins) returns a stepper; lattices for which it throws std::invalid_argument
  /// are skipped. `one_in`: 2 takes only every second lattice, and so on, for steppers that
  /// communicate often.
  template <class Motion = Turning, class Make>
  void expect_equal_bits(int depth, Make const& make, int steps = 3, std::size_t one_in = 1) {
    int compared = 0;
    auto const all = lattices();
    for (std::size_t number = 0; number < all.size(); number += one_in) {
      Lattice const& lattice = all[number];
      for (mpi::Division const& division : divisions(lattice, depth)) {
        auto const name = name_of(lattice, division);
        auto const numbers = random_directions(lattice.sites(), 7);
        auto whole = spins_of<Spins>(lattice, numbers);
        try {
          make(whole);
        } catch (std::invalid_argument const&) {
          continue;
        }
        auto const expected = run<Motion>(whole, make, steps);

        mpi::Domain const domain(MPI_COMM_WORLD, lattice, depth, division);
        auto part = spins_of<Spins>(domain.local(), numbers_of_part(domain.local(), numbers));
        auto const found = run<Motion>(part, make, steps);
        ASSERT_EQ(found.size(), expected.size()) << name;
        for (std::size_t i = 0; i < found.size(); ++i)
          ASSERT_EQ(std::bit_cast<std::uint64_t>(found[i]),
                    std::bit_cast<std::uint64_t>(expected[i]))
              << name << ", number " << i << ": " << found[i] << " and " << expected[i];
        ASSERT_NE(numbers_of(whole), numbers) << "nothing moved";
        ASSERT_EQ(numbers_of(part), numbers_of_part(domain.local(), numbers_of(whole))) << name;
        ++compared;
      }
    }
    EXPECT_GT(compared, 1);
  }

 private:
  // Returns the values of samples at the start and after each step, and the stepper's counts.
  template <class Motion, class Make>
  std::vector<double> run(Spins& spins, Make const& make, int steps) {
    auto const generator = Motion::generator_on(spins.lattice());
    auto stepper = make(spins);
    std::vector<double> numbers;
    auto const look = [&](auto const& exec, Step const& step, Spins const& now) {
      Sample const s = sample(exec, generator, step, now, generator);
      numbers.insert(numbers.end(),
                     {s.energy.value, s.energy.magnitude, s.magnetization.x, s.magnetization.y,
                      s.magnetization.z, s.norm_defect, s.largest_rate});
    };
    auto const summary = integrate(exec_, stepper, generator, spins, Times{0, 0.05, steps}, look);
    numbers.push_back(static_cast<double>(summary.evaluations));
    numbers.push_back(static_cast<double>(summary.own_steps));
    numbers.push_back(static_cast<double>(summary.rejected));
    return numbers;
  }

  typename Backend::Exec exec_;
};
/// Each precision once: sums and stages are tested on one rank elsewhere.
using HostAndDefault = ::testing::Types<Backend<float, Kokkos::DefaultHostExecutionSpace>,
                                        Backend<double, Kokkos::DefaultExecutionSpace>>;
TYPED_TEST_SUITE(EqualBits, HostAndDefault, BackendName);

TYPED_TEST(EqualBits, LieEuler) {
  this->expect_equal_bits(1, [](auto const& spins) { return LieEuler(spins); });
}

/// Returns the paths to test: sweeps run only on hosts.
template <class Exec>
std::vector<Path> paths() {
  if (detail::is_host_execution<Exec>) return {Path::pass, Path::sweep};
  return {Path::pass};
}

TYPED_TEST(EqualBits, Rkmk4InPassesAndSweeps) {
  using Spins = typename TypeParam::Spins;
  for (Path const path : paths<typename TypeParam::Exec>())
    this->expect_equal_bits(4, [&](Spins const& spins) {
      Rkmk4<Spins> stepper(spins);
      auto const& lattice = spins.lattice();
      bool const sweeps =
          lattice.boundary[1] == Boundary::open || lattice.shape[1] == 1 || lattice.shape[1] >= 4;
      stepper.use(sweeps ? path : Path::pass);
      return stepper;
    });
}

TYPED_TEST(EqualBits, CompensatedHeunWithGhostsToSpare) {
  using Spins = typename TypeParam::Spins;
  this->expect_equal_bits(3, [](Spins const& spins) { return Compensated<LieHeun<Spins>>(spins); });
}

TYPED_TEST(EqualBits, AdaptiveInPassesAndSweeps) {
  using Spins = typename TypeParam::Spins;
  StepOptions options;
  options.tolerance = 1e-3;
  options.end = 0.15;
  for (Path const path : paths<typename TypeParam::Exec>())
    this->expect_equal_bits(7, [&](Spins const& spins) {
      AdaptiveRkmk<Spins> stepper(spins, options);
      auto const& lattice = spins.lattice();
      bool const sweeps =
          lattice.boundary[1] == Boundary::open || lattice.shape[1] == 1 || lattice.shape[1] >= 7;
      stepper.use(sweeps ? path : Path::pass);
      return stepper;
    });
}

TYPED_TEST(EqualBits, StepsThatRemember) {
  using Spins = typename TypeParam::Spins;
  this->expect_equal_bits(2, [](Spins const& spins) { return LieAdamsBashforth2(spins); });
}

TYPED_TEST(EqualBits, CorrectedEuler) {
  using Spins = typename TypeParam::Spins;
  this->expect_equal_bits(
      2, [](Spins const& spins) { return LieEuler<Spins, isotropy::FiniteDifference>(spins); });
}

TYPED_TEST(EqualBits, Implicit) {
  using Spins = typename TypeParam::Spins;
  this->expect_equal_bits(
      1, [](Spins const& spins) { return ImplicitMidpoint<Spins>(spins); }, 2, 2);
  // Newton's method without fixed-point iterations before it.
  ImplicitOptions options;
  options.fixed_point = 0;
  this->expect_equal_bits(
      1, [&](Spins const& spins) { return ImplicitMidpoint<Spins>(spins, options); }, 1, 4);
}

TYPED_TEST(EqualBits, RedBlackAndSeries) {
  using Spins = typename TypeParam::Spins;
  this->template expect_equal_bits<Still>(
      1, [](Spins const& spins) { return RedBlack2<Spins>(spins); });
  this->template expect_equal_bits<Still>(4,
                                          [](Spins const& spins) { return Series4<Spins>(spins); });
}

TYPED_TEST(EqualBits, FieldOfAllSpins) {
  using Spins = typename TypeParam::Spins;
  // On devices, sums depend on the division.
  if constexpr (std::is_same_v<typename Spins::memory_space, Kokkos::HostSpace>) {
    this->template expect_equal_bits<OfAllSpins>(
        2, [](Spins const& spins) { return LieHeun<Spins>(spins); });
    this->template expect_equal_bits<OfAllSpins>(
        4, [](Spins const& spins) { return Rkmk4<Spins>(spins); });
    this->template expect_equal_bits<OfAllSpins>(
        1, [](Spins const& spins) { return ImplicitMidpoint<Spins>(spins); }, 2, 2);
  }
}

// The noise of a site, also of a ghost, depends on its place in the whole lattice.
TYPED_TEST(EqualBits, ThermalNoise) {
  using Spins = typename TypeParam::Spins;
  typename TypeParam::Exec const exec;
  auto const run = [&](Spins& spins, double temperature) {
    auto const generator = Still::generator_on(spins.lattice());
    ThermalNoise<Spins> const noise(spins, 0.1, {.temperature = temperature, .seed = 3});
    LieHeun<Spins> stepper(spins);
    Times const times{0, 0.05, 4};
    integrate(exec, stepper, generator, spins, times, noise.after_steps(times),
              noise.before_steps());
    return numbers_of(spins);
  };
  int compared = 0;
  for (Lattice const& lattice : lattices()) {
    auto const numbers = random_directions(lattice.sites(), 7);
    auto whole = spins_of<Spins>(lattice, numbers), cold = spins_of<Spins>(lattice, numbers);
    auto const expected = run(whole, 0.5);
    EXPECT_NE(expected, run(cold, 0)) << "no noise";
    for (mpi::Division const& division : divisions(lattice, 2)) {
      mpi::Domain const domain(MPI_COMM_WORLD, lattice, 2, division);
      auto part = spins_of<Spins>(domain.local(), numbers_of_part(domain.local(), numbers));
      EXPECT_EQ(run(part, 0.5), numbers_of_part(domain.local(), expected))
          << name_of(lattice, division);
      ++compared;
    }
  }
  EXPECT_GT(compared, 1);
}

}  // namespace
}  // namespace cayspin::test
