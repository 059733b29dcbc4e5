// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Single steps of coupled Landau-Lifshitz chains against 70-digit arithmetic. The chain lies along
// each axis of a lattice in turn, by itself or repeated along the other axes. Neighbours along the
// other axes are equal, so they contribute nothing.
#include "../support/evaluate.hpp"
#include "steps.hpp"

namespace cayspin::test {
namespace {

/// A chain of n sites along `axis` of a lattice; copies of it fill the other axes.
struct Placement {
  int axis;
  std::array<std::int64_t, 3> copies;

  Lattice lattice(std::int64_t n, double spacing) const {
    auto lattice = Lattice::cubic(copies[0], copies[1], copies[2], spacing, Boundary::periodic);
    lattice.shape[axis] = n;
    lattice.boundary[axis] = Boundary::open;
    return lattice;
  }
  /// Returns the chain's site that a site of the lattice copies.
  std::int64_t place(std::int64_t site, Lattice const& lattice) const {
    for (int a = 0; a < axis; ++a) site /= lattice.shape[a];
    return site % lattice.shape[axis];
  }
  std::vector<double> spread(std::vector<double> const& chain, Lattice const& lattice) const {
    std::vector<double> numbers;
    for (std::int64_t site = 0; site < lattice.sites(); ++site)
      for (int c = 0; c < 3; ++c) numbers.push_back(chain[3 * place(site, lattice) + c]);
    return numbers;
  }
};

// Rows along x of 5 and 19 sites end inside packs of every width, and those of 16 fill packs. Along
// axes of 1 or 2 sites, both neighbours of a site are the same site.
std::vector<Placement> const placements{{0, {1, 1, 1}},  {0, {1, 3, 2}},  {1, {1, 1, 1}},
                                        {1, {5, 1, 3}},  {1, {16, 1, 1}}, {2, {1, 1, 1}},
                                        {2, {19, 2, 1}}, {2, {2, 1, 1}}};

auto landau_lifshitz(nlohmann::json const& parameters, Lattice const& lattice) {
  auto const vector = [&](char const* key) {
    auto const v = decimals(parameters.at(key));
    return Vec3<double>{v[0], v[1], v[2]};
  };
  EffectiveField const field{Exchange(lattice, parameters.at("ex")),
                             UniaxialAnisotropy(parameters.at("K"), vector("e")),
                             Zeeman{vector("happ")}, SlabDemag({1, 0, 0}, parameters.at("nx"))};
  return LandauLifshitz(field, parameters.at("lam"), parameters.at("prec") != 0.0);
}

template <class Backend>
class ChainOracles : public ::testing::Test {};
TYPED_TEST_SUITE(ChainOracles, OracleBackends, BackendName);

TYPED_TEST(ChainOracles, Steps) {
  using Real = typename TypeParam::Real;
  int checked = 0;
  for (auto const& entry : oracles("llg_chain_step")) {
    auto const chain = decimals(entry.at("m")), before = decimals(entry.at("m_prev"));
    for (auto const& placement : placements) {
      auto const lattice = placement.lattice(chain.size() / 3, entry.at("params").at("dx"));
      auto const generator = landau_lifshitz(entry.at("params"), lattice);
      Start const start{lattice, placement.spread(chain, lattice),
                        placement.spread(before, lattice), entry.at("h")};
      auto const expect = [&](std::string const& method, std::vector<double> const& expected) {
        auto const found = one_step<typename TypeParam::Exec, typename TypeParam::Spins>(
            method, generator, entry.at("sigma_const"), start);
        for (std::size_t i = 0; i < found.size(); ++i)
          EXPECT_NEAR(found[i], expected[i], step_tolerance<Real>)
              << "along " << placement.axis << ", " << method << ", number " << i;
        ++checked;
        return found;
      };
      for (auto const& [method, step] : entry.at("steps").items()) {
        auto const expected = placement.spread(decimals(step.at("m1")), lattice);
        auto const found = expect(method, expected);
        if (method == "euler_cor_analytic")
          expect_same(expect("euler_cor_connection", expected), found, 8 * epsilon<Real>, "chain");
      }
    }
  }
  EXPECT_EQ(checked, (4 * (26 + 1) + 2) * 8);
}

TYPED_TEST(ChainOracles, FieldAndGenerator) {
  using Real = typename TypeParam::Real;
  typename TypeParam::Exec const exec;
  for (auto const& entry : oracles("llg_chain_step")) {
    auto const chain = decimals(entry.at("m"));
    auto const& parameters = entry.at("params");
    for (auto const& placement : placements) {
      auto const lattice = placement.lattice(chain.size() / 3, parameters.at("dx"));
      auto const generator = landau_lifshitz(parameters, lattice);
      auto const spins =
          spins_of<typename TypeParam::Spins>(lattice, placement.spread(chain, lattice));
      // Rounding is relative to the largest summand, exchange or applied field.
      double const dx = parameters.at("dx"), ex = parameters.at("ex");
      double const bound = 8 * epsilon<Real> * (4 * ex / (dx * dx) + 6);
      auto const field = evaluated(exec, generator.field(), spins);
      auto const a = evaluated(exec, generator, spins);
      auto const expected_field = placement.spread(decimals(entry.at("H")), lattice);
      auto const expected_a = placement.spread(decimals(entry.at("A")), lattice);
      for (std::size_t i = 0; i < field.size(); ++i) {
        EXPECT_NEAR(field[i], expected_field[i], bound) << "along " << placement.axis;
        EXPECT_NEAR(a[i], expected_a[i], bound) << "along " << placement.axis;
      }
    }
  }
}

}  // namespace
}  // namespace cayspin::test
