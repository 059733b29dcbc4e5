// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/isotropy/policies.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stability.hpp>
#include <cayspin/stage/kernel.hpp>
#include <cayspin/stencil.hpp>
#include <cayspin/stepper/stepper_base.hpp>
#include <cayspin/stepper/tableau.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <utility>

namespace cayspin::inline v0_2 {

namespace detail {

/// Stage `Stage` of the misprinted method. Stages 0 to 2 store a = dt * xi, and rotate m0 by a / 2,
/// a / 2 and a for the next stage. The last stage forms all increments and ends the step.
template <int Stage, class Isotropy, class Generator, class Real>
struct AsPrintedStage {
  using Tableau = tableau::Classical4;
  static constexpr bool last = Stage == 3;

  Generator generator;
  Isotropy isotropy;
  SiteArray<Real, 3> start, level, generators[3];
  OutputArray<Real, 3> kept, next;
  Real dt;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    using Value = typename Site::value_type;
    Stencil<Site, Real> const stencil(site, level);
    Vec3<Value> const m0 = site.load(start);
    Vec3<Value> f[4];
    f[Stage] = Value(dt) * isotropy(stencil.center(), evaluate(generator, stencil));
    if constexpr (last) {
      unrolled<3>([&](auto j) { f[j()] = site.load(generators[j()]); });
      // The last increment comes first: each increment overwrites its stage's `a`, which the
      // increment of the next stage needs.
      unrolled<3>([&](auto j) {
        constexpr int stage = 3 - j();
        f[stage] = Cayley::inverse_differential(
            weighted_sum<StageWeights<Tableau, stage>, stage>(f), f[stage]);
      });
      site.store(Cayley::rotate(weighted_sum<FinalWeights<Tableau>, 4>(f), m0), next);
    } else {
      constexpr double weight = Tableau::a[Stage + 1][Stage];
      site.store(f[Stage], kept);
      site.store(
          Cayley::rotate(
              weight == 1 ? f[Stage] : Vec3<Value>(Value(static_cast<Real>(weight)) * f[Stage]),
              m0),
          next);
    }
  }
};

}  // namespace detail

/// Runge-Kutta-Munthe-Kaas as printed in Lewis and Nigam 2002, Sec. 4.4: stages 3 and 4 take the
/// generators A_2 and A_3 in place of the increments F_2 and F_3. Order 3.
template <class Spins, class Isotropy = isotropy::Zero>
class Rkmk4AsPrinted : public detail::StepperBase<Spins> {
  using Base = detail::StepperBase<Spins>;

 public:
  using typename Base::Real;
  using tableau_type = tableau::Classical4;
  static constexpr int order = 3;
  static constexpr int evaluations = 4;
  static constexpr int work_fields = 5;

  explicit Rkmk4AsPrinted(Spins const& like, Isotropy isotropy = {})
      : Base("Rkmk4AsPrinted", like.lattice()),
        isotropy_(isotropy),
        levels_(detail::numbered_fields<Spins, 2>("Rkmk4AsPrinted::level", like.lattice())),
        generators_(
            detail::numbered_fields<Spins, 3>("Rkmk4AsPrinted::generator", like.lattice())) {}

  std::size_t work_bytes() const { return work_fields * levels_[0].bytes(); }

  /// Advances `spins` from t to t + dt under `generator`. Throws std::invalid_argument when `spins`
  /// is not on the lattice given at construction.
  template <class Exec, class Generator>
  void step(Exec const& exec, Generator const& generator, Spins& spins, double t, double dt) {
    auto const region = this->begin_step(exec, spins);
    stage<0>(exec, generator, spins, spins, levels_[0], t, dt);
    stage<1>(exec, generator, spins, levels_[0], levels_[1], t, dt);
    stage<2>(exec, generator, spins, levels_[1], levels_[0], t, dt);
    stage<3>(exec, generator, spins, levels_[0], spins, t, dt);
  }

  /// Returns the factor by which a linear mode grows in one step (cayspin/stability.hpp).
  static detail::Complex mode_growth(detail::Complex z, double q) {
    using detail::NearAxis;
    using Linear = detail::LinearUpdate<update::Lie<Cayley>>;
    NearAxis total, argument;
    for (int stage = 0; stage < 4; ++stage) {
      detail::Complex const growth = Linear::growth(argument);
      NearAxis const generator{detail::Complex(0, 1) * z * (1.0 + growth) + q * growth, q};
      auto const increment = Linear::increment(argument, generator, z, 1.0 + growth);
      total = total + tableau_type::b[stage] * increment;
      if (stage < 3) argument = tableau_type::a[stage + 1][stage] * generator;
    }
    return Linear::growth(total);
  }

 private:
  template <int Stage, class Exec, class Generator>
  void stage(Exec const& exec, Generator const& generator, Spins const& start, Spins const& level,
             Spins const& next, double t, double dt) const {
    auto prepared = detail::prepare_term(generator, exec, level, t + tableau_type::c[Stage] * dt);
    using Kernel = detail::AsPrintedStage<Stage, Isotropy, decltype(prepared), Real>;
    Kernel kernel{
        std::move(prepared),  isotropy_, start.array(), level.array(), {}, {}, next.output(false),
        static_cast<Real>(dt)};
    for (int j = 0; j < 3; ++j) kernel.generators[j] = generators_[j].array();
    if constexpr (Stage < 3) kernel.kept = generators_[Stage].output(false);
    detail::for_each_site<Real>(exec, labels_[Stage], start.layout(), kernel);
  }

  Isotropy isotropy_;
  std::array<Spins, 2> levels_;
  std::array<Spins, 3> generators_;
  std::array<std::string, 4> labels_ = this->template stage_labels<4>();
};

}  // namespace cayspin::inline v0_2
