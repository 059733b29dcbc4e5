// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Lagged energy control: how it changes one state; that it removes drift and keeps orders and
// lengths; bitwise identical results on host spaces; what it refuses.
#include "../backends/equal_bits.hpp"
#include "../support/backends.hpp"
#include "../support/evaluate.hpp"
#include "../support/figures.hpp"
#include "../support/larger.hpp"

#include <fstream>
#include <sstream>

using namespace cayspin;
using namespace cayspin::test;

namespace {

using Generator = decltype(Slab{}.natural());

Slab const slab{.lattice = Lattice::chain(8),
                .exchange = 1,
                .anisotropy = 0.8,
                .axis = {1, 2, 3},
                .demag = 0.7,
                .applied = {0.5, -0.7, 0.9}};

Lattice periodic_cube() {
  Lattice cube = Lattice::cubic(6, 6, 6);
  cube.boundary = {Boundary::periodic, Boundary::periodic, Boundary::periodic};
  return cube;
}

/// Records the largest |E - E_0| per spin and | |m| - 1 | at the ends of steps, before the control.
/// E_0 is the energy at step 0.
template <class Source>
struct Drift {
  Source source;
  double begin = std::numeric_limits<double>::quiet_NaN(), energy = 0, norm = 0;

  template <class Exec, class Field>
  void operator()(Exec const& exec, Step const& step, Field const& spins) {
    double const now = cayspin::energy(exec, source, spins).value;
    if (step.number == 0) begin = now;
    energy = larger(energy, std::abs(now - begin) / static_cast<double>(spins.sites()));
    norm = larger(norm, norm_defect(exec, spins));
  }
};

/// Returns the drift over `time`, with 80 evaluations per unit time. `period`: steps between
/// controls; 0: no control.
template <class Stepper>
Drift<Generator> drift(std::int64_t period, double time = 200) {
  using Field = typename Stepper::spins_type;
  Lattice const lattice = periodic_cube();
  Generator const generator = Slab{.lattice = lattice, .exchange = 1}.natural();
  auto spins = random_spins<Field>(lattice, 3);
  Stepper stepper(spins);
  Drift<Generator> seen{generator};
  double const dt = Stepper::evaluations / 80.0;
  Times const times{0, dt, std::llround(time / dt)};
  if (period == 0) {
    integrate(Space{}, stepper, generator, spins, times, seen);
  } else {
    EnergyControl control(spins, generator, {.period = period});
    integrate(Space{}, stepper, generator, spins, times, seen, control);
    EXPECT_EQ(control.evaluations_done(), times.steps / period + 1);
    EXPECT_EQ(*control.energy(), seen.begin);
  }
  return seen;
}

/// Returns the numbers of a row of the table in docs/reference/methods.md.
std::vector<double> row_of_page(std::string const& name) {
  std::ifstream file(CAYSPIN_METHODS_PAGE);
  std::string const begin = "| " + name + " |";
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(begin)) continue;
    std::vector<double> numbers;
    std::istringstream cells(line.substr(begin.size()));
    for (double number = 0; cells >> number; cells.ignore(2)) numbers.push_back(number);
    return numbers;
  }
  return {};
}

template <class Stepper>
void expect_less_drift(std::string const& method, std::string const& row) {
  auto const without = drift<Stepper>(0), with = drift<Stepper>(1), tenth = drift<Stepper>(10);
  std::printf("    %-22s dE/N %.2e, with control %.2e (1/%.0f), at every tenth step %.2e\n",
              method.c_str(), without.energy, with.energy, without.energy / with.energy,
              tenth.energy);
  EXPECT_LT(with.energy, 0.01 * without.energy) << method;
  EXPECT_LT(tenth.energy, 0.05 * without.energy) << method;
  expect_below(method + ", norm", with.norm, 1e-13);
  // The runs are chaotic: round-off on other processors changes their largest drifts. The page has
  // those of hosts.
  if constexpr (!detail::is_host_execution<Space>) return;
  double const found[] = {without.energy, with.energy, tenth.energy};
  auto const page = row_of_page(row);
  ASSERT_EQ(page.size(), std::size(found)) << row;
  for (std::size_t i = 0; i < page.size(); ++i)
    EXPECT_NEAR(found[i] / page[i], 1, 0.3) << row << ", column " << i;
}

TEST(EnergyControl, TakesDriftAway) {
  expect_less_drift<Rkmk4<Spins>>("rkmk4", "RKMK4");
  expect_less_drift<CommutatorFree4<Spins>>("commutator-free 4", "commutator-free 4");
  expect_less_drift<ProjectedRk4<Spins>>("projected rk4", "RK4 + renormalise");
}

