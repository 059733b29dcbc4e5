// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Minimising takes few evaluations for antiferromagnetic exchange, too.
#include "films.hpp"

#include <numbers>

namespace cayspin::test {
namespace {

template <class Backend>
class Antiferromagnets : public MinimizerTest<Backend> {};
TYPED_TEST_SUITE(Antiferromagnets, Backends, BackendName);

Lattice with(std::array<std::int64_t, 3> const& shape, Boundary boundary) {
  return {shape, {1, 1, 1}, {boundary, boundary, boundary}};
}

std::int64_t bonds(Lattice const& lattice, int axis) {
  auto const extent = lattice.shape[static_cast<std::size_t>(axis)];
  bool const closes = lattice.boundary[static_cast<std::size_t>(axis)] == Boundary::periodic;
  return lattice.sites() / extent * (extent - (closes && extent > 1 ? 0 : 1));
}

TYPED_TEST(Antiferromagnets, TakeAsFewEvaluations) {
  double const exchange = 50, easy = 0.1;
  for (auto const& shape : std::vector<std::array<std::int64_t, 3>>{{32, 32, 1}, {16, 16, 16}})
    for (Boundary const boundary : {Boundary::open, Boundary::periodic}) {
      auto const lattice = with(shape, boundary);
      auto const sites = static_cast<double>(lattice.sites());
      EffectiveField const field(Exchange(lattice, -exchange), UniaxialAnisotropy(easy, {1, 0, 0}));
      Minimum found[2];
      for (bool const preconditioned : {false, true}) {
        auto spins = this->random_spins(lattice, 1);
        double const bound = TestFixture::is_double ? 1e-6 : 1e-3;
        found[preconditioned] =
            minimize(this->exec, field, spins, {.torque = bound, .preconditioned = preconditioned});
        EXPECT_EQ(found[preconditioned].end, MinimizeEnd::converged);
      }
      EXPECT_LE(found[1].evaluations, 45);
      double const ratio = TestFixture::is_double ? 5 : 4.5;
      EXPECT_GT(static_cast<double>(found[0].evaluations),
                ratio * static_cast<double>(found[1].evaluations));
      double all_bonds = 0;
      for (int axis = 0; axis < 3; ++axis) all_bonds += static_cast<double>(bonds(lattice, axis));
      EXPECT_NEAR(found[1].energy.value, -2 * exchange * all_bonds - 0.5 * easy * sites,
                  1e-4 * sites);
    }
}

// Energy differences below round-off must not stop the search.
TYPED_TEST(Antiferromagnets, ConvergeWhereRoundOffHidesTheEnergy) {
  auto const lattice = with({16, 16, 16}, Boundary::periodic);
  double const torque = TestFixture::is_double ? 1e-6 : 1e-2;
  EffectiveField const field(Exchange(lattice, -50), UniaxialAnisotropy(0.1, {1, 0, 0}));
  for (unsigned const seed : {1U, 2U, 3U, 4U}) {
    auto spins = this->random_spins(lattice, seed);
    auto const found =
        minimize(this->exec, field, spins, {.torque = torque, .preconditioned = false});
    EXPECT_EQ(found.end, MinimizeEnd::converged) << seed;
    EXPECT_NEAR(found.energy.value, -1229004.8, TestFixture::is_double ? 1e-4 : 1) << seed;
  }
}

/// Exchange with a different constant along z.
struct Layers {
  double in_plane, between;

  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto const& m = stencil.center();
    auto const near = stencil.template previous<0>() + stencil.template next<0>() +
                      stencil.template previous<1>() + stencil.template next<1>();
    auto const far = stencil.template previous<2>() + stencil.template next<2>();
    Value const j = as_value<Value>(in_plane), k = as_value<Value>(between);
    return Vec3<Value>(j * (near - Value(4) * m) + k * (far - Value(2) * m));
  }
  template <class Stencil>
  KOKKOS_FUNCTION auto energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return Value(as_value<Value>(-0.5) * dot(stencil.center(), field(stencil)));
  }
};

// Along one axis, exchange has another sign than along the others. Spins of an odd ring of layers
// cannot alternate: they turn by a little less than pi from layer to layer.
TYPED_TEST(Antiferromagnets, OfSomeAxes) {
  for (auto const& [in_plane, between] : {std::pair{40.0, -30.0}, {-40.0, 30.0}})
    for (std::int64_t const layers : {10, 11})
      for (Boundary const boundary : {Boundary::open, Boundary::periodic}) {
        bool const is_frustrated = between < 0 && layers % 2 == 1 && boundary == Boundary::periodic;
        auto const lattice = with({12, 14, layers}, boundary);
        auto spins = this->random_spins(lattice, 2);
        double const bound = TestFixture::is_double ? 1e-6 : 2e-3;
        auto const found =
            minimize(this->exec, Layers{in_plane, between}, spins, {.torque = bound});
        EXPECT_EQ(found.end, MinimizeEnd::converged);
        EXPECT_LE(found.evaluations, is_frustrated ? 1000 : 80) << in_plane << " " << layers;
        auto const lowest = [&](double coupling, int axis) {
          auto const extent = lattice.shape[static_cast<std::size_t>(axis)];
          bool const frustrated = boundary == Boundary::periodic && extent % 2 == 1;
          double const turn = std::numbers::pi * (frustrated ? 1 - 1.0 / extent : 1);
          double const ends = coupling > 0 ? 0 : 1 - std::cos(turn);
          return coupling * ends * static_cast<double>(bonds(lattice, axis));
        };
        EXPECT_NEAR(found.energy.value,
                    lowest(in_plane, 0) + lowest(in_plane, 1) + lowest(between, 2),
                    1e-4 * static_cast<double>(lattice.sites()))
            << in_plane << " " << layers;
      }
}

}  // namespace
}  // namespace cayspin::test
