// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Couplings of pairs on crystals against sums over bonds by hand, on rows of several packs and of
// partial packs, past open ends and around periodic ones.
#include "gradient.hpp"

#include <cayspin/crystal.hpp>
#include <cayspin/field/pair_couplings.hpp>
#include <cayspin/generator/landau_lifshitz.hpp>
#include <cayspin/generator/orthogonal.hpp>
#include <cayspin/minimize.hpp>
#include <cayspin/observer/normalize.hpp>
#include <cayspin/stepper/methods.hpp>

#include <cayspin_paper/analytic_sigma.hpp>
#include <cayspin_paper/series4.hpp>

namespace cayspin::test {
namespace {

template <class Backend>
class Pairs : public GradientTest<Backend> {};
TYPED_TEST_SUITE(Pairs, Backends, BackendName);

/// A bond between two sites of a lattice.
struct Pair {
  std::int64_t from, to;
  Coupling coupling;
};

std::vector<Pair> pairs(Lattice const& lattice, std::vector<Coupling> const& couplings) {
  std::vector<Pair> all;
  auto const& shape = lattice.shape;
  std::int64_t const cells[3] = {shape[0], shape[1], shape[2] / lattice.cell_sites};
  auto const number = [&](std::int64_t const* cell, int site) {
    return ((cell[2] * lattice.cell_sites + site) * shape[1] + cell[1]) * shape[0] + cell[0];
  };
  for (auto const& bond : couplings)
    for (std::int64_t k = 0; k < cells[2]; ++k)
      for (std::int64_t j = 0; j < cells[1]; ++j)
        for (std::int64_t i = 0; i < cells[0]; ++i) {
          std::int64_t const here[3] = {i, j, k};
          std::int64_t there[3];
          bool is_there = true;
          for (int axis = 0; axis < 3; ++axis) {
            there[axis] = here[axis] + bond.offset[axis];
            if (lattice.boundary[axis] == Boundary::periodic)
              there[axis] = (there[axis] % cells[axis] + cells[axis]) % cells[axis];
            is_there = is_there && there[axis] >= 0 && there[axis] < cells[axis];
          }
          if (is_there)
            all.push_back({number(here, bond.between[0]), number(there, bond.between[1]), bond});
        }
  return all;
}

Vec3<double> times(std::array<double, 9> const& t, Vec3<double> const& m, bool transposed) {
  auto const row = [&](int i) {
    return transposed ? t[i] * m.x + t[3 + i] * m.y + t[6 + i] * m.z
                      : t[3 * i] * m.x + t[3 * i + 1] * m.y + t[3 * i + 2] * m.z;
  };
  return {row(0), row(1), row(2)};
}

ByHand pairs_by_hand(Lattice const& lattice, std::vector<Coupling> const& couplings) {
  return each_bond(
      pairs(lattice, couplings),
      [](Pair const& pair, auto const& m, auto const& other, double sign) {
        return times(pair.coupling.tensor, other, sign < 0) +
               2 * pair.coupling.biquadratic * dot(m, other) * other;
      },
      [](Pair const& pair, auto const& a, auto const& b) {
        return -dot(a, times(pair.coupling.tensor, b, false)) -
               pair.coupling.biquadratic * std::pow(dot(a, b), 2);
      });
}

using Cells = std::array<std::int64_t, 3>;
using Ends = std::array<Boundary, 3>;
constexpr auto open = Boundary::open, periodic = Boundary::periodic;
Ends const ends[] = {
    {open, open, open}, {periodic, periodic, periodic}, {periodic, open, periodic}};

std::vector<Coupling> shell_of_bcc() {
  std::vector<Coupling> bonds;
  for (int i : {-1, 0})
    for (int j : {-1, 0})
      for (int k : {-1, 0}) bonds.push_back(Coupling::of({0, 1}, {i, j, k}, 1.25));
  return bonds;
}

void add_along_axes(std::vector<Coupling>& bonds, int site, double exchange) {
  for (auto const& offset : {std::array{1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
    bonds.push_back(Coupling::of({site, site}, offset, exchange));
}

TYPED_TEST(Pairs, ShellsOfACubicCrystal) {
  auto bonds = shell_of_bcc();
  for (int site : {0, 1}) add_along_axes(bonds, site, -0.5);
  for (Cells const& cells : {Cells{35, 3, 3}, {4, 1, 2}, {16, 2, 1}, {1, 5, 4}, {24, 3, 4}})
    for (auto const& boundary : ends) {
      auto const lattice = Crystal::bcc().lattice(cells, boundary);
      this->check("bcc", lattice, PairCouplings<typename TypeParam::MemorySpace>(lattice, bonds),
                  pairs_by_hand(lattice, bonds));
    }
}

TYPED_TEST(Pairs, LongWaysTensorsAndBiquadraticOnes) {
  Coupling tensor{{0, 2}, {3, -1, 1}, {0.3, 0.1, -0.4, 0.7, -0.2, 0.5, 0.6, 0.9, 1.1}, 0};
  Coupling biquadratic{{1, 0}, {0, 2, 0}, {}, 0.75};
  std::vector<Coupling> const bonds{
      tensor, biquadratic, Coupling::of({1, 1}, {9, 0, 0}, 0.5, {0.1, -0.2, 0.3}),
      Coupling::of({2, 1}, {-2, 0, 0}, -1, {0, 0, 0.8}), Coupling::of({0, 0}, {0, 0, 2}, 1)};
  for (Cells const& cells : {Cells{37, 4, 3}, {5, 3, 2}, {17, 1, 1}})
    for (auto const& boundary : ends) {
      auto const lattice = Crystal::kagome().lattice(cells, boundary);
      this->check("kagome", lattice, PairCouplings<typename TypeParam::MemorySpace>(lattice, bonds),
                  pairs_by_hand(lattice, bonds));
    }
}

TYPED_TEST(Pairs, OfNeighboursAreTheExchange) {
  using Spins = typename TypeParam::Spins;
  auto const lattice = Lattice::cubic(19, 4, 3);
  std::vector<Coupling> bonds;
  add_along_axes(bonds, 0, 1.5);
  typename TypeParam::Exec const exec;
  auto const spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 3));
  // Torques are compared because the fields may differ by a multiple of the spin.
  auto const torque = [&](auto const& term) {
    Spins const field("field", lattice);
    evaluate_field(exec, term, spins, 0, field);
    exec.fence();
    auto numbers = numbers_of(field);
    auto const m = numbers_of(spins);
    for (std::int64_t site = 0; site < lattice.sites(); ++site) {
      auto const t = cross(at(m, site), at(numbers, site));
      numbers[3 * site] = t.x, numbers[3 * site + 1] = t.y, numbers[3 * site + 2] = t.z;
    }
    return numbers;
  };
  auto const pairs = torque(PairCouplings<typename TypeParam::MemorySpace>(lattice, bonds));
  auto const exchange = torque(Exchange(lattice, 1.5));
  for (std::size_t i = 0; i < pairs.size(); ++i)
    EXPECT_NEAR(pairs[i], exchange[i], 32 * epsilon<typename TypeParam::Real>);
}

/// A term without code for rows, so that its couplings are evaluated site by site.
template <class Term>
struct BySite {
  Term term;

  template <class Prepared>
  struct Now {
    Prepared prepared;
    template <class Stencil>
    KOKKOS_FUNCTION Vec3<typename Stencil::value_type> field(Stencil const& stencil) const {
      return prepared.field(stencil);
    }
    template <class Stencil>
    KOKKOS_FUNCTION typename Stencil::value_type energy_density(Stencil const& stencil) const {
      return prepared.energy_density(stencil);
    }
  };
  template <class Exec, class Spins>
  auto prepare(Exec const& exec, Spins const& spins, double t) const {
    auto prepared = term.prepare(exec, spins, t);
    return Now<decltype(prepared)>{prepared};
  }
};

template <class Backend>
std::vector<double> after_steps(Lattice const& lattice, auto const& field) {
  using Spins = typename Backend::Spins;
  auto spins = spins_of<Spins>(lattice, random_directions(lattice.sites(), 7));
  LieHeun<Spins> stepper(spins);
  typename Backend::Exec const exec;
  auto const generator = LandauLifshitz(EffectiveField(field), 0.25);
  for (int step = 0; step < 3; ++step) stepper.step(exec, generator, spins, 0, 0.01);
  exec.fence();
  return numbers_of(spins);
}

TYPED_TEST(Pairs, AlongRowsAreThoseSiteBySite) {
  using Term = PairCouplings<typename TypeParam::MemorySpace>;
  auto shells = shell_of_bcc(), tensors = shells, many = shells;
  for (int site : {0, 1}) add_along_axes(shells, site, -0.5);
  tensors.push_back(Coupling::of({0, 1}, {-3, 0, 1}, 0.5, {0.1, -0.2, 0.3}));
  tensors.push_back({{1, 1}, {2, 1, 0}, {0.3, 0.1, -0.4, 0.7, -0.2, 0.5, 0.6, 0.9, 1.1}, 0.25});
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j)
      for (int k = 1; k <= 6; ++k) many.push_back(Coupling::of({0, 0}, {i, j, k}, 0.01));
  auto far = tensors;
  far.push_back(Coupling::of({0, 1}, {19, 0, 0}, 0.5));
  for (auto const& bonds : {shells, tensors, many, far})
    for (Cells const& cells : {Cells{35, 3, 3}, {4, 1, 2}, {64, 2, 1}, {1, 5, 4}, {600, 2, 1}})
      for (auto const& boundary : ends) {
        auto const lattice = Crystal::bcc().lattice(cells, boundary);
        Term const pairs(lattice, bonds);
        EXPECT_EQ(after_steps<TypeParam>(lattice, pairs),
                  after_steps<TypeParam>(lattice, BySite<Term>{pairs}));
      }
}

TYPED_TEST(Pairs, ThatCannotBe) {
  using Term = PairCouplings<typename TypeParam::MemorySpace>;
  auto const lattice = Crystal::bcc().lattice({2, 2, 2});
  for (auto const& bond : {Coupling::of({0, 2}, {0, 0, 0}, 1), Coupling::of({1, 1}, {0, 0, 0}, 1),
                           Coupling::of({0, 1}, {0, 0, 0}, std::nan("")),
                           Coupling{{0, 1}, {0, 0, 0}, {}, std::nan("")}})
    EXPECT_THROW(Term(lattice, {bond}), std::invalid_argument);
  EXPECT_THROW(Term(Lattice::chain(0, 1, Boundary::periodic), {Coupling::of({0, 0}, {1, 0, 0}, 1)}),
               std::invalid_argument);
  // isotropy::Analytic would omit the derivative of biquadratic bonds.
  auto spins = spins_of<typename TypeParam::Spins>(Lattice::chain(4), random_directions(4, 3));
  LieEuler<typename TypeParam::Spins, isotropy::Analytic> stepper(spins);
  LandauLifshitz const generator(Term(spins.lattice(), {Coupling{{0, 0}, {1, 0, 0}, {}, 0.5}}),
                                 0.1);
  typename TypeParam::Exec const exec;
  EXPECT_THROW(stepper.step(exec, generator, spins, 0, 0.1), std::invalid_argument);
  // Series4 would omit it, too, even within a sum of terms or an orthogonal generator.
  Series4<typename TypeParam::Spins> series(spins);
  EXPECT_THROW(series.step(exec, generator, spins, 0, 0.1), std::invalid_argument);
  EXPECT_THROW(series.step(exec,
                           orthogonal(LandauLifshitz(
                               EffectiveField(Zeeman{{0, 0, 1}}, generator.field()), 0.1)),
                           spins, 0, 0.1),
               std::invalid_argument);
  LandauLifshitz const linear(
      EffectiveField(Term(spins.lattice(), {Coupling::of({0, 0}, {1, 0, 0}, 0.5)})), 0.1);
  EXPECT_NO_THROW(series.step(exec, linear, spins, 0, 0.1));
}

// The curvature at equilibrium includes biquadratic bonds: without them this state is a saddle,
// with them a minimum.
TYPED_TEST(Pairs, MinimumWithBiquadraticBonds) {
  using Term = PairCouplings<typename TypeParam::MemorySpace>;
  auto const lattice = Lattice::chain(12, 1, Boundary::periodic);
  typename TypeParam::Exec const exec;
  auto bond = Coupling::of({0, 0}, {1, 0, 0}, -0.5);
  bond.biquadratic = 1;
  Term const bonds(lattice, {bond});
  auto start = random_directions(12, 3);
  for (std::size_t i = 0; i < start.size(); ++i) start[i] = (i % 3 == 2) + 0.05 * start[i];
  auto spins = spins_of<typename TypeParam::Spins>(lattice, start);
  normalize(exec, spins);
  auto const found = minimize(exec, EffectiveField(bonds, Zeeman{{0, 0, 0.25}}), spins,
                              {.torque = sizeof(typename TypeParam::Real) == 8 ? 1e-9 : 1e-4});
  EXPECT_EQ(found.end, MinimizeEnd::converged);
  EXPECT_NEAR(found.energy.value, 12 * (0.5 - 1 - 0.25), 1e-4);
  EXPECT_NEAR(found.curvature, 0.25, 0.1);
}

}  // namespace
}  // namespace cayspin::test
