// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/minimizer/pairs.hpp>
#include <cayspin/minimizer/preconditioner.hpp>
#include <cayspin/minimizer/trial.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>

namespace cayspin::inline v0_2::detail {

/// L-BFGS with a preconditioner as the first approximation of the inverse Hessian (Nocedal and
/// Wright 2006, Alg. 7.4).
template <class Spins>
class Lbfgs {
  using Real = typename Spins::value_type;
  using Mobile = ScalarField<Real, typename Spins::memory_space>;

 public:
  Lbfgs(std::string const& name, Lattice const& lattice)
      : pairs_(name, lattice),
        changes_left_(name + "::changes_left", lattice),
        preconditioned_(name + "::preconditioned", lattice) {}

  /// g.d with the gradient g and the direction d, and the largest |d| of a spin.
  struct Direction {
    double slope, longest;
  };

  Pairs<Spins>& pairs() { return pairs_; }
  Preconditioner<Spins>& preconditioner() { return preconditioner_; }
  double first_shift() const { return preconditioner_.first_shift(); }
  /// Memory that `find` overwrites.
  Spins const& scratch() const { return preconditioned_; }

  /// Stores the pair of a step if the curvature along the step is clearly positive.
  void remember(PointOnPath const& there) {
    if (!(there.curvature > 1e-12 * std::sqrt(there.step_square * there.change_square))) return;
    pairs_.keep(there.curvature);
    step_square_ = there.step_square;
  }

  /// Writes search.direction from the gradient in `search` and the stored pairs. `torque`: the
  /// largest gradient of a spin.
  template <class Exec>
  Direction find(Exec const& exec, Spins const& spins, Mobile const& is_mobile,
                 SearchArrays<Spins> const& search, double torque) {
    using Products = ProductsOfPairs<Real>;
    std::size_t const count = pairs_.count();
    auto const count_of_kernel = static_cast<int>(count);
    auto const m = spins.array(), gradient = search.gradient.array();
    auto const steps = pairs_.steps(), changes = pairs_.changes();
    auto const& [x, y, z] = preconditioner_.couplings();
    std::array<double, Products::count_of_values> p{};
    if (count > 0) {
      p = reduce_sites<Sum, Products::count_of_values>(
          exec, "cayspin::minimize::products", spins.layout(),
          Products{m, gradient, steps, changes, count_of_kernel, {x, y, z}});
      preconditioner_.follow_curvature(pairs_.product(count - 1), p.back(), step_square_, torque);
    }

    OfPairs<double> alpha{}, weights{};
    OfPairs<Real> alpha_of_kernel{};
    for (std::size_t i = count; i-- > 0;) {
      double sum = p[i];
      for (std::size_t j = i + 1; j < count; ++j) sum -= alpha[j] * p[Products::of(i, j)];
      alpha[i] = sum / pairs_.product(i);
      alpha_of_kernel[i] = static_cast<Real>(alpha[i]);
    }
    for_each_site<Real>(exec, "cayspin::minimize::without_changes", spins.layout(),
                        WithoutChanges<Real>{m, gradient, changes, alpha_of_kernel, count_of_kernel,
                                             changes_left_.output(false)});

    double const scale = count > 0 ? scale_of_preconditioner(exec, spins) : 1;
    preconditioner_.apply(exec, changes_left_, preconditioned_);
    if (count > 0) {
      auto const along = products_with_changes(exec, spins);
      for (std::size_t i = 0; i < count; ++i) {
        double beta = scale * along[i];
        for (std::size_t j = 0; j < i; ++j) beta += weights[j] * p[Products::of(j, i)];
        weights[i] = alpha[i] - beta / pairs_.product(i);
      }
    }
    auto const [slope, square] = reduce_sites<SumsThenMaxima<1>, 2>(
        exec, "cayspin::minimize::direction", spins.layout(),
        DirectionWithSteps<Real>{m, gradient, preconditioned_.array(), is_mobile.array(), steps,
                                 weights, scale, count_of_kernel, search.direction.array()});
    return {slope, std::sqrt(square)};
  }

 private:
  template <class Exec>
  auto products_with_changes(Exec const& exec, Spins const& spins) const {
    return reduce_sites<Sum, static_cast<int>(pairs_kept)>(
        exec, "cayspin::minimize::products_with_changes", spins.layout(),
        ProductsWithChanges<Real>{spins.array(), preconditioned_.array(), pairs_.changes(),
                                  static_cast<int>(pairs_.count())});
  }

  /// Returns the factor by which the preconditioner P is multiplied: s.y / (y.P y), with the step s
  /// and the gradient change y of the last pair; 1 if this ratio is not a positive number.
  template <class Exec>
  double scale_of_preconditioner(Exec const& exec, Spins const& spins) {
    std::size_t const last = pairs_.count() - 1;
    preconditioner_.apply(exec, pairs_.change(last), preconditioned_);
    double const along = products_with_changes(exec, spins)[last];
    double const scale = pairs_.product(last) / along;
    return along > 0 && std::isfinite(scale) ? scale : 1;
  }

  Pairs<Spins> pairs_;
  Preconditioner<Spins> preconditioner_;
  Spins changes_left_, preconditioned_;
  double step_square_ = 1;
};

}  // namespace cayspin::inline v0_2::detail
