// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Each replica of a lattice is bitwise identical to a separate run, whatever the term, the method,
// the shape and the boundaries, also with noise.
#include "../support/backends.hpp"
#include "../support/coefficients.hpp"
#include "../support/wrong_call.hpp"

#include <cayspin/cayspin.hpp>
#include <cayspin/replicas.hpp>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace cayspin::test {
namespace {

using enum Boundary;
constexpr std::int64_t replicas = 5;

std::vector<Lattice> lattices_of_replicas() {
  Crystal const two_sites{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {{0, 0, 0}, {0.5, 0.5, 0.5}}};
  return {Lattice::chain(1),
          Lattice::chain(23),
          Lattice::chain(64, 1, periodic),
          Lattice::square(9, 6),
          Lattice::square(17, 14, 0.5, periodic),
          Lattice::cubic(5, 4, 3),
          Lattice::cubic(6, 14, 14, 1, periodic),
          {{7, 1, 4}, {1, 1, 1}, {open, open, periodic}},
          two_sites.lattice({6, 14, 14}, {periodic, periodic, periodic}),
          two_sites.lattice({5, 3, 2})};
}

std::string name_of(Lattice const& lattice) {
  auto const& [x, y, z] = lattice.shape;
  return std::to_string(x) + " x " + std::to_string(y) + " x " + std::to_string(z) +
         ", boundaries " + std::to_string(static_cast<int>(lattice.boundary[0])) +
         std::to_string(static_cast<int>(lattice.boundary[2])) + ", " +
         std::to_string(lattice.cell_sites) + " sites in a cell";
}

std::vector<double> numbers_of_replica(std::vector<double> const& all, std::int64_t replica) {
  auto const count = static_cast<std::ptrdiff_t>(all.size()) / replicas;
  return {all.begin() + replica * count, all.begin() + (replica + 1) * count};
}

// Fields that need neighbours along all axes or at a distance, have values per site, or depend on
// t.
struct Turning {
  template <class Spins>
  static auto generator(Lattice const& lattice) {
    return LandauLifshitz(
        EffectiveField(Exchange(lattice, 0.8), BulkDmi(lattice, 0.3),
                       UniaxialAnisotropy(0.4, {0, 0.6, 0.8}), TimeDependentZeeman([](double t) {
                         return Vec3<double>{0.1, std::sin(3 * t), 0.2};
                       })),
        0.2);
  }
};
struct InCurrent {
  template <class Spins>
  static auto generator(Lattice const& lattice) {
    return LandauLifshitz(
        EffectiveField(InterfacialDmi(lattice, 0.4), ZhangLi(lattice, {0.5, -0.2, 0.3}, 0.04)),
        0.1);
  }
};
struct Coupled {
  template <class Spins>
  static auto generator(Lattice const& lattice) {
    int const other = static_cast<int>(lattice.cell_sites) - 1;
    std::vector<Coupling> bonds{Coupling::of({0, other}, {1, 0, 0}, 1),
                                Coupling::of({0, other}, {0, 1, 0}, 0.5, {0.1, 0.2, 0.3}),
                                Coupling::of({0, 0}, {2, -1, 1}, -0.3),
                                Coupling::of({other, other}, {1, 0, -1}, 0.2)};
    if (other == 1) bonds.push_back(Coupling::of({0, 1}, {0, 0, 0}, 0.7));
    return LandauLifshitz(PairCouplings<typename Spins::memory_space>(lattice, bonds), 0.3);
  }
};
struct OfSites {
  template <class Spins>
  static auto generator(Lattice const& lattice) {
    auto one = lattice;
    one.replicas = 1;
    std::vector<double> constants;
    for (std::int64_t site = 0; site < one.sites(); ++site)
      constants.push_back(0.5 + 0.5 * std::sin(static_cast<double>(site)));
    ScalarField<typename Spins::value_type, typename Spins::memory_space> const field("constants",
                                                                                      lattice);
    copy_from_host(constants, field);  // the same for all replicas
    return LandauLifshitz(SiteDependentExchange(field), 0.1);
  }
};

template <class Backend>
class Replicas : public OnBackend<Backend> {
 protected:
  using Spins = typename Backend::Spins;
  static constexpr bool on_host = detail::is_host_execution<typename Backend::Exec>;

