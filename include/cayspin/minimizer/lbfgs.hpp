// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/minimizer/pairs.hpp>
#include <cayspin/minimizer/preconditioner.hpp>
#include <cayspin/minimizer/trial.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

namespace cayspin::inline v0_1::detail {

/// L-BFGS with a preconditioner as the first approximation (Nocedal and Wright 2006, Alg. 7.4).
template <class Spins>
class Lbfgs {
  using Real = typename Spins::value_type;
  using Moves = ScalarField<Real, typename Spins::memory_space>;

 public:
  Lbfgs(std::string const& name, Lattice const& lattice)
      : pairs_(name, lattice),
        changes_left_(name + "::changes_left", lattice),
        preconditioned_(name + "::preconditioned", lattice) {}

  /// g.d and the largest |d| of a spin.
  struct Direction {
    double slope, longest;
  };

  Pairs<Spins>& pairs() { return pairs_; }
  Preconditioner<Spins>& preconditioner() { return preconditioner_; }
  /// Memory that `find` overwrites.
  Spins const& room() const { return preconditioned_; }

  /// Keeps the pair of a step, unless the energy's curvature along it is not clearly positive.
  void remember(PointOnPath const& there) {
    if (!(there.curvature > 1e-12 * std::sqrt(there.step_square * there.change_square))) return;
    pairs_.keep(there.curvature);
    step_square_ = there.step_square;
  }

  /// Writes search.direction, from the gradient in `search`, the largest of which is `torque`, and
  /// what is remembered.
  template <class Exec>
  Direction find(Exec const& exec, Spins const& spins, Moves const& moves,
                 SearchArrays<Spins> const& search, double torque) {
    using Products = ProductsOfPairs<Real>;
    int const count = static_cast<int>(pairs_.count());
    Products products{};
    products.spins = spins.array();
    products.gradient = search.gradient.array();
    products.count = count;
    std::copy_n(preconditioner_.couplings().begin(), 3, products.couplings);
    pairs_.arrays(products.steps, products.changes);
    std::array<double, Products::count_of_values> p{};
    if (count > 0)
      p = reduce_sites<Sum, Products::count_of_values>(exec, "cayspin::minimize::products",
                                                       spins.layout(), products);
    auto const at = [&](int i) { return p[static_cast<std::size_t>(i)]; };
    auto const product = [&](int i) { return pairs_.product(static_cast<std::size_t>(i)); };
    if (count > 0)
      preconditioner_.follow_curvature(product(count - 1), p.back(), step_square_, torque);

    std::array<double, pairs_kept> alpha{}, weights{};
    auto const index = [](int i) { return static_cast<std::size_t>(i); };
    for (int i = count; i-- > 0;) {
      double sum = at(i);
      for (int j = i + 1; j < count; ++j) sum -= alpha[index(j)] * at(Products::of(i, j));
      alpha[index(i)] = sum / product(i);
    }
    WithoutChanges<Real> without{};
    without.spins = spins.array();
    without.gradient = search.gradient.array();
    without.count = count;
    without.output = changes_left_.output(false);
    for (std::size_t i = 0; i < pairs_kept; ++i) {
      without.changes[i] = products.changes[i];
      without.weights[i] = static_cast<Real>(alpha[i]);
    }
    for_each_site<Real>(exec, "cayspin::minimize::without_changes", spins.layout(), without);

    double const scale = count > 0 ? scale_of_preconditioner(exec, spins, products) : 1;
    preconditioner_.apply(exec, changes_left_, preconditioned_);
    std::array<double, pairs_kept> along{};
    if (count > 0) along = products_with_changes(exec, spins, preconditioned_, products);
    for (int i = 0; i < count; ++i) {
      double beta = scale * along[index(i)];
      for (int j = 0; j < i; ++j) beta += weights[index(j)] * at(Products::of(j, i));
      weights[index(i)] = alpha[index(i)] - beta / product(i);
    }
    return combine(exec, spins, moves, search, scale, weights, products);
  }

 private:
  template <class Exec>
  Direction combine(Exec const& exec, Spins const& spins, Moves const& moves,
                    SearchArrays<Spins> const& search, double scale,
                    std::array<double, pairs_kept> const& weights,
                    ProductsOfPairs<Real> const& products) const {
    DirectionWithSteps<Real> with{};
    with.spins = spins.array();
    with.gradient = search.gradient.array();
    with.vectors = preconditioned_.array();
    with.moves = moves.array();
    with.scale = scale;
    with.count = products.count;
    with.direction = search.direction.array();
    for (std::size_t i = 0; i < pairs_kept; ++i) {
      with.steps[i] = products.steps[i];
      with.weights[i] = weights[i];
    }
    auto const [slope, square] = reduce_sites<SumsThenMaxima<1>, 2>(
        exec, "cayspin::minimize::direction", spins.layout(), with);
    return {slope, std::sqrt(square)};
  }

  template <class Exec>
  std::array<double, pairs_kept> products_with_changes(Exec const& exec, Spins const& spins,
                                                       Spins const& vectors,
                                                       ProductsOfPairs<Real> const& products) {
    ProductsWithChanges<Real> kernel{};
    kernel.spins = spins.array();
    kernel.vectors = vectors.array();
    kernel.count = products.count;
    std::copy_n(products.changes, pairs_kept, kernel.changes);
    return reduce_sites<Sum, static_cast<int>(pairs_kept)>(
        exec, "cayspin::minimize::products_with_changes", spins.layout(), kernel);
  }

  /// s.y / y.P y of the last pair.
  template <class Exec>
  double scale_of_preconditioner(Exec const& exec, Spins const& spins,
                                 ProductsOfPairs<Real> const& products) {
    std::size_t const last = pairs_.count() - 1;
    preconditioner_.apply(exec, pairs_.change(last), preconditioned_);
    double const along = products_with_changes(exec, spins, preconditioned_, products)[last];
    double const scale = pairs_.product(last) / along;
    return along > 0 && std::isfinite(scale) ? scale : 1;
  }

  Pairs<Spins> pairs_;
  Preconditioner<Spins> preconditioner_;
  Spins changes_left_, preconditioned_;
  double step_square_ = 1;
};

}  // namespace cayspin::inline v0_1::detail
