// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The red-black splitting: orders, exactness for one spin, energy, refusals.
#include "../support/backends.hpp"
#include "../support/coefficients.hpp"
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"
#include "../support/mean_field.hpp"

#include <numbers>
#include <string>

using namespace cayspin;
using namespace cayspin::test;

namespace {

Lattice const block{{4, 3, 3}, {1, 0.9, 1.1}, {Boundary::periodic, Boundary::open, Boundary::open}};

Slab slab_of(double damping, Lattice const& lattice = block) {
  return {.lattice = lattice,
          .exchange = 1,
          .anisotropy = 0.8,
          .axis = {1, 2, 3},
          .demag = 0.7,
          .applied = {0.5, -0.7, 0.9},
          .damping = damping};
}
Slab without_own_terms(double damping, Lattice const& lattice = block) {
  Slab slab = slab_of(damping, lattice);
  slab.anisotropy = slab.demag = 0;
  return slab;
}

/// Expects the orders of errors at time 1, in 10 to 80 steps, relative to a converged run of RKMK4.
template <class Generator>
void expect_orders(std::string const& what, Generator const& generator) {
  Spins const start = random_spins(block, 3);
  Spins const reference = run<Rkmk4<Spins>>(generator, start, 1. / 4000, 4000);
  auto const expect = [&]<class Stepper>(Stepper const&, double tolerance) {
    expect_convergence(
        what + ", order " + std::to_string(Stepper::order), 1, std::array{10, 20, 40, 80},
        Stepper::order, tolerance, [&](int steps, double dt) {
          return largest_distance(run<Stepper>(generator, start, dt, steps), reference);
        });
  };
  expect(RedBlack2(start), 0.1);
  expect(RedBlack4(start), 0.15);
}

TEST(RedBlackOrder, OfCoupledSpins) {
  for (double const damping : {0.0, 0.05, 1.0}) {
    std::string const with = "damping " + std::to_string(damping).substr(0, 4);
    expect_orders(with, slab_of(damping).natural());
    expect_orders(with + ", no own terms", without_own_terms(damping).natural());
  }
  Slab overdamped = slab_of(1);
  overdamped.precession = false;
  expect_orders("overdamped", overdamped.natural());
}

TEST(RedBlackOrder, InAFieldThatChanges) {
  Slab const slab = slab_of(0.1);
  TimeDependentZeeman const turning([](double t) {
    return Vector{2 * std::cos(5 * t), 2 * std::sin(5 * t), 1 - t};
  });
  expect_orders("rotating field",
                LandauLifshitz(EffectiveField{Exchange{slab.lattice, slab.exchange},
                                              UniaxialAnisotropy{slab.anisotropy, slab.axis},
                                              SlabDemag{{1, 0, 0}, slab.demag}, turning},
                               slab.damping));
}

/// Exchange and a cubic on-site field in one term that does not declare its parts.
struct Blended {
  Exchange exchange;

  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    auto const& m = stencil.center();
    return exchange.field(stencil) +
           Vec3<typename Stencil::value_type>{m.x * m.x * m.x, m.y * m.z, m.x * m.y};
  }
  template <class Stencil>
  KOKKOS_FUNCTION auto energy_density(Stencil const& stencil) const {
    return exchange.energy_density(stencil);  // not needed
  }
};

TEST(RedBlackOrder, OfATermThatSaysNothingAboutItself) {
  expect_orders("blended term", LandauLifshitz(EffectiveField{Blended{{block, 1}}}, 0.1));
}

/// An antisymmetric coupling to neighbours. It substitutes zero for missing neighbours, and does
/// not declare that it depends only on neighbours.
struct OpenBonds {
  static constexpr int degree = 2;

  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    auto const none = zero<typename Stencil::value_type>();
    auto const x = next<0>(stencil, none) - previous<0>(stencil, none);
    auto const z = next<2>(stencil, none) - previous<2>(stencil, none);
    return Vec3<typename Stencil::value_type>{x.z, z.z, -x.x - z.y};
  }
  template <class Stencil>
  KOKKOS_FUNCTION auto energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return Value(Value(-0.5) * dot(stencil.center(), field(stencil)));
  }
};

TEST(RedBlackOrder, OfATermThatNamesWhatStandsForAMissingNeighbour) {
  expect_orders("open bonds", LandauLifshitz(EffectiveField{Exchange(block, 1), OpenBonds{}}, 0.1));
}

