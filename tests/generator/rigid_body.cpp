// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A and the energy of rigid bodies: principal axes, full tensors, one tensor for each body.
#include "../support/evaluate.hpp"

#include <cayspin/cayspin.hpp>

#include <limits>
#include <stdexcept>

namespace cayspin::test {
namespace {

constexpr std::int64_t bodies = 21;

// Row by row, as a matrix.
Vec3<double> times(SymmetricTensor const& b, Vec3<double> const& m) {
  double const matrix[3][3] = {{b[0], b[3], b[4]}, {b[3], b[1], b[5]}, {b[4], b[5], b[2]}};
  double const in[3] = {m.x, m.y, m.z};
  double out[3] = {0, 0, 0};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[i] += matrix[i][j] * in[j];
  return {out[0], out[1], out[2]};
}

// Exact in float too.
SymmetricTensor body_tensor(std::int64_t body) {
  double const b = static_cast<double>(body);
  return {1 + b / 16, 2 - b / 32, 0.5 + b / 8, 0.25 - b / 64, -0.125 + b / 128, 0.375 - b / 16};
}

template <class Backend>
class RigidBodies : public ::testing::Test {
 protected:
  using Real = typename Backend::Real;
  using Spins = typename Backend::Spins;
  using Tensors = SiteField<Real, 6, typename Backend::MemorySpace>;

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
      EXPECT_NEAR(found.x, -expected.x, 8 * epsilon<Real>) << body;
      EXPECT_NEAR(found.y, -expected.y, 8 * epsilon<Real>) << body;
      EXPECT_NEAR(found.z, -expected.z, 8 * epsilon<Real>) << body;
      EXPECT_NEAR(dot(at(across, body), spin), 0, 16 * epsilon<Real>) << body;
      // m' = m x I^-1 m
      auto const rate = cross(found, spin), euler = cross(spin, expected);
      EXPECT_NEAR(rate.x, euler.x, 16 * epsilon<Real>) << body;
      EXPECT_NEAR(rate.y, euler.y, 16 * epsilon<Real>) << body;
      EXPECT_NEAR(rate.z, euler.z, 16 * epsilon<Real>) << body;
      sum += 0.5 * dot(spin, expected);
    }
    EXPECT_NEAR(energy(exec, generator, spins).value, sum, 64 * epsilon<double> * bodies);
    EXPECT_NEAR(energy(exec, orthogonal(generator), spins).value, sum,
                64 * epsilon<double> * bodies);
  }

  static Tensors tensors(Lattice const& lattice) {
    std::vector<double> numbers;
    for (std::int64_t body = 0; body < lattice.sites(); ++body)
      for (double const entry : body_tensor(body)) numbers.push_back(entry);
    Tensors const field("tensors", lattice);
    copy_from_host(numbers, field);
    return field;
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
  this->check(RigidBodyEnsemble(this->tensors(Lattice::chain(bodies))), body_tensor);
}

// Three numbers per body in place of six, three of them zero: the same motion.
TYPED_TEST(RigidBodies, EachBodyItsOwnMoments) {
  using Real = typename TypeParam::Real;
  using Spins = typename TypeParam::Spins;
  auto const lattice = Lattice::chain(bodies);
  auto const diagonal_part = [](std::int64_t body) {
    auto const b = body_tensor(body);
    return SymmetricTensor{b[0], b[1], b[2], 0, 0, 0};
  };
  SiteField<Real, 3, typename TypeParam::MemorySpace> const moments("moments", lattice);
  typename TestFixture::Tensors const tensors("tensors", lattice);
  std::vector<double> three, six;
  for (std::int64_t body = 0; body < bodies; ++body) {
    auto const b = diagonal_part(body);
    three.insert(three.end(), b.begin(), b.begin() + 3);
    six.insert(six.end(), b.begin(), b.end());
  }
  copy_from_host(three, moments);
  copy_from_host(six, tensors);
  RigidBodyEnsemble const ensemble(moments);
  this->check(ensemble, diagonal_part);
  auto one = spins_of<Spins>(lattice, this->m), other = spins_of<Spins>(lattice, this->m);
  Rkmk4 stepper(one);
  stepper.step(this->exec, ensemble, one, 0, 0.25);
  stepper.step(this->exec, RigidBodyEnsemble(tensors), other, 0, 0.25);
  EXPECT_EQ(copy_to_host(one), copy_to_host(other));
}

// An ensemble of equal bodies steps as the uniform generator does.
TYPED_TEST(RigidBodies, EqualBodiesStepAlike) {
  using Spins = typename TypeParam::Spins;
  auto const lattice = Lattice::chain(bodies);
  typename TestFixture::Tensors const same("same", lattice);
  std::vector<double> numbers;
  for (std::int64_t body = 0; body < bodies; ++body)
    for (double const entry : body_tensor(3)) numbers.push_back(entry);
  copy_from_host(numbers, same);
  auto one = spins_of<Spins>(lattice, this->m), other = spins_of<Spins>(lattice, this->m);
  Rkmk4 stepper(one);
  stepper.step(this->exec, RigidBody(body_tensor(3)), one, 0, 0.25);
  stepper.step(this->exec, RigidBodyEnsemble(same), other, 0, 0.25);
  EXPECT_EQ(copy_to_host(one), copy_to_host(other));
}

TYPED_TEST(RigidBodies, WhatIsRefused) {
  double const infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(RigidBody({1, 1, 1, 0, infinity, 0}), std::invalid_argument);
  EXPECT_THROW(RigidBody::principal(1, 0, 1), std::invalid_argument);
  RigidBodyEnsemble const fewer(this->tensors(Lattice::chain(bodies - 1)));
  EXPECT_THROW(energy(this->exec, fewer, this->spins), std::invalid_argument);
}

}  // namespace
}  // namespace cayspin::test
