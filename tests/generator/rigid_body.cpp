// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The generator A and the energy of rigid bodies: principal axes, full tensors, one tensor for each
// body.
#include "../support/evaluate.hpp"

#include <cayspin/cayspin.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace cayspin::test {
namespace {

constexpr std::int64_t bodies = 21;

// Returns b * m, from the full matrix of b.
Vec3<double> times(SymmetricTensor const& b, Vec3<double> const& m) {
  double const matrix[3][3] = {{b[0], b[3], b[4]}, {b[3], b[1], b[5]}, {b[4], b[5], b[2]}};
  double const in[3] = {m.x, m.y, m.z};
  double out[3] = {0, 0, 0};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[i] += matrix[i][j] * in[j];
  return {out[0], out[1], out[2]};
}

// Returns a tensor whose numbers are exact in float, too.
SymmetricTensor body_tensor(std::int64_t body) {
  double const b = static_cast<double>(body);
  return {1 + b / 16, 2 - b / 32, 0.5 + b / 8, 0.25 - b / 64, -0.125 + b / 128, 0.375 - b / 16};
}

template <class Backend>
class RigidBodies : public ::testing::Test {
 protected:
  using Real = typename Backend::Real;
  using Spins = typename Backend::Spins;

  Spins spins = spins_of<Spins>(Lattice::chain(bodies), random_directions(bodies, 41));
  std::vector<double> m = numbers_of(spins);
  typename Backend::Exec exec;

  template <class Generator, class TensorOf>
  void check(Generator const& generator, TensorOf const& tensor_of) const {
    auto const a = evaluated(exec, generator, spins);
    auto const across = evaluated(exec, orthogonal(generator), spins);
    double sum = 0;
    for (std::int64_t body = 0; body < bodies; ++body) {
      auto const spin = at(m, body), expected = times(tensor_of(body), spin);
      auto const found = at(a, body);
      SCOPED_TRACE(body);
      expect_near(found, -1 * expected, 8 * epsilon<Real>);
      EXPECT_NEAR(dot(at(across, body), spin), 0, 16 * epsilon<Real>);
      // m' = m x I^-1 m
      expect_near(cross(found, spin), cross(spin, expected), 16 * epsilon<Real>);
      sum += 0.5 * dot(spin, expected);
    }
    EXPECT_NEAR(energy(exec, generator, spins).value, sum, 64 * epsilon<double> * bodies);
    EXPECT_NEAR(energy(exec, orthogonal(generator), spins).value, sum,
                64 * epsilon<double> * bodies);
  }

  /// Returns an ensemble with the first numbers of each body's tensor: all six, or the diagonal's
  /// three.
  template <int Components = 6, class TensorOf>
  static auto ensemble(TensorOf const& tensor_of) {
    std::vector<double> numbers;
    for (std::int64_t body = 0; body < bodies; ++body) {
      auto const tensor = tensor_of(body);
      numbers.insert(numbers.end(), tensor.begin(), tensor.begin() + Components);
    }
    SiteField<Real, Components, typename Backend::MemorySpace> const field("tensors",
                                                                           Lattice::chain(bodies));
    copy_from_host(numbers, field);
    return RigidBodyEnsemble(field);
  }

  /// Expects steps with the two generators to give bitwise identical spins.
  template <class One, class Other>
  void expect_same_step(One const& one, Other const& other) const {
    auto const after = [&](auto const& generator) {
      auto turned = spins_of<Spins>(spins.lattice(), m);
      Rkmk4(turned).step(exec, generator, turned, 0, 0.25);
      return copy_to_host(turned);
    };
    EXPECT_EQ(after(one), after(other));
  }
};
TYPED_TEST_SUITE(RigidBodies, Backends, BackendName);

TYPED_TEST(RigidBodies, PrincipalMoments) {
  this->check(RigidBody::principal(0.5, 2, 4),
              [](std::int64_t) { return SymmetricTensor{2, 0.5, 0.25, 0, 0, 0}; });
}

TYPED_TEST(RigidBodies, FullTensor) {
  this->check(RigidBody(body_tensor(5)), [](std::int64_t) { return body_tensor(5); });
}

TYPED_TEST(RigidBodies, EachBodyItsOwnTensor) {
  this->check(this->ensemble(body_tensor), body_tensor);
}

// Bodies given by three numbers move exactly like bodies given by six numbers, three of them zero.
TYPED_TEST(RigidBodies, EachBodyItsOwnMoments) {
  auto const diagonal_part = [](std::int64_t body) {
    auto const b = body_tensor(body);
    return SymmetricTensor{b[0], b[1], b[2], 0, 0, 0};
  };
  auto const of_moments = this->template ensemble<3>(diagonal_part);
  this->check(of_moments, diagonal_part);
  this->expect_same_step(of_moments, this->ensemble(diagonal_part));
}

// An ensemble of equal bodies steps like the uniform generator.
TYPED_TEST(RigidBodies, EqualBodiesStepAlike) {
  this->expect_same_step(RigidBody(body_tensor(3)),
                         this->ensemble([](std::int64_t) { return body_tensor(3); }));
}

TYPED_TEST(RigidBodies, WhatIsRefused) {
  double const infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(RigidBody({1, 1, 1, 0, infinity, 0}), std::invalid_argument);
  EXPECT_THROW(RigidBody::principal(1, 0, 1), std::invalid_argument);
  for (double const wrong : {infinity, std::nan("")})
    for (std::size_t entry = 0; entry < 6; ++entry) {
      auto const one_is_wrong = [&](std::int64_t body) {
        auto tensor = body_tensor(body);
        if (body == bodies - 1) tensor[entry] = wrong;
        return tensor;
      };
      EXPECT_THROW(this->ensemble(one_is_wrong), std::invalid_argument);
      if (entry < 3) {
        EXPECT_THROW(this->template ensemble<3>(one_is_wrong), std::invalid_argument);
      }
    }
}

}  // namespace
}  // namespace cayspin::test