// In single precision, the energy is held only as accurately as the spins can be stored.
TEST(EnergyControl, TakesDriftAwayInSinglePrecision) {
  using Stepper = Rkmk4<SpinField<float, Space::memory_space>>;
  auto const without = drift<Stepper>(0), with = drift<Stepper>(1);
  std::printf("    float: dE/N %.2e, with control %.2e\n", without.energy, with.energy);
  EXPECT_LT(with.energy, 0.01 * without.energy);
  EXPECT_LT(with.norm, 500 * epsilon<float>);
}

TEST(EnergyControl, TakesBodiesOfDifferentInertia) {
  using Memory = Space::memory_space;
  Lattice const lattice = Lattice::chain(5);
  SiteField<double, 3, Memory> const inverse("inverse_inertia", lattice);
  copy_from_host(std::vector<double>{1, 0.5, 0.2, 0.3, 1, 0.7, 2, 1, 0.1, 1, 0.2, 1, 1, 3, 2},
                 inverse);
  RigidBodyEnsemble const bodies(inverse);
  auto drift_of = [&](bool held) {
    Spins spins = random_spins(lattice, 5);
    Rkmk4<Spins> stepper(spins);
    Drift<RigidBodyEnsemble<double, Memory, 3>> seen{bodies};
    EnergyControl control(spins, bodies);
    Times const times{0, 0.2, 1000};
    if (held)
      integrate(Space{}, stepper, bodies, spins, times, seen, control);
    else
      integrate(Space{}, stepper, bodies, spins, times, seen);
    return seen.energy;
  };
  EXPECT_LT(drift_of(true), 0.2 * drift_of(false));
}

template <class Stepper>
void expect_order_kept(std::string const& method, int order) {
  auto const generator = slab.natural();
  Spins const start = random_spins(slab.lattice, 3);
  Spins const exact = run<Stepper>(generator, start, 1. / 4000, 4000);
  std::vector<double> dts, errors;
  for (int const steps : {20, 40, 80, 160}) {
    dts.push_back(1. / steps);
    Spins spins = copy_of(start);
    Stepper stepper(spins);
    EnergyControl control(spins, generator);
    integrate(Space{}, stepper, generator, spins, Times{0, dts.back(), steps}, control);
    errors.push_back(largest_distance(spins, exact));
  }
  expect_order(method + ", with control", fitted_order(dts, errors), order, 0.2);
}

TEST(EnergyControl, KeepsOrders) { expect_order_kept<Rkmk4<Spins>>("rkmk4", 4); }

template <class Real>
struct OneCall : ::testing::Test {
  using Field = SpinField<Real, Space::memory_space>;
};
TYPED_TEST_SUITE(OneCall, Precisions, PrecisionName);

/// Returns the spins after the control has turned them towards an energy that is greater by
/// `higher`.
template <class Source, class Field>
Field turned(Source const& source, Field const& start, double higher,
             EnergyControlOptions options = {}, double dt = 10) {
  Field spins = copy_of(start);
  options.energy = energy(Space{}, source, start).value + higher;
  EnergyControl control(spins, source, options);
  EXPECT_EQ(control.excess(), 0);
  control(Space{}, Step{0, 0, dt}, spins);
  EXPECT_NEAR(control.excess(), -higher, 1e-12);
  return spins;
}

// Compares turned() with the Cayley map of kappa * (m x A), written out here for each spin, with
// one kappa for all spins. To first order in kappa, the map adds kappa * A_o to m, where A_o is the
// part of A orthogonal to m.
template <class Source, class Field>
void expect_turn(Source const& source, Field const& start) {
  using Real = typename Field::value_type;
  double const higher = 0.01;
  auto const m = numbers_of(start), a = evaluated(Space{}, source, start);
  std::vector<Vector> axes;
  double slope = 0;
  for (std::int64_t site = 0; site < start.sites(); ++site) {
    axes.push_back(cross(at(m, site), at(a, site)));
    slope += dot(axes.back(), axes.back());
  }
  auto const found = numbers_of(turned(source, start, higher));
  double largest = 0, moved = 0;
  for (std::int64_t site = 0; site < start.sites(); ++site) {
    Vector const from = at(m, site), f = (-higher / slope) * axes[site], c = cross(f, from);
    Vector const to = from + (4 / (4 + dot(f, f))) * (c + 0.5 * cross(f, c));
    largest = larger(largest, length(at(found, site) - to));
    moved = larger(moved, length(to - from));
  }
  EXPECT_LT(largest, 4 * epsilon<Real>);
  EXPECT_GT(moved, 1e-4);
}

TYPED_TEST(OneCall, TurnsSpinsByOneNumber) {
  using Field = typename TestFixture::Field;
  expect_turn(slab.natural(), random_spins<Field>(slab.lattice, 3));
  expect_turn(RigidBody({1.1, 1.9, 2.0, 0.1, -0.6, 0.4}),
              random_spins<Field>(Lattice::chain(37), 3));
}

