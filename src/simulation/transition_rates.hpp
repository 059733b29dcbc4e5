// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/path.hpp"
#include "io/scene.hpp"
#include "tangent_basis.hpp"

#include <cayspin/evaluate.hpp>
#include <cayspin/minimizer/hessian.hpp>
#include <cayspin/spin_field.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <type_traits>
#include <vector>

namespace cayspin::simulation {

/// An equilibrium and the Hessian of its energy.
struct StateHessian : TangentBasis {
  std::vector<double> numbers;  // matrix elements, row by row
  double torque = 0;            // max |m x (-dE/dm)|
  /// Sums of m x (-dE/dm) in states far from the equilibrium. The components of the sums along an
  /// axis vanish if turning all mobile spins about this axis does not change the energy.
  std::vector<std::array<double, 3>> torques;
  double torque_scale = 0;  // sum of |m x (-dE/dm)| over all spins of these states

  using TangentBasis::TangentBasis;

  /// Sets `torque`. `field`: -dE/dm at the equilibrium.
  void set_torque(std::vector<double> const& field);
  /// Returns the spins after a random rotation, common to all that are not frozen, and a random
  /// change of each of these. `sample`: the seed of the random numbers.
  std::vector<double> far_state(unsigned sample) const;
  /// Appends the torque of a state, and adds to `torque_scale`. `field`: -dE/dm there.
  void add_torque(std::vector<double> const& state, std::vector<double> const& field);
};

/// Returns the prefactors of harmonic transition state theory and of Langer's theory, in the units
/// of the scene. `saddle_curvature`: the approximate curvature along the unstable mode of the
/// saddle. Calls poll() before each factorisation; it may throw to interrupt the work. Throws
/// NumbersFailed for zero modes that are neither translations nor rotations of all spins, for a
/// saddle on a plateau, for states with other negative curvatures, and for spins with neither
/// precession nor damping.
io::RatesOfPath rates_between(
    io::Scene const& scene, StateHessian const& start, StateHessian const& saddle,
    StateHessian const& end, double saddle_curvature, std::function<void()> const& poll = [] {});

/// Computes the Hessian and the torques of a state. The Hessian is computed one column at a time,
/// as its product with a vector. Calls poll() before each column; poll() may throw to interrupt the
/// work.
template <class Exec, class Field, class Spins>
StateHessian hessian_of(Exec const& exec, Field const& field, Spins const& spins,
                        std::vector<unsigned char> const& frozen,
                        std::function<void()> const& poll) {
  static_assert(std::is_same_v<typename Spins::value_type, double>,
                "cayspin: rates need Hessians in double precision");
  auto const& lattice = spins.lattice();
  auto const numbers = copy_to_host(spins);
  StateHessian state({numbers.begin(), numbers.end()}, frozen);
  ScalarField<double, typename Spins::memory_space> const is_mobile("rates::is_mobile", lattice,
                                                                    1.0);
  auto const fields = cayspin::detail::numbered_fields<Spins, 5>("rates", lattice);
  auto const &vector = fields[0], &product = fields[1];
  cayspin::detail::Hessian hessian(
      exec, field, 0, spins, is_mobile,
      cayspin::detail::HessianArrays<Spins>{fields[2], fields[3], fields[4]},
      cayspin::detail::HessianDifferences::of_four);
  auto const at_rest = copy_to_host(fields[3]);
  state.set_torque({at_rest.begin(), at_rest.end()});
  std::size_t const n = state.size();
  state.numbers.resize(n * n);
  std::vector<double> given(numbers.size());
  for (std::size_t column = 0; column < n; ++column) {
    poll();
    auto const at = 3 * state.sites[column / 2];
    for (std::size_t c = 0; c < 3; ++c) given[at + c] = state.vector(column)[c];
    copy_from_host(given, vector);
    hessian.multiply(vector, product);
    auto const found = copy_to_host(product);
    for (std::size_t row = 0; row < n; ++row) {
      auto const* const of_site = &found[3 * state.sites[row / 2]];
      auto const* const v = state.vector(row);
      state.numbers[row * n + column] = of_site[0] * v[0] + of_site[1] * v[1] + of_site[2] * v[2];
    }
    for (std::size_t c = 0; c < 3; ++c) given[at + c] = 0;
  }
  for (unsigned sample = 0; sample < 8; ++sample) {
    auto const far = state.far_state(sample);
    copy_from_host(far, vector);
    evaluate_field(exec, field, vector, 0, product);
    auto const found = copy_to_host(product);
    state.add_torque(far, {found.begin(), found.end()});
  }
  return state;
}

template <class Exec, class Field, class Spins>
io::RatesOfPath rates_of(io::Scene const& scene, Exec const& exec, Field const& field,
                         Spins const& start, Spins const& saddle, Spins const& end,
                         double saddle_curvature, std::function<void()> const& poll) {
  auto const frozen = io::frozen(scene, {{0, 0, 0}, scene.lattice.shape});
  return rates_between(scene, hessian_of(exec, field, start, frozen, poll),
                       hessian_of(exec, field, saddle, frozen, poll),
                       hessian_of(exec, field, end, frozen, poll), saddle_curvature, poll);
}

}  // namespace cayspin::simulation
