// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/field/local_part.hpp>
#include <cayspin/isotropy/policies.hpp>
#include <cayspin/stepper/series4_stage.hpp>
#include <cayspin/stepper/stepper_base.hpp>

#include <array>
#include <cstddef>

namespace cayspin::inline v0_1 {

/// The symbolic series of order 4 in Cayley coordinates:
/// F = dt a + dt^2 a_1/2 + dt^3 (2 a_2 + |a|^2 a + a_1 x a)/12
///   + dt^4 (a_3 + |a|^2 a_1 + a_2 x a + 2 <a_1, a> a)/24, a_k = d^k A / dt^k on the exact flow,
/// by recurrence. Rigid bodies take one kernel. Landau-Lifshitz takes four, with a field that is
/// affine in the spins and does not depend on t. isotropy::Energy is for rigid bodies only.
/// Lewis and Nigam 2002, Sec. 4.4 and 5.3.
template <class Spins, class Isotropy = isotropy::Zero, class Series = detail::DirectSeries>
class Series4 : public detail::StepperBase<Spins> {
  static_assert(std::is_same_v<Isotropy, isotropy::Zero> ||
                    std::is_same_v<Isotropy, isotropy::Energy>,
                "Series4 takes isotropy::Zero, or Energy for rigid bodies.");

 public:
  using typename detail::StepperBase<Spins>::Real;
  static constexpr int order = 4;
  static constexpr int evaluations = 4;
  static constexpr int ghosts = 4;
  static constexpr int work_fields = 7;  // 1 for rigid bodies: the others are made when first used

  explicit Series4(Spins const& like, Isotropy = {})
      : Series4::StepperBase("Series4", like.lattice(), ghosts),
        next_("Series4::next", like.lattice()) {}

  std::size_t work_bytes() const {
    return next_.bytes() * (derivatives_[0].sites() == 0 ? 1 : work_fields);
  }

  /// Advances `spins` from t to t + dt under `generator`; exchanges their memory with its own, so
  /// take arrays of `spins` again after a step.
  /// Throws std::invalid_argument when `spins` is not of the lattice given at construction.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    static_assert(!detail::depends_on_time<Generator>, "Series4 refuses fields that depend on t.");
    auto const region = this->begin_step(exec, spins);
    this->require_other_memory(spins, next_);
    auto const prepared = detail::prepare_term(generator, exec, spins, t);
    if constexpr (detail::is_local<std::remove_const_t<decltype(prepared)>>) {
      using Kernel =
          detail::LocalSeriesStage<Series, Isotropy, std::remove_const_t<decltype(prepared)>, Real>;
      detail::for_each_site<Real>(
          exec, step_label_, spins.layout(),
          Kernel{prepared, spins.array(), next_.output(false), static_cast<Real>(dt)});
    } else {
      static_assert(std::is_same_v<Isotropy, isotropy::Zero>,
                    "isotropy::Energy knows rigid bodies alone; for other generators there is "
                    "EnergyProjection.");
      allocate(spins.lattice());
      stage<0>(exec, generator, spins, t, dt);
    }
    swap(spins, next_);
    detail::update_ghosts(exec, this->lattice_, spins);
  }

 private:
  void allocate(Lattice const& lattice) {
    if (derivatives_[0].sites() != 0) return;
    for (std::size_t k = 0; k < derivatives_.size(); ++k) {
      derivatives_[k] = Spins("Series4::spins_" + std::to_string(k + 1), lattice);
      sources_[k] = Spins("Series4::source_" + std::to_string(k), lattice);
    }
  }

  template <int K>
  Spins const& derivative(Spins const& spins) const {
    if constexpr (K == 0)
      return spins;
    else
      return derivatives_[K - 1];
  }

  template <int K, class Exec, class Generator>
  void stage(Exec const& exec, Generator const& generator, Spins const& spins, double t,
             double dt) {
    auto prepared = detail::prepare_term(generator, exec, derivative<K>(spins), t);
    detail::SeriesStage<Series, K, decltype(prepared), Real> kernel{
        std::move(prepared), {}, {}, next_.output(false), static_cast<Real>(dt)};
    detail::unrolled<K + 1>([&](auto k) {
      kernel.spins[k()] = derivative<k()>(spins).array();
      if constexpr (k() < 3) kernel.sources[k()] = sources_[k()].output(false);
    });
    if constexpr (K < 3) kernel.next = derivatives_[K].output(false);
    detail::for_each_site<Real>(exec, labels_[K], spins.layout(), kernel,
                                spins.layout().own_and(3 - K));
    if constexpr (K < 3) stage<K + 1>(exec, generator, spins, t, dt);
  }

  std::string step_label_ = this->label("::step");
  std::array<std::string, 4> labels_{this->label("::derivative_1"), this->label("::derivative_2"),
                                     this->label("::derivative_3"), this->label("::rotate")};
  Spins next_;
  std::array<Spins, 3> derivatives_, sources_;
};

/// The orthogonal series as the paper prints it, from the derivatives of A_o. It drops the part of
/// the generator along m. Also valid and of order 4, with a larger energy error than Series4.
template <class Spins, class Isotropy = isotropy::Zero>
class Series4Paper : public Series4<Spins, Isotropy, detail::PaperSeries> {
 public:
  explicit Series4Paper(Spins const& like, Isotropy isotropy = {})
      : Series4Paper::Series4(like, isotropy) {}
};

}  // namespace cayspin::inline v0_1