  template <class Terms, template <class> class Method>
  void expect_bits_of_own_runs(Path path = Path::pass) {
    for (Lattice const& one : lattices_of_replicas()) {
      SCOPED_TRACE(name_of(one));
      auto const all = one.with_replicas(replicas);
      auto const start = random_directions(all.sites(), 7);
      auto const run = [&](Lattice const& lattice, std::vector<double> const& from, bool sweeps) {
        auto spins = spins_of<Spins>(lattice, from);
        Method<Spins> stepper(spins);
        if constexpr (requires { stepper.use(path); }) {
          if (sweeps) stepper.use(Path::sweep);
        }
        integrate(this->exec, stepper, Terms::template generator<Spins>(lattice), spins,
                  Times{0, 0.05, 4});
        return numbers_of(spins);
      };
      bool const wraps = one.boundary[2] == periodic && one.shape[2] > 1;
      auto const together = run(all, start, path == Path::sweep && on_host && !wraps);
      if (one.sites() > 1) {
        ASSERT_NE(together, start);
      }
      for (std::int64_t r = 0; r < replicas; ++r)
        EXPECT_EQ(numbers_of_replica(together, r), run(one, numbers_of_replica(start, r), false))
            << "replica " << r;
    }
  }
};
TYPED_TEST_SUITE(Replicas, Backends, BackendName);

template <class Spins>
using SecondOrder = RedBlack<Spins, 2>;

TYPED_TEST(Replicas, MoveAsLatticesOfTheirOwn) {
  this->template expect_bits_of_own_runs<Turning, LieHeun>();
  this->template expect_bits_of_own_runs<Turning, Rkmk4>();
  this->template expect_bits_of_own_runs<InCurrent, Rkmk4>();
  this->template expect_bits_of_own_runs<Coupled, Rkmk4>();
  this->template expect_bits_of_own_runs<OfSites, Rkmk4>();
}

TYPED_TEST(Replicas, MoveAsLatticesOfTheirOwnInSweeps) {
  this->template expect_bits_of_own_runs<Turning, LieHeun>(Path::sweep);
  this->template expect_bits_of_own_runs<Turning, Rkmk4>(Path::sweep);
  this->template expect_bits_of_own_runs<Coupled, Rkmk4>(Path::sweep);
}

TYPED_TEST(Replicas, HaveNoiseOfTheirOwn) {
  using Spins = typename TypeParam::Spins;
  for (Lattice const& one : lattices_of_replicas()) {
    SCOPED_TRACE(name_of(one));
    std::vector<double> const factors{0.1, 1.5, 0, 1, 3};
    auto const cell = static_cast<std::size_t>(one.cell_sites);
    for (bool const of_replicas : {false, true}) {
      auto const run = [&](Lattice const& lattice, std::uint64_t seed, double temperature) {
        auto spins = spins_of<Spins>(
            lattice,
            std::vector<double>(static_cast<std::size_t>(3 * lattice.sites()), 1 / std::sqrt(3.0)));
        ThermalNoiseOptions options{.temperature = temperature, .seed = seed};
        if (cell > 1) options.cell_sites = {0.5, 2};
        if (of_replicas && lattice.replicas > 1) options.replicas = factors;
        // 0.1 * 0.5 * 0.3 times 1.5 differs in the last bit from 0.1 * (0.5 * 1.5) * 0.3.
        ThermalNoise<Spins> const noise(spins, 0.1, options);
        LieEuler<Spins> stepper(spins);
        Times const times{0, 0.3, 3};
        integrate(this->exec, stepper, Turning::generator<Spins>(lattice), spins, times,
                  noise.between_steps(times));
        return numbers_of(spins);
      };
      auto const together = run(one.with_replicas(replicas), 11, 0.5);
      for (std::int64_t r = 0; r < replicas; ++r) {
        auto const of_replica = numbers_of_replica(together, r);
        double const factor = of_replicas ? factors[static_cast<std::size_t>(r)] : 1;
        EXPECT_EQ(of_replica, run(one, 11 + static_cast<std::uint64_t>(r), 0.5 * factor)) << r;
        if (r > 0) {
          EXPECT_NE(of_replica, numbers_of_replica(together, 0));
        }
      }
    }
  }
}

TYPED_TEST(Replicas, MoveByColours) {
  using Spins = typename TypeParam::Spins;
  for (auto const& one : {Lattice::cubic(6, 4, 3), Lattice::cubic(6, 4, 2, 1, periodic)}) {
    auto const all = one.with_replicas(replicas);
    auto const start = random_directions(all.sites(), 9);
    auto const run = [&](Lattice const& lattice, std::vector<double> const& from) {
      auto spins = spins_of<Spins>(lattice, from);
      SecondOrder<Spins> stepper(spins);
      LandauLifshitz const generator(Exchange(lattice, 1), 0.1);
      integrate(this->exec, stepper, generator, spins, Times{0, 0.05, 4});
      return numbers_of(spins);
    };
    auto const together = run(all, start);
    for (std::int64_t r = 0; r < replicas; ++r)
      EXPECT_EQ(numbers_of_replica(together, r), run(one, numbers_of_replica(start, r)));
  }
}

TYPED_TEST(Replicas, AreCopiedOneByOne) {
  using Spins = typename TypeParam::Spins;
  auto const one = Lattice::cubic(19, 3, 2);
  auto const all = one.with_replicas(replicas);
  auto const numbers = random_directions(all.sites(), 3);
  auto const from = spins_of<Spins>(all, numbers);
  Spins const to("to", all), alone("alone", one);
  for (std::int64_t r = 0; r < replicas; ++r) {
    copy_replica(this->exec, from, r, alone);
    this->exec.fence();
    EXPECT_EQ(numbers_of(alone), numbers_of_replica(numbers_of(from), r));
    copy_to_replica(this->exec, alone, to, replicas - 1 - r);
  }
  this->exec.fence();
  for (std::int64_t r = 0; r < replicas; ++r)
    EXPECT_EQ(numbers_of_replica(numbers_of(to), replicas - 1 - r),
              numbers_of_replica(numbers_of(from), r));
  EXPECT_THROW(copy_replica(this->exec, from, replicas, alone), std::invalid_argument);
  EXPECT_EQ(refusal([&] { copy_replica(this->exec, from, 0, to); }),
            "cayspin::copy_replica's field of one replica: made for a lattice of 5 replicas, and "
            "the spins have 1");
  EXPECT_THROW(copy_replica(this->exec, Spins(), 0, Spins()), std::invalid_argument);
  EXPECT_THROW(copy_to_replica(this->exec, Spins(), Spins(), 0), std::invalid_argument);
}

TYPED_TEST(Replicas, AreRefusedWhereReplicasWouldSeeEachOther) {
  using Spins = typename TypeParam::Spins;
  auto const all = Lattice::square(8, 8).with_replicas(2);
  Spins const spins("spins", all);
  EXPECT_THROW(Minimizer<Spins>{spins}, std::invalid_argument);
  EXPECT_EQ(refusal([&] { StiffGauss2<Spins>{spins}; }),
            "cayspin::StiffGauss2: does not work on replicas of a lattice");
  EXPECT_EQ(refusal([&] { StiffGauss4<Spins>{spins}; }),
            "cayspin::StiffGauss4: does not work on replicas of a lattice");
  EXPECT_EQ(refusal([&] { AdaptiveStiffGauss2<Spins>{spins}; }),
            "cayspin::AdaptiveStiffGauss2: does not work on replicas of a lattice");
  auto none = all;
  none.replicas = 0;
  EXPECT_THROW(none.validate(), std::invalid_argument);
  none.replicas = std::int64_t{1} << 60;
  EXPECT_THROW(none.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace cayspin::test