TEST(RedBlackOrder, OnALatticeWithVacancies) {
  EffectiveField const field(
      SiteDependentExchange(numbers_on<Spins>(block, [](auto site) { return 0.3 * (site % 4); })),
      UniaxialAnisotropy{0.8, {1, 2, 3}}, Zeeman{{0.5, -0.7, 0.9}});
  LandauLifshitz const generator(
      FieldWithVacancies(field,
                         numbers_on<Spins>(block, [](auto i) { return i % 6 == 1 ? 0 : 1; })),
      numbers_on<Spins>(block, [](auto site) { return 0.1 * (site % 5); }));
  expect_orders("vacancies, coefficients per site", generator);
  auto const start = random_spins(block, 3), end = run<RedBlack4<Spins>>(generator, start, 0.3, 9);
  for (std::int64_t site = 0; site < block.sites(); ++site)
    EXPECT_EQ(length(spin(start, site) - spin(end, site)) == 0, site % 6 == 1) << site;
}

// The exact motion of a spin about h: with the angle theta to h, tan(theta/2) shrinks by the factor
// exp(-damping * |h| * t), and the azimuth turns by |h| * t if there is precession.
struct Macrospin {
  Vector axis, across, third;
  long double strength, theta;

  Macrospin(Vector const& h, Vector const& start) : strength(length(h)) {
    axis = (1 / length(h)) * h;
    Vector const rest = start - dot(start, axis) * axis;
    theta = std::atan2(static_cast<long double>(length(rest)),
                       static_cast<long double>(dot(start, axis)));
    across = (1 / length(rest)) * rest;
    third = cross(axis, across);
  }
  Vector at(long double damping, long double t, bool precession) const {
    long double const end = 2 * std::atan(std::tan(theta / 2) * std::exp(-damping * strength * t));
    long double const turn =
        precession ? std::fmod(strength * t, 2 * std::numbers::pi_v<long double>) : 0;
    auto const c = [](long double v) { return static_cast<double>(v); };
    return c(std::cos(end)) * axis + c(std::sin(end) * std::cos(turn)) * across +
           c(std::sin(end) * std::sin(turn)) * third;
  }
};

template <class Real>
void expect_exact_macrospin() {
  using Field = SpinField<Real, Space::memory_space>;
  constexpr double eps = epsilon<Real>, most = sizeof(Real) == sizeof(double) ? 1e300 : 1e37;
  Vector const h{0.3, -0.4, 1.2};
  Vector const nearly_opposite{-0.3 + 1e-6, 0.4, -1.2};
  for (Vector const& from : {Vector{0.8, 0.6, 0}, Vector{-0.1, 0.2, -0.9}, nearly_opposite})
    for (double const damping : {0.0, 0.1, 3.0, 1e12})
      for (bool const precession : {true, false})
        for (double const dt : {1 / most, 1e-3, 0.1, 0.7, 3.0, 50.0, 1e10, most}) {
          Slab const slab{.lattice = Lattice::chain(1),
                          .applied = h,
                          .damping = damping,
                          .precession = precession};
          auto const start =
              make_spins<Field>(slab.lattice, [&](auto, auto, auto) { return from; });
          // The exact solution uses the field and dt as rounded to this precision.
          Macrospin const exact({double(Real(h.x)), double(Real(h.y)), double(Real(h.z))},
                                spin(start, 0));
          double const t = static_cast<double>(static_cast<Real>(dt));
          auto const end = spin(run<RedBlack2<Field>>(slab.natural(), start, dt, 1), 0);
          auto const where = testing::Message() << "damping " << damping << " dt " << dt
                                                << " precession " << precession << " " << from.x;
          EXPECT_NEAR(length(end), 1, 8 * eps) << where;
          // Over many turns the angle is lost to round-off, so only the component along the field
          // is compared. Errors grow for a start near the direction opposite to the field.
          double const turn = precession ? 1.3 * t : 0;
          double const start_error = 1 + 1 / std::sqrt(1 + dot(from, exact.axis) / length(from));
          if (turn < 1e3)
            EXPECT_LT(length(end - exact.at(damping, t, precession)),
                      (4 + turn) * 4 * eps * (damping == 0 ? 1 : start_error * 10))
                << where;
          else
            EXPECT_NEAR(dot(end, exact.axis), dot(exact.at(damping, t, precession), exact.axis),
                        10 * eps * start_error)
                << where;
        }
}

TEST(RedBlackMacrospin, IsExactForAnyStepAndDamping) {
  expect_exact_macrospin<double>();
  expect_exact_macrospin<float>();
}

TEST(RedBlackMacrospin, StaysWithoutAField) {
  Slab const slab{.lattice = Lattice::chain(5), .damping = 0.3};
  auto const start = random_spins(slab.lattice, 2);
  EXPECT_EQ(copy_to_host(run<RedBlack4<Spins>>(slab.natural(), start, 1e300, 3)),
            copy_to_host(start));
}