// Newton's method: the remaining error is of second order in the correction.
TEST(EnergyControl, ReachesTheEnergy) {
  Spins const start = random_spins(slab.lattice, 3);
  double const before = energy(Space{}, slab.field(), start).value;
  std::vector<double> asked{0.04, 0.02, 0.01, 0.005}, left;
  for (double const higher : asked)
    left.push_back(
        std::abs(energy(Space{}, slab.field(), turned(slab.natural(), start, higher)).value -
                 before - higher));
  EXPECT_LT(left.back(), 0.01 * asked.back());
  expect_order("left of the energy", fitted_order(asked, left), 2, 0.1);
}

// However far away the energy is, no spin moves by more than 0.1 * dt * (the largest rate). At
// equilibrium, spins do not move.
TYPED_TEST(OneCall, IsBounded) {
  using Field = typename TestFixture::Field;
  Field const start = random_spins<Field>(slab.lattice, 3);
  double const dt = 0.02, rate = largest_rate(Space{}, slab.natural(), start);
  Field const far = turned(slab.natural(), start, 1e6, {}, dt);
  EXPECT_NEAR(largest_distance(far, start), 0.1 * dt * rate, 1e-3 * dt * rate);

  auto const still = make_spins<Field>(Lattice::chain(20), [](auto, auto, auto) {
    return Vector{0, 0, 1};
  });
  Slab const along{.lattice = still.lattice(), .exchange = 1, .applied = {0, 0, 1}};
  EXPECT_EQ(copy_to_host(turned(along.natural(), still, 1.0)), copy_to_host(still));
}

#if defined(KOKKOS_ENABLE_SERIAL)
TYPED_TEST(OneCall, SameBits) {
  using Field = SpinField<typename TestFixture::Field::value_type, Kokkos::HostSpace>;
  for (Lattice const& lattice : odd_lattices()) {
    Slab undamped = every_term(lattice);
    undamped.damping = 0;
    auto const generator = undamped.natural();
    auto const start = random_spins<Field>(lattice, 11);
    auto const after = [&](auto const& exec) {
      Field spins = copy_of(start);
      EnergyControl control(spins, generator, {.energy = 0.5});
      for (int n = 0; n < 3; ++n) control(exec, Step{n, 0, 0.3}, spins);
      exec.fence();
      return copy_to_host(spins);
    };
    auto const one = after(Kokkos::Serial());
    EXPECT_NE(one, copy_to_host(start)) << name_of(lattice);
    expect_equal_bits(one, after(Threaded()), name_of(lattice));
  }
}
#endif

TEST(EnergyControl, HoldsTheEnergyOfTheFirstCall) {
  Spins const start = random_spins(slab.lattice, 3), other = random_spins(slab.lattice, 4);
  auto const energy_of = [](Spins const& spins) {
    return energy(Space{}, slab.natural(), spins).value;
  };
  EnergyControl control(start, slab.natural(), {.period = 5});
  EXPECT_TRUE(control.due(Step{3}));  // a run may start at any step
  control(Space{}, Step{3, 0, 0.1}, start);
  EXPECT_EQ(*control.energy(), energy_of(start));
  for (int const number : {4, 6, 9}) EXPECT_FALSE(control.due(Step{number}));
  EXPECT_TRUE(control.due(Step{5}));
  control.reset();
  EXPECT_FALSE(control.energy());
  control(Space{}, Step{5, 0, 0.1}, other);
  EXPECT_EQ(*control.energy(), energy_of(random_spins(slab.lattice, 4)));

  // A checkpoint from before the first call stores no energy.
  CheckpointInMemory checkpoint;
  EnergyControl before(start, slab.natural());
  serialize(before, checkpoint);
  checkpoint.close();
  serialize(control, checkpoint);
  EXPECT_FALSE(control.energy());
}

TEST(EnergyControl, LeavesWhatIsNotFinite) {
  auto numbers = copy_to_host(random_spins(slab.lattice, 3));
  numbers[4] = std::numeric_limits<double>::quiet_NaN();
  Spins const spins = spins_of<Spins>(slab.lattice, numbers);
  EnergyControl control(spins, slab.natural(), {.energy = 1.0});
  control(Space{}, Step{0, 0, 0.1}, spins);
  auto const found = copy_to_host(spins);
  EXPECT_EQ(std::memcmp(found.data(), numbers.data(), numbers.size() * sizeof(double)), 0);
}

TEST(EnergyControl, Refuses) {
  Spins const spins = random_spins(slab.lattice, 3);
  auto const refuses = [&](Generator const& generator, EnergyControlOptions const& options) {
    EXPECT_THROW(EnergyControl(spins, generator, options), std::invalid_argument);
  };
  Slab damped = slab, overdamped = slab;
  damped.damping = 1e-12;
  overdamped.precession = false;
  refuses(damped.natural(), {});
  refuses(overdamped.natural(), {});
  refuses(slab.natural(), {.period = 0});
  refuses(slab.natural(), {.largest_fraction = 0});
  refuses(slab.natural(), {.energy = std::numeric_limits<double>::infinity()});
}

}  // namespace
