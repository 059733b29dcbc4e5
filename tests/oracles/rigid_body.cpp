// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Single steps and trajectories of rigid bodies against 70-digit arithmetic.
#include "../support/evaluate.hpp"
#include "../support/larger.hpp"
#include "steps.hpp"

#include <cayspin_paper/series4.hpp>

namespace cayspin::test {
namespace {

SymmetricTensor tensor(std::vector<double> const& matrix) {
  return {matrix[0], matrix[4], matrix[8], matrix[1], matrix[2], matrix[5]};
}

// Returns the inverse of a symmetric matrix by cofactors, computed in long double.
SymmetricTensor inverse(std::vector<double> const& m) {
  long double const a = m[0], b = m[1], c = m[2], d = m[4], e = m[5], f = m[8];
  long double const determinant = a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d);
  auto const entry = [&](long double cofactor) {
    return static_cast<double>(cofactor / determinant);
  };
  return {entry(d * f - e * e), entry(a * f - c * c), entry(a * d - b * b),
          entry(c * e - b * f), entry(b * e - c * d), entry(b * c - a * e)};
}

std::vector<double> repeated(std::vector<double> const& m, std::int64_t count) {
  std::vector<double> numbers;
  for (std::int64_t i = 0; i < count; ++i) numbers.insert(numbers.end(), m.begin(), m.end());
  return numbers;
}

template <class Backend>
class RigidBodyOracles : public ::testing::Test {};
TYPED_TEST_SUITE(RigidBodyOracles, OracleBackends, BackendName);

// Nineteen equal bodies fill whole packs and a part of one, so that every lane is tested.
constexpr std::int64_t bodies = 19;

/// Like with_method, but also with the methods that only rigid bodies have.
template <class Spins, class With>
auto with_body_method(std::string const& method, RigidBody const& body, double constant,
                      Spins const& like, With const& with) {
  isotropy::Energy const energy;
  auto const w = orthogonal(body);
  if (method == "heun_dcor") return with(LieHeun(like, energy), body);
  if (method == "heun_ocor") return with(LieHeun(like, energy), w);
  if (method == "rkmk4_dcor") return with(Rkmk4(like, energy), body);
  if (method == "rkmk4_ocor") return with(Rkmk4(like, energy), w);
  if (method == "sy4_dcor") return with(Series4(like, energy), body);
  if (method == "sy4_ocor") return with(Series4(like, energy), w);
  if (method == "sy4_ocor_paper") return with(Series4Paper(like, energy), body);
  return with_method(method, body, constant, like, with);
}

TYPED_TEST(RigidBodyOracles, Steps) {
  using Real = typename TypeParam::Real;
  auto const lattice = Lattice::chain(bodies);
  int checked = 0;
  for (auto const& entry : oracles("rigid_body_step")) {
    RigidBody const body(tensor(decimals(entry.at("Iinv"))));
    Start const start{lattice, repeated(decimals(entry.at("m")), bodies),
                      repeated(decimals(entry.at("m_prev")), bodies), entry.at("h")};
    auto const expect = [&](std::string const& method, std::vector<double> const& expected) {
      auto const found = with_body_method(
          method, body, entry.at("sigma_const"), typename TypeParam::Spins("like", lattice),
          [&](auto stepper, auto const& of) {
            return step_once<typename TypeParam::Exec>(stepper, of, start);
          });
      for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_NEAR(found[i], expected[i % 3], step_tolerance<Real>)
            << entry.at("tag") << ", " << method << ", number " << i;
      ++checked;
      return found;
    };
    for (auto const& [method, step] : entry.at("steps").items()) {
      auto const expected = decimals(step.at("m1"));
      auto const found = expect(method, expected);
      if (method == "euler_cor_analytic")
        expect_same(expect("euler_cor_connection", expected), found, 8 * epsilon<Real>,
                    entry.at("tag"));
    }
  }
  EXPECT_EQ(checked, 11 * (28 + 1) - 2);
}

TYPED_TEST(RigidBodyOracles, GeneratorAndEnergy) {
  using Real = typename TypeParam::Real;
  typename TypeParam::Exec const exec;
  auto const lattice = Lattice::chain(bodies);
  for (auto const& entry : oracles("rigid_body_step")) {
    RigidBody const body(tensor(decimals(entry.at("Iinv"))));
    auto const spins =
        spins_of<typename TypeParam::Spins>(lattice, repeated(decimals(entry.at("m")), bodies));
    auto const expected = decimals(entry.at("A"));
    auto const found = evaluated(exec, body, spins);
    double const size =
        std::max({1.0, std::abs(expected[0]), std::abs(expected[1]), std::abs(expected[2])});
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_NEAR(found[i], expected[i % 3], 4 * epsilon<Real> * size) << entry.at("tag");
    double const one = static_cast<double>(decimal(entry.at("energy")));
    EXPECT_NEAR(energy(exec, body, spins).value, bodies * one,
                8 * epsilon<Real> * bodies * std::max(1.0, one))
        << entry.at("tag");
  }
}

// Motions of up to ten units of time, far from equilibria, where errors of steps add up only
// linearly.
TYPED_TEST(RigidBodyOracles, Trajectories) {
  using Real = typename TypeParam::Real;
  using Spins = typename TypeParam::Spins;
  typename TypeParam::Exec const exec;
  for (auto const& entry : oracles("rigid_body_trajectory")) {
    std::string const method = entry.at("method");
    RigidBody const body(inverse(decimals(entry.at("inertia"))));
    auto spins = spins_of<Spins>(Lattice::chain(1), decimals(entry.at("m0")));
    std::vector<Sample> samples;
    with_body_method(method, body, 0, spins, [&](auto stepper, auto const& generator) {
      integrate(exec, stepper, generator, spins, Times{0, entry.at("h"), entry.at("n")},
                Record(body, samples));
    });
    ASSERT_EQ(samples.size(), entry.at("n").get<std::size_t>() + 1) << method;

    auto const expected = decimals(entry.at("m_n")), found = numbers_of(spins);
    double energy_error = 0;
    for (auto const& sample : samples)
      energy_error = larger(energy_error, std::abs(sample.energy.value - samples[0].energy.value));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(found[c], expected[c], step_tolerance<Real>) << method << ", component " << c;
    EXPECT_NEAR(energy_error, static_cast<double>(decimal(entry.at("max_abs_energy_error"))),
                step_tolerance<Real>)
        << method;
  }
}

}  // namespace
}  // namespace cayspin::test