TEST(RedBlackEnergy, IsConservedWithoutDamping) {
  Space const exec;
  Lattice const lattice = Lattice::cubic(4, 4, 4, 1, Boundary::periodic);
  for (Slab const& slab : {without_own_terms(0, lattice), slab_of(0, lattice)}) {
    Spins const start = random_spins(lattice, 5);
    double const before = energy(exec, slab.field(), start).value;
    auto const drift = [&](Spins const& end) {
      return std::abs(energy(exec, slab.field(), end).value - before) / 64;
    };
    std::string const what = slab.anisotropy == 0 ? "exchange, applied" : "with own terms";
    expect_below(what + ", order 2",
                 drift(run<RedBlack2<Spins>>(slab.natural(), start, 0.2, 10000)), 2e-13);
    expect_below(what + ", order 4", drift(run<RedBlack4<Spins>>(slab.natural(), start, 0.2, 2000)),
                 2e-13);
    expect_below(what + ", rkmk4 at a tenth of the step, for comparison",
                 -drift(run<Rkmk4<Spins>>(slab.natural(), start, 0.02, 1000)), -1e-7);
  }
}

TEST(RedBlackEnergy, NeverRisesWithDamping) {
  Space const exec;
  struct Case {
    Slab slab;
    double dt;
  };
  for (auto const& [slab, dt] : {Case{without_own_terms(0.05), 1.0}, Case{without_own_terms(2), 50},
                                 Case{slab_of(0.05), 0.3}, Case{slab_of(2), 0.1}}) {
    Spins spins = random_spins(block, 7);
    RedBlack2 stepper(spins);
    double const first = energy(exec, slab.field(), spins).value;
    double last = first;
    for (int n = 0; n < 300; ++n) {
      stepper.step(exec, slab.natural(), spins, n * dt, dt);
      double const now = energy(exec, slab.field(), spins).value;
      EXPECT_LT(now - last, 1e-13 * std::abs(first)) << "damping " << slab.damping << " step " << n;
      last = now;
    }
    EXPECT_LT(last, first - 10);
  }
}

TEST(RedBlackNorm, AfterManySteps) {
  for (double const damping : {0.0, 0.1}) {
    Lattice const lattice = Lattice::chain(6);
    auto const end = run<RedBlack2<Spins>>(slab_of(damping, lattice).natural(),
                                           random_spins(lattice, 6), 0.1, 200000);
    expect_below("largest ||m|^2 - 1|", norm_defect(Space{}, end), damping == 0 ? 4e-13 : 1e-15);
  }
}

TEST(RedBlackBatches, AreStepsToTheBitAndShareSweeps) {
  Space const exec;
  for (Lattice const& lattice :
       {Lattice::chain(1), Lattice::square(13, 5), Lattice::square(70, 40)}) {
    for (Slab const& slab : {slab_of(0.1, lattice), without_own_terms(0.1, lattice)}) {
      auto const generator = slab.natural();
      auto const start = random_spins(lattice, 8);
      Spins one = copy_of(start), many = copy_of(start);
      RedBlack4 by_hand(one), together(many);
      advance(by_hand, generator, one, 0.1, 7);
      auto const summary = integrate(exec, together, generator, many, {0, 0.1, 7});
      EXPECT_EQ(copy_to_host(one), copy_to_host(many));
      EXPECT_EQ(summary.evaluations, (7 * 10 + 1 + 1) / 2);
      EXPECT_EQ(by_hand.evaluations_done(), (7 * 11 + 1) / 2);
      EXPECT_EQ(together.work_bytes(), 0u);
    }
  }
}

std::string refusal(auto const& action) {
  try {
    action();
  } catch (std::invalid_argument const& error) {
    return error.what();
  }
  return "accepted";
}

TEST(RedBlackRefuses, LatticesThatAreNoCheckerboard) {
  auto const made = [](Lattice const& lattice) {
    return refusal([&] { RedBlack2<Spins> stepper(Spins("like", lattice)); });
  };
  EXPECT_EQ(made(Lattice::cubic(3, 4, 5)), "accepted");
  EXPECT_EQ(made(Lattice::cubic(4, 2, 1, 1, Boundary::periodic)), "accepted");
  EXPECT_EQ(
      made(Lattice::cubic(4, 3, 1, 1, Boundary::periodic)),
      "cayspin::RedBlack: the periodic y axis has 3 sites, and no checkerboard closes on itself "
      "over an odd number");
}

TEST(RedBlackRefuses, FieldsThatNeedAllSpins) {
  Spins spins("spins", block);
  RedBlack2 stepper(spins);
  LandauLifshitz const generator(EffectiveField{MeanField(1)}, 0.1);
  EXPECT_NE(refusal([&] {
              stepper.step(Space{}, generator, spins, 0, 0.1);
            }).find("RedBlack::step: a term of the field needs all spins beforehand"),
            std::string::npos);
}

}  // namespace
