// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/isotropy/policies.hpp>
#include <cayspin/stepper/methods.hpp>
#include <cayspin/stepper/rate.hpp>
#include <cayspin/stepper/stepper_base.hpp>
#include <cayspin/stepper/two_point.hpp>

// Geometric Euler with a sigma that makes its energy error one order smaller.
namespace cayspin::inline v0_1 {

/// With sigma from a forward difference; energy error of order 2, two evaluations.
template <class Spins, class Rotation>
class LieEuler<Spins, isotropy::FiniteDifference, Rotation>
    : public TwoPoint<Spins, detail::ForwardDifferenceMethod, isotropy::Zero, Rotation> {
 public:
  explicit LieEuler(Spins const& like, isotropy::FiniteDifference isotropy = {}, Rotation = {})
      : LieEuler::TwoPoint("LieEuler", like, {isotropy.cap}) {}
};

/// With sigma from a backward difference; energy error of order 2, one evaluation.
template <class Spins, class Rotation>
class LieEuler<Spins, isotropy::FiniteDifferenceBackward, Rotation>
    : public TwoPoint<Spins, detail::BackwardDifferenceMethod, isotropy::Zero, Rotation> {
 public:
  explicit LieEuler(Spins const& like, isotropy::FiniteDifferenceBackward isotropy = {},
                    Rotation = {})
      : LieEuler::TwoPoint("LieEuler", like, {{isotropy.cap}}) {}
};

/// With sigma from the generator's derivative; energy error of order 2, one evaluation and one of
/// the field's linear part.
template <class Spins, class Rotation, class Isotropy>
  requires(std::same_as<Isotropy, isotropy::Analytic> ||
           std::same_as<Isotropy, isotropy::Connection>)
class LieEuler<Spins, Isotropy, Rotation> : public detail::StepperBase<Spins> {
 public:
  using typename detail::StepperBase<Spins>::Real;
  static constexpr int order = 1;
  static constexpr int evaluations = 2;
  static constexpr int ghosts = 2;
  static constexpr int work_fields = 2;  // 4 numbers per site: rates, and one number

  explicit LieEuler(Spins const& like, Isotropy isotropy = {}, Rotation = {})
      : LieEuler::StepperBase("LieEuler", like.lattice(), ghosts),
        isotropy_(isotropy),
        rates_("LieEuler", like.lattice()) {}

  std::size_t work_bytes() const { return rates_.bytes(); }

  /// Advances `spins` from t to t + dt under `generator`, which has the members rate (A' along the
  /// flow) and, where its derivative depends on t, prepare_rate.
  /// Throws std::invalid_argument when `spins` is not of the lattice given at construction.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    auto const region = this->begin_step(exec, spins);
    rates_.compute(exec, rates_label_, generator, spins, t);
    auto prepared = detail::bare(detail::prepare_rate(generator, exec, rates_.field(), t, dt));
    using Kernel = detail::CorrectedEulerStage<Isotropy, Rotation, decltype(prepared), Real>;
    Kernel const kernel{std::move(prepared), isotropy_,           rates_.array(),
                        rates_.along(),      spins.output(false), static_cast<Real>(dt)};
    detail::for_each_site<Real>(exec, rotate_label_, spins.layout(), kernel, spins.layout().own);
    detail::update_ghosts(exec, this->lattice_, spins);
  }

 private:
  std::string rates_label_ = this->label("::rates"), rotate_label_ = this->label("::rotate");
  Isotropy isotropy_;
  detail::Rates<Spins> rates_;
};

}  // namespace cayspin::inline v0_1
